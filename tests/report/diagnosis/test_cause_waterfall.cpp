#include "report/diagnosis/cause_waterfall.h"

#include "report/html/html.h"
#include "tests/catch.h"
#include "tests/report/made_diagnoses.h"

using namespace glidelab;

TEST_CASE("each bar of the waterfall begins where the one before ends, and ends at its gap's squared excess") {
  const diagnose::Diagnosis of = tests::two_causes();
  const auto bars = report::waterfall_bars(of.explained);
  REQUIRE(bars.size() == 2);
  CHECK(bars[0].from == 100.0);
  CHECK(bars[1].from == bars[0].to);
  const double before = of.gap->before * of.gap->before - 1.0;
  for (std::size_t i = 0; i < bars.size(); ++i) {
    // (g² - 1)/(g²_0 - 1): the made gaps are those of the shares, to the rounding of a square root.
    const double after = of.explained[i].gap_after * of.explained[i].gap_after - 1.0;
    CHECK(bars[i].to == Approx(100.0 * after / before).epsilon(1e-12));
    const diagnose::GapInterval share = *of.explained[i].share_interval95;
    CHECK(bars[i].from - bars[i].high == Approx(100.0 * share.low).epsilon(1e-12));
    CHECK(bars[i].from - bars[i].low == Approx(100.0 * share.high).epsilon(1e-12));
  }
}

TEST_CASE("the waterfall names the gap before, each cause with its share, and what is left, and gnuplot draws it") {
  diagnose::Diagnosis of = tests::two_causes();
  of.explained.back().share_interval95.reset();
  const auto plots = report::waterfall_plots(of);
  REQUIRE(plots.size() == 1);
  const std::string& script = plots.front().drawing.script;
  for (const char* name : {"'nominal model: 5.3 times the noise'", "'quadratic drag: 91 % (86 to 95 %)'",
                           "'added inertia: 6 %'", "'remainder: 3 %, 1.35 times the noise'"}) {
    INFO(name);
    CHECK(script.find(name) != std::string::npos);
  }
  REQUIRE(plots.front().drawing.data.size() == 2);
  CHECK(plots.front().drawing.data[0].rows.size() == 4);
  CHECK(plots.front().drawing.data[1].rows.size() == 1);  // whiskers where there is an interval
  const double share = of.explained.front().share;
  of.explained.front().share_interval95 = diagnose::GapInterval{share - 0.001, share + 0.001};  // as thin as its line
  CHECK(report::waterfall_plots(of).front().drawing.data.size() == 1);
  of.explained.front().share_interval95.reset();
  CHECK(report::waterfall_plots(of).front().drawing.data.size() == 1);
  CHECK_FALSE(report::page("waterfall", report::figures(report::waterfall_plots(of))).html.empty());
  of.explained.clear();
  CHECK(report::waterfall_plots(of).empty());
}
