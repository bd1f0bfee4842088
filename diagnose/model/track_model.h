/// The motion of a glider with any effects, as the measured x(t) shows it.
///
///     m dv/dt = m g sin(alpha) - K v - sign(v) mu m g cos(alpha) + a known force + an unnamed one
///
/// sliding, changed by the laws of the effects that act (diagnose/effects/effect.h). At v = 0 the glider stays at rest
/// as long as static friction, up to its limit in either direction, can hold it.
///
/// Where nothing acts that depends on place, time or the size of the speed other than the drag K v and the known force,
/// the motion from turn to turn is a closed form (steady_flow.h).
///
/// Otherwise the integrator is fourth-order Runge-Kutta, with equal steps within each frame interval or one step over
/// several frames, and a quintic polynomial between (steps of at most 12.6 ms or an eighth of the frame interval; k h
/// at most 0.3, omega h of a vibration at most 0.9). It stops exactly at v = 0 and at t_r, so that the motion is a
/// smooth function of all parameters and its derivatives follow by finite differences. SI units.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/model/steady_flow.h"

namespace glidelab::diagnose {

/// Force in N at (x, v, t); t counts from the clip's first frame.
using UnnamedForce = std::function<double(double x_m, double v_m_s, double t_s)>;

/// A force along x that was recorded with the positions, linear between its samples, whose times increase. Empty: none.
struct KnownForce {
  std::vector<double> t_s;  ///< from the clip's first frame
  std::vector<double> force_n;
};

/// Everything that determines one motion.
struct TrackModel {
  double mass_kg = 0.0;
  double gravity_m_s2 = 9.80665;
  double k_n_s_m = 0.0;
  double mu = 0.0;
  double alpha_rad = 0.0;
  double x_mid_m = 0.0;                  ///< of the set-up
  double x_mid_all_m = 0.0;              ///< of all set-ups
  double x_low_m = 0.0, x_high_m = 0.0;  ///< range of the positions of all set-ups
  std::size_t clip = 0;                  ///< index of the clip
  double x0_m = 0.0;                     ///< at the first of the requested times
  double v0_m_s = 0.0;
  EffectValues effects;
  const KnownForce* known = nullptr;
  const UnnamedForce* unnamed = nullptr;
  std::span<const double> row_px;  ///< row of the marker at each of these times; empty: not filmed
};

struct Moved {
  std::vector<double> x_m;    ///< as measured: with the effects of camera and restitution
  std::vector<double> v_m_s;  ///< true speed
};

/// The motion at the given times (increasing, from the clip's first frame), each later by its entry in `late_s` unless
/// that is empty. The result is not finite if the motion runs away, or if it would need more work, turns included, than
/// 2000 steps a frame (fewer than 100 frames count as 100) or, unless it is a closed form, more than 2500 steps plus 54
/// a frame (200 frames in 2 s: K/m above 2000 1/s).
Moved move(const TrackModel& model, std::span<const double> times_s, std::span<const double> late_s = {});

/// Whether a shift of the start shifts all measured positions by as much: nothing that acts depends on place.
bool shifts_as_a_whole(const TrackModel& model);

/// K (N s/m) and mu of the configuration that the model belongs to: with the effects that give each configuration a
/// drag or a friction of its own, and evaluated at the middle of the set-up's positions if the drag changes along the
/// track.
struct OwnLaw {
  double k_n_s_m = 0.0, mu = 0.0;
};
OwnLaw own_law(const TrackModel& model);

/// Building blocks of the track model's integrator: one step that spans several frames, and a sine wave at equally
/// spaced instants without a call of sin for each. They are in a header because they are the innermost loop of all
/// fits. SI units.

/// The quintic polynomial over one step, through position, speed and acceleration at both ends.
class Stride {
 public:
  Stride(const PlaceAndSpeed& from, double a_from, const PlaceAndSpeed& to, double a_to, double length_s)
      : from_(from),
        to_(to),
        v_(from.v * length_s),
        a_(0.5 * a_from * length_s * length_s),
        by_length_(1.0 / length_s) {
    const double rest = to.x - from.x - v_ - a_, slope = to.v * length_s - v_ - 2.0 * a_;
    const double bend = 0.5 * (a_to - a_from) * length_s * length_s;
    c3_ = 10.0 * rest - 4.0 * slope + bend;
    c4_ = -15.0 * rest + 7.0 * slope - 2.0 * bend;
    c5_ = 6.0 * rest - 3.0 * slope + bend;
  }

  PlaceAndSpeed at(double since_s) const {
    const double u = since_s * by_length_;
    return {from_.x + u * (v_ + u * (a_ + u * (c3_ + u * (c4_ + u * c5_)))),
            (v_ + u * (2.0 * a_ + u * (3.0 * c3_ + u * (4.0 * c4_ + u * 5.0 * c5_)))) * by_length_};
  }

  const PlaceAndSpeed& to() const { return to_; }

 private:
  PlaceAndSpeed from_, to_;
  double v_, a_, by_length_;  // coefficients of the position's powers of the elapsed fraction
  double c3_ = 0.0, c4_ = 0.0, c5_ = 0.0;
};

/// sin(omega t + phase) at equally spaced instants, without a call of sin for each.
class SineSteps {
 public:
  SineSteps(double hz, double phase) : omega_(2.0 * std::numbers::pi * hz), phase_(phase) {}

  /// At t, t + h/2 and t + h.
  std::array<double, 3> over(double t, double h) {
    if (std::abs(t - t_) > kRounding_s) {
      sin_ = std::sin(omega_ * t + phase_);
      cos_ = std::cos(omega_ * t + phase_);
    }
    if (std::abs(h - h_) > kRounding_s) {
      half_sin_ = std::sin(0.5 * omega_ * h);
      half_cos_ = std::cos(0.5 * omega_ * h);
      h_ = h;
    }
    std::array<double, 3> values{sin_, 0.0, 0.0};
    for (std::size_t i = 1; i < values.size(); ++i) {
      values[i] = sin_ * half_cos_ + cos_ * half_sin_;
      cos_ = cos_ * half_cos_ - sin_ * half_sin_;
      sin_ = values[i];
    }
    t_ = t + h;
    return values;
  }

 private:
  static constexpr double kRounding_s = 1e-15;  // rounding error of times of some seconds
  double omega_, phase_;
  double t_ = std::numeric_limits<double>::infinity(), sin_ = 0.0, cos_ = 0.0;  // at the end of the last step
  double h_ = std::numeric_limits<double>::infinity(), half_sin_ = 0.0, half_cos_ = 0.0;
};

}  // namespace glidelab::diagnose
