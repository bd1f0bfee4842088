#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "report/certificate/certificate_report.h"
#include "report/certificate/certificate_words.h"
#include "report/text/display_text.h"
#include "tests/catch.h"

using namespace glidelab;
using validate::TwinLimit;

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

validate::ChangedTwin change(validate::TwinLimit limit, bool stands_out) {
  return {limit, {}, 10, {}, validate::RunFall{0.42, 0.3, 0.5}, stands_out};
}

}  // namespace

TEST_CASE(
    "a certificate's first line is the share of intervals that hold and the largest sure bias of K/m, mu and alpha") {
  validate::Certificate made = certificate();
  CHECK(report::certificate_answer(made) ==
        "Intervals of K/m and µ hold in 94 % (90 to 97 %) of recordings like yours; µ is off by 0.3 standard "
        "deviations on average.");
  CHECK(report::certificate_text(made).starts_with(report::certificate_answer(made) + "\n"));
  made.quantities[0].bias_sds = {1.2, 0.4};  // larger, and as sure
  CHECK(report::certificate_answer(made).ends_with("; K/m is off by 1.2 standard deviations on average."));
  made.quantities[0].bias_sds = {0.1, 0.1};
  made.quantities[1].bias_sds.value = 0.1;
  CHECK(report::certificate_answer(made).ends_with("none of them is biased by more than chance."));
}

TEST_CASE("a certificate of intervals that do not hold begins with do not trust and names them") {
  validate::Certificate made = certificate();
  made.quantities[2].wide_coverage = {20, 40, 0.5, 0.3, 0.7};
  CHECK_FALSE(made.holds());
  made.quantities[2].coverage = {20, 40, 0.5, 0.35, 0.65};
  CHECK(report::certificate_answer(made) ==
        "Do not trust the intervals of the terminal velocity: they hold in 50 % (35 to 65 %) of recordings like yours, "
        "not in 95 %; µ is off by 0.3 standard deviations on average.");
  made.quantities[1].wide_coverage.high = 0.9;
  CHECK(report::certificate_answer(made).starts_with(
      "Do not trust the intervals of µ and the terminal velocity: they hold in 95 % (83 to 99 %) and 50 % (35 to 65 %) "
      "of"));
  made = certificate();
  made.together.high = 0.94;  // one in forty is so by chance
  CHECK(made.holds());
  made.wide_together = {113, 120, 0.9, 0.85, 0.94};
  CHECK_FALSE(made.holds());
  CHECK(report::certificate_answer(made).starts_with("Do not trust the intervals: "));
}

TEST_CASE("where the terminal velocity alone has a known true value, the first line is about it") {
  validate::Certificate fall = certificate();
  fall.together = fall.wide_together = {};
  fall.quantities = {fall.quantities[2]};
  CHECK_FALSE(fall.empty());
  CHECK(fall.holds());
  CHECK(report::certificate_answer(fall) ==
        "Intervals of the terminal velocity hold in 95 % (83 to 99 %) of recordings like yours. K/m, µ and α have no "
        "known true value.");
  fall.quantities[0].coverage = {74, 200, 0.37, 0.3, 0.44};
  fall.quantities[0].wide_coverage = {74, 200, 0.37, 0.28, 0.46};
  fall.changes = {change(TwinLimit::cause, false)};
  fall.changes[0].causes = {"quadratic_drag"};
  CHECK_FALSE(fall.holds());
  CHECK(report::certificate_answer(fall) ==
        "Do not trust the intervals of the terminal velocity: they hold in 37 % (30 to 44 %) of recordings like yours, "
        "not in 95 %. `glidelab analyze --with quadratic_drag` includes this cause in the law.");
  CHECK(report::certificate_page("a", fall).html.find("<code>glidelab analyze --with quadratic_drag</code> includes") !=
        std::string::npos);
  fall.quantities[0].failed = fall.quantities[0].asked;
  CHECK(fall.empty());
  CHECK(report::certificate_answer(fall).starts_with("There is nothing to count"));
}

TEST_CASE("a bias that one twin alone shows has no standard deviation") {
  validate::Certificate made = certificate();
  made.quantities[1].bias_sds.sd = std::numeric_limits<double>::infinity();
  const std::string text = report::certificate_text(made);
  CHECK(text.find("-0.32") != std::string::npos);
  CHECK(text.find("0.10 ± 0.10") != std::string::npos);
  CHECK(text.find("inf") == std::string::npos);
  made.quantities[0].bias_sds = {10.8692, 0.0123};
  CHECK(report::certificate_text(made).find("10.87 ± 0.01") != std::string::npos);
}

TEST_CASE("only changes that stand out are given as advice, three at most, and none is said in words") {
  validate::Certificate made = certificate();
  made.changes = {change(TwinLimit::pixel_noise, true), change(TwinLimit::marker, false)};
  REQUIRE(report::best_changes(made).size() == 1);
  CHECK(report::best_changes(made).front() ==
        "Use more light, or a wider aperture: four times the light halves the noise. With half the noise of each "
        "pixel, the errors of K/m and µ are 42 % (30 to 50 %) smaller.");
  CHECK(report::certificate_text(made).find("What limits it, the largest first: noise.") != std::string::npos);
  made.changes.front().limit = TwinLimit::cause;
  made.changes.front().causes = {"quadratic_drag"};
  made.changes.back().together = validate::RunFall{-0.002, -0.1, 0.1};
  CHECK(report::certificate_page("a", made).html.find("(<code>glidelab analyze --with quadratic_drag</code>)") !=
        std::string::npos);
  CHECK(report::certificate_page("a", made).html.find("-0 %") == std::string::npos);
  CHECK(report::certificate_page("a", made).html.find("−0 %") == std::string::npos);
  made.changes.back().together = validate::RunFall{-237.6, -2900.0, -18.7};  // 238.6 times the error
  CHECK(report::certificate_page("a", made).html.find("240 times larger (20 to 2900)") != std::string::npos);
  made.changes.assign(5, change(TwinLimit::few_clips, true));
  CHECK(report::best_changes(made).size() == 3);
  made.changes.assign(2, change(TwinLimit::few_clips, false));
  CHECK(report::best_changes(made).empty());
  CHECK(report::certificate_text(made).find("Nothing stands out") != std::string::npos);
}

TEST_CASE("a change that reduces the errors by less than a tenth is no advice, however sure it is") {
  validate::Certificate made = certificate();
  made.changes = {change(TwinLimit::cause, true), change(TwinLimit::pixel_noise, true)};
  made.changes[1].together = validate::RunFall{0.05, 0.049, 0.06};
  REQUIRE(report::best_changes(made).size() == 1);
  CHECK(report::best_changes(made).front().starts_with("Remove the cause"));
  const std::string text = report::certificate_text(made);
  CHECK(text.find("the largest first: a cause that the law lacks.\n") != std::string::npos);
  made.changes.erase(made.changes.begin());
  CHECK(report::best_changes(made).empty());
  CHECK(report::certificate_text(made).find("reduces the errors by a tenth or more, beyond chance") !=
        std::string::npos);
}

TEST_CASE("an advice that makes another quantity worse says so, and several causes are several") {
  validate::Certificate fall = certificate();
  fall.changes = {change(TwinLimit::cause, true)};
  fall.changes[0].causes = {"quadratic_drag", "rotational_inertia"};
  CHECK(report::best_changes(fall).front() ==
        "Remove these causes from the experiment, or put them into the model (glidelab analyze --with quadratic_drag "
        "--with rotational_inertia). With viscous and Coulomb friction alone, the errors of K/m and µ are 42 % (30 to "
        "50 %) smaller.");
  fall.changes[0].quantities = {{"v_lim_m_s", {-149.0, -189.0, -109.0}, false}};
  CHECK(report::best_changes(fall).front() ==
        "Put these causes into the model (glidelab analyze --with quadratic_drag --with rotational_inertia). With "
        "viscous and Coulomb friction alone, the errors of K/m and µ are 42 % (30 to 50 %) smaller, but those of the "
        "terminal velocity 150 times larger (110 to 190).");
  fall.changes[0].quantities = {{"v_lim_m_s", {-0.3, -0.7, 0.1}, false}};  // by chance
  CHECK(report::best_changes(fall).front().ends_with("smaller."));
  fall.changes[0].quantities = {{"v_lim_m_s", {-0.3, -0.4, -0.2}, false}};
  CHECK(report::best_changes(fall).front().ends_with("those of the terminal velocity 30 % (20 to 40 %) larger."));
  CHECK(report::certificate_text(fall).find("What limits it, the largest first: causes that the law lacks.") !=
        std::string::npos);
  fall.quantities[2].wide_coverage = {20, 40, 0.5, 0.3, 0.7};
  CHECK(report::certificate_answer(fall).ends_with("--with rotational_inertia` includes these causes in the law."));
  CHECK(report::certificate_text(fall).find('`') == std::string::npos);  // a terminal has no code
}

TEST_CASE("quantities that no twin gives are said once with the reason, and fill no rows with dashes") {
  validate::Certificate fall = certificate();
  fall.quantities[1].failed = fall.quantities[1].asked;
  fall.quantities[1].why = core::WhyUnknown{core::unknown::NoDownhillLine{}};
  fall.changes = {change(TwinLimit::few_clips, true)};
  fall.setups = {{"a", 0.335, 0.0}};
  fall.configurations = fall.quantities;
  for (validate::CertifiedQuantity& one : fall.configurations) one.setup = 0;
  const std::string text = report::certificate_text(fall), page = report::certificate_page("a", fall).html;
  CHECK(text.find("No twin has a value of µ: no line for v > 0.") != std::string::npos);
  CHECK(text.find("\nµ ") == std::string::npos);
  CHECK(page.find("No twin has a value of µ: no line for v &gt; 0.") != std::string::npos);
  CHECK(page.find("<td>µ</td>") == std::string::npos);
  CHECK(page.find("<th class=\"n\">µ</th>") == std::string::npos);
  CHECK(page.find(">terminal velocity (m/s)</td>") != std::string::npos);
}

TEST_CASE("an error that all but disappears is over 99.9 % smaller, not 100 %") {
  validate::Certificate made = certificate();
  made.changes = {change(TwinLimit::cause, true)};
  const auto words = [&](const validate::RunFall& fall) {
    made.changes.front().together = fall;
    const std::string advice = report::best_changes(made).front();
    return advice.substr(advice.find(" are ") + 5);
  };
  CHECK(words({0.9996, 0.9994, 0.9998}) == "over 99.9 % smaller.");
  CHECK(words({0.9996, 0.995, 0.9998}) == "99.9 % (99.5 to 99.9 %) smaller.");
  CHECK(words({0.988, 0.98, 0.992}) == "98.8 % (98.0 to 99.2 %) smaller.");
  CHECK(words({0.97, 0.96, 0.98}) == "97 % (96 to 98 %) smaller.");
}

TEST_CASE("what the twins are without stands right below the answer, on the page too") {
  validate::Certificate made = certificate();
  made.without = {validate::lacking::Inexpressible{"friction_drift", "it has no name"}};
  const std::string text = report::certificate_text(made);
  const std::size_t line = text.find('\n');
  CHECK(report::effect_name("friction_drift") != "friction_drift");
  CHECK(text.substr(line + 1).starts_with(
      "The recording has what its twins lack: " + report::effect_name("friction_drift") + " (it"));
  CHECK(report::certificate_page("a", made).html.find("The recording has what its twins lack") != std::string::npos);
}

TEST_CASE("a certificate says which explanation breaks the intervals where another one does not") {
  validate::Certificate made = certificate();
  made.explanations = {{{}, 0.7, 28, {83, 84, 0.988, 0.93, 1.0}},
                       {{"quadratic_drag"}, 0.3, 12, {12, 36, 0.333, 0.2, 0.5}}};
  const std::string text = report::certificate_text(made);
  CHECK(text.substr(text.find('\n') + 1)
            .starts_with("They fail under explanations of the data to which the diagnosis gives a probability of 30 % "
                         "in all, above all under quadratic drag (33 % hold).\n"));
  const std::string page = report::certificate_page("a", made).html;
  CHECK(page.find("the nominal law alone") != std::string::npos);
  CHECK(page.find("Each explanation") != std::string::npos);
  made.explanations[0].coverage = {28, 84, 0.333, 0.2, 0.5};
  const std::string all = report::certificate_text(made);
  CHECK(all.substr(all.find('\n') + 1)
            .starts_with("They fail under every explanation of the data that the diagnosis finds likely, above all "
                         "under the nominal law alone (33 % hold).\n"));
  made.explanations.pop_back();
  CHECK(report::certificate_text(made).find("leaves a probability") == std::string::npos);
  CHECK(report::certificate_page("a", made).html.find("Each explanation") == std::string::npos);
}

TEST_CASE("every limitation of a recording has a name, what its twins have instead, and advice") {
  struct Row {
    TwinLimit limit;
    const char *name, *change, *advice;
  };
  const std::vector<Row> rows = {
      {TwinLimit::pixel_noise, "noise", "half the noise of each pixel",
       "Use more light, or a wider aperture: four times the light halves the noise"},
      {TwinLimit::position_noise, "noise", "half the noise of each position",
       "Lower the noise of the positions: more light, a larger marker, a finer scale or a better tracker"},
      {TwinLimit::marker, "marker", "a marker of twice the diameter", "Use a larger marker"},
      {TwinLimit::frame_rate, "frame rate", "twice as many frames a second", "Use a higher frame rate"},
      {TwinLimit::scale, "scale", "the scale without error",
       "Measure the scale better (a longer ruler, in the plane of motion), or use a pattern"},
      {TwinLimit::calibration, "calibration", "the camera known without error",
       "Take more calibration images, tilted more and filling the image"},
      {TwinLimit::codec, "codec", "no compression loss",
       "Compress less: a higher bit rate or quality, or a lossless codec"},
      {TwinLimit::rounding, "rounding", "positions with all their digits", "Export more digits"},
      {TwinLimit::cause, "a cause that the law lacks", "viscous and Coulomb friction alone",
       "Remove the cause from the experiment"},
      {TwinLimit::clip_scatter, "what differs from clip to clip", "one law for every clip",
       "Make the clips alike: the track clean and level, the air still, nothing that touches the glider"},
      {TwinLimit::few_clips, "few clips", "every clip recorded twice", "Record a second clip of each kind"}};
  CHECK(rows.size() == static_cast<std::size_t>(TwinLimit::few_clips) + 1);
  for (const Row& row : rows) {
    const report::LimitWords words = report::limit_words(change(row.limit, true), certificate());
    CHECK(words.limit == row.name);
    CHECK(words.change == row.change);
    CHECK(words.advice == row.advice);
  }
  validate::ChangedTwin two = change(TwinLimit::cause, true);
  two.causes = {"quadratic_drag", "track_bow"};
  CHECK(report::limit_words(two, certificate()).advice ==
        "Remove these causes from the experiment, or put them into the model (glidelab analyze --with quadratic_drag "
        "--with "
        "track_bow)");
}

TEST_CASE("of a single clip nobody is advised to make the clips alike, and its motions are counted") {
  validate::Certificate one = certificate();
  one.clips = one.motions = 1;
  one.changes = {change(TwinLimit::clip_scatter, true)};
  CHECK(report::limit_words(one.changes[0], one).limit == "what the law leaves unexplained");
  CHECK(report::certificate_text(one).find("40 twins of this recording (1 clip), ") != std::string::npos);
  CHECK(report::certificate_text(one).find("clips alike") == std::string::npos);
  one.motions = 11;
  CHECK(report::limit_words(one.changes[0], one).advice.starts_with("Make the motions alike: "));
  CHECK(report::certificate_text(one).find("(1 clip with 11 motions), ") != std::string::npos);
  CHECK(report::certificate_text(one).find("the fitted motions, each as a clip of its own, ") != std::string::npos);
}

TEST_CASE("a certificate says why no twin has a value of a quantity") {
  validate::Certificate made = certificate();
  CHECK(report::certificate_text(made).find("No twin has a value") == std::string::npos);
  made.quantities[1].failed = 40;
  made.quantities[1].why.emplace(core::unknown::NoDownhillMotion{});
  CHECK(report::certificate_text(made).find("No twin has a value of µ: no motion with v > 0.") != std::string::npos);
  CHECK(report::certificate_page("a", made).html.find("No twin has a value of µ: ") != std::string::npos);
}

TEST_CASE("everything that twins may lack has words and a reason, an error of several lines in one") {
  namespace lacking = validate::lacking;
  const std::vector<std::pair<validate::NotInTwins, std::string>> lacks = {
      {lacking::Inexpressible{"quadratic_drag", "no law"}, "quadratic drag (no law)"},
      {lacking::Images{"twin: no view\nof the track"}, "images and calibration (twin: no view of the track)"},
      {lacking::Pattern{},
       "the calibration by a pattern (one folder has a pattern and another a scale: all twins are measured by the "
       "scale, "
       "with its error)"},
      {lacking::ClipScatter{}, "the scatter from clip to clip (errors of filming may explain it)"},
      {lacking::Noise{5e-4, 1.23456e-5},
       "noise as in the recording (its positions scatter by 0.0005 m, the twin's by 1.23e-05 m: something other than "
       "pixel noise is at work)"}};
  std::vector<bool> seen(std::variant_size_v<validate::NotInTwins>, false);
  for (const auto& [lack, words] : lacks) {
    CHECK(report::lack_words(lack) == words);
    seen[lack.index()] = true;
  }
  CHECK(std::find(seen.begin(), seen.end(), false) == seen.end());
}

TEST_CASE("a quantity that no twin answers says why, also where no clip could be used") {
  validate::CertifiedQuantity none = quantity("mu", 0.0);
  none.failed = none.asked;
  CHECK(report::unanswered_words(none) == "none of its clips could be used");
  none.why = core::WhyUnknown{core::unknown::NoDownhillLine{}};
  CHECK(report::unanswered_words(none) == "no line for v > 0");
  validate::Certificate made = certificate();
  made.quantities = {none};
  CHECK(report::certificate_json(made).find("\"coverage\": \"no line for v > 0\"") != std::string::npos);
}

TEST_CASE("configurations are named by mass and inclination, and by the twin's own names where two read the same") {
  validate::Certificate made = certificate();
  constexpr double kDegree = 0.017453292519943295;  // pi / 180
  made.setups = {{"a", 0.335, 4.0 * kDegree}, {"b", 0.335, 4.0 * kDegree}, {"c", 0.2, 0.0}};
  CHECK(report::setup_names(made) == std::vector<std::string>{"0.335 kg, 4° (a)", "0.335 kg, 4° (b)", "0.2 kg, 0°"});
  validate::CertifiedQuantity own = quantity("mu", 0.0);
  own.setup = 2;
  made.configurations = {own};
  CHECK(report::certificate_json(made).find("\"configuration\": \"0.2 kg, 0°\"") != std::string::npos);
  CHECK(report::certificate_page("a", made).html.find(">0.2\u00a0kg, 0°</td>") != std::string::npos);
}
