#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

/// One frame in fifty is lost, others in each clip: most where the glider is so slow that its neighbours do not show
/// it.
bool lost(std::size_t clip, std::size_t frame) {
  return (frame + 37 * clip) % 50 == 45;
}

std::set<std::string> named(const diagnose::Diagnosis& diagnosis) {
  std::set<std::string> ids;
  for (const auto& effect : diagnosis.effects) ids.insert(effect.id);
  return ids;
}

diagnose::Diagnosis diagnosed(const tests::MadeEffect& effect, unsigned seed, double noise_m) {
  const tests::MadeExperiment made = tests::made_experiment(tests::made_launches(), effect, seed, noise_m);
  return diagnose::diagnose_results(made.results, made.setups, {});
}

}  // namespace

TEST_CASE("frames that are lost beside a force are named with it") {
  const auto air = [](double, double, double v, double) { return -0.08 * v * std::abs(v); };
  const auto bow = [](double mass_kg, double x_m, double, double) { return mass_kg * 9.80665 * 0.003 * x_m; };
  const auto with_air = diagnosed({.force = air, .lost = lost}, 31, 2e-4);
  CHECK(with_air.verdict == diagnose::Verdict::effect);
  CHECK(named(with_air) == std::set<std::string>{"dropped_frames", "quadratic_drag"});
  // Each has a share of its own, and the two take all of the gap.
  REQUIRE(with_air.explained.size() >= 2);
  std::set<std::string> causes;
  double shares = 0.0;
  for (std::size_t c = 0; c < 2; ++c) {
    causes.insert(with_air.explained[c].id);
    CHECK(with_air.explained[c].share > 0.02);
    shares += with_air.explained[c].share;
  }
  CHECK(causes == named(with_air));
  CHECK(std::abs(shares - 1.0) < 0.1);
  const auto with_bow = diagnosed({.force = bow, .lost = lost}, 31, 2e-4);
  CHECK(with_bow.verdict == diagnose::Verdict::effect);
  CHECK(named(with_bow) == std::set<std::string>{"dropped_frames", "track_bow"});
  for (const auto& effect : with_bow.effects) {
    if (effect.id != "dropped_frames") continue;
    REQUIRE(effect.parameters.size() == 1);
    // 24 of 1200. Those show that move the glider by several times the noise, at 2 mm/s or faster: nearly all. Poisson.
    CHECK(std::abs(effect.parameters.front().value - 0.02) < 0.008);
  }
}

TEST_CASE("frames that are lost beside a force that no list holds leave it unnamed") {
  const auto post = [](double, double x_m, double, double) {
    return 0.06 * std::exp(-0.5 * std::pow((x_m + 0.1) / 0.03, 2));
  };
  const auto diagnosis = diagnosed({.force = post, .lost = lost}, 33, 1e-4);
  // The frames take most of the gap, and have their name; the force is a remainder.
  for (const std::string& id : named(diagnosis)) CHECK(id == "dropped_frames");
  REQUIRE(diagnosis.remainder);
  CHECK(diagnosis.remainder->gap > 1.1);
}
