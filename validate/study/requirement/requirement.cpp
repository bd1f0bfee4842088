#include "validate/study/requirement/requirement.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <sstream>

#include "base/errors.h"
#include "base/long_work.h"
#include "render/film/clip_renderer.h"
#include "render/film/stills.h"
#include "render/scenario/scenario.h"
#include "validate/film/film_studio.h"
#include "validate/made_tracks/made_tracks.h"
#include "validate/study/requirement/requirement_trial.h"
#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/design/sweep_scenario.h"

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

/// Error over target, for the hardest target.
double hardest_found(const std::vector<TargetResult>& results, const std::vector<Target>& targets) {
  double most = 0.0;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    most = std::max(most, results[t].found.value_or(std::numeric_limits<double>::infinity()) / targets[t].value);
  }
  return most;
}

/// A point of the sweep that is being judged.
struct Trial {
  Candidate candidate;
  std::uint64_t point = 0;
  std::optional<Setting> setting;  ///< empty if it was refused
  bool render = false;
  bool tracks_miss = false;
  std::vector<Limit> limits_by_tracks = {};  ///< of one that tracks do not show to reach the targets
  bool settled = false;                      ///< more rendered runs would not change the verdict
  std::unique_ptr<RecordedRuns> runs = {};   ///< if it is rendered
};

constexpr std::uint64_t kFewTrackRuns =
    60;  // the largest of 59 errors is a limit of the 95 % error, for any distribution

/// Options of the runs of one kind.
RequirementOptions options_of(RequirementOptions options, Confirm confirm) {
  options.confirm = confirm;
  if (confirm == Confirm::tracks) options.runs = options.track_runs;
  return options;
}

/// From this gain on, the clock makes most of the squared error: no other limitation removed alone reduces the error as
/// much, whatever it does to the bound.
const double kMostOfError = std::sqrt(2.0);

/// Finds limits by the bound, by tracks (many runs, which show rarely lost frames) and, if given, by rendered runs.
void find_limits(const RequirementOptions& options, RecordedRuns* runs, Trial& trial) {
  Candidate& candidate = trial.candidate;
  candidate.limits.clear();
  const bool not_filmed = candidate.verdict == Verdict::unconfirmed && options.confirm != Confirm::none;
  const bool none = candidate.verdict == Verdict::reached || not_filmed || candidate.verdict == Verdict::refused;
  if (none || !std::isfinite(candidate.need)) return;
  candidate.limits = limits_of(*trial.setting, candidate.need, options.targets);
  candidate.limits.insert(candidate.limits.end(), trial.limits_by_tracks.begin(), trial.limits_by_tracks.end());
  if (runs != nullptr) {
    for (const Limit& limit : runs->limits()) {
      const bool known = std::ranges::any_of(trial.limits_by_tracks,
                                             [&](const Limit& by_tracks) { return by_tracks.what == limit.what; });
      if (!known) candidate.limits.push_back(limit);
    }
  }
  std::stable_sort(candidate.limits.begin(), candidate.limits.end(),
                   [](const Limit& a, const Limit& b) { return a.gain > b.gain; });
  if (trial.limits_by_tracks.empty()) return;
  std::stable_partition(candidate.limits.begin(), candidate.limits.end(), [](const Limit& limit) {
    return limit.what == Limitation::clock && limit.gain >= kMostOfError;
  });
}

/// Judges by tracks: finally, if nothing is to be rendered; otherwise by fewer, if these decide.
void judge_by_tracks(const Sweep& sweep, const RequirementOptions& options, Trial& trial) {
  const RequirementOptions as_tracks = options_of(options, Confirm::tracks);
  Candidate& candidate = trial.candidate;
  RecordedRuns runs(sweep, *trial.setting, trial.point, as_tracks);
  trial.render = options.confirm == Confirm::clips;
  candidate.judged_by = Confirm::tracks;
  candidate.verdict = Verdict::undecided;
  if (trial.render) candidate.verdict = runs.judge_after(std::min(kFewTrackRuns, as_tracks.runs), candidate.results);
  if (candidate.verdict == Verdict::undecided) candidate.verdict = runs.judge_after(as_tracks.runs, candidate.results);
  if (candidate.verdict != Verdict::reached) trial.limits_by_tracks = runs.limits();
  if (!trial.render) find_limits(options, nullptr, trial);
}

/// Does `work`, whose errors become those of the candidate.
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

CodecSetting codec_of(const render::Scenario& scenario) {
  const render::Compression& how = scenario.compression;
  if (scenario.codec == render::Codec::mjpeg) return {CodecSetting::Kind::mjpeg, static_cast<double>(how.quality)};
  if (scenario.codec != render::Codec::h264) return {};
  return how.bitrate_kbit_s > 0.0 ? CodecSetting{CodecSetting::Kind::h264_bitrate, how.bitrate_kbit_s}
                                  : CodecSetting{CodecSetting::Kind::h264_quality, how.crf};
}

/// Tests a point by the bound and, if that allows the target, by tracks.
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
                      codec_of(run.scenario)};
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

/// Approximate cost of a scenario's stills and of rendering and reading its clips, in nanoseconds of one core.
double work_of(const render::Scenario& scenario) {
  constexpr double kStill = 25.0, kLossless = 1.5, kLossy = 20.0;  // ns per pixel
  constexpr double kAnalysis = 3e8;                                // ns
  const double pixels = static_cast<double>(scenario.camera.width_px) * scenario.camera.height_px;
  return kAnalysis + pixels * (kStill * static_cast<double>(render::count_stills(scenario)) +
                               (render::lossy(scenario.codec) ? kLossy : kLossless) *
                                   static_cast<double>(render::count_clips(scenario, 1).frames));
}

/// Cost of drawing the static scene, once per camera; likewise.
double stage_work_of(const render::Scenario& scenario) {
  constexpr double kStage = 700.0;  // ns per pixel
  return kStage * static_cast<double>(scenario.camera.width_px) * scenario.camera.height_px;
}

/// Estimated from the smallest recording of all, which is made for this purpose and discarded.
ConfirmationSize size_of(const std::vector<Trial*>& trials, std::size_t points, const RequirementOptions& options) {
  ConfirmationSize size;
  size.points = points;
  size.close = trials.size();
  if (trials.empty()) return size;
  size.recordings = options.runs;
  const auto work = [](const Trial* trial) { return work_of(trial->setting->scenario); };
  const auto stage_work = [](const Trial* trial) { return stage_work_of(trial->setting->scenario); };
  double each = 0.0;
  for (const Trial* trial : trials) {
    each += work(trial) * static_cast<double>(std::min(kLeastRendered, options.runs)) + stage_work(trial);
  }
  const double first = work(trials.front()) * static_cast<double>(options.runs) + stage_work(trials.front());
  const Trial* smallest = *std::ranges::min_element(trials, {}, work);
  const auto start = std::chrono::steady_clock::now();
  film_tracks(smallest->setting->scenario, 1, 1, [&](std::string_view, double) { options.watch(); });
  const double one_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const double per_work = one_s / (work(smallest) + stage_work(smallest)) / std::max(1, options.jobs);
  size.seconds = per_work * first;
  size.seconds_each = per_work * each;
  return size;
}

/// Rendered runs of several points concurrently, on all threads.
class Rendering {
 public:
  Rendering(const RequirementOptions& options, const base::Progress& progress)
      : options_(options), progress_(progress) {}

  /// Announces additional work to be rendered.
  void expect(double work) { expected_ = expected_ + work; }

  /// Each point gets `runs` in total. Runs of as many points as there are threads alternate, so that no thread waits
  /// for another to draw the same point.
  void render(const std::vector<Trial*>& trials, std::uint64_t runs) {
    struct Task {
      Trial* trial;
      std::uint64_t run;
    };
    std::vector<Task> tasks;
    std::map<const Trial*, std::atomic<std::uint64_t>> left;
    const std::size_t side_by_side = static_cast<std::size_t>(std::max(1, options_.jobs));
    for (std::size_t first = 0; first < trials.size(); first += side_by_side) {
      const std::size_t end = std::min(trials.size(), first + side_by_side);
      for (std::uint64_t run = 0; run < runs; ++run) {
        for (std::size_t i = first; i < end; ++i) {
          if (run < trials[i]->runs->planned()) continue;
          tasks.push_back({trials[i], run});
          ++left[trials[i]];
        }
      }
    }
    for (Trial* const trial : trials) trial->runs->plan(runs);
    base::for_each_parallel(tasks.size(), options_.jobs, [&](std::size_t i) {
      const Task& task = tasks[i];
      tell(0.0);
      task.trial->runs->make(task.run);
      tell(work_of(task.trial->setting->scenario));
      if (--left.at(task.trial) == 0) task.trial->runs->clear_stage();
    });
  }

 private:
  void tell(double work) {
    const double done = done_ += work;
    progress_("rendered runs", std::min(1.0, done / std::max(expected_.load(), done)));
  }

  const RequirementOptions& options_;
  const base::Progress& progress_;
  std::atomic<double> done_ = 0.0, expected_ = 0.0;
};

/// Judges by all its rendered runs. A target that many tracks miss because of the clock alone is not reached by a few
/// rendered runs in which the clock did not show.
void judge_by_clips(const RequirementOptions& options, Trial& trial) {
  Candidate& candidate = trial.candidate;
  as_candidate(candidate, [&] {
    candidate.verdict = trial.runs->judge(candidate.results, confidence_of_look(options.runs));
    candidate.judged_by = Confirm::clips;
    trial.settled = candidate.verdict != Verdict::undecided;
    if (candidate.verdict != Verdict::reached || !trial.tracks_miss) return;
    if (options.runs < kRunsForQuantile) {
      candidate.verdict = Verdict::undecided;  // final
    } else {
      trial.settled = trial.runs->planned() == options.runs;
    }
  });
  if (candidate.verdict == Verdict::refused) trial.settled = true;
}

/// Renders one point more and more often until its verdict is final, and `options.runs` times if it reaches the
/// targets.
void render_until_settled(const RequirementOptions& options, Rendering& rendering, Trial& trial) {
  const auto render = [&](std::uint64_t runs) {
    const std::uint64_t more = runs - std::min(runs, trial.runs->planned());
    rendering.expect(work_of(trial.setting->scenario) * static_cast<double>(more));
    rendering.render({&trial}, runs);
    judge_by_clips(options, trial);
  };
  for (const std::uint64_t runs : looks(options.runs)) {
    render(runs);
    if (trial.settled) break;
  }
  if (trial.candidate.verdict == Verdict::reached) render(options.runs);
}

/// Renders those that the bound allows, the cheapest first, until one reaches the targets: what is more expensive
/// cannot change what to buy. A more expensive one that reaches them as tracks is unconfirmed.
void confirm_by_clips(const Sweep& sweep, const RequirementOptions& options, const base::Progress& progress,
                      std::vector<Trial>& trials) {
  std::vector<Trial*> chosen;
  for (Trial& trial : trials) {
    if (trial.render) chosen.push_back(&trial);
  }
  const ConfirmationSize size = size_of(chosen, trials.size(), options);
  if (options.before_rendering) options.before_rendering(size);
  const RequirementOptions as_clips = options_of(options, Confirm::clips);
  Rendering rendering(options, progress);
  auto buy = chosen.begin();
  for (; buy != chosen.end(); ++buy) {
    Trial& trial = **buy;
    trial.tracks_miss = trial.candidate.verdict == Verdict::missed;
    for (TargetResult& result : trial.candidate.results) result.by_tracks = result.found;
    trial.runs = std::make_unique<RecordedRuns>(sweep, *trial.setting, trial.point, as_clips);
    render_until_settled(options, rendering, trial);
    if (trial.candidate.verdict == Verdict::reached) break;
  }
  for (auto trial = buy; trial != chosen.end(); ++trial) {
    if (trial != buy && (*trial)->candidate.verdict == Verdict::reached)
      (*trial)->candidate.verdict = Verdict::unconfirmed;
  }
  progress("rendered runs", 1.0);
  // Rendered runs show what limits the cheaper points; the bound and tracks, what limits the more expensive ones.
  for (auto trial = chosen.begin(); trial != chosen.end(); ++trial) {
    progress("what limits the others",
             static_cast<double>(trial - chosen.begin()) / static_cast<double>(chosen.size()));
    RecordedRuns* const runs = trial < buy ? (*trial)->runs.get() : nullptr;
    as_candidate((*trial)->candidate, [&] { find_limits(options, runs, **trial); });
    (*trial)->runs.reset();
  }
}

/// The error over target of a setting as tracks, for the hardest target; infinite if it is refused or its clips are too
/// short.
double need_by_tracks(const Sweep& sweep, std::uint64_t point, const RequirementOptions& options,
                      const Setting& setting) {
  Candidate candidate;
  candidate.results.resize(options.targets.size());
  as_candidate(candidate,
               [&] { RecordedRuns(sweep, setting, point, options).judge_after(options.runs, candidate.results); });
  return candidate.verdict == Verdict::refused ? std::numeric_limits<double>::infinity()
                                               : hardest_found(candidate.results, options.targets);
}

/// Finds what would suffice instead of the first that reaches the targets, if that is much better than needed: the
/// frame rate is halved repeatedly, and the noise doubled repeatedly, as long as tracks, including the error added by
/// rendering, stay within the target.
void find_enough(const Sweep& sweep, const RequirementOptions& options, Trial& trial) {
  Candidate& candidate = trial.candidate;
  const double found = hardest_found(candidate.results, options.targets);
  if (!(found * kMuchLess < 1.0)) return;
  candidate.enough = Enough{1.0 / found, {}, {}};

  RequirementOptions as_tracks = options_of(options, Confirm::tracks);
  as_tracks.runs = std::min(options.track_runs, kFewTrackRuns);
  const double now = need_by_tracks(sweep, trial.point, as_tracks, *trial.setting);
  const double room = std::max(1.0, found / now);  // the factor added by rendering
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

Confirm usual_confirm(const Sweep& sweep) {
  return sweep.level == Level::clips ? Confirm::clips : Confirm::tracks;
}

Requirement find_requirement(const Sweep& sweep, const RequirementOptions& options, const base::Progress& progress) {
  Requirement requirement;
  requirement.name = sweep.name;
  requirement.targets = options.targets;
  requirement.confirm = options.confirm;
  requirement.track_runs = options.track_runs;
  requirement.runs = options.runs;
  const std::uint64_t points = point_count(sweep);
  constexpr std::uint64_t kMost = 100000;  // they are stored and shown together
  if (points > kMost) {
    throw base::InputError(base::Issue{sweep.file.string(), 0, "vary", fmt::format("{} combinations", points),
                                       fmt::format("at most {}", kMost)});
  }
  std::vector<Trial> trials(points);
  std::atomic<std::uint64_t> done = 0;
  RequirementOptions one_thread = options;
  one_thread.jobs = 1;
  one_thread.before_run = [&] {  // an interrupt need not wait for all runs of a camera
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
