#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

constexpr double kG = 9.80665;

struct Body {
  double mass_kg;
  double c_kg_m;  ///< of the drag of air
};

/// Falls from rest, one after the other, filmed at 60 Hz to 1 mm over 0.8 s.
diagnose::Diagnosis of_falls(const std::vector<Body>& bodies, unsigned seed) {
  tests::MadeExperiment all;
  for (const Body& body : bodies) {
    const tests::MadeEffect air{.force = [c = body.c_kg_m](double, double, double v, double) { return -c * v * v; }};
    const tests::MadeExperiment one =
        tests::made_experiment({{body.mass_kg, 90.0, 0.0, 1e-6}}, air, seed++, 1e-3, 48, 60.0, 0.0, 0.0,
                               {.k_n_s_m = 0.0, .mu = 0.0, .gravity_m_s2 = kG});
    all.results.gravity_m_s2 = kG;
    all.results.gravity_sd_m_s2 = one.results.gravity_sd_m_s2;
    all.results.clips.push_back(one.results.clips.front());
    all.setups.push_back(one.setups.front());
    all.results.clips.back().name = all.setups.back().name = "fall" + std::to_string(all.setups.size());
  }
  return diagnose::diagnose_results(all.results, all.setups, {.without = {}, .jobs = 2});
}

const diagnose::DiagnosedEffect* find(const diagnose::Diagnosis& diagnosis, const std::string& id) {
  const auto at =
      std::find_if(diagnosis.effects.begin(), diagnosis.effects.end(), [&](const auto& one) { return one.id == id; });
  return at == diagnosis.effects.end() ? nullptr : &*at;
}

const diagnose::DiagnosedParameter& size_of(const diagnose::DiagnosedEffect& effect, const std::string& key) {
  const auto at =
      std::find_if(effect.parameters.begin(), effect.parameters.end(), [&](const auto& one) { return one.key == key; });
  INFO(effect.id << " without " << key);
  REQUIRE(at != effect.parameters.end());
  return *at;
}

void check_size(const diagnose::DiagnosedParameter& size, double truth) {
  INFO(size.key << " " << size.value << " +- " << size.sd << ", true " << truth);
  CHECK(std::abs(size.value - truth) < 3.0 * size.sd + 0.01 * truth);
  CHECK(size.sd < 0.2 * truth);
}

}  // namespace

TEST_CASE("a drag of air that differs between bodies is named, with the coefficient of each") {
  const std::vector<Body> kinds = {{1e-3, 2.2e-3}, {2e-3, 2.7e-3}, {3e-3, 3.2e-3}};
  std::vector<Body> bodies;
  for (const Body& kind : kinds) bodies.insert(bodies.end(), 3, kind);
  const diagnose::Diagnosis diagnosis = of_falls(bodies, 11);
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  REQUIRE(find(diagnosis, "quadratic_drag") != nullptr);
  const diagnose::DiagnosedEffect* own = find(diagnosis, "configuration_drag");
  REQUIRE(own != nullptr);
  check_size(size_of(*own, "c_kg_m.0.001 kg"), 2.2e-3);
  check_size(size_of(*own, "c_kg_m.0.002 kg"), 2.7e-3);
  check_size(size_of(*own, "c_kg_m.0.003 kg"), 3.2e-3);
  CHECK(size_of(*own, "sd_c_kg_m").value == Approx(0.5e-3).epsilon(0.1));
}

TEST_CASE("a drag of air that differs from fall to fall is named, and the interval of c allows for it") {
  const std::vector<double> deviation = {0.10, -0.07, 0.03, -0.11, 0.06, -0.02, 0.08, -0.07};  // sum 0
  constexpr double kC = 2.4e-3;
  std::vector<Body> bodies;
  double square = 0.0;
  for (const double d : deviation) {
    bodies.push_back({1.5e-3, kC * (1.0 + d)});
    square += d * d / 7.0;
  }
  const diagnose::Diagnosis diagnosis = of_falls(bodies, 31);
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  const diagnose::DiagnosedEffect *drag = find(diagnosis, "quadratic_drag"), *scatter = find(diagnosis, "clip_scatter");
  REQUIRE((drag != nullptr && scatter != nullptr));
  CHECK(size_of(*scatter, "sd_c_kg_m").value == Approx(kC * std::sqrt(square)).epsilon(0.2));
  check_size(size_of(*drag, "c_kg_m"), kC);
  CHECK(size_of(*drag, "c_kg_m").sd > 0.5 * kC * std::sqrt(square / 8.0));
}
