/// Which of a sweep's points (cameras, settings) reach a target: first by the Cramér-Rao bound, then by runs.
///
/// A target is on the worst configuration of the scenario: what 95 % of the errors stay within ("error95"), the root
/// mean square error, a bias included ("sd": of an unbiased estimator the standard deviation), or the mean error
/// ("bias"); target.h. The bound takes the noise of the sweep's tracks, or predicts it from the camera
/// (validate/tracks/made_tracks.h), and is that of the standard deviation, times 1.96 for "error95". A point whose
/// bound is above the target cannot reach it. Any other is rendered, with lens, shutter, codec and calibration:
/// kLeastRendered times, then twice as often, up to `runs` times, until the limits of the error (of the better
/// estimator) are on one side of the target. The limits have such a confidence that all looks together err with 5 % at
/// most, so that two runs decide what errs ten times less than it may, and four what errs four times less. The cheapest
/// that reaches the target is rendered `runs` times in any case: it is the one to buy. Up to `track_runs` runs as
/// tracks with that noise are made besides, for a bound knows nothing of dropped frames: where fewer than
/// kRunsForQuantile rendered runs reach what these miss, and where the limits span the target, nothing is decided.
/// Without rendering the tracks judge alone. Where nothing is run, a bound below the target by kClearMargin is said to
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
/// A camera that errs so many times less than it may is better than needed, and what would do is found.
inline constexpr double kMuchLess = 3.0;

struct Requirement {
  std::string name;
  std::vector<Target> targets;
  Confirm confirm = Confirm::none;
  std::uint64_t track_runs = 0, runs = 0;
  bool by_price = false;              ///< all have a price; else by pixels a second
  std::vector<Candidate> candidates;  ///< the cheapest first
  bool any_reached() const;
  /// The cheapest that reaches the targets; null where none does.
  const Candidate* first_reached() const;
};

/// Judges every point. InputError if the sweep has more than 100,000; what refuses a single point is its verdict.
Requirement find_requirement(const Sweep& sweep, const RequirementOptions& options,
                             const base::Progress& progress = base::no_progress);

}  // namespace glidelab::validate
