/// The open part of the page of a diagnosis, below its first paragraph: the waterfall, K/m, µ, α and terminal velocity
/// with the causes in the model, where the remainder lies, and what to record next. Everything else on the page is
/// folded.
#pragma once

#include "diagnose/result/diagnosis.h"
#include "report/html/html.h"

namespace glidelab::report {

/// Regions of a gap; empty if there are none. The unit of a size shown by images is that of a parameter's key.
std::string region_table(const std::vector<diagnose::GapRegion>& regions);

/// Differences between configurations, if an effect has a value for each; empty if none has.
std::string member_section(const diagnose::Diagnosis& diagnosis);

/// Empty parts are left out. Not for a table of lines.
Html answer_sections(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
