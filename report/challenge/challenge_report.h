/// The score of a challenge (validate/challenge/challenge_score.h): a file, a text, a page. Each ranks entrants only if
/// they differ significantly.
#pragma once

#include <string>

#include "report/html/html.h"
#include "validate/challenge/challenge_score.h"

namespace glidelab::report {

/// score.json, with a newline at its end.
std::string challenge_json(const validate::ChallengeScore& score);
std::string challenge_text(const validate::ChallengeScore& score);
Page challenge_page(const validate::ChallengeScore& score);

}  // namespace glidelab::report
