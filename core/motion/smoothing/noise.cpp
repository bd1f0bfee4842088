#include "core/motion/smoothing/noise.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/math/dense.h"
#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kFewestResiduals = 20;
constexpr std::size_t kFewestForCorrelation = 60;
constexpr std::size_t kFewestForParts = 6;  // positions

double autocorrelation(const std::vector<double>& filter, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = 0; i + lag < filter.size(); ++i) sum += filter[i] * filter[i + lag];
  return sum;
}

/// p = 1 - s on a uniform grid of the step; no longer than a series of the given number of points, beyond which there
/// is nothing to smooth (a gap in the times makes the bandwidth long compared with the step).
std::vector<double> residual_filter(double bandwidth_s, double step_s, std::size_t points) {
  const double reach = std::ceil(kKernelReach * bandwidth_s / step_s) + 1.0;
  const auto half = static_cast<std::size_t>(std::min(reach, static_cast<double>(points)));
  std::vector<double> t(2 * half + 1);
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = static_cast<double>(i) * step_s;
  const auto row = LocalCubic(t, bandwidth_s).row_of_point(half);
  std::vector<double> filter(t.size(), 0.0);
  if (row) {
    for (std::size_t i = 0; i < row->weights->x.size(); ++i) filter[row->first + i] = -row->weights->x[i];
  }
  filter[half] += 1.0;
  return filter;
}

struct Residuals {
  std::vector<double> product;  // mean of r_j r_(j+k)
  std::size_t count = 0;
};

Residuals residuals_of(const std::vector<NoisePiece>& pieces, std::size_t lags) {
  Residuals residuals;
  residuals.product.assign(lags + 1, 0.0);
  std::vector<std::size_t> pairs(lags + 1, 0);
  for (const NoisePiece& piece : pieces) {
    const std::span<const double> t = piece.cubic->times();
    const double margin = kCompleteKernel * piece.cubic->bandwidth_s();
    const auto smoothed = piece.cubic->smooth(piece.x_m);
    std::vector<double> r;
    for (std::size_t j = 0; j < t.size(); ++j) {
      if (t[j] < t.front() + margin || t[j] > t.back() - margin || !smoothed[j]) continue;
      r.push_back(piece.x_m[j] - smoothed[j]->x_m);
    }
    residuals.count += r.size();
    for (std::size_t lag = 0; lag <= lags && lag < r.size(); ++lag) {
      for (std::size_t j = 0; j + lag < r.size(); ++j) residuals.product[lag] += r[j] * r[j + lag];
      pairs[lag] += r.size() - lag;
    }
  }
  for (std::size_t lag = 0; lag <= lags; ++lag) {
    if (pairs[lag] > 0) residuals.product[lag] /= static_cast<double>(pairs[lag]);
  }
  return residuals;
}

bool looks_white(const Residuals& residuals, const std::vector<double>& passed) {
  const std::size_t lags = std::min<std::size_t>({10, passed.size() - 1, residuals.product.size() - 1});
  double chi2 = 0.0;
  for (std::size_t lag = 1; lag <= lags; ++lag) {
    const double off = residuals.product[lag] / residuals.product[0] - passed[lag] / passed[0];
    chi2 += off * off * static_cast<double>(residuals.count);
  }
  // Four standard deviations of chi^2, because the filter itself slightly correlates the residuals.
  const auto degrees = static_cast<double>(lags);
  return chi2 < degrees + 4.0 * std::sqrt(2.0 * degrees);
}

struct Mixture {
  double white = 0.0, correlated = 0.0, rho = 0.0;
  double misfit = std::numeric_limits<double>::infinity();
};

/// Least squares of the products for white noise and a part rho^|lag|, neither of them negative.
Mixture mixture(const Residuals& residuals, const std::vector<double>& passed, double rho) {
  const auto lags = static_cast<Eigen::Index>(residuals.product.size());
  Eigen::MatrixXd design(lags, 2);
  const Eigen::Map<const Eigen::VectorXd> seen(residuals.product.data(), lags);
  const auto reach = static_cast<long>(passed.size()) - 1;
  for (Eigen::Index lag = 0; lag < lags; ++lag) {
    design(lag, 0) = passed[static_cast<std::size_t>(lag)];
    double sum = 0.0;
    for (long l = -reach; l <= reach; ++l) {  // sum over the lag of P
      sum += passed[static_cast<std::size_t>(std::abs(l))] * std::pow(rho, static_cast<double>(std::abs(lag - l)));
    }
    design(lag, 1) = sum;
  }
  Eigen::Vector2d part = base::least_squares(design, seen);
  for (int i = 0; i < 2; ++i) {
    if (part[i] >= 0.0) continue;
    part[i] = 0.0;
    part[1 - i] = std::max(0.0, design.col(1 - i).dot(seen) / design.col(1 - i).squaredNorm());
  }
  return {part[0], part[1], rho, (design * part - seen).squaredNorm()};
}

/// The step of counts that were written with few decimals: an encoder's counts, times a length. `about` is one of the
/// changes, with the error of its last decimal, which the larger distances make smaller; 0 if these are no counts.
double step_of_counts(std::span<const double> x_m, double about) {
  constexpr double kOff = 0.02;           // of a count: a position fits once in 25 by chance
  constexpr std::size_t kFewestFar = 20;  // positions ten counts or more from the first
  std::vector<double> distances;
  for (const double x : x_m) distances.push_back(std::abs(x - x_m[0]));
  std::sort(distances.begin(), distances.end());
  double step = about, counts2 = 0.0, products = 0.0;
  std::size_t far = 0;
  for (const double distance : distances) {
    const double count = std::round(distance / step);
    if (std::abs(distance / step - count) > 2.0 * kOff) return 0.0;
    counts2 += count * count;
    products += count * distance;
    if (counts2 > 0.0) step = products / counts2;
    if (count >= 10.0) ++far;
  }
  const bool all_fit = std::all_of(distances.begin(), distances.end(), [&](double distance) {
    return std::abs(distance / step - std::round(distance / step)) <= kOff;
  });
  return all_fit && far >= kFewestFar ? step : 0.0;
}

}  // namespace

double rounding_step(std::span<const double> x_m) {
  constexpr int kMostParts = 8;  // the smallest change may be several steps if the motion is never slow
  double least = std::numeric_limits<double>::infinity(), most_change = 0.0, least_change = least;
  for (std::size_t i = 1; i < x_m.size(); ++i) {
    const double change = std::abs(x_m[i] - x_m[i - 1]);
    if (change > 1e-12 * std::abs(x_m[i])) least = std::min(least, change);
    most_change = std::max(most_change, change);
    least_change = std::min(least_change, change);
  }
  if (!std::isfinite(least)) return 0.0;
  // Positions that all lie one step apart are marks, as light gates, whose times were measured: rounding would pass
  // over one of them, or give one twice.
  constexpr double kSameChange = 1e-6;
  if (most_change - least_change <= kSameChange * most_change) return 0.0;
  const auto fits = [&](double step) {
    return std::all_of(x_m.begin(), x_m.end(), [&](double x) {
      const double multiple = (x - x_m[0]) / step;
      return std::abs(multiple - std::round(multiple)) <= 1e-3;
    });
  };
  // Few positions are multiples of a small part by chance: one in 500 each.
  const int most = x_m.size() < kFewestForParts ? 1 : kMostParts;
  for (int parts = 1; parts <= most; ++parts) {
    if (fits(least / parts)) return least / parts;
  }
  for (int parts = 1; parts <= most; ++parts) {
    if (const double step = step_of_counts(x_m, least / parts); step > 0.0) return step;
  }
  // If the motion is never slow, the last decimal place is seen in the numbers themselves.
  constexpr int kMostPlaces = 9;
  double step = 1.0;
  for (int places = 0; places <= kMostPlaces; ++places, step = std::pow(10.0, -places)) {
    if (least > step && fits(step)) return step;
  }
  return 0.0;
}

namespace {

constexpr int kMostDecimals = 10;

/// The decimals of a number as it was written; kMostDecimals for any longer one.
int decimals_of(double x) {
  constexpr double kDigits = 1e-4;  // of the last decimal: what a conversion of units leaves is smaller
  double scaled = std::abs(x);
  for (int decimals = 0; decimals < kMostDecimals; ++decimals, scaled *= 10.0) {
    if (std::abs(scaled - std::round(scaled)) < kDigits) return decimals;
  }
  return kMostDecimals;
}

int decade_of(double x) {
  constexpr double kOnBorder = 1e-9;
  return static_cast<int>(std::floor(std::log10(std::abs(x)) + kOnBorder));
}

}  // namespace

std::vector<double> written_steps(std::span<const double> x_m) {
  constexpr std::size_t kFewestNumbers = 6;  // that all end in a zero by chance in one of a million cases
  std::map<int, std::set<double>> numbers;
  for (const double x : x_m) {
    if (x != 0.0) numbers[decade_of(x)].insert(std::abs(x));
  }
  std::map<int, int> decimals;  // of each decade
  for (const auto& [decade, of_decade] : numbers) {
    if (of_decade.size() < kFewestNumbers) continue;
    int most = 0;
    for (const double x : of_decade) most = std::max(most, decimals_of(x));
    // A smaller number is not written more coarsely.
    for (auto& [smaller, known] : decimals) known = std::max(known, most);
    decimals[decade] = most;
  }
  if (decimals.empty() || decimals.begin()->second == decimals.rbegin()->second) return {};
  std::vector<double> steps;
  for (const double x : x_m) {
    auto at = x == 0.0 ? decimals.begin() : decimals.upper_bound(decade_of(x));
    if (at != decimals.begin()) --at;
    steps.push_back(at->second == kMostDecimals ? 0.0 : std::pow(10.0, -at->second));
  }
  return steps;
}

double coarsest_step(std::span<const double> x_m) {
  constexpr double kShare = 0.9;  // quantile: a tenth of the positions have it
  std::vector<double> steps = written_steps(x_m);
  return steps.empty() ? 0.0 : quantile(std::move(steps), kShare);
}

double pilot_noise(std::span<const double> t_s, std::span<const double> x_m) {
  std::vector<double> squares;
  for (std::size_t i = 2; i + 2 < t_s.size(); ++i) {
    double off = x_m[i], gain = 1.0;
    for (const std::size_t a : {i - 2, i - 1, i + 1, i + 2}) {
      double weight = 1.0;  // Lagrange's, of the neighbour a at t_i
      for (const std::size_t b : {i - 2, i - 1, i + 1, i + 2}) {
        if (b != a) weight *= (t_s[i] - t_s[b]) / (t_s[a] - t_s[b]);
      }
      off -= weight * x_m[a];
      gain += weight * weight;
    }
    squares.push_back(off * off / gain);
  }
  double sd = 0.0;
  if (!squares.empty()) {
    std::sort(squares.begin(), squares.end());
    const std::size_t half = (squares.size() + 1) / 2;
    double sum = 0.0;
    for (std::size_t i = 0; i < half; ++i) sum += squares[i];
    // Mean of z^2 over the smaller half of |z|, z normal: 1 - 2 q phi(q) / 0.5 at the quartile q = 0.6745.
    constexpr double kOfSmallerHalf = 0.14267;
    sd = std::sqrt(sum / static_cast<double>(half) / kOfSmallerHalf);
  }
  return std::max(sd, std::max(rounding_step(x_m), coarsest_step(x_m)) / std::sqrt(12.0));
}

double sum_over_lags(const std::vector<double>& autocovariance) {
  double sum = 0.0;
  for (std::size_t lag = 0; lag < autocovariance.size(); ++lag) sum += (lag == 0 ? 1.0 : 2.0) * autocovariance[lag];
  return sum;
}

PositionNoise estimate_noise(const std::vector<NoisePiece>& pieces, double at_least_m) {
  PositionNoise noise{at_least_m, {at_least_m * at_least_m}};
  std::size_t points = 0;
  std::vector<double> steps;
  for (const NoisePiece& piece : pieces) {
    points += piece.x_m.size();
    const auto t = piece.cubic->times();
    for (std::size_t i = 1; i < t.size(); ++i) steps.push_back(t[i] - t[i - 1]);
  }
  if (steps.empty()) return noise;
  const double step = quantile(std::move(steps), 0.5), bandwidth = pieces.front().cubic->bandwidth_s();
  const std::vector<double> filter = residual_filter(bandwidth, step, points);
  const auto lags = static_cast<std::size_t>(
      std::clamp(std::ceil(3.0 * bandwidth / step), 4.0, std::max(4.0, static_cast<double>(points) / 10.0)));
  const Residuals residuals = residuals_of(pieces, lags);
  if (residuals.count < kFewestResiduals) return noise;
  std::vector<double> passed(std::max(filter.size(), lags + 1), 0.0);
  for (std::size_t lag = 0; lag < filter.size(); ++lag) passed[lag] = autocorrelation(filter, lag);
  const double variance = residuals.product[0] / passed[0];
  noise.sd_m = std::sqrt(variance);
  noise.autocovariance = {variance};
  if (variance == 0.0 || residuals.count < kFewestForCorrelation || looks_white(residuals, passed)) return noise;
  Mixture best;
  for (const double rho : {-0.8, -0.6, -0.4, -0.2, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95}) {
    const Mixture tried = mixture(residuals, passed, rho);
    if (tried.misfit < best.misfit) best = tried;
  }
  if (best.correlated <= 0.0) return noise;
  noise.autocovariance = {best.white + best.correlated};
  noise.sd_m = std::sqrt(noise.autocovariance[0]);
  for (double part = best.correlated * best.rho; std::abs(part) > 1e-3 * best.correlated; part *= best.rho) {
    noise.autocovariance.push_back(part);
  }
  return noise;
}

}  // namespace glidelab::core
