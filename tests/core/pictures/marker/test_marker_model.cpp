#include "core/pictures/marker/marker_model.h"

#include <cmath>
#include <random>

#include "core/pictures/image/pixel_signal.h"
#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::core;

namespace {

template <int N>
Eigen::Matrix<double, N, 1> parameters() {
  Eigen::Matrix<double, N, 1> p = Eigen::Matrix<double, N, 1>::Zero();
  p.template head<kUniformParameters>() << 20.3, 18.6, 0.16, 0.01, 0.18, std::log(0.6), 190.0, 40.0, 0.7, -0.4;
  if constexpr (N == kShadedParameters) p.template tail<3>() << 9.0, -5.0, 4.0;
  return p;
}

/// A window around a disc with values that no model gives, and not a whole number of batches.
MarkerPixels pixels() {
  MarkerPixels made;
  std::mt19937 engine(3);
  for (int v = 8; v < 29; ++v) {
    for (int u = 10; u < 31; ++u) {
      const double value = 30.0 + 1e-7 * static_cast<double>(engine() % 1000000000u);
      made.add(u, v, value, 1.0 / (1.0 + 0.01 * (u - 20) * (u - 20)));
    }
  }
  made.complete();
  return made;
}

template <int N>
void check_gradient() {
  const MarkerPixels window = pixels();
  const Eigen::Matrix<double, N, 1> p = parameters<N>();
  MarkerModel<N> model(window);
  const auto here = model.equations(p);
  REQUIRE(here);
  // The derivatives with respect to brightness, background and shading. Those with respect to the outline neglect the
  // change of its steepness.
  for (int k = kBright; k < N; ++k) {
    // Truncation is 1e-10 of the third derivative, and rounding 1e-16 of a cost of 1e6, over 1e-5.
    constexpr double kStep = 1e-5;
    Eigen::Matrix<double, N, 1> up = p, down = p;
    up[k] += kStep;
    down[k] -= kStep;
    const double by_cost = (model.equations(up)->cost - model.equations(down)->cost) / (4.0 * kStep);
    INFO("parameter " << k);
    CHECK(std::abs(by_cost - here->jtr[k]) < 1e-6 * std::sqrt(here->cost * here->jtj(k, k)));
  }
}

}  // namespace

TEST_CASE(
    "the derivatives of the marker model with respect to brightness, background and shading are those of finite "
    "differences") {
  check_gradient<kUniformParameters>();
  check_gradient<kShadedParameters>();
}

TEST_CASE("the sums over the pixels of a marker are those of the model written out pixel by pixel") {
  const MarkerPixels window = pixels();
  const auto p = parameters<kUniformParameters>();
  const Eigen::Matrix2d m{{p[kMuu], p[kMuv]}, {p[kMuv], p[kMvv]}};
  const Eigen::Vector2d g(p[kSlopeU], p[kSlopeV]);
  const double blur = std::exp(p[kLogBlur]);
  double cost = 0.0, weight = 0.0, edges = 0.0, variance = 0.0;
  for (std::size_t i = 0; i < window.size(); ++i) {
    const Eigen::Vector2d d(window.u()[i] - p[kU], window.v()[i] - p[kV]);
    const Eigen::Vector2d steep = m * m * d;
    const double rho = (m * d).norm();
    const Eigen::Vector2d normal = steep.normalized();
    const PixelEdge edge = pixel_edge(rho * (1.0 - rho) / steep.norm(), normal.x(), normal.y(), blur);
    const double behind = p[kLevel] + g.dot(d);
    const double model =
        behind + (p[kBright] - behind) * edge.value + g.dot(normal) * (blur * blur + 1.0 / 12.0) * edge.slope;
    const double w = window.weight()[i], r = model - window.value()[i];
    cost += w * r * r;
    weight += w;
    edges += w * edge.value * edge.value;
    variance += w * r * w * r * edge.value * edge.value;
  }
  // Rounding of 441 terms.
  MarkerModel<kUniformParameters> fitted(window);
  const Eigen::Matrix<double, kUniformParameters, 1> none = Eigen::Matrix<double, kUniformParameters, 1>::Zero();
  const auto sums = fitted.equations(p);
  REQUIRE(sums);
  CHECK(std::abs(sums->cost / cost - 1.0) < 1e-12);
  CHECK(std::abs(sums->weight / weight - 1.0) < 1e-12);
  CHECK(std::abs(sums->jtj(kBright, kBright) / edges - 1.0) < 1e-12);
  CHECK(std::abs(fitted.gradient_variance(p, none)(kBright, kBright) / variance - 1.0) < 1e-12);
  // The model is linear in brightness and background, so a step in these gives the residuals after it.
  auto brighter = none, behind = p;
  brighter[kBright] = 3.0;
  brighter[kLevel] = -2.0;
  behind += brighter;
  const auto stepped = fitted.gradient_variance(p, brighter);
  CHECK(std::abs(fitted.gradient_variance(behind, none)(kBright, kBright) / stepped(kBright, kBright) - 1.0) < 1e-12);
  // Derivatives that were taken elsewhere in between do not count.
  auto elsewhere = p;
  elsewhere[kU] += 1.0;
  fitted.equations(elsewhere);
  CHECK(std::abs(fitted.gradient_variance(p, none)(kBright, kBright) / variance - 1.0) < 1e-12);
}

TEST_CASE(
    "wide vectors give the sums of a marker to the last bit, and a pixel exactly at the centre counts as marker") {
  const MarkerPixels window = pixels();
  auto p = parameters<kShadedParameters>();
  p[kU] = 20.0;
  p[kV] = 18.0;
  MarkerModel<kShadedParameters> by_wide(window, Vectors::best), by_plain(window, Vectors::baseline);
  const auto wide = by_wide.equations(p), plain = by_plain.equations(p);
  REQUIRE(wide);
  REQUIRE(plain);
  CHECK(std::isfinite(wide->cost));
  CHECK(wide->cost == plain->cost);
  CHECK(wide->weight == plain->weight);
  CHECK(wide->jtj == plain->jtj);
  CHECK(wide->jtr == plain->jtr);
  const Eigen::Matrix<double, kShadedParameters, 1> step = 1e-3 * p;
  CHECK(by_wide.gradient_variance(p, step) == by_plain.gradient_variance(p, step));
}

TEST_CASE("parameters that cannot be those of a marker give no sums") {
  const MarkerPixels window = pixels();
  auto p = parameters<kUniformParameters>();
  p[kMuv] = 0.5;  // no ellipse
  CHECK_FALSE(MarkerModel<kUniformParameters>(window).equations(p));
  p = parameters<kUniformParameters>();
  p[kLogBlur] = std::log(30.0);
  CHECK_FALSE(MarkerModel<kUniformParameters>(window).equations(p));
}
