/// The open part of a diagnosis' page, below its first paragraph: the waterfall, K/m, µ, α and terminal velocity with
/// the causes in the model, where the rest lies, and what to record next. All else on the page is folded.
#pragma once

#include "diagnose/result/diagnosis.h"
#include "report/html/html.h"

namespace glidelab::report {

/// Places of a gap; empty without any. A size that images show has a parameter's key for its unit.
std::string region_table(const std::vector<diagnose::GapRegion>& regions);

/// What differs from one configuration to the next, where an effect has a value of each; empty where none has.
std::string member_section(const diagnose::Diagnosis& diagnosis);

/// Parts that there is nothing to say of are left out. Not of a table of lines.
Html answer_sections(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
