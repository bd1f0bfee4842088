// What is known of recordings that others measured, and their diagnosis.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/core/real_data.h"

using namespace glidelab;

namespace {

std::optional<diagnose::Diagnosis> diagnose_real(const std::string& name) {
  return tests::with_real(name, [](const std::filesystem::path& folder) {
    return diagnose::diagnose({folder}, {.without = {}, .jobs = 2});
  });
}

}  // namespace

TEST_CASE("carts whose positions are rounded to 1 cm lack nothing that rounding does not explain", "[slow]") {
  const auto diagnosis = diagnose_real("incline-cart");
  if (!diagnosis) return;
  CHECK(diagnosis->verdict == diagnose::Verdict::none);
  CHECK(diagnosis->effects.empty());
  CHECK(diagnosis->traces == std::vector<std::string>{"position_rounding"});
  REQUIRE(diagnosis->gap);
  CHECK(diagnosis->gap->before < 1.1);
  // An independent fit of each run leaves 3 to 5 mm.
  double square = 0.0, points = 0.0;
  for (const diagnose::ResidualCurve& curve : diagnosis->residuals) {
    for (const double off_m : curve.before_m) square += off_m * off_m;
    points += static_cast<double>(curve.before_m.size());
  }
  CHECK(std::sqrt(square / points) < 5e-3);
}

TEST_CASE("paper cups that fall side by side have a drag with the square of the speed", "[slow]") {
  const auto diagnosis = diagnose_real("falling-cups");
  if (!diagnosis) return;
  REQUIRE(diagnosis->verdict == diagnose::Verdict::effect);
  REQUIRE_FALSE(diagnosis->explained.empty());
  CHECK(diagnosis->explained.front().share > 0.5);
  const diagnose::DiagnosedEffect& first = diagnosis->effects.front();
  CHECK((first.id == "quadratic_drag" || first.id == "power_law_drag"));
  for (const diagnose::DiagnosedParameter& told : first.parameters) {
    if (told.key == "n") CHECK(std::abs(told.value - 2.0) < 3.0 * told.sd);
  }
}

TEST_CASE("a block that runs into the foot of its board is stopped there", "[slow]") {
  const auto diagnosis = diagnose_real("sliding-block");
  if (!diagnosis) return;
  // The images show it: in each clip the block slides freely until x = 0.01 m, runs into a paper cone at the foot of
  // the board, and has lost most of its speed by 0.13 m. A cable that tightens would brake it in the same way.
  REQUIRE(diagnosis->verdict == diagnose::Verdict::effect);
  const diagnose::DiagnosedEffect& first = diagnosis->effects.front();
  CHECK((first.id == "end_stop" || first.id == "tether"));
  CHECK(first.equivalent_to == std::vector<std::string>{first.id == "tether" ? "end_stop" : "tether"});
  for (const diagnose::DiagnosedParameter& told : first.parameters) {
    if (told.key == "x_t_m" || told.key == "x_b_m") CHECK(std::abs(told.value - 0.05) < 0.05);
  }
  const auto is_hand = [](const diagnose::Note& note) { return std::holds_alternative<diagnose::HandExplained>(note); };
  CHECK(std::ranges::any_of(diagnosis->notes, is_hand));
  REQUIRE(diagnosis->gap);
  CHECK(diagnosis->gap->before > 1.5);
}
