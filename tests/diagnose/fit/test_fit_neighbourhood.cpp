#include "diagnose/fit/fit_neighbourhood.h"

#include <cmath>

#include "tests/catch.h"

using namespace glidelab;

namespace {

/// The integral over log z by Simpson's rule in steps that are small beside the likelihood's width, one standard
/// deviation, at every z.
double integral(double z_hat, double z_most, bool both_signs) {
  const double from = std::log(2.0), to = std::log(z_most);
  constexpr int kSteps = 200000;
  double sum = 0.0;
  for (int i = 0; i <= kSteps; ++i) {
    const double z = std::exp(from + (to - from) * i / kSteps);
    const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
    // Over the likelihood of the absence, exp(-z_hat²/2); and over that of z_hat itself, against overflow.
    const auto likelihood = [&](double size) { return std::exp(-0.5 * (z_hat - size) * (z_hat - size)); };
    sum += weight * (likelihood(z) + (both_signs ? likelihood(-z) : 0.0));
  }
  const double mean = sum / (3.0 * kSteps) / (both_signs ? 2.0 : 1.0);
  return std::log(mean) + 0.5 * z_hat * z_hat;
}

}  // namespace

TEST_CASE("the evidence of an amplitude is its likelihood over the prior that is even in log z from 2 on") {
  for (const bool both_signs : {false, true}) {
    for (const double z_most : {20.0, 400.0}) {
      for (const double z : {-12.0, -3.0, 0.0, 2.0, 3.5, 6.0, 12.0, 25.0, 60.0}) {
        if (z > 0.8 * z_most) continue;  // the peak would be cut
        INFO("z " << z << " of " << z_most << ", " << (both_signs ? "both signs" : "one sign"));
        // Midpoints 1/120 or less apart in log z; above 30 the peak counts as a Gaussian one, to 1/z².
        CHECK(diagnose::log_amplitude_evidence(z, z_most, both_signs) ==
              Approx(integral(z, z_most, both_signs)).margin(3e-3));
      }
    }
  }
}

TEST_CASE("an amplitude of the wrong sign is evidence against an effect that has one sign") {
  CHECK(diagnose::log_amplitude_evidence(-4.0, 100.0, false) < -4.0);
  CHECK(diagnose::log_amplitude_evidence(-4.0, 100.0, true) ==
        Approx(diagnose::log_amplitude_evidence(4.0, 100.0, true)).epsilon(1e-12));
  // Half of the prior lies at the other sign.
  CHECK(diagnose::log_amplitude_evidence(8.0, 100.0, true) ==
        Approx(diagnose::log_amplitude_evidence(8.0, 100.0, false) - std::log(2.0)).margin(1e-6));
  // Less than two standard deviations is nothing, and the wider the prior the less evidence chance makes.
  CHECK(diagnose::log_amplitude_evidence(0.0, 100.0, true) < 0.0);
  CHECK(diagnose::log_amplitude_evidence(0.0, 1e4, true) ==
        Approx(diagnose::log_amplitude_evidence(0.0, 100.0, true) + std::log(std::log(50.0) / std::log(5000.0)))
            .margin(3e-3));
}
