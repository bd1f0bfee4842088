// What is known of measured recordings that no one here made, beside their diagnosis.
#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>

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

TEST_CASE("carts whose positions are rounded to 1 cm lack a displacement that swings with the place", "[slow]") {
  const auto diagnosis = diagnose_real("incline-cart");
  if (!diagnosis) return;
  CHECK(diagnosis->verdict == diagnose::Verdict::unknown);
  REQUIRE_FALSE(diagnosis->regions.empty());
  const diagnose::GapRegion& first = diagnosis->regions.front();
  CHECK(first.variable == "x_m");
  CHECK(first.what == "displacement");
  // What rounding to steps of d does has the first harmonic d/pi. A scatter of sigma before the rounding weakens it by
  // exp(-2 (pi sigma/d)²): 0.82 for 1 mm, 0.49 for 1.9 mm.
  const double harmonic_m = 0.01 / std::numbers::pi;
  CHECK(std::abs(first.size) > 0.5 * harmonic_m);
  CHECK(std::abs(first.size) < 1.1 * harmonic_m);
}

TEST_CASE("three half seconds of a block that slides on wood carry no name", "[slow]") {
  const auto diagnosis = diagnose_real("sliding-block");
  if (!diagnosis) return;
  // Friction of wood differs from place to place: no effect of the list, and no clean experiment either.
  CHECK(diagnosis->verdict == diagnose::Verdict::unknown);
  CHECK(diagnosis->effects.empty());
  REQUIRE(diagnosis->gap);
  CHECK(diagnosis->gap->before > 1.5);
}
