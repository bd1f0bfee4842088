#include "diagnose/verdict/diagnose.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/errors.h"
#include "core/analysis/analyze.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/lines/line_diagnosis.h"
#include "diagnose/next/next_experiment.h"
#include "diagnose/pictures/image_evidence.h"
#include "diagnose/pictures/twin_camera.h"
#include "diagnose/verdict/settled_motions.h"
#include "diagnose/verdict/verdict_with_causes.h"
#include "diagnose/weigh/air_odds.h"
#include "diagnose/weigh/hypotheses.h"

namespace glidelab::diagnose {
namespace {

std::vector<std::size_t> indices(const std::vector<std::string>& ids) {
  std::vector<std::size_t> effects;
  for (const std::string& id : ids) {
    std::string known;
    bool found = false;
    for (std::size_t e = 0; e < effect_list().size(); ++e) {
      known += (known.empty() ? "" : ", ") + std::string(effect_list()[e].id);
      if (effect_list()[e].id != id) continue;
      effects.push_back(e);
      found = true;
    }
    if (!found) throw base::InputError(base::Issue{"", 0, "without", fmt::format("\"{}\"", id), "one of " + known});
  }
  return effects;
}

/// The fit of the likeliest explanation; the nominal fit if that explanation has none.
const MotionFit& best_fit(const Comparison& comparison) {
  return comparison.fits[static_cast<std::size_t>(std::max(0, comparison.all.front().fit))];
}

/// Adds the speeds and accelerations that the analysis found in the same motions: all of a clip that has one motion.
void add_speeds(const core::AnalysisResults& results, std::vector<MeasuredMotion>& measured) {
  std::vector<std::size_t> motions(results.clips.size(), 0);
  for (const MeasuredMotion& one : measured) ++motions[one.recorded];
  for (MeasuredMotion& one : measured) {
    const std::vector<core::MotionPoint>& motion = results.clips[one.recorded].motion;
    for (const core::MotionPoint& point : motion) {
      if (!point.smoothed || point.left_out != core::LeftOut::used || one.t_s.empty()) continue;
      const double t_s = point.t_s - motion.front().t_s;
      const bool within = one.t_s.front() <= t_s && t_s <= one.t_s.back();
      if (motions[one.recorded] > 1 && !within) continue;
      one.v_m_s.push_back(point.v_m_s);
      one.a_m_s2.push_back(point.a_m_s2);
    }
  }
}

/// A body whose height is recorded falls, or moves on a slope: assumed to be level, it would be in a hand all the time.
void refuse_heights(const std::vector<std::filesystem::path>& inputs, const core::TrackFileOptions& bare) {
  if (bare.incline_deg) return;
  for (const std::filesystem::path& input : inputs) {
    if (!core::is_bare_track(input)) continue;
    for (const core::ClipSetup& clip : core::read_tracks(input, bare).clips) {
      for (const core::Note& note :
           core::read_track(clip.track, {}, clip.column, core::SpeedsAlone::refused, clip.image_units).notes) {
        const auto* const taken = std::get_if<core::HeightTaken>(&note);
        if (taken == nullptr) continue;
        throw base::InputError(base::Issue{input.string(), 0, "--incline",
                                           fmt::format("none, and x is \"{}\", a height", taken->column),
                                           "the inclination in degrees: --incline 90 for a fall"});
      }
    }
  }
}

/// The header, or nothing where a person says so, if a motion sensor measured all positions.
std::optional<SensorPositions> sensor_of(const core::AnalysisResults& results,
                                         const std::vector<core::ClipSetup>& setups) {
  SensorPositions of;
  for (std::size_t i = 0; i < setups.size(); ++i) {
    const std::string& column = results.clips[i].sensor_column;
    const bool stated = setups[i].recorded_by == core::RecordedBy::sensor;
    if (!stated && (setups[i].recorded_by != core::RecordedBy::unstated || column.empty())) return {};
    if (!stated && of.column.empty()) of.column = column;
  }
  return of;
}

/// Whether these are files by themselves, each of which may count x from an origin of its own. A sensor stays where it
/// is, and a folder says that its clips belong together.
bool lack_common_origin(const std::vector<core::Experiment>& folders, const std::optional<SensorPositions>& sensor) {
  return folders.size() > 1 && !sensor &&
         std::ranges::any_of(folders, [](const core::Experiment& one) { return core::is_bare_track(one.file); });
}

/// Whether a cause at a place is named, or told to help.
bool tells_a_place(const Diagnosis& diagnosis) {
  const auto is_at_place = [](const auto& of) { return is_bound_to_place(effect_index(of.id)); };
  return std::ranges::any_of(diagnosis.effects, is_at_place) || std::ranges::any_of(diagnosis.explained, is_at_place);
}

/// The named effect that acts where the analysis sees a hand or an end stop; null if there is none.
const std::string* named_of_hand(const Diagnosis& diagnosis) {
  if (diagnosis.verdict != Verdict::effect) return nullptr;
  for (const DiagnosedEffect& effect : diagnosis.effects) {
    if (effect_of(effect.id).touch != Touch::nothing) return &effect.id;
  }
  return nullptr;
}

/// The fit with the most evidence that reached a minimum; null: none.
const MotionFit* best_by_evidence(const Comparison& comparison) {
  const Hypothesis* best = nullptr;
  for (const Hypothesis& one : comparison.all) {
    if (one.unnamed || one.fit <= 0 || !one.converged) continue;
    if (best == nullptr || one.log_evidence > best->log_evidence) best = &one;
  }
  return best != nullptr ? &comparison.fits[static_cast<std::size_t>(best->fit)] : nullptr;
}

}  // namespace

Diagnosis diagnose_results(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups,
                           const DiagnoseOptions& options, const base::Progress& progress,
                           const std::vector<std::optional<core::CameraSettings>>& cameras,
                           const std::vector<core::Experiment>& folders) {
  std::vector<std::size_t> without = indices(options.without);
  TrackSet set = whole_motions(results, setups);
  const std::optional<SensorPositions> sensor = sensor_of(results, setups);
  for (std::size_t e = 0; e < effect_list().size(); ++e) {
    if (sensor && effect_list()[e].of_camera) without.push_back(e);
  }
  progress("weighing explanations", 0.1);
  ImageEvidence images;
  if (cameras.size() == results.clips.size()) images = image_evidence(filmed_clips(results, setups, cameras));
  if (options.twin) images.filming = filming_of(results, folders, options.jobs);
  settle_noise(images, set);
  const auto weighed = [&](double from, double to) {
    return [&progress, from, to](double part) { progress("weighing explanations", from + part * (to - from)); };
  };
  const auto compare = [&](double from, double to) {
    Comparison made = compare_hypotheses(set, without, options.jobs, &images, weighed(from, to));
    if (!set.through_air || !too_strong_for_air(set, made)) return made;
    set.through_air = false;
    return compare_hypotheses(set, without, options.jobs, &images, weighed(to, to));
  };
  Comparison comparison = compare(0.1, 0.5);
  std::size_t with_hand = set.disputed;
  if (set.disputed > 0 && (comparison.all.front().unnamed || is_misfit(set, best_fit(comparison)))) {
    // No effect on the list explains the motion with its hand and stops, so these are what the analysis took them for.
    std::optional<TrackSet> trimmed = motions_without_hand(results, setups, set.disputed);
    const MotionFit* best = best_by_evidence(comparison);
    if (trimmed && !(best != nullptr && explains_disputed(set, comparison.fits.front(), *best, *trimmed))) {
      set = std::move(*trimmed);
      with_hand = 0;
      progress("weighing explanations", 0.5);
      settle_noise(images, set);
      comparison = compare(0.5, 0.9);
    }
  }
  if (settle_noise_again(best_fit(comparison), set)) comparison = compare(0.9, 0.9);
  if (const auto reversed = reversed_force(set, comparison.fits.front())) set.notes.emplace_back(*reversed);
  Diagnosis diagnosis = with_causes(set, std::move(comparison), images, without, options.jobs, progress);
  const bool no_origin = lack_common_origin(folders, sensor);
  if (no_origin && tells_a_place(diagnosis)) {
    for (std::size_t e = 0; e < effect_list().size(); ++e) {
      if (is_bound_to_place(e)) without.push_back(e);
    }
    diagnosis = with_causes(set, compare(0.9, 0.9), std::move(images), without, options.jobs, progress);
  }
  quote_tables(diagnosis);
  if (const std::string* effect = with_hand > 0 ? named_of_hand(diagnosis) : nullptr) {
    diagnosis.notes.emplace_back(HandExplained{with_hand, *effect});
  }
  if (sensor) diagnosis.notes.emplace_back(*sensor);
  for (Note& note : diagnosis.notes) {
    if (auto* const origin = std::get_if<OneOrigin>(&note)) origin->left_out = no_origin;
  }
  if (std::optional<FitsCutOff> cut_off = fits_cut_off(diagnosis.ranking)) {
    diagnosis.notes.emplace_back(std::move(*cut_off));
  }
  add_speeds(results, diagnosis.measured);
  for (const core::CalibrationResult& of : results.calibrations) {
    diagnosis.calibrations.push_back({of.experiment, of.rests});
  }
  return diagnosis;
}

core::AnalysisResults analyze_for_diagnosis(const std::vector<std::filesystem::path>& folders,
                                            const DiagnoseOptions& options, const base::Progress& progress,
                                            core::WithoutMarker without) {
  refuse_heights(folders, options.bare);
  return core::analyze(folders,
                       {.bandwidth_s = {},
                        .jobs = options.jobs,
                        .lost_frames = core::LostFrameTimes::kept,
                        .images = true,
                        .bare = options.bare,
                        .without_marker = without},
                       progress);
}

Diagnosis diagnose(const std::vector<std::filesystem::path>& folders, const DiagnoseOptions& options,
                   const base::Progress& progress) {
  std::vector<core::ClipSetup> setups;
  std::vector<std::optional<core::CameraSettings>> cameras;
  std::vector<core::Experiment> experiments;
  for (const std::filesystem::path& folder : folders) {
    const core::Experiment experiment = read_recording(folder, options.bare);
    if (experiment.lines) {
      if (folders.size() > 1) {
        throw base::InputError(base::Issue{experiment.file.string(), 0, "lines", "a table of lines with other folders",
                                           "a table of lines by itself"});
      }
      return diagnose_lines(read_lines(*experiment.lines), experiment.gravity_m_s2, options.without);
    }
    setups.insert(setups.end(), experiment.clips.begin(), experiment.clips.end());
    cameras.resize(setups.size(), experiment.camera);
    experiments.push_back(experiment);
  }
  indices(options.without);  // a misspelt id is refused before the clips are read
  const core::AnalysisResults results =
      analyze_for_diagnosis(folders, options, progress, core::WithoutMarker::left_out);
  Diagnosis diagnosis = diagnose_results(results, core::of_analysed(results, std::move(setups)), options, progress,
                                         core::of_analysed(results, std::move(cameras)), experiments);
  diagnosis.left_out = results.left_out;
  return diagnosis;
}

}  // namespace glidelab::diagnose
