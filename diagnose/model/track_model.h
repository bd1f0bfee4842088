/// The motion of a glider with any effects, as the measured x(t) shows it.
///
///     m dv/dt = m g sin(alpha) - K v - sign(v) mu m g cos(alpha) + a known force + an unnamed one
///
/// sliding, changed by the laws of the effects that act (diagnose/effects/effect.h). At v = 0 the glider stays at rest
/// as long as static friction, up to its limit in either direction, can hold it.
///
/// The integrator is fourth-order Runge-Kutta, with equal steps within each frame interval or one step over several
/// frames, and a quintic polynomial between (steps of at most 12.6 ms or an eighth of the frame interval; k h at most
/// 0.3, omega h of a vibration at most 0.9). It stops exactly at v = 0 and at t_r, so that the motion is a smooth
/// function of all parameters and its derivatives follow by finite differences. SI units.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "diagnose/effects/effect_library.h"

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
/// that is empty. The result is not finite if the motion runs away, or would need more than 2500 steps plus 54 a frame
/// (200 frames in 2 s: K/m above 2000 1/s), or more work, turns included, than 2000 steps a frame; fewer than 100
/// frames count as 100.
Moved move(const TrackModel& model, std::span<const double> times_s, std::span<const double> late_s = {});

}  // namespace glidelab::diagnose
