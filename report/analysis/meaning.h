/// What the numbers say, in words, at the head of a page.
#pragma once

#include <string>
#include <vector>

#include "core/result/results.h"

namespace glidelab::report {

/// The friction that was found: how large it is, how well a straight line describes it, what is not determined. If the
/// law is in doubt, that comes first and the numbers are presented only as the result of a fit. HTML.
std::string meaning_of(const core::AnalysisResults& results);

/// Results that the assumed law cannot explain (drag or friction below zero, points far off their line), and what to do
/// next. One sentence each, plain text; none if the law fits.
std::vector<std::string> doubts_about(const core::AnalysisResults& results);

}  // namespace glidelab::report
