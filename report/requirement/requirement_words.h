/// A requirement in words: what it finds of a camera (validate/study/requirement/candidate.h), and its answer: what to
/// buy, how to set it, and what to expect. Text.
#pragma once

#include <string>

#include "validate/study/requirement/requirement.h"

namespace glidelab::report {

/// "reached, by clips", "impossible", …
std::string candidate_verdict(const validate::Candidate& candidate);

/// "fit of the whole motion": by whose errors the candidate is judged, of each target; "–" if nothing was run.
std::string judging_estimators(const validate::Candidate& candidate);

/// "µ: no answer with the fit of the whole motion in 1 of 8 runs", "; " between several; empty if all answered.
std::string unanswered_words(const validate::Requirement& requirement, const validate::Candidate& candidate);

/// "light (no shot noise)": the limitation, and what the camera would have instead.
std::string limitation_words(validate::Limitation limitation);

/// "H.264 at 8 Mbit/s", "frames without loss", …
std::string codec_words(const validate::CodecSetting& codec);

/// "mu 95 % error 0.0005"
std::string target_words(const validate::Target& target);

/// Factor gained by removing one limitation; smaller gains are not mentioned.
inline constexpr double kLeastNamedGain = 1.05;

/// "µ within 0.0001" for a 95 % error, "an rms error of µ of 0.0001", "a bias of µ of 0.0001", with their units.
std::string error_words(const validate::Target& target, const std::string& value);

/// "Buy: CAMERA, PRICE; set it to MODE; expect µ within …, at most … (95 % of 8 rendered experiments)": the cheapest
/// that reaches the targets; "Choose …" if no price is known. If none does, the nearest candidate and what limits it.
/// Text, one line without its end.
std::string requirement_answer(const validate::Requirement& requirement);

/// "This is 50 times better than needed: 11 frames/s, or … would do.", if that is the case; otherwise empty. Text.
std::string enough_words(const validate::Requirement& requirement);

}  // namespace glidelab::report
