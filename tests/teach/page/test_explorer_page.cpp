#include "teach/page/page_texts.h"
#include "teach/page/teaching_pages.h"

#include <fmt/format.h>

#include "teach/study/phase_explorer.h"
#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("the explorer's sliders end where its motions were checked") {
  const std::string html = teach::explorer_page(teach::PhaseExplorer{}).html;
  const auto holds = [&](const char* id, double low, double high) {
    INFO(id);
    CHECK(html.find(fmt::format("id=\"{}\" min=\"{}\" max=\"{}\"", id, low, high)) != std::string::npos);
  };
  holds("k", 0.0, teach::kDragRange.high);  // below its range's low end: no drag
  holds("mu", teach::kMuRange.low, teach::kMuRange.high);
  holds("alpha", teach::kInclineRange.low, teach::kInclineRange.high);
  holds("v0", teach::kStartRange.low, teach::kStartRange.high);
  holds("t", 0.0, teach::kExplorerTime);
}
