/// A dry friction mu (1 + s(x)) that changes along the track,
///
///     s(x) = sum_j b_j (B_j(x) - mean of B_j),   B_j(x) = exp(-(u - j)²/2),   u = 5 (x - x_low)/(x_high - x_low),
///
/// j = 0 to 5. x_low to x_high is the range of all positions, over which s has mean 0. A normal prior of standard
/// deviation 1 holds each b_j near 0.
#include "diagnose/effects/effect.h"

#include <array>
#include <cmath>
#include <numbers>

namespace glidelab::diagnose::effects {
namespace {

constexpr std::size_t kBumps = 6;

/// The mean of each B_j over the range, u from 0 to 5.
std::array<double, kBumps> means_of_bumps() {
  std::array<double, kBumps> means;
  const auto last = static_cast<double>(kBumps - 1);
  for (std::size_t j = 0; j < kBumps; ++j) {
    const auto middle = static_cast<double>(j);
    means[j] = std::sqrt(0.5 * std::numbers::pi) / last *
               (std::erf((last - middle) / std::numbers::sqrt2) + std::erf(middle / std::numbers::sqrt2));
  }
  return means;
}

void friction_along(const double* p, const GliderConstants& glider, const GliderState& at, DryFriction& of) {
  static const std::array<double, kBumps> means = means_of_bumps();
  const double u = static_cast<double>(kBumps - 1) * (at.x - glider.x_low_m) / (glider.x_high_m - glider.x_low_m);
  constexpr double kFar = 30.0;  // in units of u: beyond, every B_j is negligible
  const bool near = std::abs(u) < kFar;
  // exp(-(u - j)²/2) = exp(-u²/2) exp(u)^j exp(-j²/2)
  static const std::array<double, kBumps> own = [] {
    std::array<double, kBumps> factors;
    for (std::size_t j = 0; j < kBumps; ++j) factors[j] = std::exp(-0.5 * static_cast<double>(j * j));
    return factors;
  }();
  double more = 0.0, power = near ? std::exp(-0.5 * u * u) : 0.0;
  const double ratio = near ? std::exp(u) : 0.0;
  for (std::size_t j = 0; j < kBumps; ++j) {
    more += p[j] * (power * own[j] - means[j]);
    power *= ratio;
  }
  of.mu *= 1.0 + more;
}

EffectParameter bump(std::string_view key) {
  return {.key = key,
          .absent = 0.0,
          .low = -20.0,
          .high = 20.0,
          .step = 1e-4,
          .shown_as = ShownAs::along_track,
          .held_sd = 1.0};
}

}  // namespace

EffectInfo place_friction() {
  return {
      .id = ids::place_friction,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a dry friction that changes along the track",
      .name = "friction that varies along x",
      .meaning = "µ becomes µ (1 + s(x)); sd: how far s is from 0",
      .search = Search::spread,
      .both_signs = true,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {bump("sd"), bump({}), bump({}), bump({}), bump({}), bump({})},
      .law = {.sizes = kBumps, .friction = friction_along, .passing = true},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::none("no force in a scenario depends on position"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
