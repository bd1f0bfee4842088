// Measured tracks that no one here made.
#include <cmath>
#include <map>

#include "tests/catch.h"
#include "tests/core/real_data.h"

using namespace glidelab;
using tests::analyze_real;

namespace {

double newtons(const core::Quantity& mu, double mass_kg) {
  return mu.estimate->value * mass_kg * 9.80665;
}

}  // namespace

TEST_CASE("the linear axis has the published viscous and Coulomb friction within 5 %") {
  const auto results = analyze_real("linear-axis");
  if (!results) return;
  REQUIRE(results->configurations.size() == 1);
  const core::ConfigurationResult& axis = results->configurations[0];
  const double mass_kg = 95.109;
  REQUIRE(axis.k_over_m_1_s.estimate);
  REQUIRE(axis.mu.estimate);
  // Janot, Gautier, Brunot: 203.50 N s/m and 20.394 N, for one viscous coefficient of both directions. They differ here
  // (167 and 240 by an independent fit), so that the mean's standard deviation is of that size.
  CHECK(axis.k_over_m_1_s.estimate->value * mass_kg == Approx(203.50).epsilon(0.05));
  CHECK(newtons(axis.mu, mass_kg) == Approx(20.394).epsilon(0.05));
  REQUIRE(axis.lines.size() == 2);
  CHECK(axis.lines[0].k_over_m_1_s.value * mass_kg == Approx(240.0).epsilon(0.05));
  CHECK(axis.lines[1].k_over_m_1_s.value * mass_kg == Approx(167.0).epsilon(0.05));
  CHECK(axis.k_over_m_1_s.estimate->sd * mass_kg > 25.0);
  CHECK_FALSE(axis.v_lim_m_s.estimate);
}

TEST_CASE("carts that bounce at the foot of an incline: inclination and friction agree with an independent fit") {
  const auto results = analyze_real("incline-cart");
  if (!results) return;
  // Parabolas fitted to seven bounces a run (the README of the data): 1.99 to 2.08 degrees on all runs, and a
  // friction deceleration of 0.0265, 0.100 and 0.038 m/s^2. Two lines a(v) of 1 cm positions are far less certain; what
  // they state must agree (three standard deviations), and be worth stating.
  const std::map<std::string, double> friction{{"good", 0.0265}, {"plunger", 0.100}, {"magnetic", 0.038}};
  for (const core::ConfigurationResult& cart : results->configurations) {
    INFO(cart.group);
    if (cart.group == "at-rest") {
      CHECK_FALSE(cart.k_over_m_1_s.estimate);
      CHECK_FALSE(cart.mu.estimate);
      CHECK_FALSE(cart.alpha_deg.estimate);
      CHECK(cart.mu.why);
      continue;
    }
    REQUIRE(cart.alpha_deg.estimate);
    REQUIRE(cart.mu.estimate);
    INFO("alpha " << cart.alpha_deg.estimate->value << " +- " << cart.alpha_deg.estimate->sd << ", mu "
                  << cart.mu.estimate->value << " +- " << cart.mu.estimate->sd);
    CHECK(std::abs(cart.alpha_deg.estimate->value - 2.035) < 3.0 * cart.alpha_deg.estimate->sd + 0.045);
    CHECK(std::abs(cart.mu.estimate->value - friction.at(cart.group) / 9.80665) < 3.0 * cart.mu.estimate->sd);
    CHECK(cart.alpha_deg.estimate->sd < 0.5);
  }
  for (const core::ClipResult& clip : results->clips) {
    if (clip.name == "at-rest") {
      CHECK(clip.segments.empty());
      continue;
    }
    INFO(clip.name);
    // Rounding to 1 cm is 2.9 mm; the independent fit leaves 3 to 5 mm.
    CHECK(clip.position_noise_m > 0.0028);
    CHECK(clip.position_noise_m < 0.005);
    CHECK(clip.stretches.front().direction == 1);  // released at the upper end
    CHECK(clip.stretches.size() >= 3);
  }
}

TEST_CASE("the cart on a rail: its friction is what an independent fit saw, a newton or two") {
  const auto results = analyze_real("rail-cart");
  if (!results) return;
  REQUIRE(results->clips.size() == 10);
  REQUIRE(results->configurations.size() == 1);
  const core::ConfigurationResult& cart = results->configurations[0];
  for (const core::ClipResult& clip : results->clips) {
    INFO(clip.name);
    CHECK(clip.segments.size() == 2);
    CHECK(clip.stretches.size() > 20);  // to and fro at some 2.4 Hz for 20 s
    // The encoder's step is 88 um: 25 um, and more where its error lasts from one frame to the next.
    CHECK(clip.position_noise_m > 2e-5);
    CHECK(clip.position_noise_m < 5e-4);
  }
  // Seen: 0.3 to 2.3 N one way, 2.1 to 4.3 N the other, constant and viscous part in one. At the mean speed of 0.15
  // m/s:
  REQUIRE(cart.lines.size() == 2);
  for (const core::LineFit& line : cart.lines) {
    const double friction = 6.28 * (line.k_over_m_1_s.value * 0.15 - line.direction * line.a0_m_s2.value);
    INFO("direction " << line.direction << " friction " << friction << " N");
    CHECK(friction > 0.3);
    CHECK(friction < 4.3);
  }
}
