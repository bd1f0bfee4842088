#include "diagnose/weigh/unknown_noise.h"

#include <cmath>

#include "tests/catch.h"

using namespace glidelab;

// The marginal likelihood of residuals whose variance s² has a scaled inverse chi² posterior with nu degrees about 1:
// the integral of s^-n exp(-chi²/2s²) over it, by the trapezoidal rule in log s².
TEST_CASE("with few positions a gain is that of the likelihood averaged over the unknown noise") {
  const double n = 15.0, nu = 0.38 * n;
  const auto log_marginal = [&](double chi2) {
    double sum = 0.0;
    for (double log_s2 = -12.0; log_s2 < 12.0; log_s2 += 1e-3) {
      sum += std::exp(-0.5 * (nu + n) * log_s2 - 0.5 * (nu + chi2) * std::exp(-log_s2)) * 1e-3;
    }
    return std::log(sum);
  };
  for (const double chi2 : {8.0, 15.0, 60.0}) {
    for (const double gain : {0.5, 2.0, 3.5}) {
      CAPTURE(chi2, gain);
      const double expected = log_marginal(chi2 - 2.0 * gain) - log_marginal(chi2);
      CHECK(std::abs(diagnose::gain_with_unknown_noise({n, nu}, chi2, gain) - expected) < 1e-6);
    }
  }
}

TEST_CASE("an unknown noise takes nothing off a loss, nor off a gain where it counts as known") {
  const diagnose::FewPositions few{15.0, 5.7};
  CHECK(diagnose::lost_to_unknown_noise(few, 60.0, -20.0) == 0.0);
  CHECK(diagnose::lost_to_unknown_noise(std::nullopt, 60.0, 20.0) == 0.0);
  CHECK(diagnose::lost_to_unknown_noise(few, 60.0, 20.0) ==
        Approx(20.0 - diagnose::gain_with_unknown_noise(few, 60.0, 20.0)).epsilon(1e-12));
}

TEST_CASE("with many positions the noise counts as known") {
  diagnose::TrackSet set;
  set.motions.resize(2);
  for (diagnose::TrackedMotion& motion : set.motions) motion.outlier.assign(40, 0);
  CHECK_FALSE(diagnose::few_positions(set));
  set.motions.front().outlier.assign(30, 0);
  CHECK(diagnose::few_positions(set));
  // About chi² = n the gain of known noise is approached as 1/n.
  CHECK(std::abs(diagnose::gain_with_unknown_noise({1e4, 3.8e3}, 1e4, 5.0) - 5.0) < 0.01);
}
