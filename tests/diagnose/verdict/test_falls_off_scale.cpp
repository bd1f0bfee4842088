// Falls without any drag whose scale is off: slower than gravity allows from the first position on.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

constexpr double kScale = 0.88;

/// One fall of 100 g at 60 Hz, 12 % too short, with a scale that varies by 3 mm along x. Five positions are averaged,
/// as a tracker that smooths does, so that the noise about neighbouring positions says little of the errors.
diagnose::Diagnosis of_smoothed(unsigned seed) {
  tests::MadeEffect seen;
  seen.seen = [](double x, double) { return kScale * (x + 3e-3 * std::sin(2.0 * std::numbers::pi * x / 0.4 + 1.0)); };
  tests::MadeExperiment made = tests::made_experiment({{0.1, 90.0, 0.0, 1e-6}}, seen, seed, 1e-3, 52, 60.0, 0.0, 0.0,
                                                      {.k_n_s_m = 0.0, .mu = 0.0, .gravity_m_s2 = 9.80665});
  std::vector<core::MotionPoint>& motion = made.results.clips.front().motion;
  const std::vector<core::MotionPoint> raw = motion;
  for (std::size_t i = 2; i + 2 < motion.size(); ++i) {
    double sum = 0.0;
    for (std::size_t k = i - 2; k <= i + 2; ++k) sum += *raw[k].measured_m;
    motion[i].measured_m = sum / 5.0;
  }
  return diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
}

}  // namespace

TEST_CASE("a drag of air is not named where a viscous one without anything else leaves less of the gap") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    CAPTURE(seed);
    const diagnose::Diagnosis diagnosis = of_smoothed(seed);
    REQUIRE(diagnosis.gap);
    CHECK(diagnosis.gap->before > 5.0);
    for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
      CHECK(effect.id != diagnose::ids::quadratic_drag);
      if (effect.id == diagnose::ids::scale_error) {
        CHECK(std::abs(effect.parameters.front().value - (kScale - 1.0)) < 3.0 * effect.parameters.front().sd);
      }
    }
  }
}
