/// Which of a sweep's points (cameras, settings) reach a target: first by the Cramér-Rao bound, then by runs.
///
/// A target is on the worst configuration of the scenario: its root mean square error, a bias included ("sd": of an
/// unbiased estimator the standard deviation), what 95 % of the errors stay within ("error95"), or the mean error
/// ("bias"); target.h. The bound takes the noise of the sweep's tracks, or predicts it from the camera
/// (validate/tracks/made_tracks.h), and is that of the standard deviation, times 1.96 for "error95". A point whose
/// bound is above the target cannot reach it. Any other is run as tracks with that noise and judged by its errors (of
/// the better estimator), for a bound knows nothing of dropped frames. Where rendered clips are to confirm, those that
/// miss the target by less than kClearMargin or reach it by less than kClearMarginOfClips are rendered as well, with
/// lens, shutter, codec and calibration, and these judge. Where the errors' uncertainty spans the target, nothing is
/// decided. Where nothing is run, a bound below the target by kClearMargin is said to have room.
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
/// Clips of a cheap camera with a compressing codec were seen to err 13 times as much as tracks
/// (docs/evidence/requirements.md).
inline constexpr double kClearMarginOfClips = 20.0;

struct Requirement {
  std::string name;
  std::vector<Target> targets;
  Confirm confirm = Confirm::none;
  std::uint64_t track_runs = 0, runs = 0;
  bool by_price = false;              ///< all have a price; else by pixels a second
  std::vector<Candidate> candidates;  ///< the cheapest first
  bool any_reached() const;
};

/// Judges every point. InputError if the sweep has more than 100,000; what refuses a single point is its verdict.
Requirement find_requirement(const Sweep& sweep, const RequirementOptions& options,
                             const base::Progress& progress = base::no_progress);

}  // namespace glidelab::validate
