/// The motion of a blind case: the truth to which a diagnosis is compared, made with none of the diagnosis's code.
///
///     inertia dv/dt = drive - drag - sign(v) friction,        at v = 0 it stays while |drive| <= friction
///
/// drive = m g sin(alpha), drag = K v, friction = mu m g cos(alpha), inertia = m, each of which a change may alter as a
/// function of (x, v, t). Boost.Odeint's Dormand-Prince pair with dense output (tolerance 1e-11 m, steps of at most
/// 2 ms, so that no narrow force is stepped over); v = 0 is found by bisection in the dense output. SI, x downhill.
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace glidelab::validate {

struct BlindTerms {
  double drive_n = 0.0;
  double drag_n = 0.0;      ///< against the motion where it has v's sign
  double friction_n = 0.0;  ///< never negative
  double inertia_kg = 0.0;
  double mass_kg = 0.0;  ///< true; no change alters it
};

using BlindChange = std::function<void(double x_m, double v_m_s, double t_s, BlindTerms&)>;

struct BlindLaw {
  double mass_kg = 0.0;
  double k_n_s_m = 0.0;
  double mu = 0.0;
  double alpha_rad = 0.0;
  double gravity_m_s2 = 9.80665;
  std::vector<BlindChange> changes;  ///< in this order
};

struct BlindSample {
  double x_m = 0.0;
  double v_m_s = 0.0;
};

/// From (x0, v0) at the first of the times, which rise. NaN from where it runs away (1 km), or where a million steps
/// have not brought it.
std::vector<BlindSample> blind_motion(const BlindLaw& law, double x0_m, double v0_m_s, std::span<const double> times_s);

}  // namespace glidelab::validate
