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
  CHECK(english.title == "Worksheet: Viscous and Coulomb friction together");
  CHECK(english.answers[0] ==
        "−2.77 1/s in both: a straight line. The friction grows in proportion to v, with K/m = 2.77 1/s.");
  // 2 · 0.02 · 9.80665 · cos 4.311°, and (g sin α − 0.02 g cos α) / 2.768.
  CHECK(english.answers[1] == "By 0.391 m/s² = 2 μ g cos α. There is dry friction; near v = 0 its μ is 0.02.");
  CHECK(english.answers[2].starts_with("The glider tends to vₗᵢₘ = 0.1957 m/s."));
  CHECK(german.title == "Arbeitsblatt: Viskose und Coulombsche Reibung zusammen");
  CHECK(german.answers[0].starts_with("Beide Male −2,77 1/s"));
  CHECK(german.answers[2].starts_with("Der Gleiter strebt gegen vₗᵢₘ = 0,1957 m/s."));
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
