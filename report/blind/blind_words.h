/// What the scores of blind cases (validate/blind/) tell apart, in words. Text.
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "validate/blind/blind_score.h"

namespace glidelab::report {

/// "glidelab diagnose", "stepwise BIC", …
std::string method_name(validate::DecisionMethod method);

/// "unknown", "another name, probability over 0.8", …
std::string without_words(validate::VerdictWithout verdict);

/// The rows of the confusion matrix by what is true ("none", an effect's id, "two effects"): how often each was said
/// ("unknown", "none", "failed", an effect's id, "1 of the two named").
std::map<std::string, std::map<std::string, std::size_t>> confusion_words(const validate::BlindScore& score);

}  // namespace glidelab::report
