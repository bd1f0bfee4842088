#include "diagnose/model/track_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr auto kShake = diagnose::slot_of(diagnose::ids::base_vibration, 0);
constexpr auto kHz = diagnose::slot_of(diagnose::ids::base_vibration, 1);
constexpr auto kPhase = diagnose::slot_of(diagnose::ids::base_vibration, 2);

/// Frames of 1.5 s, among them pairs that lie close together, and a gap.
std::vector<double> times(double rate_hz) {
  std::vector<double> t;
  for (int i = 0; i < 1.5 * rate_hz; ++i) {
    if (i > 20 && i < 24) continue;
    t.push_back(i / rate_hz);
    if (i % 7 == 3) t.push_back((i + 0.1) / rate_hz);
  }
  return t;
}

diagnose::TrackModel glider() {
  diagnose::TrackModel model;
  model.mass_kg = 0.4;
  model.k_n_s_m = 0.9;
  model.alpha_rad = 0.07;
  return model;
}

}  // namespace

TEST_CASE("a glider that runs up and comes back is where the closed form has it, whatever the frames") {
  diagnose::TrackModel model = glider();
  model.mu = 0.006;
  model.x0_m = 0.5;
  model.v0_m_s = -0.6;
  const double k = model.k_n_s_m / model.mass_kg, g = model.gravity_m_s2;
  const double drive = g * std::sin(model.alpha_rad), friction = model.mu * g * std::cos(model.alpha_rad);
  const double up = (drive + friction) / k, down = (drive - friction) / k;  // speeds that it tends to
  const double turn_s = std::log((up - model.v0_m_s) / up) / k;
  const double turn_m = model.x0_m + up * turn_s + (model.v0_m_s - up) / k * (1.0 - std::exp(-k * turn_s));
  REQUIRE(turn_s < 1.0);
  for (const double rate : {50.0, 120.0, 240.0, 1000.0}) {
    const std::vector<double> t = times(rate);
    const diagnose::Moved moved = diagnose::move(model, t);
    for (std::size_t i = 0; i < t.size(); ++i) {
      INFO(rate << " frames a second, " << t[i] << " s");
      const double since = t[i] - turn_s, to = since < 0.0 ? up : down;
      const double from = since < 0.0 ? model.v0_m_s - up : -down, s = since < 0.0 ? t[i] : since;
      CHECK(moved.v_m_s[i] == Approx(to + from * std::exp(-k * s)).margin(2e-8));
      const double x = (since < 0.0 ? model.x0_m : turn_m) + to * s + from / k * (1.0 - std::exp(-k * s));
      CHECK(moved.x_m[i] == Approx(x).margin(2e-8));
    }
  }
}

namespace {

/// |x - expected|² in units of the noise.
double off2(const std::vector<double>& x_m, const std::vector<double>& expected_m, double noise_m) {
  double sum = 0.0;
  for (std::size_t i = 0; i < x_m.size(); ++i) sum += std::pow((x_m[i] - expected_m[i]) / noise_m, 2);
  return sum;
}

}  // namespace

// Errors d of the modelled positions in units of the noise change a log likelihood by r'd + d'd/2, and r'd ~ N(0, d'd)
// for residuals r of unit variance: with |d| below 0.01 the standard deviation of the change is below 0.01.
TEST_CASE("the steps of the integration change no log evidence by 0.01, for carts and for falls, stiff ones too") {
  constexpr double kMost2 = 0.01 * 0.01;
  for (const double k : {0.0, 0.3, 3.0, 30.0, 300.0}) {  // K/m in 1/s
    for (const double rate : {25.0, 60.0, 240.0}) {
      CAPTURE(k, rate);
      diagnose::TrackModel model;
      model.mass_kg = 0.01;
      model.k_n_s_m = k * model.mass_kg;
      model.alpha_rad = 0.5 * std::numbers::pi;
      std::vector<double> t, x;
      for (int i = 0; i < 60; ++i) {
        t.push_back(i / rate);
        const double g = model.gravity_m_s2;
        x.push_back(k > 0.0 ? g / k * (t.back() + std::expm1(-k * t.back()) / k) : 0.5 * g * t.back() * t.back());
      }
      CHECK(off2(diagnose::move(model, t).x_m, x, 1e-4) < kMost2);
    }
  }
  for (const double c : {1e-3, 3e-2, 1.0}) {  // c/m in 1/m, from rest: v = u tanh(g t/u)
    for (const double rate : {25.0, 60.0, 240.0}) {
      CAPTURE(c, rate);
      diagnose::TrackModel model;
      model.mass_kg = 0.01;
      model.alpha_rad = 0.5 * std::numbers::pi;
      model.effects[diagnose::slot_of(diagnose::ids::quadratic_drag)] = c * model.mass_kg;
      std::vector<double> t, x;
      for (int i = 0; i < 60; ++i) {
        t.push_back(i / rate);
        x.push_back(std::log(std::cosh(std::sqrt(model.gravity_m_s2 * c) * t.back())) / c);
      }
      CHECK(off2(diagnose::move(model, t).x_m, x, 1e-4) < kMost2);
    }
  }
  for (const double rate : {30.0, 100.0, 240.0}) {
    CAPTURE(rate);
    diagnose::TrackModel model = glider();  // downhill
    model.mu = 0.006;
    model.v0_m_s = 0.3;
    const double k = model.k_n_s_m / model.mass_kg;
    const double u = model.gravity_m_s2 * (std::sin(model.alpha_rad) - model.mu * std::cos(model.alpha_rad)) / k;
    std::vector<double> t, x;
    for (int i = 0; i < 200; ++i) {
      t.push_back(i / rate);
      x.push_back(u * t.back() - (model.v0_m_s - u) * std::expm1(-k * t.back()) / k);
    }
    CHECK(off2(diagnose::move(model, t).x_m, x, 3e-5) < kMost2);
  }
}

TEST_CASE("a drag is followed as long as any position can show it") {
  diagnose::TrackModel model = glider();
  model.v0_m_s = 0.6;
  std::vector<double> t;
  for (int i = 0; i < 1000; ++i) t.push_back(0.04 * i);
  const diagnose::UnnamedForce nothing = [](double, double, double) { return 0.0; };
  model.unnamed = &nothing;                     // in steps
  model.k_n_s_m = 16.0 / 0.04 * model.mass_kg;  // exp(-16) = 1e-7 of the first speed is left in the second frame
  CHECK(std::isfinite(diagnose::move(model, t).x_m.back()));
  model.k_n_s_m = 18.0 / 0.04 * model.mass_kg;
  CHECK_FALSE(std::isfinite(diagnose::move(model, t).x_m.back()));
}

TEST_CASE("a closed form is exact however strong the drag: at the terminal velocity in the second frame") {
  diagnose::TrackModel model = glider();
  model.mu = 0.0;
  model.v0_m_s = 0.6;
  std::vector<double> t;
  for (int i = 0; i < 200; ++i) t.push_back(0.05 * i);
  for (const double rate : {8.0, 18.0, 400.0, 1635.0, 1e4}) {
    CAPTURE(rate);
    model.k_n_s_m = rate * model.mass_kg;
    const double u = model.gravity_m_s2 * std::sin(model.alpha_rad) / rate, part = (model.v0_m_s - u) / rate;
    const diagnose::Moved moved = diagnose::move(model, t);
    for (std::size_t i = 0; i < t.size(); i += 7) {
      CHECK(moved.x_m[i] ==
            Approx(model.x0_m + u * t[i] - part * std::expm1(-rate * t[i])).epsilon(1e-12).margin(1e-14));
    }
    CHECK(moved.v_m_s.back() == Approx(u).epsilon(1e-10));
  }
  // Launched uphill it turns within the first frame, where friction changes its sign.
  model.mu = 0.01;
  model.v0_m_s = -0.6;
  model.k_n_s_m = 1635.0 * model.mass_kg;
  const diagnose::Moved moved = diagnose::move(model, t);
  const double slope = std::sin(model.alpha_rad) - model.mu * std::cos(model.alpha_rad);
  CHECK(moved.v_m_s.back() == Approx(model.gravity_m_s2 * slope / 1635.0).epsilon(1e-10));
  CHECK((moved.x_m[150] - moved.x_m[50]) / (t[150] - t[50]) == Approx(moved.v_m_s.back()).epsilon(1e-10));
}

TEST_CASE("a shaken glider is where the closed form has it, whatever the frames") {
  diagnose::TrackModel model = glider();
  model.v0_m_s = 0.4;
  model.effects[kShake] = 0.3;
  model.effects[kPhase] = 0.8;
  for (const double hz : {3.0, 11.0}) {
    model.effects[kHz] = hz;
    const double k = model.k_n_s_m / model.mass_kg, omega = 2.0 * std::numbers::pi * hz;
    const double drive = model.gravity_m_s2 * std::sin(model.alpha_rad);
    const double part = model.effects[kShake] / (k * k + omega * omega);
    const auto speed = [&](double t) {  // the forced motion
      const double phase = omega * t + model.effects[kPhase];
      return drive / k + part * (k * std::sin(phase) - omega * std::cos(phase));
    };
    const auto place = [&](double t) {
      const double phase = omega * t + model.effects[kPhase];
      return drive / k * t - part * (k / omega * std::cos(phase) + std::sin(phase));
    };
    const double own = model.v0_m_s - speed(0.0);  // and what dies away
    for (const double rate : {50.0, 120.0, 240.0, 1000.0}) {
      const std::vector<double> t = times(rate);
      const diagnose::Moved moved = diagnose::move(model, t);
      for (std::size_t i = 0; i < t.size(); ++i) {
        INFO(hz << " Hz, " << rate << " frames a second, " << t[i] << " s");
        const double gone = std::exp(-k * t[i]);
        CHECK(moved.v_m_s[i] == Approx(speed(t[i]) + own * gone).margin(1e-5));  // of some mm/s
        CHECK(moved.x_m[i] == Approx(place(t[i]) - place(0.0) + own / k * (1.0 - gone)).margin(1e-7));
      }
    }
  }
}

TEST_CASE("a drag as no fit should ask for is not followed, where it would take for ever") {
  diagnose::TrackModel model = glider();
  model.v0_m_s = 0.6;
  for (const double k : {1e6, 1e12, 1e300}) {  // stopped within a microsecond, in 1e5 to 1e300 steps of k h = 0.3
    model.k_n_s_m = k;
    const diagnose::Moved moved = diagnose::move(model, times(100.0));
    REQUIRE(moved.x_m.size() == times(100.0).size());
    CHECK_FALSE(std::isfinite(moved.x_m.back()));
  }
  model.k_n_s_m = 400.0;  // a thousand a second: three steps to a millisecond, and at rest but for the slope
  const diagnose::Moved slow = diagnose::move(model, times(100.0));
  const double v_lim = model.mass_kg * model.gravity_m_s2 * std::sin(model.alpha_rad) / model.k_n_s_m;
  CHECK(std::abs(slow.v_m_s.back() - v_lim) < 1e-9);
}

TEST_CASE("frames that are far apart cost a few steps each, and the motion stays exact") {
  diagnose::TrackModel model = glider();
  model.mu = 0.0;
  model.v0_m_s = 0.1;
  model.k_n_s_m = 1e-3 * model.mass_kg;  // dies away over a thousand seconds
  std::vector<double> t;
  for (int i = 0; i < 100; ++i) t.push_back(20.0 * i);
  int evaluations = 0;
  const diagnose::UnnamedForce counts = [&](double, double, double) { return ++evaluations, 0.0; };
  model.unnamed = &counts;
  const diagnose::Moved moved = diagnose::move(model, t);
  const double k = 1e-3, a = model.gravity_m_s2 * std::sin(model.alpha_rad);
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double gone = std::exp(-k * t[i]);
    CHECK(moved.v_m_s[i] == Approx(a / k + (model.v0_m_s - a / k) * gone).epsilon(1e-9));
  }
  CHECK(evaluations < 100 * 8 * 4 + 100);  // 8 steps of a frame, each of four stages
}

TEST_CASE("no motion takes more work than its positions are worth, however it turns or decays") {
  // Forces are asked for 4 times in each of 2000 steps for each time and, in one interval that was begun, at
  // most 500 parts (the limit of 2500 steps and 60 a time leaves fewer), each of 20 turns with 7 steps, which ask up to
  // 45 times besides.
  const std::size_t most = 5 * (2000 * times(100.0).size() + 500 * 20 * (7 + 45));
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> decades(-3.0, 4.0), speed(-2.0, 2.0);
  std::size_t asked = 0, largest = 0;
  const diagnose::UnnamedForce nothing = [&](double, double, double) {
    ++asked;
    return 0.0;
  };
  for (int i = 0; i < 300; ++i) {
    diagnose::TrackModel model = glider();
    model.unnamed = &nothing;
    model.k_n_s_m = std::pow(10.0, decades(random)) * (i % 3 == 0 ? -1.0 : 1.0);
    model.mu = std::pow(10.0, decades(random)) * (i % 2 == 0 ? -1.0 : 1.0);  // what pushes along turns at once
    model.alpha_rad = 0.3 * speed(random);
    model.v0_m_s = speed(random);
    asked = 0;
    const diagnose::Moved moved = diagnose::move(model, times(100.0));
    CAPTURE(model.k_n_s_m, model.mu, model.v0_m_s);
    CHECK(moved.x_m.size() == times(100.0).size());
    CHECK(asked <= most);
    largest = std::max(largest, asked);
  }
  CHECK(largest > times(100.0).size());  // the counter counts
}
