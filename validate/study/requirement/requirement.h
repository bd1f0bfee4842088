/// Which of a sweep's points (cameras, settings) reach a target: first by the Cramér-Rao bound, then by runs.
///
/// A target applies to the worst configuration of the scenario. It limits the error that 95 % of the errors do not
/// exceed ("error95"), the rms error including bias ("sd": for an unbiased estimator the standard deviation), or the
/// mean error ("bias"); see target.h. The bound takes the noise of the sweep's tracks, or predicts it from the camera
/// (validate/made_tracks/made_tracks.h); it is that of the standard deviation, times 1.96 for "error95". A point whose
/// bound is above the target cannot reach it. Any other is judged as tracks and then rendered, with lens, shutter,
/// codec and calibration, the cheapest first: kLeastRendered times, then twice as often, up to `runs` times, until the
/// limits of the error (of the better estimator) are on one side of the target. The first that reaches it is rendered
/// `runs` times: it is the one to buy, and nothing more expensive is rendered. The confidence of the limits is such
/// that all looks at one point together err with at most 5 %. (That holds for a point, not for the search: of k cheaper
/// points that just miss the target, one is taken with a probability of up to 1 - 0.95^k.) Two runs then decide if the
/// errors are ten times smaller than allowed, and four runs if they are four times smaller. The up to `track_runs` runs
/// as tracks have that noise; they are made because a bound does not include dropped frames: if fewer than
/// kRunsForQuantile rendered runs reach what the tracks miss, or if the limits span the target, the point is undecided.
/// Without rendering, the tracks alone judge. If nothing is run, a bound below the target by kClearMargin is said to
/// have room.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/long_work.h"
#include "validate/study/requirement/candidate.h"
#include "validate/study/requirement/target.h"
#include "validate/study/sweep/design/sweep.h"

namespace glidelab::validate {

inline constexpr double kClearMargin = 4.0;
/// A camera whose errors are smaller than allowed by this factor is better than needed; what would suffice is then
/// determined.
inline constexpr double kMuchLess = 3.0;

struct Requirement {
  std::string name;
  std::vector<Target> targets;
  Confirm confirm = Confirm::none;
  std::uint64_t track_runs = 0, runs = 0;
  bool by_price = false;              ///< all have a price; otherwise by pixels per second
  std::vector<Candidate> candidates;  ///< the cheapest first
  bool any_reached() const;
  /// The cheapest that reaches the targets; null if none does.
  const Candidate* first_reached() const;
};

/// How a sweep is judged if nothing is said: by clips if it has images, else by tracks.
Confirm usual_confirm(const Sweep& sweep);

/// Judges every point. InputError if the sweep has more than 100,000; an error of a single point becomes its verdict.
Requirement find_requirement(const Sweep& sweep, const RequirementOptions& options,
                             const base::Progress& progress = base::no_progress);

}  // namespace glidelab::validate
