#include "diagnose/verdict/own_sizes.h"

#include <cmath>
#include <optional>
#include <vector>

#include "diagnose/causes/further_causes.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/track_set.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"
#include "tests/diagnose/scattering_friction.h"

using namespace glidelab;

TEST_CASE("a friction that all clips of one direction share is no scatter: it stands for an inclination that is off") {
  // Lengths are 5 % too long, so that 4 degrees look like 4.2; mu differs by 2 % (rms) within each direction.
  const std::vector<double> part = {0.02, -0.015, -0.02, 0.02, 0.01, -0.025, -0.01, 0.02};
  constexpr double kMu = 0.006;
  double squares = 0.0;
  for (const double one : part) squares += one * one;
  const double sd = kMu * std::sqrt(squares / 6.0);  // about the mean of each direction, which is 0
  tests::ScatteringFriction friction(kMu, part);
  tests::MadeEffect both;
  both.force = [&](double m, double, double v, double t) { return friction(m, v, t); };
  both.seen = [](double x, double) { return 1.05 * x; };
  std::vector<tests::MadeLaunch> launches;
  for (int i = 0; i < 4; ++i) {
    launches.push_back({0.4, 4.0, 0.6, -1.3 - 0.05 * i});
    launches.push_back({0.4, 4.0, -0.6, 0.8 - 0.05 * i});
  }
  // Half a second: none turns.
  const auto made = tests::made_experiment(launches, both, 5, 2e-6, 50, 100.0, 0.01, 0.0, {.k_n_s_m = 0.1, .mu = kMu});
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const std::optional<diagnose::MotionFit> fit = diagnose::with_clip_scatter(set, diagnose::fit_nominal(set));
  REQUIRE(fit);
  const std::size_t scatter = diagnose::effect_index(diagnose::ids::clip_scatter);
  const std::vector<diagnose::DiagnosedParameter> sizes = diagnose::own_sizes(set, *fit, scatter);
  REQUIRE(sizes.front().key == "sd_mu");
  // A tilt of 0.2 degrees is a friction of 0.0035 more in one direction than in the other.
  CHECK(sizes.front().value < 3.0 * sd + 3.0 * sizes.front().sd);
  CHECK(sizes.front().value < 0.1 * 0.0035);
}
