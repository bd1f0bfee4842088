#include <limits>
#include <string>

#include "report/certificate/certificate_report.h"
#include "report/text/display_text.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

validate::CertifiedQuantity quantity(const std::string& key, double bias_sds) {
  validate::CertifiedQuantity one;
  one.quantity = key;
  one.asked = 40;
  one.coverage = {38, 40, 0.95, 0.83, 0.99};
  one.wide_coverage = {38, 40, 0.95, 0.78, 1.0};
  one.bias_sds = {bias_sds, 0.1};
  one.rms = one.stated_sd = 1e-4;
  return one;
}

validate::Certificate certificate() {
  validate::Certificate made;
  made.runs = 40;
  made.clips = 2;
  made.estimator = "phase-diagram";
  made.together = {113, 120, 0.942, 0.90, 0.97};
  made.wide_together = {113, 120, 0.942, 0.88, 0.98};
  made.quantities = {quantity("k_over_m_1_s", 0.1), quantity("mu", -0.32), quantity("v_lim_m_s", 2.0)};
  return made;
}

validate::ChangedTwin change(const std::string& limit, bool stands_out) {
  return {limit, "half of it", "more light", 10, {}, validate::RunFall{0.42, 0.3, 0.5}, stands_out};
}

}  // namespace

TEST_CASE(
    "a certificate's first line is the share of intervals that hold and the largest sure bias of K/m, mu and alpha") {
  validate::Certificate made = certificate();
  CHECK(report::certificate_answer(made) ==
        "Intervals of K/m, µ hold in 94 % (90 to 97 %) of recordings like yours; µ is off by 0.3 of its standard "
        "deviation on average.");
  CHECK(report::certificate_text(made).starts_with(report::certificate_answer(made) + "\n"));
  made.quantities[0].bias_sds = {1.2, 0.4};  // larger, and as sure
  CHECK(report::certificate_answer(made).ends_with("; K/m is off by 1.2 of its standard deviation on average."));
  made.quantities[0].bias_sds = {0.1, 0.1};
  made.quantities[1].bias_sds.value = 0.1;
  CHECK(report::certificate_answer(made).ends_with("none of them is off on average by more than chance."));
}

TEST_CASE("a certificate of intervals that do not hold begins with do not trust and names them") {
  validate::Certificate made = certificate();
  made.quantities[2].wide_coverage = {20, 40, 0.5, 0.3, 0.7};
  CHECK_FALSE(made.holds());
  CHECK(report::certificate_answer(made).starts_with(
      "Do not trust the intervals of terminal velocity: those of K/m, µ hold "
      "in 94 % (90 to 97 %)"));
  made = certificate();
  made.together.high = 0.94;  // one in forty is so by chance
  CHECK(made.holds());
  made.wide_together = {113, 120, 0.9, 0.85, 0.94};
  CHECK_FALSE(made.holds());
  CHECK(report::certificate_answer(made).starts_with("Do not trust the intervals: "));
}

TEST_CASE("a bias that one twin alone shows has no standard deviation") {
  validate::Certificate made = certificate();
  made.quantities[1].bias_sds.sd = std::numeric_limits<double>::infinity();
  const std::string text = report::certificate_text(made);
  CHECK(text.find("-0.32") != std::string::npos);
  CHECK(text.find("0.10 ± 0.10") != std::string::npos);
  CHECK(text.find("inf") == std::string::npos);
}

TEST_CASE("only changes that stand out are given as advice, three at most, and none is said in words") {
  validate::Certificate made = certificate();
  made.changes = {change("noise", true), change("marker", false)};
  REQUIRE(report::best_changes(made).size() == 1);
  CHECK(report::best_changes(made).front() == "more light. With half of it, K/m, µ err 42 % (30 to 50 %) less.");
  CHECK(report::certificate_text(made).find("What limits it, most first: noise.") != std::string::npos);
  made.changes.front().advice = "Take it out (glidelab analyze --with quadratic_drag)";
  made.changes.back().together = validate::RunFall{-0.002, -0.1, 0.1};
  CHECK(report::certificate_page("a", made).html.find("(<code>glidelab analyze --with quadratic_drag</code>)") !=
        std::string::npos);
  CHECK(report::certificate_page("a", made).html.find("-0 %") == std::string::npos);
  CHECK(report::certificate_page("a", made).html.find("−0 %") == std::string::npos);
  made.changes.back().together = validate::RunFall{-237.6, -2900.0, -18.7};  // 238.6 times the error
  CHECK(report::certificate_page("a", made).html.find("× 240 (20 to 2900)") != std::string::npos);
  made.changes.assign(5, change("noise", true));
  CHECK(report::best_changes(made).size() == 3);
  made.changes.assign(2, change("noise", false));
  CHECK(report::best_changes(made).empty());
  CHECK(report::certificate_text(made).find("Nothing stands out") != std::string::npos);
}

TEST_CASE("what the twins are without stands right below the answer, on the page too") {
  validate::Certificate made = certificate();
  made.without = {{"friction_drift", "it has no name"}};
  const std::string text = report::certificate_text(made);
  const std::size_t line = text.find('\n');
  CHECK(report::effect_name("friction_drift") != "friction_drift");
  CHECK(text.substr(line + 1).starts_with(
      "The recording has what its twins have not: " + report::effect_name("friction_drift") + " (it"));
  CHECK(report::certificate_page("a", made).html.find("what its twins have not") != std::string::npos);
}

TEST_CASE("a certificate says which explanation breaks the intervals where another one does not") {
  validate::Certificate made = certificate();
  made.explanations = {{{}, 0.7, 28, {83, 84, 0.988, 0.93, 1.0}},
                       {{"quadratic_drag"}, 0.3, 12, {12, 36, 0.333, 0.2, 0.5}}};
  const std::string text = report::certificate_text(made);
  CHECK(
      text.substr(text.find('\n') + 1)
          .starts_with("They fail with explanations that the diagnosis finds 30 % probable together, most of all with "
                       "quadratic drag (33 % hold).\n"));
  const std::string page = report::certificate_page("a", made).html;
  CHECK(page.find("the nominal law alone") != std::string::npos);
  CHECK(page.find("Each explanation") != std::string::npos);
  made.explanations.pop_back();
  CHECK(report::certificate_text(made).find("leaves a probability") == std::string::npos);
  CHECK(report::certificate_page("a", made).html.find("Each explanation") == std::string::npos);
}
