/// The page of a diagnosis with a sequence of causes: what is open, what is folded, which numbers are not shown, and
/// its waterfall.
#include "report/diagnosis/diagnosis_answer.h"

#include <algorithm>

#include "report/diagnosis/diagnosis_report.h"
#include "report/html/html.h"
#include "tests/catch.h"
#include "tests/report/made_diagnoses.h"

using namespace glidelab;

namespace {

bool shows(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

std::string page_of(const diagnose::Diagnosis& diagnosis) {
  return report::diagnosis_report("made", diagnosis).html;
}

}  // namespace

TEST_CASE(
    "the page has verdict, waterfall, quantities, the rest and the next step open, in this order, and all else "
    "folded") {
  const std::string page = page_of(tests::two_causes());
  const std::size_t folds = page.find("<details");
  REQUIRE(folds != std::string::npos);
  const std::string open = page.substr(0, folds);
  std::size_t at = 0;
  for (const char* part : {"<b>Quadratic drag", "What explains the gap", "Waterfall of the gap",
                           "K/m, µ, α and terminal velocity", "with quadratic drag and added inertia in the model",
                           "Where the rest lies", "random acceleration", "What to record next"}) {
    INFO(part);
    const std::size_t found = open.find(part, at);
    CHECK(found != std::string::npos);
    at = std::min(found, open.size());
  }
  CHECK_FALSE(shows(open, "class=\"tiles\""));
  CHECK(std::count(open.begin(), open.end(), '\n') < 125);
  for (const char* part : {"Probability of each explanation", "How large the gap is",
                           "Where the gap of the nominal model lies", "The gap, clip by clip", "Method"}) {
    INFO(part);
    CHECK(page.find(part, folds) != std::string::npos);
    CHECK_FALSE(shows(open, part));
  }
  const auto count = [&](const std::string& what) {
    std::size_t n = 0;
    for (std::size_t i = page.find(what); i != std::string::npos; i = page.find(what, i + 1)) ++n;
    return n;
  };
  CHECK(count("<details") == count("</details>"));
}

TEST_CASE("without a sequence of causes the page keeps its tiles open and has no empty part") {
  diagnose::Diagnosis of = tests::two_causes();
  of.explained.clear();
  of.remainder.reset();
  of.levels.reset();
  of.recovered.clear();
  const std::string page = page_of(of);
  CHECK(page.find("class=\"tiles\"") < page.find("<details"));
  for (const char* part :
       {"What explains the gap", "K/m, µ, α and terminal velocity", "Where the rest lies", "Notes ("}) {
    INFO(part);
    CHECK_FALSE(shows(page, part));
  }
}

TEST_CASE("a remainder that is said to be nothing has no size and no place, on screen and page") {
  diagnose::Diagnosis of = tests::two_causes();
  of.remainder->share = 0.0;
  of.remainder->gap = 1.02;
  const std::string page = page_of(of);
  std::string text = report::diagnosis_text(of);
  std::replace(text.begin(), text.end(), '\n', ' ');  // it is wrapped
  for (const std::string& shown : {page, text}) {
    CHECK(shows(shown, "nothing is left above the noise"));
    CHECK_FALSE(shows(shown, "random acceleration"));
    CHECK_FALSE(shows(shown, "is clearest"));
  }
  CHECK_FALSE(shows(page, "Where the rest lies"));
  of.remainder->gap = 1.2;
  CHECK(shows(page_of(of), "Where the rest lies"));
  CHECK(shows(report::diagnosis_text(of), "random acceleration"));
}

TEST_CASE("where something is missing no page shows the nominal model's K with a standard deviation") {
  diagnose::Diagnosis of = tests::two_causes();
  // Beside what was recovered it is not shown at all.
  CHECK_FALSE(shows(page_of(of), "0.9412"));
  CHECK_FALSE(shows(page_of(of), "nominal model, alone"));
  of.recovered.clear();
  for (const diagnose::Verdict verdict : {diagnose::Verdict::effect, diagnose::Verdict::unknown}) {
    of.verdict = verdict;
    const std::string page = page_of(of);
    CHECK(shows(page, "nominal model, alone"));
    CHECK(shows(page, "0.941\u00a0N\u00a0s/m</td>"));
    CHECK_FALSE(shows(page, "0.9412"));
    CHECK(shows(page, "not those of the glider"));
  }
  of.verdict = diagnose::Verdict::none;
  CHECK(shows(page_of(of), "0.9412340\u00a0±\u00a00.0000077"));
}

TEST_CASE("where nothing has a name the curve over what matters most is open, and no other") {
  diagnose::Diagnosis of = tests::no_half();
  const auto open_part = [&] {
    const std::string page = page_of(of);
    return page.substr(0, page.find("<details"));
  };
  CHECK_FALSE(shows(open_part(), "Curve of the force"));  // over the position, and the rest lies over time
  of.curves.front().variable = diagnose::GapVariable::time;
  CHECK(shows(open_part(), "Curve of the force against time"));
  CHECK(shows(open_part(), "The smooth force as a function of time"));
  of.verdict = diagnose::Verdict::effect;
  CHECK_FALSE(shows(open_part(), "Curve of the force"));
  // Without a remainder `unknown` has the places of the whole gap.
  of.verdict = diagnose::Verdict::unknown;
  of.regions = of.remainder->regions;
  of.regions.front().what = diagnose::GapKind::friction;
  of.remainder.reset();
  CHECK(shows(open_part(), "<h2>Where the gap lies</h2>"));
  CHECK(shows(open_part(), "<td>friction</td>"));
  of.regions.front().variable = diagnose::GapVariable::set_up;
  CHECK(shows(open_part(), "one of the set-ups of m2-up"));
}

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
    CHECK(script.find(report::typeset_numbers(name)) != std::string::npos);
  }
  REQUIRE(plots.front().drawing.data.size() == 2);
  CHECK(plots.front().drawing.data[0].rows.size() == 4);
  CHECK(plots.front().drawing.data[1].rows.size() == 1);  // whiskers where there is an interval
  CHECK(plots.front().caption.ends_with("; whiskers are 95 % intervals over clips"));
  const double share = of.explained.front().share;
  of.explained.front().share_interval95 = diagnose::GapInterval{share - 0.001, share + 0.001};  // as thin as its line
  CHECK(report::waterfall_plots(of).front().drawing.data.size() == 1);
  CHECK(report::waterfall_plots(of).front().caption.find("whiskers") == std::string::npos);
  of.explained.back().share_interval95 = diagnose::GapInterval{-0.005, 0.1};
  CHECK(report::waterfall_plots(of).front().drawing.script.find("(−1 to 10") != std::string::npos);
  of.explained.back().share_interval95.reset();
  of.explained.front().share_interval95.reset();
  CHECK(report::waterfall_plots(of).front().drawing.data.size() == 1);
  CHECK_FALSE(report::page("waterfall", report::figures(report::waterfall_plots(of))).html.empty());
  of.explained.clear();
  CHECK(report::waterfall_plots(of).empty());
}
