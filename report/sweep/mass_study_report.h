/// The section of a sweep's page on whether mu falls with mass (validate/study/sweep/mass_study.h, as part of the
/// summary).
#pragma once

#include <string>

#include "validate/study/sweep/sweep_summary.h"

namespace glidelab::report {

/// HTML: the answer in words where the sweep names what was published, and the table. Empty of any other sweep.
std::string mass_study_section(const validate::MassStudy& study);

}  // namespace glidelab::report
