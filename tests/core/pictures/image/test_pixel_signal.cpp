#include "core/pictures/image/pixel_signal.h"

#include <cmath>

#include "tests/catch.h"

using namespace glidelab;

namespace {

/// The pixel's mean over 400 x 400 points of the blurred edge Phi(s / blur).
double by_sums(double s, double nu, double nv, double blur) {
  constexpr int kPoints = 400;
  double sum = 0.0;
  for (int j = 0; j < kPoints; ++j) {
    for (int i = 0; i < kPoints; ++i) {
      const double at = s + nu * ((i + 0.5) / kPoints - 0.5) + nv * ((j + 0.5) / kPoints - 0.5);
      sum += 0.5 * std::erfc(-at / (blur * std::sqrt(2.0)));
    }
  }
  return sum / (kPoints * kPoints);
}

}  // namespace

TEST_CASE("a pixel's response to a blurred edge is the mean over its square") {
  for (const double angle : {0.0, 0.05, 0.3, 0.7853981633974483, 1.2, 2.5}) {
    for (const double blur : {0.15, 0.5, 1.3}) {
      for (const double s : {-1.4, -0.5, -0.1, 0.0, 0.3, 0.9}) {
        // The midpoint rule over 400 points: 1 / (24 * 400^2) of the second derivative (at most 10 here): 3e-6; the
        // narrow box's Gaussian adds 1e-6.
        const double expected = by_sums(s, std::cos(angle), std::sin(angle), blur);
        CHECK(std::abs(core::pixel_edge(s, std::cos(angle), std::sin(angle), blur).value - expected) < 5e-6);
      }
    }
  }
}

TEST_CASE("the response's derivatives are those of finite differences") {
  constexpr double kStep = 1e-5;  // rounding 1e-16 / 1e-10 and truncation 1e-10 both below 1e-5
  for (const double angle : {0.0, 0.04, 0.4, 0.8}) {
    for (const double s : {-0.8, -0.2, 0.1, 0.6}) {
      const double nu = std::cos(angle), nv = std::sin(angle), blur = 0.4;
      const auto at = [&](double where) { return core::pixel_edge(where, nu, nv, blur); };
      CHECK(std::abs((at(s + kStep).value - at(s - kStep).value) / (2.0 * kStep) - at(s).slope) < 1e-6);
      CHECK(std::abs((at(s + kStep).slope - at(s - kStep).slope) / (2.0 * kStep) - at(s).bend) < 1e-5);
      const double by_blur =
          (core::pixel_edge(s, nu, nv, blur + kStep).value - core::pixel_edge(s, nu, nv, blur - kStep).value) /
          (2.0 * kStep);
      // In the narrow branch the joint blur is sqrt(blur^2 + b^2 / 12), whose derivative is blur / joint: 1e-3 of it.
      CHECK(std::abs(by_blur - blur * at(s).bend) < 1e-3 * std::abs(by_blur) + 1e-6);
    }
  }
}

TEST_CASE("far from the edge a pixel is all dark or all bright") {
  // Differences of numbers of the size s^2 / (a b) = 50.
  CHECK(std::abs(core::pixel_edge(5.0, 0.6, 0.8, 0.3).value - 1.0) < 1e-13);
  CHECK(core::pixel_edge(-5.0, 0.6, 0.8, 0.3).value == 0.0);
}
