/// Motions in closed form, from the paper's equations and for single drag laws.
///
/// Frame and signs as everywhere: x positive downhill, friction opposes v. All rates are per mass: k = K/m in 1/s,
/// q = c/m in 1/m, accelerations in m/s². Every formula passes into its limit (k -> 0, q -> 0, no net acceleration, n
/// -> 1) without a threshold at which the value jumps: differences are taken by expm1 and log1p.
///
/// These are the oracle for simulate(), and share only State with it.
#pragma once

#include <optional>

#include "sim/motion/simulate.h"

namespace glidelab::sim {

/// (e^z - 1) / z, 1 at z = 0.
double phi1(double z);
/// (e^z - 1 - z) / z², 1/2 at z = 0.
double phi2(double z);
/// (phi2(z) - 1/2) / z, 1/6 at z = 0.
double phi3(double z);
/// (phi3(z) - 1/6) / z, 1/24 at z = 0.
double phi4(double z);

struct Kinematics {
  double x_m = 0.0;
  double v_m_s = 0.0;
  double a_m_s2 = 0.0;
};

/// Viscous drag and a constant force, v = v_lim + (v0 - v_lim) exp(-k t), with v_lim given and k > 0 (equations (2) and
/// (3) of the paper).
Kinematics viscous_motion(double k_1_s, double v_lim_m_s, double x0_m, double v0_m_s, double t_s);

/// Constant acceleration, v = v0 + a t; on a dry incline a = g (sin alpha - mu cos alpha) (the paper's (6), (7)).
Kinematics uniform_motion(double a_m_s2, double x0_m, double v0_m_s, double t_s);

/// dv/dt = a0 - k v for any k >= 0: viscous_motion() with v_lim = a0 / k, and uniform_motion() at k = 0.
Kinematics linear_motion(double a0_m_s2, double k_1_s, double x0_m, double v0_m_s, double t_s);

/// When linear_motion() comes to v = 0; empty if it does not (t = 0 if v0 = 0).
std::optional<double> linear_stop_time_s(double a0_m_s2, double k_1_s, double v0_m_s);

/// What acts on the glider besides a drag that vanishes at rest, per mass.
struct DryTrack {
  double drive_m_s2 = 0.0;     ///< g sin(alpha), and constant forces
  double friction_m_s2 = 0.0;  ///< mu g cos(alpha), against the motion
  double holding_m_s2 = 0.0;   ///< mu_static g cos(alpha), the largest force held at rest
};

DryTrack dry_track(double incline_rad, double mu, double mu_static, double gravity_m_s2);

/// dv/dt = drive - k v - sign(v) friction (the paper's (8)), piece by piece: exponentials up to v = 0. There it sticks
/// if |drive| <= holding (equality within rounding); otherwise it slides on with the sign of the drive. It comes to v =
/// 0 at most once, because v grows afterwards.
State viscous_coulomb_motion(const DryTrack& track, double k_1_s, double x0_m, double v0_m_s, double t_s);

/// When viscous_coulomb_motion() first comes to v = 0; empty if it does not, or if v0 = 0.
std::optional<double> viscous_coulomb_stop_time_s(const DryTrack& track, double k_1_s, double v0_m_s);

/// dv/dt = drive -+ friction - q v |v|: tangent while it slows down to v = 0, hyperbolic tangent (or cotangent, above
/// v_lim) towards v_lim, with the same rule at v = 0.
State quadratic_coulomb_motion(const DryTrack& track, double q_1_m, double x0_m, double v0_m_s, double t_s);

std::optional<double> quadratic_coulomb_stop_time_s(const DryTrack& track, double q_1_m, double v0_m_s);

/// dv/dt = -k v |v / (1 m/s)|^(n-1) and nothing else, k > 0. For n < 1 it stops at power_law_stop_time_s() and sticks.
State power_law_motion(double k_1_s, double n, double x0_m, double v0_m_s, double t_s);

/// |v0|^(1-n) / ((1-n) k) for n < 1; empty for n >= 1 or v0 = 0.
std::optional<double> power_law_stop_time_s(double k_1_s, double n, double v0_m_s);

/// dv/dt = -k v / (1 + (v/v_c)²) and nothing else, k > 0: the time from v0 to v (of one sign, |v| <= |v0|, not 0),
/// (ln(v0/v) + (v0² - v²) / (2 v_c²)) / k.
double eddy_rolloff_time_s(double k_1_s, double v_c_m_s, double v0_m_s, double v_m_s);

/// The distance from v0 to v of the same motion, (v0 - v + (v0³ - v³) / (3 v_c²)) / k.
double eddy_rolloff_distance_m(double k_1_s, double v_c_m_s, double v0_m_s, double v_m_s);

}  // namespace glidelab::sim
