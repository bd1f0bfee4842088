/// What a requirement finds of a camera (validate/study/requirement/candidate.h), in words. Text.
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

}  // namespace glidelab::report
