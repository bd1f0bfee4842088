// plug-in: h^9 = 5 R_2 s^2 dt / mean(x''''^2), R_2 = 3/(8 sqrt(pi)) (local_polynomial.h): it minimises the mean square
// error of a with one h for all points. x'''' comes from one polynomial of order 6 through each part (order p + 3: Fan
// and Gijbels 1996, section 4.2; Ruppert, Sheather and Wand 1995 fit it in blocks); the noise's share of its square is
// subtracted. If x'''' does not rise above the noise by two standard deviations of its mean square, the widest
// bandwidth is taken, and the result says so. Correlated noise enters by its sum over all lags.
#include <algorithm>
#include <cmath>

#include "core/math/least_squares.h"
#include "core/motion/bandwidth/bandwidth_rule.h"
#include "core/motion/smoothing/local_polynomial.h"

namespace glidelab::core {
namespace {

constexpr int kGlobalOrder = 6;
constexpr double kCurvatureSeen = 2.0;  // standard deviations by which the mean square of x'''' must stand out

/// Sums over the points of a part: of x''''^2 as fitted, of its expectation from noise alone, and the variance of the
/// first sum.
struct FourthDerivative {
  double square = 0.0, by_noise = 0.0, variance = 0.0;
  std::size_t points = 0;
};

FourthDerivative fourth_derivative(const MotionPart& part, double noise_variance) {
  FourthDerivative sums;
  const std::size_t n = part.t_s.size();
  if (n < 2 * (kGlobalOrder + 1)) return sums;
  const double middle = 0.5 * (part.t_s.front() + part.t_s.back()), half = 0.5 * (part.t_s.back() - part.t_s.front());
  std::vector<double> u, one(n, 1.0);
  for (const double t : part.t_s) u.push_back((t - middle) / half);
  const auto basis = OrthogonalPolynomials::make(kGlobalOrder, u, one);
  if (!basis) return sums;
  std::vector<double> coefficient;  // of p_k over the root of its norm: independent, with the noise's variance
  for (int k = 0; k <= kGlobalOrder; ++k) {
    double projection = 0.0;
    for (std::size_t i = 0; i < n; ++i) projection += basis->at_points(k)[i] * (part.x_m[i] - part.x_m[0]);
    coefficient.push_back(projection / std::sqrt(basis->norm(k)));
  }
  // x''''(t) = sum_k c_k q_k(t); its sum of squares is c'Gc with G = sum over the points of q q'.
  constexpr int kFirst = 4, kCount = kGlobalOrder - kFirst + 1;
  double gram[kCount][kCount] = {};
  for (std::size_t i = 0; i < n; ++i) {
    const std::vector<double> d = basis->derivatives(u[i], 4);
    double q[kCount];
    for (int k = 0; k < kCount; ++k) {
      q[k] = d[static_cast<std::size_t>((kFirst + k) * 5 + 4)] / std::sqrt(basis->norm(kFirst + k)) / std::pow(half, 4);
    }
    for (int r = 0; r < kCount; ++r) {
      for (int c = 0; c < kCount; ++c) gram[r][c] += q[r] * q[c];
    }
  }
  for (int r = 0; r < kCount; ++r) {
    double of_row = 0.0;
    for (int c = 0; c < kCount; ++c) {
      of_row += gram[r][c] * coefficient[static_cast<std::size_t>(kFirst + c)];
      sums.variance += 2.0 * gram[r][c] * gram[r][c] * noise_variance * noise_variance;
    }
    sums.square += coefficient[static_cast<std::size_t>(kFirst + r)] * of_row;
    sums.by_noise += gram[r][r] * noise_variance;
  }
  sums.points = n;
  return sums;
}

std::optional<BandwidthPick> by_plug_in(const BandwidthProblem& problem) {
  const BandwidthScan scan(problem);
  if (scan.grid().empty()) return {};
  const double white = sum_over_lags(problem.noise.autocovariance);
  FourthDerivative all;
  for (const MotionPart& part : problem.parts) {
    const FourthDerivative of = fourth_derivative(part, white);
    all.square += of.square;
    all.by_noise += of.by_noise;
    all.variance += of.variance;
    all.points += of.points;
  }
  if (all.points == 0) return {};
  BandwidthPick pick;
  const double signal = all.square - all.by_noise;
  const double narrowest = scan.grid().front(), widest = scan.grid().back();
  if (signal <= kCurvatureSeen * std::sqrt(all.variance)) {
    pick.bandwidth_s = widest;
    pick.by = found_by_rule("plug-in: x'''' does not rise above the noise");
    pick.by.edge = edge_of(scan.grid(), scan.grid().size() - 1);
    return pick;
  }
  const double mean_square = signal / static_cast<double>(all.points);
  const double ideal = std::pow(kGaussianA.best_h9() * white * problem.step_s / mean_square, 1.0 / 9.0);
  pick.bandwidth_s = std::clamp(ideal, narrowest, widest);
  const double rms = std::sqrt(mean_square), ideal_ms = 1e3 * ideal;
  if (ideal < narrowest) {
    pick.by = found_by_rule("plug-in: rms x'''' of {:.3g} m/s^4 calls for {:.1f} ms, narrower than the frames allow",
                            rms, ideal_ms);
  } else if (ideal > widest) {
    pick.by = found_by_rule("plug-in: rms x'''' of {:.3g} m/s^4 calls for {:.1f} ms, wider than the motion allows", rms,
                            ideal_ms);
  } else {
    pick.by = found_by_rule("plug-in: rms x'''' of {:.3g} m/s^4", rms);
  }
  return pick;
}

}  // namespace

extern const BandwidthRule kPlugIn = {
    "plug-in",
    "the h of smallest mean square error of a, with x'''' from one polynomial of order 6 through each stretch",
    "such a polynomial has the right x''''", by_plug_in};

}  // namespace glidelab::core
