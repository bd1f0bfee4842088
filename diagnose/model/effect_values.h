/// The sizes of all effects at once, as one motion feels them. At the values given here every effect is absent.
///
/// Names and meanings are those of the list of effects (docs/reference/effects.md); x downhill, v = dx/dt.
#pragma once

#include <limits>

namespace glidelab::diagnose {

struct EffectValues {
  // Dynamics.
  double c_kg_m = 0.0;         ///< -C v |v|
  double rolloff_s2_m2 = 0.0;  ///< 1/v_c²: K v / (1 + v²/v_c²)
  double power = 0.0;          ///< n - 1: K v |v/v_1|^(n-1), v_1 = 1 m/s
  double stribeck = 0.0;       ///< s - 1: mu (1 + (s-1) exp(-(v/v_s)²))
  double stribeck_m_s = 0.05;  ///< v_s
  double force_n = 0.0;        ///< -sign(v) F_0
  double asymmetry = 0.0;      ///< d: mu (1 + d sign(v))
  double bow_1_m = 0.0;        ///< c: sin(alpha) + c (x - x_mid)
  double gradient_1_m = 0.0;   ///< b: K (1 + b (x - x_mid))
  /// x_mid of the gradient: 0 the set-up's own middle, 1 the middle of all set-ups (one K(x) for the track).
  double gradient_about = 0.0;
  double wheels_kg = 0.0;   ///< m_w: (m + m_w) dv/dt
  double tether_n_m = 0.0;  ///< -k (x - x_t) where x > x_t
  double tether_x_m = std::numeric_limits<double>::infinity();
  double shake_m_s2 = 0.0;  ///< A of m A sin(2 pi f t + phi)
  double shake_hz = 0.0;
  double shake_phase = 0.0;  ///< each motion its own
  double push_m_s2 = 0.0;    ///< each motion its own: extra acceleration until t_r
  double release_s = 0.0;    ///< t_r, from the first frame
  // Observation: x(t) seen by the camera from the true one.
  double rate_error = 0.0;       ///< e: the true time is (1 + e) t
  double scale_error = 0.0;      ///< e: (1 + e) x
  double perspective_1_m = 0.0;  ///< p: x / (1 + p x)
  double lens_1_m2 = 0.0;        ///< k: x (1 + k (x - x_c)²)
  double lens_x_m = 0.0;         ///< x_c
  double line_s = 0.0;           ///< time from one row of the picture to the next below, more than stated
  double camera_m = 0.0;         ///< amplitude of a camera that sways, as metres along x
  double camera_hz = 0.0;
  double camera_phase = 0.0;  ///< each motion its own
  /// A turning camera moves what is at the picture's sides by more: A (1 + slope (x - x_mid) + bend (x - x_mid)²).
  double camera_slope_1_m = 0.0, camera_bend_1_m2 = 0.0;
};

}  // namespace glidelab::diagnose
