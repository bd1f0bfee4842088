/// K/m, µ, α and the terminal velocity with causes in the model that the user named (diagnose/result/given_causes.h),
/// compared with the results of the analysis without them: for the page, the screen and results.json of `analyze
/// --with`.
#pragma once

#include <string>

#include "core/result/results.h"
#include "diagnose/result/given_causes.h"
#include "report/html/html.h"
#include "report/text/json_numbers.h"

namespace glidelab::report {

/// A section of the page: the sizes of the causes, how far they close the gap, and both columns of quantities.
Html given_causes_section(const core::AnalysisResults& results, const diagnose::GivenCauses& given);

/// The same for a terminal.
std::string given_causes_text(const core::AnalysisResults& results, const diagnose::GivenCauses& given);

/// The object "with" of results.json.
Json given_causes_json(const diagnose::GivenCauses& given);

}  // namespace glidelab::report
