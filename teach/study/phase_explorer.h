/// The solutions behind a page on which K/m, mu, alpha, v0 and the law are chosen by hand, stored as a few tables.
///
/// Every law here is dv/dt = A - s F - k s |v|^n, s the sign of v, A = g sin(alpha), F = mu g cos(alpha). On one side
/// of v = 0 the speed w = |v| follows
///
///     dw/dt = B - k w^n,   B = s A - F,
///
/// and with W = (|B| / k)^(1/n), T = W / |B|, u = w / W, tau = t / T that is du/dtau = +1 - u^n, -1 - u^n, or, if B is
/// zero (W = the start, T = W^(1-n) / k), -u^n. The only remaining parameter is n, and every start is a point on one of
/// four orbits: rising (from rest), falling (from far above the limit), braking (from far above to rest), and free.
/// Without drag (denoted by n = 0) W = 1 m/s. So four orbits per law, made once by simulate(), contain all motions; a
/// page scales them and joins them at v = 0, where the glider stays if |A| <= F.
///
/// Distances are scaled by W T, which is 1e4 m if k is small, while the distance itself is a few metres: the difference
/// of distance between two points of an orbit must be accurate, not only each distance. So an orbit is solved in legs
/// over which u falls by a factor of ten at most, and its points are close enough for fifth-order polynomials: their
/// error is 1e-10 of u.
#pragma once

#include <string>
#include <vector>

namespace glidelab::teach {

/// At tau: u, the distance (integral of u, 0 at the orbit's end: small where u is), du/dtau and d²u/dtau².
struct OrbitPoint {
  double tau = 0.0, u = 0.0, distance = 0.0, slope = 0.0, bend = 0.0;
};

using Orbit = std::vector<OrbitPoint>;

struct LawOrbits {
  std::string name;       ///< "viscous"
  double exponent = 1.0;  ///< n; 0: no drag
  Orbit rising;           ///< from u = 0 with B > 0
  Orbit falling;          ///< from u = kFastest with B > 0, down to 1; without drag there is none, and `rising`
                          ///< continues
  Orbit braking;          ///< from u = kFastest (kLongest without drag) with B < 0, down to 0, the last point
  Orbit free;             ///< from u = 1 with B = 0
};

/// The largest start, in units of W. The smallest nonzero |B| that the sliders reach is 9.6e-6 m/s² (1.1°, mu =
/// 0.0192): with k = 5 and n = 1 the start at 2 m/s is 1.04e6 W.
inline constexpr double kFastest = 1e7;
inline constexpr double kLongest = 64.0;  ///< tau to which orbits extend: 5 s at k = 5, n = 2 and 2 m/s are 50

/// A motion solved directly by the program, against which a page is checked.
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

/// The ends of a slider's range.
struct ExplorerRange {
  double low = 0.0, high = 0.0;
};
inline constexpr ExplorerRange kDragRange{0.01, 5.0};  ///< k; also 0, which is no drag
inline constexpr ExplorerRange kMuRange{0.0, 0.03};
inline constexpr ExplorerRange kInclineRange{-4.0, 8.0};  ///< degrees
inline constexpr ExplorerRange kStartRange{-2.0, 2.0};    ///< m/s
inline constexpr double kExplorerTime = 5.0;              ///< s

/// The result is the same every time. The references are every corner of the sliders' ranges (including the level track
/// and the start at rest), and motions whose parameters are drawn with a fixed seed, k uniformly in its logarithm.
PhaseExplorer explore_phases();

}  // namespace glidelab::teach
