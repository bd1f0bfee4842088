/// A run of blind cases with its score, as it is reported.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fit/outside/outside_tally.h"
#include "validate/blind/blind_score.h"
#include "validate/blind/everyday_score.h"

namespace glidelab::report {

/// Largest acceptable calibration error.
inline constexpr double kWantedCalibration = 0.05;

struct BlindRun {
  std::uint64_t seed = 0;
  std::vector<validate::BlindOutcome> outcomes;
  validate::BlindScore score;
  std::optional<fit::OutsideTally> outside = {};         ///< of an estimator that answered the same cases
  bool images = false;                                   ///< filmed experiments, not tracks
  std::optional<validate::EverydayScore> everyday = {};  ///< of everyday cases; `score` is then empty
};

}  // namespace glidelab::report
