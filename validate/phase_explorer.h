/// The solutions behind a page on which K/m, mu, alpha, v0 and the law are chosen by hand, as few tables.
///
/// Every law here is dv/dt = A - s F - k s |v|^n, s the sign of v, A = g sin(alpha), F = mu g cos(alpha). On one side
/// of v = 0 the speed w = |v| follows
///
///     dw/dt = B - k w^n,   B = s A - F,
///
/// and with W = (|B| / k)^(1/n), T = W / |B|, u = w / W, tau = t / T that is du/dtau = +1 - u^n, -1 - u^n, or, where B
/// is nothing (W = the start, T = W^(1-n) / k), -u^n: no parameter is left but n, and every start is a place on one of
/// four orbits: rising (from rest), falling (from far above the limit), braking (from far above to rest), and free.
/// Without a drag (n = 0 stands for it) W = 1 m/s. So four orbits a law, made once by simulate(), hold all motions; a
/// page scales and joins them at v = 0, where the glider stays if |A| <= F.
#pragma once

#include <string>
#include <vector>

namespace glidelab::validate {

/// At tau: u, the way (integral of u, 0 at the orbit's end: small where u is), and du/dtau.
struct OrbitPoint {
  double tau = 0.0, u = 0.0, way = 0.0, slope = 0.0;
};

using Orbit = std::vector<OrbitPoint>;

struct LawOrbits {
  std::string name;       ///< "viscous"
  double exponent = 1.0;  ///< n; 0: no drag
  Orbit rising;           ///< from u = 0 with B > 0
  Orbit falling;          ///< from u = kFastest with B > 0, down to 1; without drag there is none, and rising goes on
  Orbit braking;          ///< from u = kFastest with B < 0, down to 0, the last point
  Orbit free;             ///< from u = 1 with B = 0
};

inline constexpr double kFastest = 1e6;  ///< of a start, in units of W

/// A motion that the program solved as it is, for a page to be checked against.
struct ReferenceMotion {
  std::size_t law = 0;
  double drag = 0.0;  ///< k
  double mu = 0.0;
  double alpha_deg = 0.0;
  double v0_m_s = 0.0;
  std::vector<double> t_s, x_m, v_m_s, a_m_s2;
};

struct PhaseExplorer {
  double gravity_m_s2 = 9.80665;
  std::vector<LawOrbits> laws;
  std::vector<ReferenceMotion> references;
};

/// The same every time: the references' parameters are drawn with a fixed seed.
PhaseExplorer explore_phases();

}  // namespace glidelab::validate
