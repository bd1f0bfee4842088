#include "validate/requirement.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>

#include "base/errors.h"
#include "core/parallel.h"
#include "diagnose/trajectory_results.h"
#include "render/camera_file.h"
#include "validate/camera_noise.h"
#include "validate/comparison.h"
#include "validate/made_tracks.h"
#include "validate/sweep_design.h"
#include "validate/sweep_run.h"
#include "validate/sweep_scenario.h"

namespace glidelab::validate {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kWide95 = 1.959963984540054;  // standard deviations that hold 95 %

std::optional<double> bound_of(const LeastSd& least, const std::string& quantity) {
  if (quantity == "k_over_m_1_s") return least.k_over_m_1_s;
  if (quantity == "mu") return least.mu;
  if (quantity == "alpha_deg") return least.alpha_deg;
  return least.v_lim_m_s;
}

/// The worst configuration's bound in the target's measure.
std::vector<TargetResult> bounds(const MadeTracks& made, const std::vector<double>& noise_m,
                                 const std::vector<Target>& targets) {
  std::vector<TargetResult> results(targets.size());
  if (std::any_of(noise_m.begin(), noise_m.end(), [](double noise) { return !std::isfinite(noise); })) {
    for (TargetResult& result : results) result.bound = kNever;
    return results;
  }
  const std::vector<LeastSd> all = least_sds(made.truth, noise_m, made.gravity_m_s2);
  for (std::size_t t = 0; t < targets.size(); ++t) {
    for (const LeastSd& least : all) {
      const std::optional<double> sd = bound_of(least, targets[t].quantity);
      if (!sd) continue;
      const double factor = targets[t].measure == Target::Measure::sd        ? 1.0
                            : targets[t].measure == Target::Measure::error95 ? kWide95
                                                                             : 0.0;
      results[t].bound = std::max(results[t].bound.value_or(0.0), factor * *sd);
    }
  }
  return results;
}

double hardest(const std::vector<TargetResult>& results, const std::vector<Target>& targets) {
  double need = 0.0;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    need = std::max(need, results[t].bound ? *results[t].bound / targets[t].value : kNever);
  }
  return need;
}

/// All that the bound of one point rests on.
struct Setting {
  render::Scenario scenario;
  std::optional<double> given_noise_m;  ///< of tracks
};

double need_of(const Setting& setting, const WithoutLimit& without, const std::vector<Target>& targets) {
  const MadeTracks made = make_tracks(setting.scenario, 1);
  const std::vector<double> noise_m = setting.given_noise_m
                                          ? std::vector<double>(made.truth.clips.size(), *setting.given_noise_m)
                                          : predicted_noise_m(setting.scenario, made.truth, without);
  return hardest(bounds(made, noise_m, targets), targets);
}

std::vector<Limit> limits_of(const Setting& setting, double need, const std::vector<Target>& targets) {
  std::vector<Limit> limits;
  const auto try_without = [&](const std::string& name, const Setting& changed, const WithoutLimit& without) {
    const double then = need_of(changed, without, targets);
    if (std::isfinite(then) && then > 0.0) limits.push_back({name, need / then});
  };
  constexpr double kFast_hz = 1000.0;
  if (setting.scenario.recording.frame_rate_hz < kFast_hz) {
    Setting fast = setting;
    fast.scenario.recording.frame_rate_hz = kFast_hz;
    try_without("frame rate (1000 Hz instead, the same exposure)", fast, {});
  }
  if (!setting.given_noise_m) {
    try_without("light (no shot noise)", setting, {.shot_noise = true});
    try_without("the camera's own noise (none)", setting, {.camera_noise = true});
    try_without("motion blur (none)", setting, {.motion_blur = true});
    try_without("resolution (4 times finer)", setting, {.finer = 4.0});
  }
  std::sort(limits.begin(), limits.end(), [](const Limit& a, const Limit& b) { return a.gain > b.gain; });
  return limits;
}

/// Errors of one estimator in one quantity of one configuration, over the runs.
struct Errors {
  std::string estimator, configuration, quantity;
  std::vector<double> errors;
  bool missing = false;
};

void add_errors(const std::vector<QuantityComparison>& quantities, std::vector<Errors>& all) {
  for (const QuantityComparison& q : quantities) {
    if (!q.truth) continue;
    auto found = std::find_if(all.begin(), all.end(), [&](const Errors& e) {
      return e.estimator == q.estimator && e.configuration == q.configuration && e.quantity == q.quantity;
    });
    if (found == all.end()) found = all.insert(all.end(), {q.estimator, q.configuration, q.quantity, {}, false});
    if (q.error) {
      found->errors.push_back(*q.error);
    } else {
      found->missing = true;
    }
  }
}

double measure_of(const Errors& errors, Target::Measure measure) {
  if (errors.missing || errors.errors.empty()) return kNever;
  double sum = 0.0, square = 0.0;
  for (const double error : errors.errors) {
    sum += error;
    square += error * error;
  }
  const double n = static_cast<double>(errors.errors.size());
  if (measure == Target::Measure::bias) return std::abs(sum / n);
  return std::sqrt(square / n) * (measure == Target::Measure::error95 ? kWide95 : 1.0);
}

/// The better estimator's measure, each judged by its worst configuration.
void judge(const std::vector<Errors>& all, const Target& target, TargetResult& result) {
  for (const char* estimator : {"phase-diagram", "trajectory"}) {
    double worst = 0.0;
    std::size_t runs = 0;
    for (const Errors& errors : all) {
      if (errors.estimator != estimator || errors.quantity != target.quantity) continue;
      worst = std::max(worst, measure_of(errors, target.measure));
      runs = errors.errors.size();
    }
    if (runs == 0 || (result.found && *result.found <= worst)) continue;
    result.found = worst;
    result.found_sd = worst / std::sqrt(2.0 * static_cast<double>(runs));
    result.estimator = estimator;
  }
}

core::AnalysisResults one_run(const Setting& setting, const MadeTracks& made, const std::vector<double>& noise_m,
                              std::uint64_t seed, Confirm confirm) {
  if (confirm == Confirm::clips) return phase_diagram_of(film_tracks(setting.scenario, seed, 1), {});
  // Clips of one scenario have about one noise: their root mean square.
  double square = 0.0;
  for (const double noise : noise_m) square += noise * noise / static_cast<double>(noise_m.size());
  return analyze_tracks(with_noise(made, std::sqrt(square), seed), std::nullopt);
}

void confirm_by_runs(const Sweep& sweep, const Setting& setting, std::uint64_t point, const RequirementOptions& options,
                     Candidate& candidate) {
  std::vector<Errors> all;
  for (std::uint64_t run = 0; run < options.runs; ++run) {
    const std::uint64_t seed = seed_of(sweep, point * options.runs + run);
    const MadeTracks made = make_tracks(setting.scenario, seed);
    const std::vector<double> noise_m = setting.given_noise_m
                                            ? std::vector<double>(made.truth.clips.size(), *setting.given_noise_m)
                                            : predicted_noise_m(setting.scenario, made.truth);
    const core::AnalysisResults results = one_run(setting, made, noise_m, seed, options.confirm);
    add_errors(compare_quantities(results, made.truth), all);
    add_errors(compare_quantities(diagnose::with_trajectory_fits(results), made.truth), all);
  }
  bool reached = true;
  for (std::size_t t = 0; t < options.targets.size(); ++t) {
    judge(all, options.targets[t], candidate.results[t]);
    reached = reached && candidate.results[t].found && *candidate.results[t].found <= options.targets[t].value;
  }
  candidate.verdict = reached ? Verdict::reached : Verdict::missed;
}

/// Dropped, duplicated and late frames are in no bound: the same runs with an even clock tell what they cost.
void add_clock_limit(const Sweep& sweep, const Setting& setting, std::uint64_t point, const RequirementOptions& options,
                     Candidate& candidate) {
  Setting even = setting;
  even.scenario.recording.clock = {};
  Candidate then;
  then.results.resize(options.targets.size());
  confirm_by_runs(sweep, even, point, options, then);
  double gain = 0.0;
  for (std::size_t t = 0; t < options.targets.size(); ++t) {
    if (!candidate.results[t].found || !then.results[t].found) continue;
    gain = std::max(gain, *candidate.results[t].found / *then.results[t].found);
  }
  if (std::isfinite(gain) && gain > 0.0) {
    candidate.limits.insert(candidate.limits.begin(), {"the camera's clock (even instead, by runs)", gain});
  }
  std::stable_sort(candidate.limits.begin(), candidate.limits.end(),
                   [](const Limit& a, const Limit& b) { return a.gain > b.gain; });
}

std::string name_of(const Sweep& sweep, const std::vector<base::TomlScalar>& values, const render::Scenario& scenario) {
  std::string name = scenario.camera_name;
  for (std::size_t i = 0; i < sweep.axes.size(); ++i) {
    if (sweep.axes[i].keys == std::vector<std::string>{"camera_file"}) continue;
    name += fmt::format("{}{} = {}", name.empty() ? "" : ", ", sweep.axes[i].name, base::toml_text(values[i]));
  }
  return name;
}

/// "3000-5000 EUR" is 4000; nothing where there is no number.
std::optional<double> price_of(const std::string& price_class) {
  std::istringstream text(price_class);
  double low = 0.0, high = 0.0;
  char dash = 0;
  if (!(text >> low)) return std::nullopt;
  if (text >> dash && dash == '-' && text >> high) return 0.5 * (low + high);
  return low;
}

void set_price(const Sweep& sweep, const std::vector<base::TomlScalar>& values, Candidate& candidate) {
  for (std::size_t i = 0; i < sweep.axes.size(); ++i) {
    if (sweep.axes[i].keys != std::vector<std::string>{"camera_file"}) continue;
    candidate.price_class = render::read_camera_name(std::get<std::string>(values[i])).price_class;
    candidate.price = price_of(candidate.price_class);
  }
}

Candidate candidate_of(const Sweep& sweep, std::uint64_t point, const RequirementOptions& options) {
  const std::vector<base::TomlScalar> values = values_of(sweep, point * sweep.replicates);
  Candidate candidate;
  candidate.results.resize(options.targets.size());
  set_price(sweep, values, candidate);
  try {
    const RunScenario run = scenario_with(sweep, values);
    const Setting setting{run.scenario, sweep.level == Level::tracks ? std::optional(run.noise_m) : std::nullopt};
    candidate.name = name_of(sweep, values, run.scenario);
    candidate.frame_rate_hz = run.scenario.recording.frame_rate_hz;
    candidate.pixels_s = candidate.frame_rate_hz * run.scenario.camera.width_px * run.scenario.camera.height_px;
    const MadeTracks made = make_tracks(setting.scenario, 1);
    const std::vector<double> noise_m = setting.given_noise_m
                                            ? std::vector<double>(made.truth.clips.size(), *setting.given_noise_m)
                                            : predicted_noise_m(setting.scenario, made.truth);
    for (const double noise : noise_m) candidate.noise_m += noise * noise / static_cast<double>(noise_m.size());
    candidate.noise_m = std::sqrt(candidate.noise_m);
    candidate.results = bounds(made, noise_m, options.targets);
    candidate.need = hardest(candidate.results, options.targets);
    const bool any_bias = std::any_of(options.targets.begin(), options.targets.end(),
                                      [](const Target& target) { return target.measure == Target::Measure::bias; });
    if (candidate.need > 1.0) {
      candidate.verdict = Verdict::impossible;
    } else if (candidate.need < 1.0 / kClear && !any_bias && options.confirm == Confirm::none) {
      candidate.verdict = Verdict::by_bound;
    } else if (options.confirm != Confirm::none) {
      confirm_by_runs(sweep, setting, point, options, candidate);
    }
    const bool short_of_it = candidate.verdict == Verdict::impossible || candidate.verdict == Verdict::missed;
    if (short_of_it && std::isfinite(candidate.need)) {
      candidate.limits = limits_of(setting, candidate.need, options.targets);
      if (candidate.verdict == Verdict::missed) add_clock_limit(sweep, setting, point, options, candidate);
    }
  } catch (const base::InputError& error) {
    candidate.verdict = Verdict::refused;
    candidate.why = error.what();
  } catch (const base::NumericalError& error) {
    candidate.verdict = Verdict::refused;
    candidate.why = error.what();
  }
  if (candidate.name.empty()) candidate.name = fmt::format("point {}", point);
  return candidate;
}

}  // namespace

std::string Target::name() const {
  const char* measures[] = {"sd", "95 % error", "bias"};
  return fmt::format("{} {} {}", quantity, measures[static_cast<int>(measure)], value);
}

Target parse_target(const std::string& text) {
  Target target;
  const std::size_t equals = text.find('='), colon = text.find(':');
  target.quantity = text.substr(0, std::min(colon, equals));
  const std::string measure =
      colon < equals && equals != std::string::npos ? text.substr(colon + 1, equals - colon - 1) : "sd";
  const std::vector<std::string> quantities = {"k_over_m_1_s", "mu", "alpha_deg", "v_lim_m_s"};
  std::istringstream number(equals == std::string::npos ? "" : text.substr(equals + 1));
  const bool read = (number >> target.value) && number.peek() == std::istringstream::traits_type::eof();
  const bool known = std::find(quantities.begin(), quantities.end(), target.quantity) != quantities.end();
  if (!read || !known || !(target.value > 0.0) || (measure != "sd" && measure != "error95" && measure != "bias")) {
    throw base::InputError(base::Issue{"", 0, "--target", fmt::format("\"{}\"", text),
                                       fmt::format("QUANTITY=VALUE, or QUANTITY:sd|error95|bias=VALUE, with one of {} "
                                                   "and a number above 0",
                                                   fmt::join(quantities, ", "))});
  }
  target.measure = measure == "sd"     ? Target::Measure::sd
                   : measure == "bias" ? Target::Measure::bias
                                       : Target::Measure::error95;
  return target;
}

std::string describe(Verdict verdict) {
  switch (verdict) {
    case Verdict::reached:
      return "reached, by runs";
    case Verdict::by_bound:
      return "reached, the bound has room";
    case Verdict::unconfirmed:
      return "possible, not run";
    case Verdict::missed:
      return "missed, by runs";
    case Verdict::impossible:
      return "impossible";
    case Verdict::refused:
      break;
  }
  return "refused";
}

bool Requirement::any_reached() const {
  return std::any_of(candidates.begin(), candidates.end(), [](const Candidate& candidate) {
    return candidate.verdict == Verdict::reached || candidate.verdict == Verdict::by_bound;
  });
}

Requirement find_requirement(const Sweep& sweep, const RequirementOptions& options, const base::Progress& progress) {
  Requirement requirement;
  requirement.name = sweep.name;
  requirement.targets = options.targets;
  requirement.confirm = options.confirm;
  requirement.runs = options.runs;
  const std::uint64_t points = point_count(sweep);
  constexpr std::uint64_t kMost = 100000;  // they are held and shown together
  if (points > kMost) {
    throw base::InputError(base::Issue{sweep.file.string(), 0, "vary", fmt::format("{} combinations", points),
                                       fmt::format("at most {}", kMost)});
  }
  requirement.candidates.resize(points);
  std::atomic<std::uint64_t> done = 0;
  core::for_each_parallel(points, options.jobs, [&](std::size_t point) {
    requirement.candidates[point] = candidate_of(sweep, point, options);
    progress("cameras", static_cast<double>(++done) / static_cast<double>(points));
  });
  requirement.by_price = std::all_of(requirement.candidates.begin(), requirement.candidates.end(),
                                     [](const Candidate& candidate) { return candidate.price.has_value(); });
  std::stable_sort(requirement.candidates.begin(), requirement.candidates.end(),
                   [&](const Candidate& a, const Candidate& b) {
                     return requirement.by_price ? *a.price < *b.price : a.pixels_s < b.pixels_s;
                   });
  return requirement;
}

}  // namespace glidelab::validate
