/// Parts of a page that open when their heading is clicked.
#pragma once

#include <string>

#include "report/html/html.h"

namespace glidelab::report {

/// The heading is HTML; an empty part gives nothing.
Html folded(const std::string& heading, const Html& part);

}  // namespace glidelab::report
