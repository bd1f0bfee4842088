/// Parts of a page that open where their heading is clicked.
#pragma once

#include <string>

#include "report/html/html.h"

namespace glidelab::report {

/// The heading is HTML; nothing of an empty part.
Html folded(const std::string& heading, const Html& part);

}  // namespace glidelab::report
