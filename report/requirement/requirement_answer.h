/// The answer of `require` in a sentence: what to buy, how to set it, and what to expect.
#pragma once

#include <string>

#include "validate/study/requirement/requirement.h"

namespace glidelab::report {

/// Factor gained by removing one limitation; smaller gains are not mentioned.
inline constexpr double kLeastNamedGain = 1.05;

/// "µ ± 0.0001" for a 95 % error, "an rms error of µ of 0.0001", "a bias of µ of 0.0001", with their units.
std::string error_words(const validate::Target& target, const std::string& value);

/// "Buy: CAMERA, PRICE; set it to MODE; expect µ within …, at most … (95 % of 8 rendered experiments)": the cheapest
/// that reaches the targets; "Choose …" if no price is known. If none does, the nearest candidate and what limits it.
/// Text, one line without its end.
std::string requirement_answer(const validate::Requirement& requirement);

/// "That is 50 times better than needed: 11 frames/s would do, or …", if that is the case; otherwise empty. Text.
std::string enough_words(const validate::Requirement& requirement);

}  // namespace glidelab::report
