/// The results of everyday blind cases: a file, a text, a page.
#pragma once

#include <string>

#include "report/blind/blind_run.h"
#include "report/html/html.h"

namespace glidelab::report {

/// Like those of blind_report.h, for a run with `everyday`.
std::string everyday_json(const BlindRun& run);
std::string everyday_text(const BlindRun& run);
Page everyday_page(const BlindRun& run);

}  // namespace glidelab::report
