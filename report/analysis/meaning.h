/// What the numbers say, in words, at the head of a page.
#pragma once

#include <string>
#include <vector>

#include "core/result/results.h"

namespace glidelab::report {

/// On the friction that was found: how large, how well a straight line describes it, what is not determined. Where the
/// law is in doubt that comes first, and the numbers are called no more than what a fit gives. HTML.
std::string meaning_of(const core::AnalysisResults& results);

/// What of the numbers the assumed law cannot mean, and what to do next: drag or friction below zero, points that lie
/// far off their line. One sentence each, plain text; none where the law serves.
std::vector<std::string> doubts_about(const core::AnalysisResults& results);

}  // namespace glidelab::report
