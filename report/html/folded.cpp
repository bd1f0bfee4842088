#include "report/html/folded.h"

namespace glidelab::report {

Html folded(const std::string& heading, const Html& part) {
  if (part.plots().empty() && part.texts().front().empty()) return {};
  return Html("<details class=\"part\"><summary>" + heading + "</summary>\n") + part + "</details>\n";
}

}  // namespace glidelab::report
