#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

constexpr double kG = 9.80665, kCup_kg = 0.481e-3;

/// A paper cup that a hand holds until 0.05 s, and from which it then opens within `opens_s`: it bears a part of the
/// weight that falls linearly to 0.
diagnose::Diagnosis of_cup(double c_kg_m, double air_kg, double opens_s, unsigned seed) {
  constexpr double kHeld_s = 0.05;
  tests::MadeEffect air_and_hand;
  air_and_hand.force = [=](double m, double, double v, double t) {
    const double free = std::clamp((t - kHeld_s) / opens_s, 0.0, 1.0);
    return -c_kg_m * v * std::abs(v) - (1.0 - free) * m * kG;
  };
  const tests::MadeExperiment made =
      tests::made_experiment({{kCup_kg, 90.0, 0.0, 1e-6, 0.0, 0.0, 1.0 + air_kg / kCup_kg}}, air_and_hand, seed, 1e-3,
                             130, 100.0, 0.0, 0.0, {.k_n_s_m = 0.0, .mu = 0.0, .gravity_m_s2 = kG});
  return diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
}

const diagnose::DiagnosedParameter* size_of(const diagnose::Diagnosis& diagnosis, const std::string& id) {
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    if (effect.id == id) return &effect.parameters.front();
  }
  return nullptr;
}

}  // namespace

TEST_CASE("of a paper cup that a hand lets go slowly, drag, air and hand are named, with their sizes") {
  for (const double air_kg : {0.1e-3, 0.35e-3}) {
    CAPTURE(air_kg);
    const diagnose::Diagnosis diagnosis = of_cup(1.9e-3, air_kg, 0.1, 4);
    REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
    std::set<std::string> ids;
    for (const auto& effect : diagnosis.effects) ids.insert(effect.id);
    CHECK(ids == std::set<std::string>{"late_release", "quadratic_drag", "rotational_inertia"});
    const auto *c = size_of(diagnosis, "quadratic_drag"), *air = size_of(diagnosis, "rotational_inertia");
    REQUIRE((c != nullptr && air != nullptr));
    CHECK(std::abs(c->value - 1.9e-3) < std::max(3.0 * c->sd, 0.01 * 1.9e-3));
    CHECK(std::abs(air->value - air_kg) < 3.0 * air->sd + 0.05 * air_kg);  // the hand is no step
  }
}

TEST_CASE("what every likely explanation has is named, whatever else is open") {
  // One clip with a wave of the positions that no law has: a second cause is uncertain, the drag is not.
  for (const unsigned seed : {5u, 6u}) {
    const diagnose::Diagnosis diagnosis = of_cup(1.9e-3, 0.2e-3, 0.15, seed);
    REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
    CHECK(diagnosis.effects.front().id == "quadratic_drag");
    CHECK(size_of(diagnosis, "frame_rate_error") == nullptr);
    for (const diagnose::RankedExplanation& one : diagnosis.ranking) {
      if (one.probability > 0.05 && !one.explanation.effects.empty()) CHECK(one.gap_after.has_value());
    }
  }
}
