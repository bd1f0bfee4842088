/// A run of blind cases with its score (validate/blind/), as it is reported, and what the score tells apart, in words.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
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

/// "glidelab diagnose", "stepwise BIC", …
std::string method_name(validate::DecisionMethod method);

/// "unknown", "another name, probability over 0.8", …
std::string without_words(validate::VerdictWithout verdict);

/// The rows of the confusion matrix by what is true ("none", an effect's id, "two effects"): how often each was said
/// ("unknown", "none", "failed", an effect's id, "1 of the two named").
std::map<std::string, std::map<std::string, std::size_t>> confusion_words(const validate::BlindScore& score);

}  // namespace glidelab::report
