#include "diagnose/model/steady_flow.h"

#include <cmath>
#include <vector>

#include "diagnose/model/track_model.h"
#include "tests/catch.h"

using namespace glidelab;

// Rounding of a position or speed of about 1 is 1e-16; some ten operations, and the oracle's own differences divided by
// b t = 0.01 three times in long double (1e-19 / 1e-6), stay below 1e-14.
TEST_CASE("a steady flow is the exponential solution, and two steps are one") {
  const diagnose::PlaceAndSpeed from{0.3, -0.7};
  const double a = 0.9, c = -2.5;
  for (const double b : {-3.0, -0.1, 0.1, 1.0, 3.0}) {
    const diagnose::SteadyFlow flow(from, a, c, b);
    for (const double t : {0.1, 0.05, 0.099}) {
      CAPTURE(b, t);
      // v = v_end + (c/b) t + (v0 - v_end) exp(-bt), with v_end = v0 + a/b - c/b²; x is its integral.
      using Long = long double;
      const Long lb = b, lt = t, end = from.v + a / lb - c / (lb * lb), rest = from.v - end, decay = std::exp(-lb * lt);
      const Long v = end + c / lb * lt + rest * decay;
      const Long x = from.x + end * lt + 0.5L * c / lb * lt * lt + rest * (1.0L - decay) / lb;
      const diagnose::PlaceAndSpeed there = flow.at(t);
      CHECK(there.x == Approx(static_cast<double>(x)).margin(1e-14).epsilon(0.0));
      CHECK(there.v == Approx(static_cast<double>(v)).margin(1e-14).epsilon(0.0));
      const diagnose::PlaceAndSpeed half = flow.at(0.4 * t);
      const double a_half = a + c * 0.4 * t - b * (half.v - from.v);
      const diagnose::PlaceAndSpeed again = diagnose::SteadyFlow(half, a_half, c, b).at(0.6 * t);
      CHECK(again.x == Approx(there.x).margin(1e-14).epsilon(0.0));
      CHECK(again.v == Approx(there.v).margin(1e-14).epsilon(0.0));
    }
  }
  for (const double b : {-20.0, 2.9, 3.1, 20.0, 800.0}) {  // on both sides of where the series ends, and far beyond
    using Long = long double;
    const Long lb = b, lt = 0.1L, end = from.v + a / lb - c / (lb * lb), rest = from.v - end;
    const Long x = from.x + end * lt + 0.5L * c / lb * lt * lt - rest * std::expm1(-lb * lt) / lb;
    const diagnose::PlaceAndSpeed there = diagnose::SteadyFlow(from, a, c, b).far(0.1);
    CHECK(there.x == Approx(static_cast<double>(x)).epsilon(1e-13));
    CHECK(there.v == Approx(static_cast<double>(end + c / lb * lt + rest * std::exp(-lb * lt))).epsilon(1e-13));
  }
  const diagnose::PlaceAndSpeed free = diagnose::SteadyFlow(from, a, c, 0.0).at(2.0);
  CHECK(free.x == Approx(from.x + 2.0 * from.v + 2.0 * a + 8.0 / 6.0 * c).margin(1e-14));
  CHECK(free.v == Approx(from.v + 2.0 * a + 2.0 * c).margin(1e-14));
}

namespace {

/// Uphill and back within 1.5 s, at 200 frames a second.
diagnose::TrackModel up_and_back() {
  diagnose::TrackModel model;
  model.mass_kg = 0.4;
  model.k_n_s_m = 0.9;
  model.mu = 0.006;
  model.alpha_rad = 0.07;
  model.x_low_m = -0.5;
  model.x_high_m = 0.5;
  model.clip = 3;
  model.v0_m_s = -0.6;
  return model;
}

std::vector<double> frames() {
  std::vector<double> t;
  for (int i = 0; i < 300; ++i) t.push_back(0.005 * i);
  return t;
}

}  // namespace

// The integrator in steps, which a force of size 0 without a name switches on, is right to 2e-8 (test_track_model.cpp).
TEST_CASE("every effect that counts as steady moves the glider as the integrator in steps does") {
  const diagnose::UnnamedForce nothing = [](double, double, double) { return 0.0; };
  const std::vector<double> t = frames();
  std::size_t steady = 0;
  for (std::size_t e = 0; e < diagnose::effect_list().size(); ++e) {
    const diagnose::EffectInfo& info = diagnose::effect_list()[e];
    if (!info.law.steady) continue;
    INFO(info.id);
    ++steady;
    diagnose::TrackModel model = up_and_back();
    for (const diagnose::EffectParameter& parameter : info.parameters) model.effects[parameter.slot] = 0.1;
    CHECK(diagnose::shifts_as_a_whole(model));
    const diagnose::Moved moved = diagnose::move(model, t);
    diagnose::TrackModel shifted = model;
    shifted.x0_m += 0.25;
    const diagnose::Moved beside = diagnose::move(shifted, t);
    model.unnamed = &nothing;
    CHECK_FALSE(diagnose::shifts_as_a_whole(model));
    // Acts, but moves nothing: the forces are then evaluated at each step and not held.
    model.effects[diagnose::slot_of(diagnose::ids::quadratic_drag)] = 1e-300;
    const diagnose::Moved in_steps = diagnose::move(model, t);
    double off_m = 0.0, off_m_s = 0.0, off_shift_m = 0.0;
    for (std::size_t i = 0; i < t.size(); ++i) {
      off_m = std::max(off_m, std::abs(moved.x_m[i] - in_steps.x_m[i]));
      off_m_s = std::max(off_m_s, std::abs(moved.v_m_s[i] - in_steps.v_m_s[i]));
      off_shift_m = std::max(off_shift_m, std::abs(beside.x_m[i] - moved.x_m[i] - 0.25));
    }
    CHECK(off_m < 2e-8);
    CHECK(off_m_s < 2e-8);
    CHECK(off_shift_m < 1e-13);
  }
  CHECK(steady == 8);
}

TEST_CASE("what depends on place does not shift as a whole") {
  for (const auto& id : {diagnose::ids::place_friction, diagnose::ids::tether, diagnose::ids::lens_distortion}) {
    diagnose::TrackModel model = up_and_back();
    CHECK(diagnose::shifts_as_a_whole(model));
    model.effects[diagnose::slot_of(id)] = 0.1;
    CHECK_FALSE(diagnose::shifts_as_a_whole(model));
  }
}
