#include "diagnose/verdict/diagnose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "base/errors.h"
#include "core/analysis/analyze.h"
#include "diagnose/causes/cause_odds.h"
#include "diagnose/causes/cause_sequence.h"
#include "diagnose/causes/cause_weighing.h"
#include "diagnose/causes/gap_levels.h"
#include "diagnose/causes/recovered.h"
#include "diagnose/causes/remainder.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/frames/frame_effects.h"
#include "diagnose/frames/missing_frames.h"
#include "diagnose/frames/plain_losses.h"
#include "diagnose/frames/point_scatter.h"
#include "diagnose/lines/line_diagnosis.h"
#include "diagnose/noise/position_noise.h"
#include "diagnose/pictures/picture_evidence.h"
#include "diagnose/pictures/twin_camera.h"
#include "diagnose/tracks/coarse_force.h"
#include "diagnose/tracks/rounded_positions.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/tracks/tracked_motions.h"
#include "diagnose/tracks/usable_motions.h"
#include "diagnose/tracks/whitening.h"
#include "diagnose/twin/twin.h"
#include "diagnose/unnamed/unnamed.h"
#include "diagnose/verdict/verdict.h"
#include "diagnose/verdict/verdict_details.h"
#include "diagnose/weigh/hypotheses.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kFewestPositions = 40;  // of all clips together: fewer carry no verdict beside four parameters
constexpr std::size_t kFewestPoints = 12;     // of a piece of a driven motion
constexpr double kContradiction = 5.0;        // standard deviations between two statements
constexpr double kLatestLaunch_s = 0.2;       // a motion that begins later is not the launch
constexpr std::size_t kFirstPoints = 8;       // that show which way it begins,
constexpr double kOtherWay = 10.0;            // by so many standard deviations of a position
constexpr double kMisfit = 1.5;               // chi² per point from which on the motion counts as not explained

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

/// InputError, an issue for each clip, where all of them together hold too little motion.
void check(const std::vector<core::ClipSetup>& setups, const TrackSet& set) {
  std::vector<std::size_t> of_clip(set.clips.size(), 0);
  std::size_t points = 0;
  for (const TrackedMotion& motion : set.motions) {
    of_clip[motion.clip] += motion.t_s.size();
    points += motion.t_s.size();
  }
  if (points >= kFewestPositions) return;
  std::vector<base::Issue> issues;
  for (std::size_t c = 0; c < of_clip.size(); ++c) {
    issues.push_back(
        {(setups[c].track.empty() ? setups[c].file : setups[c].track).string(), 0,
         fmt::format("clip \"{}\"", set.clips[c].name),
         of_clip[c] == 0 ? "nothing that moves freely" : fmt::format("{} positions of free motion", of_clip[c]),
         fmt::format("at least {} in all clips together: fewer carry no verdict", kFewestPositions)});
  }
  throw base::InputError(std::move(issues));
}

void add_once(const std::string& name, std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// What a reader should know of the data before trusting the verdict: one note for what several set-ups share.
void note_limits(const std::vector<core::ClipSetup>& setups, TrackSet& set) {
  std::vector<std::string> free, mixed;
  for (const TrackGroup& group : set.groups) {
    if (group.statements.empty()) add_once(group.name, free);
    for (std::size_t a = 0; a < group.statements.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const InclineStatement &one = group.statements[a], &two = group.statements[b];
        const double z = (one.alpha_rad - two.alpha_rad) / std::hypot(one.sd_rad, two.sd_rad);
        if (std::abs(z) < kContradiction) continue;
        set.notes.emplace_back(StatementsDisagree{group.name, one.against, two.against, std::abs(z)});
      }
    }
  }
  for (std::size_t a = 0; a < set.groups.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (set.groups[a].name == set.groups[b].name) add_once(set.groups[a].name, mixed);
    }
  }
  if (!free.empty()) set.notes.emplace_back(NoInclination{std::move(free)});
  if (only_falls(set)) set.notes.emplace_back(OnlyFalls{});
  if (!mixed.empty()) set.notes.emplace_back(SplitSetUps{std::move(mixed)});
  for (const TrackedMotion& motion : set.motions) {
    const core::ClipSetup& setup = setups[motion.clip];
    const bool stated_way = setup.launched == core::Launched::up || setup.launched == core::Launched::down;
    if (!stated_way || motion.t_s.front() > kLatestLaunch_s) continue;
    const std::size_t some = std::min<std::size_t>(kFirstPoints, motion.x_m.size() - 1);
    const double way = motion.x_m[some] - motion.x_m.front();
    const double stated = setup.launched == core::Launched::up ? -1.0 : 1.0;
    if (way * stated < -kOtherWay * motion.sd_m) {
      set.notes.emplace_back(LaunchedOtherWay{setup.name, stated < 0.0});
    }
  }
}

/// Of imported tracks, whose images nobody sees here.
void note_lasting_noise(TrackSet& set) {
  const NoiseShape& shape = set.position_noise->shape;
  if (set.pictures || !(shape.lasting > 0.0)) return;
  const double lasting = shape.lasting * shape.lasting;
  set.notes.emplace_back(LastingErrors{lasting / (1.0 + lasting) * std::exp(-1.0 / shape.lasting_frames),
                                       lasting / (1.0 + lasting) * std::exp(-4.0 / shape.lasting_frames)});
}

/// One position beyond a gap may as well be an outlier where no frame is missing elsewhere; two at one end are none.
void leave_single(const TrackSet& set, std::vector<EdgePosition>& beyond) {
  const auto same_end = [&](const EdgePosition& a, const EdgePosition& b) {
    const std::size_t middle = set.motions[a.motion].t_s.size() / 2;
    return a.motion == b.motion && (a.point < middle) == (b.point < middle);
  };
  const std::vector<EdgePosition> all = beyond;
  std::erase_if(beyond, [&](const EdgePosition& position) {
    return std::count_if(all.begin(), all.end(), [&](const EdgePosition& of) { return same_end(position, of); }) < 2;
  });
}

constexpr double kUnfelt_sd = 0.3, kUnfeltPart = 1e-3;  // of the noise, and of what the nominal model leaves

/// Recorded forces without what neither the noise nor the misfit would let anyone see.
void coarsen_forces(TrackSet& set, const MotionFit& nominal) {
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    TrackedMotion& motion = set.motions[i];
    if (motion.known.t_s.empty()) continue;
    const Eigen::VectorXd& left = nominal.motions[i].residual;
    const double rms = std::sqrt(left.squaredNorm() / static_cast<double>(left.size()));
    coarsen_force(motion, set.masses[motion.mass].mass_kg, motion.sd_m * std::max(kUnfelt_sd, kUnfeltPart * rms));
  }
}

/// The noise of every position, by what single frames tell of it. Frames that are missing are taken out first: a jump
/// is no noise and no outlier.
void settle_noise(TrackSet& set) {
  const MotionFit nominal = fit_nominal(set);
  coarsen_forces(set, nominal);
  MissingFrames missing = find_missing_frames(set, nominal);
  std::vector<EdgePosition> beyond = positions_beyond_gaps(set, missing.fit);
  if (missing.count == 0) leave_single(set, beyond);
  for (const EdgePosition& position : beyond) set.motions[position.motion].outlier[position.point] = 0;
  if (!beyond.empty()) missing = find_missing_frames(set, fit_nominal(set));
  if (missing.count > 0) measure_noise(set.motions, missing.fit.late);
  const auto refit = [&] { missing.fit = fit_motions(set, missing.fit.effects, missing.fit.at, missing.fit.late); };
  if (missing.count > 0 && set.pictures) refit();
  // Of rounded positions neighbours tell no noise but that of rounding, which is known.
  if (noise_is_rounding(set)) {
    refit();
    set_tails_aside(set, missing.fit);
    return;
  }
  if (find_position_noise(set, missing.fit)) {
    refit();
    set_tails_aside(set, missing.fit);
    note_lasting_noise(set);
    for (TrackedMotion& motion : set.motions) {
      whiten(motion, set.position_noise->shape, set.clips[motion.clip].frame_rate_hz);
    }
    return;
  }
  if (give_fast_positions_their_noise(set, missing.fit.late)) {
    refit();
  }
  set_tails_aside(set, missing.fit);
}

/// A codec that predicts each image from those before it leaves a marker in place that has moved by less than some
/// hundredths of a pixel, and so makes the slowest motion look like friction.
constexpr double kHeldPx = 0.05;  // from one frame to the next

/// Whether the files say, or the images show, that they went through a lossy codec.
void note_loss(const PictureEvidence& pictures, TrackSet& set) {
  set.lossy = std::any_of(pictures.findings.begin(), pictures.findings.end(), [](const PictureFinding& finding) {
    return finding.id == ids::compression && (finding.stated || finding.seen);
  });
  set.handed_on = set.lossy && !std::all_of(pictures.clips.begin(), pictures.clips.end(), [](const FilmedClip& clip) {
                    return clip.record->codec == "MJPG";  // each image by itself
                  });
  set.held_m_s = 0.0;
  if (!set.handed_on) return;
  for (const FilmedClip& clip : pictures.clips) {
    if (clip.px_per_m > 0.0) {
      set.held_m_s = std::max(set.held_m_s, kHeldPx * clip.camera.frame_rate_hz / clip.px_per_m);
    }
  }
}

/// How far the best explanation that names something (or nothing) is from the noise: chi² per point.
double misfit(const TrackSet& set, const Comparison& comparison) {
  const Hypothesis& best = comparison.all.front();
  const int fit = best.fit >= 0 ? best.fit : 0;
  double points = 0.0;
  for (const TrackedMotion& motion : set.motions) points += static_cast<double>(motion.t_s.size());
  return comparison.fits[static_cast<std::size_t>(fit)].cost / points;
}

/// What the analysis made of the same clips.
void add_speeds(const core::AnalysisResults& results, std::vector<MeasuredMotion>& measured) {
  std::vector<std::string> names;
  for (const core::ClipResult& clip : results.clips) names.push_back(clip.name);
  names = twin_clip_names(names);
  for (MeasuredMotion& one : measured) {
    for (std::size_t c = 0; c < names.size(); ++c) {
      if (names[c] != one.clip) continue;
      for (const core::MotionPoint& point : results.clips[c].motion) {
        if (!point.smoothed || point.left_out != core::LeftOut::used) continue;
        one.v_m_s.push_back(point.v_m_s);
        one.a_m_s2.push_back(point.a_m_s2);
      }
    }
  }
}

constexpr double kLeft = 0.5;    // probability of something without a name from which on a remainder is weighed
constexpr double kDoubt = 0.01;  // of a name by the noise alone
constexpr double kHalf = 0.5;    // of the excess: what a verdict's causes take at least
constexpr double kMostOfOneClip = 0.999;  // probability that one clip may carry

constexpr double kMost = 0.75;    // of the excess
constexpr double kTrusted = 0.8;  // the probability of a name by its share alone

/// Whether some of an explanation takes part of the gap.
bool shows_in_gap(const Hypothesis& best) {
  return std::any_of(best.effects.begin(), best.effects.end(),
                     [](std::size_t e) { return takes_part_of_gap(effect_list()[e].search); });
}

bool shows_in_images(const Hypothesis& best) {
  return std::any_of(best.effects.begin(), best.effects.end(),
                     [](std::size_t e) { return effect_list()[e].search == Search::pictures; });
}

/// The rest is shared as before among what has a name, or nothing.
void set_unknown(double unknown, Comparison& comparison) {
  const double before = 1.0 - comparison.unknown;
  const double factor = before > 0.0 ? (1.0 - unknown) / before : 0.0;
  for (Hypothesis& one : comparison.all) {
    if (!one.unnamed) one.probability *= factor;
  }
  for (double& probability : comparison.effect_probability) probability *= factor;
  comparison.none *= factor;
  comparison.unknown = unknown;
}

/// Probabilities of a comparison as a verdict on a gap above its floor. What the remainder makes is unknown, and so is
/// all of it where the named causes take less than half.
void settle(const CauseSequence& sequence, const Hypothesis& best, Comparison& comparison) {
  const bool half = sequence.named_share >= kHalf || !shows_in_gap(best);
  const bool most = sequence.named_share >= kMost && !follows_each_clip(effect_index(sequence.causes.front().id));
  comparison.unknown += std::exchange(comparison.none, 0.0);
  if (!half) set_unknown(1.0, comparison);
  // Where the noise is next to nothing any curve has the evidence of certainty, and only the share counts.
  if (!most || sequence.gap_before * sequence.gap_before - 1.0 < kLargestExcess || comparison.unknown < 1.0 - kTrusted)
    return;
  for (Hypothesis& one : comparison.all) {
    one.probability = !one.unnamed && one.effects == best.effects ? kTrusted : one.probability * (1.0 - kTrusted);
  }
  for (double& probability : comparison.effect_probability) probability *= 1.0 - kTrusted;
  for (const std::size_t e : best.effects) comparison.effect_probability[e] = kTrusted;
  comparison.unknown = 1.0 - kTrusted;
  std::stable_sort(comparison.all.begin(), comparison.all.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.probability > b.probability; });
}

GapRemainder remainder_of(const CauseSequence& sequence, const RemainderSizes& sizes, double part_s) {
  GapRemainder remainder;
  for (const ExplainedCause& cause : sequence.causes) remainder.share -= cause.share;
  remainder.gap = sequence.gap_after;
  if (part_s > 0.0) remainder.acceleration_m_s2 = std::sqrt(sizes.q_m2_s3 / part_s);
  remainder.clip_scatter_m_s2 = sizes.force_m_s2;
  remainder.drag_scatter = sizes.drag;
  return remainder;
}

/// Where the rest lies, beside the named causes; nowhere where nothing is left.
std::vector<GapRegion> regions_beside(const TrackSet& set, const CauseSequence& sequence) {
  if (!(sequence.gap_after > 1.0 + 3.0 * sequence.standard_error)) return {};
  Diagnosis rest;
  rest.verdict = Verdict::unknown;
  add_regions(set, sequence.named, unnamed_families(ScoreSpace(set, sequence.named)), rest);
  return rest.regions;
}

/// Effects that a verdict names as they stand in `explained`, then those that no motion shows.
void order_by_share(Diagnosis& diagnosis) {
  const auto place = [&](const DiagnosedEffect& effect) {
    return std::find_if(diagnosis.explained.begin(), diagnosis.explained.end(),
                        [&](const ExplainedCause& cause) { return cause.id == effect.id; });
  };
  std::stable_sort(diagnosis.effects.begin(), diagnosis.effects.end(),
                   [&](const DiagnosedEffect& a, const DiagnosedEffect& b) { return place(a) < place(b); });
  if (!diagnosis.effects.empty()) diagnosis.stage = diagnosis.effects.front().stage;
}

constexpr double kLikely = 0.02;  // probability from which on an explanation widens what is recovered
constexpr std::size_t kMostLikely = 6;

/// Explanations beside the reported one, whose probability is added to it; the nominal model for all that is unknown.
void add_others(const WeighedCauses& weighed, const std::vector<Hypothesis>& all, double unknown,
                const std::vector<std::size_t>& reported, Explanations& explanations) {
  const auto add = [&](std::size_t fit, double probability) {
    if (probability < kLikely || explanations.size() > kMostLikely || !weighed.fits[fit]) return;
    explanations.push_back({&weighed.fits[fit]->noise_alone, weighed.fits[fit]->sizes, probability});
  };
  if (!reported.empty()) add(0, unknown);
  for (const Hypothesis& one : all) {
    if (one.unnamed || one.effects.empty()) continue;
    if (one.effects == reported) {
      explanations.front().probability += one.probability;
    } else if (one.fit > 0) {
      add(static_cast<std::size_t>(one.fit), one.probability);
    }
  }
}

/// Whether the nominal model has a gap, and the likeliest explanation by the noise alone leaves one or a doubt.
bool leaves_a_gap(const TrackSet& set, const Comparison& by_noise) {
  const MotionFit& nominal = by_noise.fits.front();
  if (!has_gap(set, nominal, nominal)) return false;
  const Hypothesis* best = best_named(set, by_noise);
  if (best == nullptr || best->fit <= 0 || by_noise.none + by_noise.unknown > kDoubt) return true;
  return has_gap(set, nominal, by_noise.fits[static_cast<std::size_t>(best->fit)]);
}

/// The verdict, the causes in order, what remains, and what K/m, mu and alpha are with the causes in the model.
Diagnosis with_causes(const TrackSet& set, Comparison first, PictureEvidence pictures,
                      const std::vector<std::size_t>& left_out, int jobs, const base::Progress& progress) {
  const std::set<std::size_t> without(left_out.begin(), left_out.end());
  const MotionFit& nominal = first.fits.front();
  std::optional<WeighedCauses> weighed;
  if (first.unknown > kLeft || leaves_a_gap(set, first)) {
    weighed = weigh_causes(set, first, without, jobs, &pictures,
                           [&](double part) { progress("weighing explanations", 0.5 + 0.4 * part); });
  }
  progress("measuring the gap", 0.9);
  const Comparison& by = weighed ? weighed->comparison : first;
  const TrackSet& with = weighed ? weighed->set : set;
  const Hypothesis* found = best_named(with, by);
  const bool names =
      found != nullptr && found->fit > 0 && (weighed || verdict_by(by.none, by.unknown) == Verdict::effect);
  const Hypothesis best = names ? *found : Hypothesis{};  // the comparison's own order changes below
  const MotionFit& fit = names ? by.fits[static_cast<std::size_t>(best.fit)] : nominal;
  const CauseSequence sequence = sequence_of(set, nominal, with, fit, without);
  Diagnosis diagnosis;
  std::vector<std::string> traces;
  // Where there is no gap nothing remains, and what has no name shows best against the noise alone.
  const std::vector<Hypothesis> weighed_all = weighed ? by.all : std::vector<Hypothesis>();  // before the share counts
  const double unknown = by.none + by.unknown;
  const bool settled = weighed && sequence.is_gap && names;
  if (settled) settle(sequence, best, weighed->comparison);
  if (settled && verdict_by(by.none, by.unknown) == Verdict::effect) {
    const NoiseAlone noise_alone{set, nominal, sequence.named};
    diagnosis = verdict_of(with, by, std::move(pictures), &noise_alone);
  } else {
    // Below a step of rounding nothing is claimed: what shows there and leaves no gap comes from rounding.
    if (noise_is_rounding(set) && !sequence.is_gap) first.none += std::exchange(first.unknown, 0.0);
    // A name that takes next to nothing of a gap explains something else.
    const bool explains = !names || !shows_in_gap(best) || sequence.named_share >= kHalf;
    if (!weighed && sequence.is_gap && !explains) set_unknown(1.0, first);
    if (weighed && sequence.is_gap && !(found != nullptr && shows_in_images(*found))) {
      // Nothing that moves the glider explains the gap.
      first.unknown += std::exchange(first.none, 0.0);
      set_unknown(names ? std::max(first.unknown, by.none + by.unknown) : 1.0, first);
    }
    // Without a gap a name must do more than small imperfections would.
    if (!weighed && !sequence.is_gap && names && shows_in_gap(best)) {
      allow_for_remainders(set, without, jobs, first);
      if (verdict_by(first.none, first.unknown) == Verdict::none) {
        for (const std::size_t e : best.effects) traces.emplace_back(effect_list()[e].id);
      }
    }
    diagnosis = verdict_of(set, first, std::move(pictures));
  }
  if (noise_is_rounding(set)) traces.emplace_back(ids::position_rounding);
  diagnosis.traces = std::move(traces);
  diagnosis.explained = sequence.causes;
  order_by_share(diagnosis);
  // Without a gap there is no sequence, and the explanation's own fit has the effect.
  const MotionFit& with_effect = sequence.is_gap ? sequence.named : fit;
  const MotionFit& reported = diagnosis.verdict == Verdict::effect ? with_effect : nominal;
  const RemainderSpace space(set, reported);
  const RemainderSizes sizes = space.likeliest().sizes;
  if (sequence.is_gap) {
    diagnosis.remainder = remainder_of(sequence, sizes, space.part_s());
    diagnosis.remainder->regions =
        diagnosis.verdict == Verdict::effect ? regions_beside(set, sequence) : diagnosis.regions;
  }
  diagnosis.levels = levels_of(set, nominal, jobs);
  Explanations explanations{{&reported, sizes, 1.0}};
  if (weighed) {
    const bool with_names = diagnosis.verdict == Verdict::effect;
    explanations.front().probability = with_names ? 0.0 : unknown;
    add_others(*weighed, weighed_all, unknown, with_names ? best.effects : std::vector<std::size_t>(), explanations);
    explanations.front().probability = std::max(explanations.front().probability, kLikely);
  }
  diagnosis.recovered = recovered_of(set, explanations);
  if (set.clips.size() < 2) {
    for (DiagnosedEffect& effect : diagnosis.effects) {
      effect.probability = std::min(effect.probability, kMostOfOneClip);
      effect.joint_probability = std::min(effect.joint_probability, kMostOfOneClip);
    }
  }
  return diagnosis;
}

}  // namespace

Diagnosis diagnose_results(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups,
                           const DiagnoseOptions& options, const base::Progress& progress,
                           const std::vector<std::optional<core::CameraSettings>>& cameras,
                           const std::vector<core::Experiment>& folders) {
  const std::vector<std::size_t> without = indices(options.without);
  require_usable_motions(results, setups);
  TrackSet set = track_set(results, setups, true);
  check(setups, set);
  note_limits(setups, set);
  cut_driven_motions(set, kFewestPoints);
  progress("weighing explanations", 0.1);
  PictureEvidence pictures;
  if (cameras.size() == results.clips.size()) pictures = picture_evidence(filmed_clips(results, setups, cameras));
  if (options.twin) pictures.filming = filming_of(results, folders, options.jobs);
  note_loss(pictures, set);
  settle_noise(set);
  const auto weighed = [&](double from, double to) {
    return [&progress, from, to](double part) { progress("weighing explanations", from + part * (to - from)); };
  };
  Comparison comparison = compare_hypotheses(set, without, options.jobs, &pictures, weighed(0.1, 0.5));
  if (set.disputed > 0 && (comparison.all.front().unnamed || misfit(set, comparison) > kMisfit)) {
    // Nothing of the list explains the motion with its hand and stops: they are what the analysis took them for.
    TrackSet trimmed = track_set(results, setups, false);
    std::size_t points = 0;
    for (const TrackedMotion& motion : trimmed.motions) points += motion.t_s.size();
    if (points >= kFewestPositions) {
      set = std::move(trimmed);
      note_limits(setups, set);
      cut_driven_motions(set, kFewestPoints);
      set.notes.emplace_back(HandLeftOut{set.disputed});
      progress("weighing explanations", 0.5);
      note_loss(pictures, set);
      settle_noise(set);
      comparison = compare_hypotheses(set, without, options.jobs, &pictures, weighed(0.5, 0.9));
    }
  }
  Diagnosis diagnosis = with_causes(set, std::move(comparison), std::move(pictures), without, options.jobs, progress);
  add_speeds(results, diagnosis.measured);
  for (const core::CalibrationResult& of : results.calibrations) {
    diagnosis.calibrations.push_back({of.experiment, of.rests});
  }
  return diagnosis;
}

Diagnosis diagnose(const std::vector<std::filesystem::path>& folders, const DiagnoseOptions& options,
                   const base::Progress& progress) {
  std::vector<core::ClipSetup> setups;
  std::vector<std::optional<core::CameraSettings>> cameras;
  std::vector<core::Experiment> experiments;
  for (const std::filesystem::path& folder : folders) {
    const core::Experiment experiment = read_recording(folder, options.outside);
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
  indices(options.without);  // what is misspelt shows before the clips are read
  const core::AnalysisResults results =
      core::analyze(folders,
                    {.bandwidth_s = {},
                     .jobs = options.jobs,
                     .lost_frames = core::LostFrameTimes::kept,
                     .pictures = true,
                     .bare = {.column = {}, .mass_kg = {}, .incline_deg = {}, .outside = options.outside}},
                    progress);
  return diagnose_results(results, setups, options, progress, cameras, experiments);
}

}  // namespace glidelab::diagnose
