#include "validate/study/requirement/requirement.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <sstream>

#include "base/errors.h"
#include "base/long_work.h"
#include "render/film/clip_renderer.h"
#include "render/scenario/scenario.h"
#include "validate/film/film_studio.h"
#include "validate/study/requirement/requirement_trial.h"
#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/design/sweep_scenario.h"
#include "validate/tracks/made_tracks.h"

namespace glidelab::validate {
namespace {

std::string name_of(const Sweep& sweep, const std::vector<base::TomlScalar>& values, const render::Scenario& scenario) {
  std::string name = scenario.camera_name;
  for (std::size_t i = 0; i < sweep.axes.size(); ++i) {
    if (sweep.axes[i].keys == std::vector<std::string>{"camera_file"}) continue;
    if (!name.empty()) name += ", ";
    name += sweep.axes[i].choices.empty() ? fmt::format("{} = {}", sweep.axes[i].name, base::toml_text(values[i]))
                                          : std::get<std::string>(values[i]);
  }
  return name;
}

/// "3000-5000 EUR" is 4000; nothing if there is no number.
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

/// Errors over targets, of the hardest.
double hardest_found(const std::vector<TargetResult>& results, const std::vector<Target>& targets) {
  double most = 0.0;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    most = std::max(most, results[t].found.value_or(std::numeric_limits<double>::infinity()) / targets[t].value);
  }
  return most;
}

/// A point of the sweep on its way to a verdict.
struct Trial {
  Candidate candidate;
  std::optional<Setting> setting;  ///< nothing if it was refused
  bool close = false;              ///< to be rendered
};

void judge_by_runs(const Sweep& sweep, std::uint64_t point, RequirementOptions options, Confirm confirm, Trial& trial) {
  options.confirm = confirm;
  if (confirm == Confirm::tracks) options.runs = options.track_runs;
  Candidate& candidate = trial.candidate;
  candidate.limits.clear();
  RecordedRuns runs(sweep, *trial.setting, point, options);
  candidate.verdict = runs.judge(candidate.results);
  candidate.judged_by = confirm;
  const double found = hardest_found(candidate.results, options.targets);
  if (confirm == Confirm::tracks) trial.close = found < kClearMargin && found > 1.0 / kClearMarginOfClips;
  if (candidate.verdict == Verdict::reached || !std::isfinite(candidate.need)) return;
  candidate.limits = limits_of(*trial.setting, candidate.need, options.targets);
  for (Limit& limit : runs.limits(candidate.results)) candidate.limits.push_back(std::move(limit));
  std::stable_sort(candidate.limits.begin(), candidate.limits.end(),
                   [](const Limit& a, const Limit& b) { return a.gain > b.gain; });
}

/// `work`, whose errors are the candidate's.
template <typename Work>
void as_candidate(Candidate& candidate, const Work& work) {
  try {
    work();
  } catch (const base::InputError& error) {
    candidate.verdict = Verdict::refused;
    candidate.why = error.what();
  } catch (const base::NumericalError& error) {
    candidate.verdict = Verdict::refused;
    candidate.why = error.what();
  }
}

/// By the bound and, where that allows the target, by tracks.
Trial trial_of(const Sweep& sweep, std::uint64_t point, const RequirementOptions& options) {
  const std::vector<base::TomlScalar> values = values_of(sweep, point * sweep.replicates);
  Trial trial;
  Candidate& candidate = trial.candidate;
  candidate.results.resize(options.targets.size());
  set_price(sweep, values, candidate);
  as_candidate(candidate, [&] {
    const RunScenario run = scenario_with(sweep, values);
    trial.setting = {run.scenario, sweep.level == Level::tracks ? std::optional(run.noise_m) : std::nullopt};
    candidate.name = name_of(sweep, values, run.scenario);
    candidate.frame_rate_hz = run.scenario.recording.frame_rate_hz;
    candidate.pixels_s = candidate.frame_rate_hz * run.scenario.camera.width_px * run.scenario.camera.height_px;
    const MadeTracks made = make_tracks(trial.setting->scenario, 1);
    const std::vector<double> noise_m = noise_of(*trial.setting, made.truth);
    for (const double noise : noise_m) candidate.noise_m += noise * noise / static_cast<double>(noise_m.size());
    candidate.noise_m = std::sqrt(candidate.noise_m);
    candidate.results = bounds(made, noise_m, options.targets);
    candidate.need = hardest(candidate.results, options.targets);
    const bool any_bias = std::any_of(options.targets.begin(), options.targets.end(),
                                      [](const Target& target) { return target.measure == Target::Measure::bias; });
    if (candidate.need > 1.0) {
      candidate.verdict = Verdict::impossible;
      if (std::isfinite(candidate.need)) candidate.limits = limits_of(*trial.setting, candidate.need, options.targets);
    } else if (options.confirm != Confirm::none) {
      judge_by_runs(sweep, point, options, Confirm::tracks, trial);
    } else if (candidate.need < 1.0 / kClearMargin && !any_bias) {
      candidate.verdict = Verdict::by_bound;
    }
  });
  if (candidate.name.empty()) candidate.name = fmt::format("point {}", point);
  return trial;
}

/// What it takes to render a scenario's clips, in units of their pixels.
double pixels_of(const render::Scenario& scenario) {
  return static_cast<double>(render::count_clips(scenario, 1).frames) * scenario.camera.width_px *
         scenario.camera.height_px;
}

/// From the smallest recording of all, which is made for that and thrown away.
ConfirmationSize size_of(const std::vector<Trial>& trials, const RequirementOptions& options) {
  ConfirmationSize size;
  size.points = trials.size();
  double all = 0.0;
  const Trial* least = nullptr;
  for (const Trial& trial : trials) {
    if (!trial.close) continue;
    ++size.close;
    all += pixels_of(trial.setting->scenario);
    if (least == nullptr || pixels_of(trial.setting->scenario) < pixels_of(least->setting->scenario)) least = &trial;
  }
  size.recordings = size.close * options.runs;
  if (least == nullptr) return size;
  const auto start = std::chrono::steady_clock::now();
  film_tracks(least->setting->scenario, 1, 1, [&](std::string_view, double) { options.watch(); });
  const double one_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  size.seconds = one_s * all / pixels_of(least->setting->scenario) * static_cast<double>(options.runs) /
                 std::min<double>(std::max(1, options.jobs), static_cast<double>(options.runs));
  return size;
}

/// Renders those that are close: one after another, each with its runs on all threads.
void confirm_by_clips(const Sweep& sweep, const RequirementOptions& options, const base::Progress& progress,
                      std::vector<Trial>& trials) {
  const ConfirmationSize size = size_of(trials, options);
  if (options.before_rendering) options.before_rendering(size);
  std::uint64_t done = 0;
  std::atomic<std::uint64_t> begun = 0;  // of a camera's runs; those of what is thought away count no more
  RequirementOptions watched = options;
  watched.before_run = [&] {
    if (options.before_run) options.before_run();
    const std::uint64_t before = std::min(begun++, options.runs);
    progress("rendered clips", static_cast<double>(done * options.runs + before) /
                                   static_cast<double>(std::max<std::uint64_t>(1, size.recordings)));
  };
  progress("rendered clips", 0.0);
  for (std::uint64_t point = 0; point < trials.size(); ++point) {
    Trial& trial = trials[point];
    if (!trial.close) continue;
    begun = 0;
    as_candidate(trial.candidate, [&] { judge_by_runs(sweep, point, watched, Confirm::clips, trial); });
    ++done;
  }
  progress("rendered clips", 1.0);
}

}  // namespace

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
  requirement.track_runs = options.track_runs;
  requirement.runs = options.runs;
  const std::uint64_t points = point_count(sweep);
  constexpr std::uint64_t kMost = 100000;  // they are held and shown together
  if (points > kMost) {
    throw base::InputError(base::Issue{sweep.file.string(), 0, "vary", fmt::format("{} combinations", points),
                                       fmt::format("at most {}", kMost)});
  }
  std::vector<Trial> trials(points);
  std::atomic<std::uint64_t> done = 0;
  RequirementOptions one_thread = options;
  one_thread.jobs = 1;
  one_thread.before_run = [&] {  // whoever wants to stop need not wait for all runs of a camera
    if (options.before_run) options.before_run();
    progress("cameras", static_cast<double>(done) / static_cast<double>(points));
  };
  base::for_each_parallel(points, options.jobs, [&](std::size_t point) {
    trials[point] = trial_of(sweep, point, one_thread);
    progress("cameras", static_cast<double>(++done) / static_cast<double>(points));
  });
  if (options.confirm == Confirm::clips) confirm_by_clips(sweep, options, progress, trials);
  for (Trial& trial : trials) requirement.candidates.push_back(std::move(trial.candidate));
  requirement.by_price = std::all_of(requirement.candidates.begin(), requirement.candidates.end(),
                                     [](const Candidate& candidate) { return candidate.price.has_value(); });
  std::stable_sort(requirement.candidates.begin(), requirement.candidates.end(),
                   [&](const Candidate& a, const Candidate& b) {
                     return requirement.by_price ? *a.price < *b.price : a.pixels_s < b.pixels_s;
                   });
  return requirement;
}

}  // namespace glidelab::validate
