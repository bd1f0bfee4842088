#include "teach/page/worksheet.h"

#include <cmath>
#include <filesystem>
#include <numbers>

#include "teach/page/page_words.h"
#include "teach/study/law_questions.h"
#include "test_paths.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kGravity = 9.80665, kIncline = 4.311 * std::numbers::pi / 180.0;

teach::LawStudy law(const char* name) {
  return teach::study_law(std::filesystem::path(tests::kSourceDir) / "scenarios/laws" / name);
}

bool ends_with_limit(const teach::LawStudy& study, double v_m_s) {
  const teach::LawCurve& curve = study.curves[teach::answers_of(study).curve];
  return !curve.equilibria.empty() && std::abs(curve.equilibria.back().v_m_s - v_m_s) < 1e-12;
}

}  // namespace

TEST_CASE("a worksheet's answers are the closed forms of its law") {
  // From the scenarios: K/m = 2.768 1/s, mu = 0.02, c/m = 0.5 / 0.335 1/m, on 4.311 degrees. Differences of a, which is
  // some m/s², and quotients of them with 0.1 m/s at the least: 1e-14 of rounding, with room.
  const double k = 2.768, mu = 0.02, sine = std::sin(kIncline), cosine = std::cos(kIncline);
  const teach::LawStudy viscous = law("1-viscous.toml");
  const teach::LawAnswers one = teach::answers_of(viscous);
  CHECK(viscous.curves[one.curve].configuration == "inclined");
  CHECK(one.straight());
  CHECK_FALSE(one.flat());
  CHECK_FALSE(one.jumps());
  CHECK(std::abs(one.slope1_1_s + k) < 1e-11);
  CHECK(std::abs(one.slope2_1_s + k) < 1e-11);
  CHECK(ends_with_limit(viscous, kGravity * sine / k));

  const teach::LawStudy both = law("3-viscous-and-coulomb.toml");
  const teach::LawAnswers two = teach::answers_of(both);
  CHECK(two.straight());
  CHECK(std::abs(two.slope1_1_s + k) < 1e-11);
  CHECK(std::abs(two.jump_m_s2 - 2.0 * mu * kGravity * cosine) < 1e-12);
  CHECK(std::abs(two.mu - mu) < 1e-12);
  const double v_lim = kGravity * (sine - mu * cosine) / k;
  CHECK(ends_with_limit(both, v_lim));
  // And the simulated glider is on its way there: v - v_lim falls as exp(-k t). The solver's tolerance is below 1e-8.
  for (const teach::LawMotion& motion : both.motions) {
    if (motion.clip != "inclined-fast") continue;
    CHECK(std::abs(motion.v_m_s.back() - v_lim - (1.2 - v_lim) * std::exp(-k * motion.t_s.back())) < 1e-8);
  }

  const teach::LawAnswers dry = teach::answers_of(law("2-coulomb.toml"));
  CHECK(dry.flat());
  CHECK(std::abs(dry.mu - mu) < 1e-12);

  const teach::LawStudy quadratic = law("4-quadratic.toml");
  const teach::LawAnswers square = teach::answers_of(quadratic);
  const double c = 0.5 / 0.335;
  CHECK_FALSE(square.straight());
  CHECK(std::abs(square.slope1_1_s + c * square.v1_m_s) < 1e-11);        // (v1² - 0) / v1
  CHECK(std::abs(square.slope2_1_s + 3.0 * c * square.v1_m_s) < 1e-11);  // (4 v1² - v1²) / v1
  CHECK(ends_with_limit(quadratic, std::sqrt(kGravity * sine / c)));
}

TEST_CASE("a worksheet asks and answers in its language, with that language's numbers") {
  const teach::LawStudy both = law("3-viscous-and-coulomb.toml");
  const teach::WorksheetTexts english = teach::worksheet_texts(both, "en"), german = teach::worksheet_texts(both, "de");
  CHECK(english.title == "Worksheet: Viscous drag and Coulomb friction together");
  CHECK(
      english.answers[0] ==
      "−2.8 1/s in both: a straight line. The part of the friction that depends on v is proportional to v, with K/m = "
      "2.8 1/s.");
  // 2 · 0.02 · 9.80665 · cos 4.311°, and (g sin α − 0.02 g cos α) / 2.768.
  CHECK(english.answers[1] == "By 0.39 m/s² = 2 μ g cos α. There is dry friction, with μ = 0.020.");
  CHECK(
      english.answers[2] ==
      "However it starts, the glider tends to vₗᵢₘ = 0.20 m/s. Where a falls through 0, a > 0 at lower v and a < 0 at "
      "higher v: the glider returns to that speed.");
  CHECK(german.title == "Arbeitsblatt: Viskose und Coulombsche Reibung zusammen");
  CHECK(german.answers[0].starts_with("Beide Male −2,8 1/s"));
  CHECK(german.answers[2].starts_with("Wie er auch startet: Der Gleiter strebt gegen vₗᵢₘ = 0,20 m/s."));
}

TEST_CASE("a worksheet says what becomes of a glider in each range of speeds, and only what is true of its law") {
  const auto end = [](const char* name, const char* language = "en") {
    return teach::worksheet_texts(law(name), language).answers[2];
  };
  // tan 4.311° = 0.075 is more than μ = 0.02, and no drag balances the slope.
  CHECK(end("2-coulomb.toml") == "a is never 0: the glider gets faster and faster.");
  CHECK(end("2-coulomb.toml", "es") == "a nunca es 0: el deslizador va cada vez más deprisa.");
  // The zeros of g sin 2° − 0.02 g cos 2° (1 + 2 exp(−(v/0.15)²)) − 0.3 v: 0.1805 and 0.4874 m/s.
  const std::string reasons =
      " Where a falls through 0, a > 0 at lower v and a < 0 at higher v: the glider returns to that speed.";
  CHECK(end("6-stribeck.toml") ==
        "A glider slower than 0.18 m/s comes to rest. A glider faster than 0.18 m/s tends to vₗᵢₘ = 0.49 m/s." +
            reasons + " At 0.18 m/s a rises through 0: this equilibrium is unstable.");
  // k v / (1 + (v / v_c)²) = g sin α with k = 2.768 1/s and v_c = 0.6 m/s: v² − 1.3519 v + 0.36 = 0 (m/s), so that
  // v = 0.365 and 0.987 m/s.
  CHECK(end("7-eddy-rolloff.toml")
            .starts_with("A glider slower than 0.99 m/s tends to vₗᵢₘ = 0.36 m/s. A glider faster than 0.99 m/s gets "
                         "faster and faster."));
  CHECK(end("8-look-alike.toml").starts_with("However it starts, the glider comes to rest."));
  CHECK(end("8-look-alike.toml").find("unstable") == std::string::npos);
}

TEST_CASE("μ is called that near v = 0 where it changes with the speed, and there alone") {
  const auto dry = [](const char* name) { return teach::worksheet_texts(law(name), "en").answers[1]; };
  // 2 · 0.06 · 9.80665 · cos 2°: the friction of rest is 3 times 0.02.
  CHECK(dry("6-stribeck.toml") == "By 1.2 m/s² = 2 μ g cos α. There is dry friction; near v = 0 its μ is 0.060.");
  // 2 · 0.030003 · 9.80665.
  CHECK(dry("8-look-alike.toml") == "By 0.59 m/s² = 2 μ g cos α. There is dry friction, with μ = 0.030.");
}

TEST_CASE("a sheet draws both sides of v = 0, whose distance it asks for, where no glider of the law goes uphill") {
  for (const char* name : {"6-stribeck.toml", "8-look-alike.toml"}) {
    const teach::LawStudy study = law(name);
    for (const teach::LawCurve& curve : study.curves) {
      CHECK(curve.up_v_m_s.empty());
      const teach::LawCurve both = teach::in_both_directions(curve);
      REQUIRE(!both.up_v_m_s.empty());
      CHECK(both.down_v_m_s == curve.down_v_m_s);
      CHECK(both.down_a_m_s2 == curve.down_a_m_s2);
      // Friction is odd in v, and what is left is gravity: a(v) + a(-v) = 2 g sin α. Sums of terms below 2 m/s²: 1e-14
      // of rounding, with room.
      for (std::size_t i = 0; i < both.up_v_m_s.size(); ++i) {
        const double v = -both.up_v_m_s[i];
        const double a = sim::net_force_n(curve.body, v, 1) / curve.body.mass_kg;
        CHECK(std::abs(both.up_a_m_s2[i] + a - 2.0 * kGravity * std::sin(curve.body.incline_rad)) < 1e-12);
      }
      CHECK(both.up_v_m_s.front() == 0.0);
      CHECK(both.up_v_m_s.back() == -0.5 * curve.down_v_m_s.back());
    }
  }
  const teach::LawCurve whole = law("1-viscous.toml").curves[0];  // launched both ways
  CHECK(teach::in_both_directions(whole).up_v_m_s == whole.up_v_m_s);
}

TEST_CASE("a law has one sheet for the class and another with the answers, the same each time") {
  const std::vector<teach::LawStudy> studies = {law("1-viscous.toml"), law("6-stribeck.toml")};
  const std::vector<teach::Worksheet> made = teach::worksheets(studies, "fr");
  REQUIRE(made.size() == 2);
  for (const teach::Worksheet& sheet : made) {
    CHECK(sheet.pdf.starts_with("%PDF"));
    CHECK(sheet.answers.starts_with("%PDF"));
    CHECK(sheet.pdf != sheet.answers);
  }
  CHECK(made[0].pdf == teach::worksheets({studies[0]}, "fr")[0].pdf);
}
