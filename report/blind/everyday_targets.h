/// What a diagnosis of everyday cases should reach, what it reached, and whether so many cases decide.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "validate/blind/everyday_score.h"

namespace glidelab::report {

/// A number with an upper limit, or with a required range.
struct EverydayTarget {
  std::string what;
  validate::BlindShare share;   ///< if the target is a share; of no cases otherwise
  std::optional<double> value;  ///< if the target is not a share; empty if no case bears on it
  double low = 0.0, high = 1.0;
  bool number = false;                                        ///< not a share: its limits are no percentages
  std::optional<validate::ProportionInterval> interval = {};  ///< of `value`, 95 %
};
std::vector<EverydayTarget> everyday_targets(const validate::EverydayScore& score);

/// Whether some case bears on it.
bool bears(const EverydayTarget& target);

/// Met or missed if the whole 95 % interval lies inside or outside the required range, otherwise open.
enum class TargetVerdict { met, missed, open };
TargetVerdict verdict_of(const EverydayTarget& target);

/// "86 % (43 of 50; 95 %: 73 to 94 %)", a number, or a dash if no case bears on it. Text.
std::string found_text(const EverydayTarget& target);

/// "at least 85 %", "90 % to 98 %". Text.
std::string limits_text(const EverydayTarget& target);

/// "86 % (43 of 50; 95 %: 73 to 94 %)"; a dash if there are none. Text.
std::string share_and_interval(const validate::BlindShare& share);

/// Intervals of the diagnosis that contain the true value, of one class and one quantity; of all where they are empty.
validate::BlindShare covered_of(const validate::EverydayScore& score, const std::string& of_class,
                                const std::string& quantity);

/// "one cause", "a cause not on the list", … Text.
std::string words_of_class(const std::string& kind);

}  // namespace glidelab::report
