#include "validate/law_study.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "catch.h"
#include "test_paths.h"

using namespace glidelab;

namespace {

validate::LawStudy study(const std::string& name) {
  return validate::study_law(std::filesystem::path(tests::kSourceDir) / "scenarios/laws" / (name + ".toml"));
}

}  // namespace

TEST_CASE("Every teaching scenario is a whole scenario, and its motions run on its curves") {
  std::size_t count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::filesystem::path(tests::kSourceDir) / "scenarios/laws")) {
    INFO(entry.path().filename().string());
    const validate::LawStudy found = validate::study_law(entry.path());
    CHECK_FALSE(found.text.empty());
    CHECK_FALSE(found.motions.empty());
    for (const validate::LawMotion& motion : found.motions) {
      CHECK(motion.x_m.size() == motion.t_s.size());
      const auto [low, high] = std::minmax_element(motion.x_m.begin(), motion.x_m.end());
      CHECK(*low > -1.0);  // on the 2 m track
      CHECK(*high < 1.0);
    }
    ++count;
  }
  CHECK(count == 8);
}

TEST_CASE("Launched up, from rest and too fast, the viscous glider tends to the v_lim of equation (4)") {
  const validate::LawStudy found = study("1-viscous");
  const double v_lim = 9.80665 * std::sin(4.311 * std::acos(-1.0) / 180.0) / 2.768;
  REQUIRE(found.curves.size() == 2);
  CHECK(found.curves[0].equilibrium_m_s == 0.0);
  CHECK(std::abs(*found.curves[1].equilibrium_m_s - v_lim) < 1e-12);
  std::set<int> starts;
  for (const std::size_t m : found.curves[1].motions) {
    const validate::LawMotion& motion = found.motions[m];
    starts.insert(motion.v_m_s.front() < 0.0 ? -1 : motion.v_m_s.front() > v_lim ? 2 : 0);
    // What is left of the start after the clip: e^(-K t / m) of it.
    const double left = std::abs(motion.v_m_s.front() - v_lim) * std::exp(-2.768 * motion.t_s.back());
    CHECK(std::abs(std::abs(motion.v_m_s.back() - v_lim) - left) < 1e-9);
  }
  CHECK(starts == std::set<int>{-1, 0, 2});
}

TEST_CASE("The look-alikes are a millimetre apart in x and a quarter m/s2 and more in a") {
  const validate::LawStudy found = study("8-look-alike");
  REQUIRE(found.x_apart_m);
  // The fit of the second law's parameters to the first one's x(t) leaves 1.0 mm.
  CHECK(*found.x_apart_m < 1.1e-3);
  // At v -> 0 the one has no friction, the other mu g = 0.294 m/s2.
  CHECK(std::abs(*found.a_apart_m_s2 - 0.030003 * 9.80665) < 1e-3);
}
