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
  std::uint64_t point = 0;
  std::optional<Setting> setting;  ///< nothing if it was refused
  bool render = false;
};

/// Options of the runs of one kind.
RequirementOptions options_of(RequirementOptions options, Confirm confirm) {
  options.confirm = confirm;
  if (confirm == Confirm::tracks) options.runs = options.track_runs;
  return options;
}

void find_limits(const RequirementOptions& options, RecordedRuns& runs, Trial& trial) {
  Candidate& candidate = trial.candidate;
  candidate.limits.clear();
  if (candidate.verdict == Verdict::reached || !std::isfinite(candidate.need)) return;
  candidate.limits = limits_of(*trial.setting, candidate.need, options.targets);
  for (Limit& limit : runs.limits()) candidate.limits.push_back(std::move(limit));
  std::stable_sort(candidate.limits.begin(), candidate.limits.end(),
                   [](const Limit& a, const Limit& b) { return a.gain > b.gain; });
}

/// By tracks, for good where nothing is to be rendered.
void judge_by_tracks(const Sweep& sweep, const RequirementOptions& options, Trial& trial) {
  const RequirementOptions as_tracks = options_of(options, Confirm::tracks);
  Candidate& candidate = trial.candidate;
  RecordedRuns runs(sweep, *trial.setting, trial.point, as_tracks);
  candidate.verdict = runs.judge(candidate.results);
  candidate.judged_by = Confirm::tracks;
  trial.render = options.confirm == Confirm::clips;
  if (!trial.render) find_limits(options, runs, trial);
}

/// By rendered runs: all of them where the point would be the first that reaches the targets. What tracks, which are
/// many, miss by their clock alone is not reached by a few rendered runs in which the clock did not show.
void judge_by_clips(const Sweep& sweep, const RequirementOptions& options, bool none_before, Trial& trial) {
  Candidate& candidate = trial.candidate;
  RecordedRuns runs(sweep, *trial.setting, trial.point, options);
  const bool tracks_miss = candidate.verdict == Verdict::missed;
  for (TargetResult& result : candidate.results) result.by_tracks = result.found;
  candidate.verdict = runs.judge(candidate.results);
  candidate.judged_by = Confirm::clips;
  if (candidate.verdict == Verdict::reached && (none_before || tracks_miss)) {
    candidate.verdict = runs.judge_all(candidate.results);
  }
  if (candidate.verdict == Verdict::reached && tracks_miss && options.runs < kRunsForQuantile) {
    candidate.verdict = Verdict::undecided;
  }
  find_limits(options, runs, trial);
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

std::string codec_text(const render::Scenario& scenario) {
  const std::string name = scenario.codec == render::Codec::h264    ? "H.264"
                           : scenario.codec == render::Codec::mjpeg ? "MJPEG"
                                                                    : "frames without loss";
  const render::Compression& how = scenario.compression;
  if (scenario.codec == render::Codec::mjpeg) return fmt::format("{} of quality {}", name, how.quality);
  if (scenario.codec != render::Codec::h264) return name;
  return how.bitrate_kbit_s > 0.0 ? fmt::format("{} at {:.3g} Mbit/s", name, how.bitrate_kbit_s / 1000.0)
                                  : fmt::format("{} at crf {:.3g}", name, how.crf);
}

/// By the bound and, where that allows the target, by tracks.
Trial trial_of(const Sweep& sweep, std::uint64_t point, const RequirementOptions& options) {
  const std::vector<base::TomlScalar> values = values_of(sweep, point * sweep.replicates);
  Trial trial;
  trial.point = point;
  Candidate& candidate = trial.candidate;
  candidate.results.resize(options.targets.size());
  set_price(sweep, values, candidate);
  as_candidate(candidate, [&] {
    const RunScenario run = scenario_with(sweep, values);
    trial.setting = {run.scenario, sweep.level == Level::tracks ? std::optional(run.noise_m) : std::nullopt};
    candidate.name = name_of(sweep, values, run.scenario);
    candidate.frame_rate_hz = run.scenario.recording.frame_rate_hz;
    candidate.pixels_s = candidate.frame_rate_hz * run.scenario.camera.width_px * run.scenario.camera.height_px;
    candidate.mode = {run.scenario.camera.width_px, run.scenario.camera.height_px, run.scenario.recording.exposure_s,
                      codec_text(run.scenario)};
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
      judge_by_tracks(sweep, options, trial);
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
    if (!trial.render) continue;
    ++size.close;
    all += pixels_of(trial.setting->scenario);
    if (least == nullptr || pixels_of(trial.setting->scenario) < pixels_of(least->setting->scenario)) least = &trial;
  }
  const std::uint64_t runs = std::min(kLeastRendered, options.runs);
  size.recordings = size.close * runs;
  if (least == nullptr) return size;
  const auto start = std::chrono::steady_clock::now();
  film_tracks(least->setting->scenario, 1, 1, [&](std::string_view, double) { options.watch(); });
  const double one_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  size.seconds = one_s * all / pixels_of(least->setting->scenario) * static_cast<double>(runs) /
                 std::min<double>(std::max(1, options.jobs), static_cast<double>(runs));
  return size;
}

/// Renders those that the bound allows, the cheapest first: one after another, each with its runs on all threads.
void confirm_by_clips(const Sweep& sweep, const RequirementOptions& options, const base::Progress& progress,
                      std::vector<Trial>& trials) {
  const ConfirmationSize size = size_of(trials, options);
  if (options.before_rendering) options.before_rendering(size);
  double all = 0.0, done = 0.0;  // pixels of the cameras
  for (const Trial& trial : trials) all += trial.render ? pixels_of(trial.setting->scenario) : 0.0;
  std::atomic<std::uint64_t> begun = 0;  // of a camera's runs; more than the least count no more
  double now = 0.0;
  RequirementOptions watched = options_of(options, Confirm::clips);
  watched.before_run = [&] {
    if (options.before_run) options.before_run();
    const double part = static_cast<double>(std::min(begun++, kLeastRendered)) / static_cast<double>(kLeastRendered);
    progress("rendered clips", (done + part * now) / all);
  };
  progress("rendered clips", 0.0);
  bool none_before = true;
  for (Trial& trial : trials) {
    if (!trial.render) continue;
    begun = 0;
    now = pixels_of(trial.setting->scenario);
    as_candidate(trial.candidate, [&] { judge_by_clips(sweep, watched, none_before, trial); });
    none_before = none_before && trial.candidate.verdict != Verdict::reached;
    done += now;
  }
  progress("rendered clips", 1.0);
}

/// The hardest error of a setting as tracks, over the targets; infinite where it is refused or its clips are too short.
double need_by_tracks(const Sweep& sweep, std::uint64_t point, const RequirementOptions& options,
                      const Setting& setting) {
  Candidate candidate;
  candidate.results.resize(options.targets.size());
  as_candidate(candidate, [&] { RecordedRuns(sweep, setting, point, options).judge(candidate.results); });
  return candidate.verdict == Verdict::refused ? std::numeric_limits<double>::infinity()
                                               : hardest_found(candidate.results, options.targets);
}

/// What would do in place of the first that reaches the targets, where that errs much less than it may: half the frame
/// rate again and again, and twice the noise again and again, as long as tracks, with what rendering adds to their
/// error, keep within the target.
void find_enough(const Sweep& sweep, const RequirementOptions& options, Trial& trial) {
  Candidate& candidate = trial.candidate;
  const double found = hardest_found(candidate.results, options.targets);
  if (!(found * kMuchLess < 1.0)) return;
  candidate.enough = Enough{1.0 / found, {}, {}};
  constexpr std::uint64_t kTrackRuns = 60;  // the least whose largest error is a limit of the 95 % error
  RequirementOptions as_tracks = options_of(options, Confirm::tracks);
  as_tracks.runs = std::min(options.track_runs, kTrackRuns);
  const double now = need_by_tracks(sweep, trial.point, as_tracks, *trial.setting);
  const double room = std::max(1.0, found / now);  // what rendering adds
  constexpr int kHalvings = 10;
  for (int i = 1; i <= kHalvings; ++i) {
    Setting slow = *trial.setting;
    slow.scenario.recording.frame_rate_hz = candidate.frame_rate_hz / std::pow(2.0, i);
    if (need_by_tracks(sweep, trial.point, as_tracks, slow) * room > 1.0) break;
    candidate.enough->frame_rate_hz = slow.scenario.recording.frame_rate_hz;
  }
  for (int i = 1; i <= kHalvings; ++i) {
    Setting noisy = *trial.setting;
    noisy.given_noise_m = candidate.noise_m * std::pow(2.0, i);
    if (need_by_tracks(sweep, trial.point, as_tracks, noisy) * room > 1.0) break;
    candidate.enough->noise_m = noisy.given_noise_m;
  }
}

}  // namespace

bool Requirement::any_reached() const {
  return first_reached() != nullptr;
}

const Candidate* Requirement::first_reached() const {
  const auto first = std::find_if(candidates.begin(), candidates.end(), [](const Candidate& candidate) {
    return candidate.verdict == Verdict::reached || candidate.verdict == Verdict::by_bound;
  });
  return first == candidates.end() ? nullptr : &*first;
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
  requirement.by_price =
      std::all_of(trials.begin(), trials.end(), [](const Trial& trial) { return trial.candidate.price.has_value(); });
  std::stable_sort(trials.begin(), trials.end(), [&](const Trial& a, const Trial& b) {
    return requirement.by_price ? *a.candidate.price < *b.candidate.price : a.candidate.pixels_s < b.candidate.pixels_s;
  });
  if (options.confirm == Confirm::clips) confirm_by_clips(sweep, options, progress, trials);
  const auto first = std::find_if(trials.begin(), trials.end(),
                                  [](const Trial& trial) { return trial.candidate.verdict == Verdict::reached; });
  if (first != trials.end()) find_enough(sweep, options, *first);
  for (Trial& trial : trials) requirement.candidates.push_back(std::move(trial.candidate));
  return requirement;
}

}  // namespace glidelab::validate
