/// Tracks with a known truth for the tests of core/: closed forms of x'' = c - k v, one after the other, and noise.
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/track/track_data.h"

namespace glidelab::tests {

inline constexpr double kGravity = 9.80665;

struct Law {
  double alpha_deg = 0.0;
  double mu = 0.0;
  double k_1_s = 0.0;
  double slope() const { return kGravity * std::sin(alpha_deg * std::numbers::pi / 180.0); }
  double friction() const { return mu * kGravity * std::cos(alpha_deg * std::numbers::pi / 180.0); }
  double a0(int direction) const { return slope() - direction * friction(); }
  double v_lim() const { return a0(1) / k_1_s; }
};

/// x'' = c - k v from (t, x, v) on.
struct Phase {
  double t_s = 0.0, x_m = 0.0, v_m_s = 0.0, c_m_s2 = 0.0, k_1_s = 0.0;
  double v(double t) const {
    const double s = t - t_s;
    return k_1_s == 0.0 ? v_m_s + c_m_s2 * s : c_m_s2 / k_1_s + (v_m_s - c_m_s2 / k_1_s) * std::exp(-k_1_s * s);
  }
  double x(double t) const {
    const double s = t - t_s;
    if (k_1_s == 0.0) return x_m + v_m_s * s + 0.5 * c_m_s2 * s * s;
    const double end = c_m_s2 / k_1_s;
    return x_m + end * s - (v_m_s - end) * std::expm1(-k_1_s * s) / k_1_s;
  }
};

/// A motion as a sequence of phases; x(t) is that of the last phase begun.
class SimulatedMotion {
 public:
  explicit SimulatedMotion(double x_m = 0.0) { phases_.push_back({0.0, x_m, 0.0, 0.0, 0.0}); }

  double now() const { return phases_.back().t_s; }
  double x(double t) const { return at(t).x(t); }
  double v(double t) const { return at(t).v(t); }

  SimulatedMotion& rest(double duration_s) { return add({now(), x(now()), 0.0, 0.0, 0.0}, now() + duration_s); }
  SimulatedMotion& push(double duration_s, double a_m_s2) {
    return add({now(), x(now()), v(now()), a_m_s2, 0.0}, now() + duration_s);
  }
  SimulatedMotion& kick(double v_m_s) { return add({now(), x(now()), v_m_s, 0.0, 0.0}, now()); }

  /// Equation (8) with reversals and sticking until `until_s`; bounces with `restitution` off a stop at x = `stop_m`.
  SimulatedMotion& slide(const Law& law, double until_s, double stop_m = std::numeric_limits<double>::infinity(),
                         double restitution = 0.0) {
    while (now() < until_s) {
      const double from = now(), x0 = x(from), v0 = v(from);
      int direction = v0 > 0.0 ? 1 : v0 < 0.0 ? -1 : 0;
      if (direction == 0) direction = law.slope() > law.friction() ? 1 : law.slope() < -law.friction() ? -1 : 0;
      if (direction == 0) return rest(until_s - from);
      Phase phase{from, x0, v0, law.a0(direction), law.k_1_s};
      const double start = from + 1e-9;  // off the event that began the phase
      const double turn = first_root([&](double t) { return direction * phase.v(t); }, start, until_s);
      const double hit = first_root([&](double t) { return stop_m - phase.x(t); }, start, until_s);
      const double end = std::min({turn, hit, until_s});
      add(phase, end);
      if (end == hit && hit < until_s) {
        const double rebound = restitution * phase.v(hit);
        if (rebound < 1e-3) return rest(until_s - hit);  // it leans on the stop
        kick(-rebound);
      }
      if (end == turn && turn < until_s) kick(0.0);
    }
    return *this;
  }

 private:
  const Phase& at(double t) const {
    std::size_t i = phases_.size() - 1;
    while (i > 0 && phases_[i].t_s > t) --i;
    return phases_[i];
  }

  /// The phase holds until `end_s`, where the next one begins with its x and v.
  SimulatedMotion& add(const Phase& phase, double end_s) {
    phases_.back() = phase;
    phases_.push_back({end_s, phase.x(end_s), phase.v(end_s), 0.0, 0.0});
    return *this;
  }

  /// Where f falls below zero, found in steps of 1 ms and halved to 1e-13 s; infinite where it does not.
  static double first_root(const std::function<double(double)>& f, double from, double to) {
    for (double a = from; a < to; a += 1e-3) {
      double low = a, high = std::min(a + 1e-3, to);
      if (f(high) > 0.0) continue;
      while (high - low > 1e-13) {
        const double middle = 0.5 * (low + high);
        if (middle == low || middle == high) break;
        (f(middle) > 0.0 ? low : high) = middle;
      }
      return high;
    }
    return std::numeric_limits<double>::infinity();
  }

  std::vector<Phase> phases_;
};

struct Filming {
  double frame_rate_hz = 200.0;
  double duration_s = 1.7;
  double noise_m = 1e-5;
  unsigned seed = 1;
  double rounding_m = 0.0;
};

inline core::TrackData film(const SimulatedMotion& motion, const Filming& how) {
  core::TrackData track;
  track.frame_rate_hz = how.frame_rate_hz;
  std::mt19937_64 random(how.seed);
  std::normal_distribution<double> noise(0.0, 1.0);
  const auto frames = static_cast<std::size_t>(how.duration_s * how.frame_rate_hz) + 1;
  for (std::size_t frame = 0; frame < frames; ++frame) {
    const double t = static_cast<double>(frame) / how.frame_rate_hz;
    double x = motion.x(t) + how.noise_m * noise(random);
    if (how.rounding_m > 0.0) x = how.rounding_m * std::round(x / how.rounding_m);
    track.t_s.push_back(t);
    track.x_m.push_back(x);
    track.frame.push_back(frame);
  }
  track.frame_t_s = track.t_s;
  return track;
}

inline core::ClipSetup clip_setup(core::Launched launched, double incline_deg, double mass_kg = 0.335) {
  core::ClipSetup setup;
  setup.name = launched == core::Launched::up ? "up" : launched == core::Launched::down ? "down" : "released";
  setup.mass_kg = mass_kg;
  setup.incline_rad = incline_deg * std::numbers::pi / 180.0;
  setup.launched = launched;
  setup.group = "all";
  return setup;
}

inline SimulatedMotion launch(const Law& law, double v_m_s, double duration_s) {
  return SimulatedMotion().kick(v_m_s).slide(law, duration_s);
}

}  // namespace glidelab::tests
