#include "report/explorer_page.h"

#include <fmt/format.h>

#include "catch.h"
#include "validate/phase_explorer.h"

using namespace glidelab;

TEST_CASE("the explorer's sliders end where its motions were checked") {
  const std::string html = report::explorer_page(validate::PhaseExplorer{}).html;
  const auto holds = [&](const char* id, double low, double high) {
    INFO(id);
    CHECK(html.find(fmt::format("id=\"{}\" min=\"{}\" max=\"{}\"", id, low, high)) != std::string::npos);
  };
  holds("k", 0.0, validate::kDragRange.high);  // below its range's low end: no drag
  holds("mu", validate::kMuRange.low, validate::kMuRange.high);
  holds("alpha", validate::kInclineRange.low, validate::kInclineRange.high);
  holds("v0", validate::kStartRange.low, validate::kStartRange.high);
  holds("t", 0.0, validate::kExplorerTime);
}
