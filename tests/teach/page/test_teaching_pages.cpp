#include "teach/page/teaching_pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <regex>

#include "base/files/file_io.h"
#include "teach/page/page_texts.h"
#include "teach/study/phase_explorer.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/report/text_of_pages.h"

using namespace glidelab;
using tests::check_is_text;
using tests::has;
using tests::kEvil;

TEST_CASE("the page of laws has every name from a file as text") {
  teach::LawStudy study;
  study.name = study.text = kEvil;
  study.curves = {{kEvil, 0.0, {}, {}, {0.0, 1.0}, {0.0, -2.0}, {{0.0}}, {0}}};
  study.motions = {{kEvil, kEvil, {0.0, 0.02}, {0.0, 0.02}, {1.0, 0.96}, {-2.0, -1.9}}};
  teach::LawFilm film;
  film.frames = 2;
  film.frame_rate_hz = 25.0;
  film.clips = {kEvil};
  check_is_text(teach::laws_report({study}, {film}));
}

TEST_CASE("the films of laws have every motion's name as text, which steers nothing") {
  teach::LawStudy study;
  study.name = "viscous";
  study.curves = {{"level", 0.0, {}, {}, {0.0, 1.0}, {0.0, -2.0}, {{0.0}}, {0}}};
  study.motions = {{"</script><b>up", "level", {0.0, 0.02}, {0.0, 0.02}, {1.0, 0.96}, {-2.0, -1.9}}};
  teach::LawFilm film;
  film.mp4 = "film";
  film.frames = 26;
  film.frame_rate_hz = 25.0;
  const std::string page = teach::laws_report({study}, {film}).html;
  CHECK(has(page, "&lt;/script&gt;&lt;b&gt;up</li>"));
  CHECK_FALSE(has(page, "</script><b>up"));
  CHECK(has(page, "src=\"data:video/mp4;base64,ZmlsbQ==\""));
  CHECK(has(page, "1.0\u00a0s, in real time"));
  CHECK(has(page, ".law canvas, .law .rows i { filter: invert"));  // a dark page's names have the curves' hues
}

TEST_CASE("the page of laws tells coming to rest from tending to it, and marks what is unstable as such") {
  teach::LawStudy study;
  study.name = "three";
  study.curves = {{"viscous", 0.0, {}, {}, {0.0, 1.0}, {0.0, -2.0}, {{0.0, true, false}}, {}},
                  {"coulomb", 0.0, {}, {}, {0.0, 1.0}, {-0.1, -0.1}, {{0.0, true, true}}, {}},
                  {"stribeck", 2.0, {}, {}, {0.0, 1.0}, {-0.2, -0.1}, {{0.1805, false}, {0.4874, true}}, {}}};
  study.motions = {{"down", "viscous", {0.0, 0.02}, {0.0, 0.02}, {1.0, 0.96}, {-2.0, -1.9}}};
  const report::Page page = teach::laws_report({study}, {teach::LawFilm{}});
  const std::string said = std::regex_replace(page.html, std::regex("</?span[^>]*>"), "");
  CHECK(has(said,
            "viscous (0°): tends to rest; coulomb (0°): comes to rest; "
            "stribeck (2°): unstable at 0.1805\u00a0m/s, tends to v<sub>lim</sub> = 0.4874\u00a0m/s"));
  const auto script = std::ranges::find_if(
      page.files, [](const auto& file) { return file.first.ends_with(".gp") && has(file.first, "a-v"); });
  REQUIRE(script != page.files.end());
  CHECK(has(script->second, "with points pt 6"));
  CHECK(has(script->second, "with points pt 7"));
  CHECK(has(said, "circles: speeds that they leave"));
  // Which track an equilibrium belongs to; none is named where all have it.
  CHECK(has(script->second, "set label 'viscous, coulomb' at 0, 0"));
  CHECK(has(script->second, "set label 'stribeck' at 0.4874, 0"));
  study.curves.pop_back();
  for (const auto& [name, text] : teach::laws_report({study}, {teach::LawFilm{}}).files) {
    CHECK_FALSE(has(text, "set label 'viscous"));
  }
}

TEST_CASE("every page that teach can make either reads no file or is among those whose texts are tested here") {
  const std::filesystem::path root = tests::kSourceDir;
  const std::string here = base::read_file(root / "tests/teach/page/test_teaching_pages.cpp");
  const std::vector<std::string> pages = tests::pages_of(root / "teach");
  for (const std::string& name : pages) {
    INFO(name);
    CHECK((name == "explorer_page" || has(here, "check_is_text(teach::" + name + "(")));
  }
  CHECK(pages.size() >= 2);
}

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
