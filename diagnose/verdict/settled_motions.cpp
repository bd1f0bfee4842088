#include "diagnose/verdict/settled_motions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <variant>

#include "base/errors.h"
#include "core/result/estimate.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/noise/position_noise.h"
#include "diagnose/single_frames/missing_frames.h"
#include "diagnose/single_frames/plain_losses.h"
#include "diagnose/single_frames/point_scatter.h"
#include "diagnose/tracks/coarse_force.h"
#include "diagnose/tracks/rounded_positions.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/tracks/usable_motions.h"
#include "diagnose/tracks/whitening.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kFewestWithoutHand = 25;   // positions that are left: fewer are better kept whole
constexpr std::size_t kFewestDrivenPoints = 12;  // of a piece of a driven motion
constexpr double kLeastContradictionSds = 5.0;   // standard deviations between two statements
constexpr double kLatestLaunch_s = 0.2;          // a motion that starts later is not the launch
constexpr std::size_t kFirstPoints = 8;          // which show the direction of the launch,
constexpr double kOpposite_sd = 10.0;            // by a displacement of so many standard deviations of a position

/// InputError with an issue for each clip if all of them together have too little motion.
void check(const std::vector<core::ClipSetup>& setups, const TrackSet& set) {
  const std::size_t parameters = free_parameters(set, {}), fewest = parameters + kFewestSpare;
  if (points_of(set) >= fewest) return;
  std::vector<std::size_t> of_clip(set.clips.size(), 0);
  for (const TrackedMotion& motion : set.motions) of_clip[motion.clip] += motion.t_s.size();
  // Without any motion the number of parameters means nothing: there is nothing to fit.
  const std::string expected =
      set.motions.empty()
          ? "a body that moves freely in one of the clips at least"
          : fmt::format("at least {} positions in all clips together: the model has {} parameters", fewest, parameters);
  std::vector<base::Issue> issues;
  for (std::size_t c = 0; c < of_clip.size(); ++c) {
    issues.push_back(
        {(setups[c].track.empty() ? setups[c].file : setups[c].track).string(), 0,
         fmt::format("clip \"{}\"", set.clips[c].name),
         of_clip[c] == 0 ? "nothing that moves freely" : fmt::format("{} positions of free motion", of_clip[c]),
         expected});
  }
  throw base::InputError(std::move(issues));
}

void add_once(const std::string& name, std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// What the reader must be told of the readings: one without its uncertainty does not constrain a fit, but the
/// accelerations may contradict it; one that nobody made may hide a fall; positions of several folders have one origin.
void note_readings(const core::AnalysisResults& results, TrackSet& set) {
  const auto elsewhere = [&](const core::ClipResult& clip) { return clip.experiment != results.clips[0].experiment; };
  if (!set.images && std::any_of(results.clips.begin(), results.clips.end(), elsewhere)) {
    set.notes.emplace_back(OneOrigin{});
  }
  for (const core::ConfigurationResult& found : results.configurations) {
    for (const core::Note& note : found.notes) {
      if (const auto* const fall = std::get_if<core::MayBeAFall>(&note)) set.notes.emplace_back(SuspectedFall{*fall});
    }
    if (found.incline_sd_deg || found.incline_assumed) continue;
    auto contradiction = core::incline_contradiction(found, results.gravity_m_s2, core::stated_incline(found));
    if (!contradiction || !contradiction->gross) continue;
    set.notes.emplace_back(ContradictedReading{found.mass_kg, *contradiction});
  }
}

/// Notes on what a reader should know of the data before trusting the verdict: one note for all set-ups that share a
/// limit.
void note_limits(const std::vector<core::ClipSetup>& setups, TrackSet& set) {
  std::vector<std::string> free, mixed;
  for (const TrackGroup& group : set.groups) {
    if (group.statements.empty() && !is_fall(group)) add_once(group.name, free);
    for (std::size_t a = 0; a < group.statements.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        const InclineStatement &one = group.statements[a], &two = group.statements[b];
        const double z = (one.alpha_rad - two.alpha_rad) / std::hypot(one.sd_rad, two.sd_rad);
        if (std::abs(z) < kLeastContradictionSds) continue;
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
  if (set.mass_assumed) set.notes.emplace_back(NoMassStated{});
  if (only_falls(set)) set.notes.emplace_back(OnlyFalls{});
  if (!mixed.empty()) set.notes.emplace_back(SplitSetUps{std::move(mixed)});
  for (const TrackedMotion& motion : set.motions) {
    const core::ClipSetup& setup = setups[motion.clip];
    const bool direction_stated = setup.launched == core::Launched::up || setup.launched == core::Launched::down;
    if (!direction_stated || motion.t_s.front() > kLatestLaunch_s) continue;
    const std::size_t some = std::min<std::size_t>(kFirstPoints, motion.x_m.size() - 1);
    const double displacement_m = motion.x_m[some] - motion.x_m.front();
    const double stated = setup.launched == core::Launched::up ? -1.0 : 1.0;
    if (displacement_m * stated < -kOpposite_sd * motion.sd_m) {
      set.notes.emplace_back(OppositeLaunch{setup.name, stated < 0.0});
    }
  }
}

/// A note on lasting errors of imported tracks, whose images are not available.
void note_lasting_noise(TrackSet& set) {
  const NoiseShape& shape = set.position_noise->shape;
  if (set.images || !(shape.lasting > 0.0)) return;
  const double lasting = shape.lasting * shape.lasting;
  set.notes.emplace_back(LastingErrors{lasting / (1.0 + lasting) * std::exp(-1.0 / shape.lasting_frames),
                                       lasting / (1.0 + lasting) * std::exp(-4.0 / shape.lasting_frames)});
}

/// A single position beyond a gap may be an outlier if no frame is missing elsewhere. Two at one end are not.
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

constexpr double kUnfeltSds = 0.3, kUnfeltPart = 1e-3;  // of the noise, and of the nominal model's residuals

/// Removes detail from the recorded forces that would be lost in the noise or in the misfit.
void coarsen_forces(TrackSet& set, const MotionFit& nominal) {
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    TrackedMotion& motion = set.motions[i];
    if (motion.known.t_s.empty()) continue;
    const Eigen::VectorXd& left = nominal.motions[i].residual;
    const double rms = std::sqrt(left.squaredNorm() / static_cast<double>(left.size()));
    coarsen_force(motion, set.masses[motion.mass].mass_kg, motion.sd_m * std::max(kUnfeltSds, kUnfeltPart * rms));
  }
}

/// Finds the noise of every position from single frames. Missing frames are corrected first: a jump is neither noise
/// nor an outlier.
void settle(TrackSet& set) {
  const MotionFit nominal = fit_nominal(set);
  coarsen_forces(set, nominal);
  MissingFrames missing = find_missing_frames(set, nominal);
  std::vector<EdgePosition> beyond = positions_beyond_gaps(set, missing.fit);
  if (missing.count == 0) leave_single(set, beyond);
  for (const EdgePosition& position : beyond) set.motions[position.motion].outlier[position.point] = 0;
  if (!beyond.empty()) missing = find_missing_frames(set, fit_nominal(set));
  if (missing.count > 0) measure_noise(set.motions, missing.fit.late);
  const auto refit = [&] { missing.fit = fit_motions(set, missing.fit.effects, missing.fit.at, missing.fit.late); };
  if (missing.count > 0 && set.images) refit();
  // Neighbouring rounded positions show only the noise of rounding, which is known.
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

/// A codec that predicts each image from earlier ones leaves a marker in place if it has moved by less than a few
/// hundredths of a pixel. The slowest motion then looks like friction.
constexpr double kHeldStep_px = 0.05;  // from one frame to the next

/// Records whether the clips went through a lossy codec, as their files say or their images show.
void note_loss(const ImageEvidence& images, TrackSet& set) {
  set.lossy = std::any_of(images.findings.begin(), images.findings.end(), [](const ImageFinding& finding) {
    return finding.id == ids::compression && (finding.stated || finding.seen);
  });
  set.handed_on = set.lossy && !std::all_of(images.clips.begin(), images.clips.end(), [](const FilmedClip& clip) {
                    return clip.record->codec == "MJPG";  // compresses each image by itself
                  });
  set.held_m_s = 0.0;
  if (!set.handed_on) return;
  for (const FilmedClip& clip : images.clips) {
    if (clip.px_per_m > 0.0) {
      set.held_m_s = std::max(set.held_m_s, kHeldStep_px * clip.camera.frame_rate_hz / clip.px_per_m);
    }
  }
}

/// Leaves open what part of its weight drives a body, from 0 to four times gravity at a standard deviation of gravity
/// itself, where all falls begin far too slowly (core::slow_fall()) and none is too fast for a viscous drag, as in a
/// liquid.
void open_weight(const core::AnalysisResults& results, TrackSet& set) {
  set.weight_open = !results.configurations.empty() && !set.through_air &&
                    std::ranges::all_of(results.configurations, [&](const core::ConfigurationResult& configuration) {
                      return core::slow_fall(configuration, results.gravity_m_s2).has_value();
                    });
  if (set.weight_open) set.gravity_sd_m_s2 = set.gravity_m_s2;
}

}  // namespace

TrackSet whole_motions(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups) {
  std::vector<DoubtfulUnit> doubtful = doubtful_units(results, setups);
  TrackSet set = track_set(results, setups, true);
  open_weight(results, set);
  for (DoubtfulUnit& one : doubtful) one.weight_open = set.weight_open;
  set.notes.insert(set.notes.end(), std::make_move_iterator(doubtful.begin()), std::make_move_iterator(doubtful.end()));
  check(setups, set);
  note_limits(setups, set);
  note_readings(results, set);
  cut_driven_motions(set, kFewestDrivenPoints);
  return set;
}

std::optional<TrackSet> motions_without_hand(const core::AnalysisResults& results,
                                             const std::vector<core::ClipSetup>& setups, std::size_t disputed) {
  TrackSet set = track_set(results, setups, false);
  if (points_of(set) < kFewestWithoutHand) return {};
  open_weight(results, set);
  note_limits(setups, set);
  note_readings(results, set);
  cut_driven_motions(set, kFewestDrivenPoints);
  set.notes.emplace_back(HandLeftOut{disputed});
  return set;
}

namespace {

/// Whether this time of a clip lies within one of the motions of `trimmed`. Driven motions are cut into pieces, which
/// `trimmed` numbers otherwise.
bool is_within(const TrackSet& trimmed, std::size_t clip, double t_s) {
  return std::any_of(trimmed.motions.begin(), trimmed.motions.end(), [&](const TrackedMotion& motion) {
    return (trimmed.pieces || motion.clip == clip) && motion.t_s.front() <= t_s && t_s <= motion.t_s.back();
  });
}

/// Whether an effect is a law that acts throughout, and neither lost frames nor something that is met in one place.
bool acts_throughout(std::size_t effect) {
  return shows_in_motion(effect_list()[effect].search) && effect_list()[effect].search != Search::lines &&
         !follows_each_clip(effect) && effect_list()[effect].touch == Touch::nothing;
}

/// Whether a law explains the positions that `trimmed` lacks: of what the nominal model leaves of them, in chi², beyond
/// their noise, a fit with the law leaves at most a tenth.
bool explains_by_law(const TrackSet& set, const MotionFit& nominal, const MotionFit& fit, const TrackSet& trimmed) {
  constexpr double kMostLeft = 0.1, kClearSds = 5.0;
  if (fit.effects.empty() || !std::all_of(fit.effects.begin(), fit.effects.end(), acts_throughout)) return false;
  double before = 0.0, after = 0.0, count = 0.0;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    const TrackedMotion& motion = set.motions[i];
    for (std::size_t p = 0; p < motion.t_s.size(); ++p) {
      if (motion.outlier[p] != 0 || is_within(trimmed, motion.clip, motion.t_s[p])) continue;
      const auto at = static_cast<Eigen::Index>(p);
      before += std::pow(nominal.motions[i].residual[at], 2) - 1.0;
      after += std::pow(fit.motions[i].residual[at], 2) - 1.0;
      count += 1.0;
    }
  }
  return before > kClearSds * std::sqrt(2.0 * count) && after < kMostLeft * before;
}

}  // namespace

bool explains_disputed(const TrackSet& set, const MotionFit& nominal, const MotionFit& fit, const TrackSet& trimmed) {
  constexpr double kAboutAsFar = 2.0;
  const bool acts = std::any_of(fit.effects.begin(), fit.effects.end(),
                                [](std::size_t e) { return effect_list()[e].touch == Touch::in_one_place; });
  const bool loses = std::any_of(fit.late.begin(), fit.late.end(), [](const std::vector<double>& motion) {
    return std::any_of(motion.begin(), motion.end(), [](double late) { return late != 0.0; });
  });
  if (!acts && !loses) return explains_by_law(set, nominal, fit, trimmed);
  return held_out_gap(set, fit).value < kAboutAsFar * std::max(1.0, held_out_gap(trimmed, fit_nominal(trimmed)).value);
}

void settle_noise(const ImageEvidence& images, TrackSet& set) {
  note_loss(images, set);
  for (const ImageFinding& finding : images.findings) {
    if (const auto* sway = std::get_if<image::Sway>(&finding.fact)) set.camera_drift_m_s = sway->speed_m_s;
  }
  settle(set);
}

std::optional<ForceReversed> reversed_force(const TrackSet& set, const MotionFit& nominal) {
  constexpr double kFarBetter = 0.25;
  const auto driven = [](const TrackedMotion& motion) { return !motion.known.t_s.empty(); };
  if (!std::any_of(set.motions.begin(), set.motions.end(), driven) || !is_misfit(set, nominal)) return {};
  TrackSet reversed = set;
  for (TrackedMotion& motion : reversed.motions) {
    for (double& force : motion.known.force_n) force = -force;
  }
  const double part = fit_nominal(reversed, nominal.late).cost / nominal.cost;
  return part < kFarBetter ? std::optional(ForceReversed{part}) : std::nullopt;
}

bool settle_noise_again(const MotionFit& explanation, TrackSet& set) {
  constexpr double kMostOfNoise = 0.5;  // of its variance: no explanation of hundreds of positions leaves less
  if (!set.images || !set.position_noise || !std::isfinite(explanation.cost)) return false;
  if (explanation.cost > kMostOfNoise * static_cast<double>(points_of(set))) return false;
  return find_position_noise(set, explanation);
}

}  // namespace glidelab::diagnose
