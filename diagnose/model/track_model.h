/// The motion of a glider with any effects, as the measured x(t) shows it.
///
///     m dv/dt = m g sin(alpha) - K v - sign(v) mu m g cos(alpha) + a known force + an unnamed one
///
/// sliding, changed by the laws of the effects that act (diagnose/effects/effect.h); at v = 0 the glider stays as long
/// as static friction, up to its limit in either direction, can hold it. Runge and Kutta's fourth order in equal parts
/// of every frame interval, or over several frames, with a polynomial of fifth order between (steps of at most 12.6 ms
/// or an eighth of the frame interval; k h at most 0.3, a shaking's omega h at most 0.9), stopped exactly at v = 0 and
/// at t_r: a smooth function of all parameters, so that its derivatives follow by finite differences. SI units.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {

/// Force in N at (x, v, t); t counts from the clip's first frame.
using UnnamedForce = std::function<double(double x_m, double v_m_s, double t_s)>;

/// A force that was recorded with the positions, along x, linear between its samples; their times rise. Empty: none.
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
  double x_low_m = 0.0, x_high_m = 0.0;  ///< of the positions of all set-ups
  std::size_t clip = 0;                  ///< its number
  double x0_m = 0.0;                     ///< at the first of the times
  double v0_m_s = 0.0;
  EffectValues effects;
  const KnownForce* known = nullptr;
  const UnnamedForce* unnamed = nullptr;
  std::span<const double> row_px;  ///< of the marker at each of the times; empty: not filmed
};

struct Moved {
  std::vector<double> x_m;    ///< as measured: with what camera and restitution do to it
  std::vector<double> v_m_s;  ///< true
};

/// At the stated times (rising, from the clip's first frame), each later by its `late_s`, where that is not empty. Not
/// finite where the motion runs away, or would need more than 2500 steps and 24 a frame (200 frames in 2 s: K/m above
/// 1100 1/s), or more work with what turns cost than 2000 steps a frame; fewer than 100 frames count as 100.
Moved move(const TrackModel& model, std::span<const double> times_s, std::span<const double> late_s = {});

}  // namespace glidelab::diagnose
