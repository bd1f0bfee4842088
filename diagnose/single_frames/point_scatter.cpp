#include "diagnose/single_frames/point_scatter.h"

#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "base/math/dense.h"
#include "base/math/log_sum.h"
#include "core/motion/smoothing/noise.h"
#include "diagnose/fit/fit_model.h"
#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/tracks/neighbour_residual.h"

namespace glidelab::diagnose {
namespace {

constexpr std::array kPointsABump = {14.0, 10.0, 7.0, 5.0};  // of the smooth curve
constexpr double kFewestBumps = 4.0;
constexpr double kMostOffCurve = 5.0;  // standard deviations
constexpr double kTwoSd = 2.0;         // of the sum of neighbours' products, where they err by chance

struct UnderCurve {
  Eigen::VectorXd rest;  // of all points
  Eigen::Index bumps = 0;
};

/// What is left of `r` after a least-squares curve of bumps, with this many points to each; outliers do not count.
/// There are bumps before the first point and behind the last as well: without them the curve would bend away there.
UnderCurve left_by_curve(const TrackedMotion& data, const Eigen::VectorXd& r, double points_a_bump) {
  const Eigen::Index n = r.size();
  const auto parts = static_cast<Eigen::Index>(std::max(kFewestBumps, static_cast<double>(n) / points_a_bump)) - 1;
  const double span = data.t_s.back() - data.t_s.front(), width = span / static_cast<double>(parts);
  const Eigen::Index bumps = parts + 3;
  Eigen::MatrixXd basis(n, bumps);
  for (Eigen::Index p = 0; p < n; ++p) {
    for (Eigen::Index b = 0; b < bumps; ++b) {
      const double z = (data.t_s[static_cast<std::size_t>(p)] - data.t_s.front()) / width - static_cast<double>(b - 1);
      basis(p, b) = std::abs(z) < 4.0 ? std::exp(-0.5 * z * z) : 0.0;
    }
  }
  Eigen::VectorXd rest = r;
  std::vector<char> out = data.outlier;
  for (int round = 0; round < 3; ++round) {
    Eigen::MatrixXd kept = basis;
    Eigen::VectorXd of = r;
    for (Eigen::Index p = 0; p < n; ++p) {
      if (!out[static_cast<std::size_t>(p)]) continue;
      kept.row(p).setZero();
      of[p] = 0.0;
    }
    Eigen::MatrixXd normal = base::transposed_product(kept, kept);
    normal.diagonal().array() += 1e-9 * normal.diagonal().maxCoeff();
    rest = r - base::product(basis, base::solve_positive(normal, base::transposed_product(kept, of)));
    for (Eigen::Index p = 0; p < n; ++p) {
      const auto q = static_cast<std::size_t>(p);
      out[q] = std::abs(rest[p]) * data.sd_m > kMostOffCurve * data.sd_of(q) ? 1 : 0;
    }
  }
  return {std::move(rest), bumps};
}

/// Whether the errors of neighbours correlate more than by chance; a single point that is far off is not evidence of
/// that.
bool lasts(const TrackedMotion& data, const Eigen::VectorXd& rest) {
  double products = 0.0, squares = 0.0, pairs = 0.0;
  const auto clipped = [&](Eigen::Index p) {
    const double wider = data.sd_of(static_cast<std::size_t>(p)) / data.sd_m;
    return std::clamp(rest[p] / wider, -kMostOffCurve, kMostOffCurve);
  };
  for (Eigen::Index p = 0; p + 1 < rest.size(); ++p) {
    if (data.outlier[static_cast<std::size_t>(p)] || data.outlier[static_cast<std::size_t>(p) + 1]) continue;
    products += clipped(p) * clipped(p + 1);
    squares += 0.5 * (clipped(p) * clipped(p) + clipped(p + 1) * clipped(p + 1));
    pairs += 1.0;
  }
  return pairs > 0.0 && products * std::sqrt(pairs) > kTwoSd * squares;
}

}  // namespace

Leftover leftover_of(const TrackSet& set, const MotionFit& fit, std::size_t motion) {
  const TrackedMotion& data = set.motions[motion];
  const Moved moved = move(model_of(set, *fit.layout, fit.at, motion), data.t_s,
                           fit.late.empty() ? std::span<const double>() : std::span(fit.late[motion]));
  const std::vector<double> shared = shared_errors(set, *fit.layout, fit.at, motion, moved.x_m);
  const auto n = static_cast<Eigen::Index>(data.t_s.size());
  Eigen::VectorXd r(n);
  for (Eigen::Index p = 0; p < n; ++p) {
    const auto q = static_cast<std::size_t>(p);
    r[p] = (data.x_m[q] - moved.x_m[q] - shared[q]) / data.sd_m;
  }
  UnderCurve under;
  for (const double points : kPointsABump) {
    under = left_by_curve(data, r, points);
    if (!lasts(data, under.rest)) break;
  }
  const double taken = std::sqrt(1.0 - std::min(0.5, static_cast<double>(under.bumps) / static_cast<double>(n)));
  Leftover left;
  left.v_m_s = moved.v_m_s;
  for (Eigen::Index p = 0; p < n; ++p) {
    left.over_sd.push_back(under.rest[p] * data.sd_m / data.sd_of(static_cast<std::size_t>(p)) / taken);
  }
  return left;
}

namespace {

constexpr double kMostJitterScatter = 8.0;  // standard deviations
constexpr int kJitterRounds = 3;            // the jitter is found against the noise of all speeds first
constexpr double kSpreadOfMotions = 0.5;    // standard deviation of the logarithm of a motion's noise
constexpr double kLeastAtRest = 0.003;      // of the noise of all speeds
constexpr double kIndependent = 0.38;       // squares of neighbouring fourth differences: 1 / (1 + 2 sum of rho²)

/// Scatter of a motion's positions about their four neighbours.
void add_neighbours(const TrackedMotion& motion, const std::vector<double>& t_s, SpeedScatter& scatter) {
  for (std::size_t p = 2; p + 2 < t_s.size(); ++p) {
    if (std::any_of(motion.outlier.begin() + static_cast<long>(p) - 2,
                    motion.outlier.begin() + static_cast<long>(p) + 3, [](char out) { return out != 0; }))
      continue;
    const double v = (motion.x_m[p + 2] - motion.x_m[p - 2]) / (t_s[p + 2] - t_s[p - 2]);
    const double over_sd = neighbour_residual(t_s, motion.x_m, p) / motion.sd_of(p);
    if (std::abs(over_sd) < kMostJitterScatter) scatter.add(motion, p, over_sd, v);
  }
}

/// -2 log likelihood of a motion's scatter with a noise at rest and a jitter.
double cost(const SpeedScatter& scatter, double sd_m, double at_rest_m, double jitter_s) {
  double sum = 0.0;
  for (std::size_t p = 0; p < scatter.squares.size(); ++p) {
    const double variance = std::pow(at_rest_m / sd_m, 2) + jitter_s * jitter_s * scatter.fast[p];
    sum += kIndependent * (scatter.squares[p] / variance + std::log(variance));
  }
  return sum;
}

/// The minimum of a function of the logarithm.
template <typename Function>
double lowest(const Function& of_log, double from, double to) {
  constexpr int kBits = 20;
  return std::exp(boost::math::tools::brent_find_minima(of_log, std::log(from), std::log(to), kBits).first);
}

/// Each motion's noise at rest besides a jitter: its own if its slow positions determine it, otherwise that of all.
void set_noise_at_rest(std::vector<TrackedMotion>& motions, const std::vector<SpeedScatter>& scatters,
                       double jitter_s) {
  double most = 0.0;
  for (const TrackedMotion& motion : motions) most = std::max(most, motion.sd_m);
  const double of_all = lowest(
      [&](double log_sd) {
        double sum = 0.0;
        for (std::size_t i = 0; i < motions.size(); ++i)
          sum += cost(scatters[i], motions[i].sd_m, std::exp(log_sd), jitter_s);
        return sum;
      },
      kLeastAtRest * most, most);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const auto own = [&](double log_sd) {
      return cost(scatters[i], motions[i].sd_m, std::exp(log_sd), jitter_s) +
             std::pow((log_sd - std::log(of_all)) / kSpreadOfMotions, 2);
    };
    motions[i].sd_m = lowest(own, of_all / 10.0, of_all * 10.0);
  }
}

}  // namespace

void SpeedScatter::add(const TrackedMotion& motion, std::size_t point, double over_sd, double v_m_s) {
  const double own_sd_m = motion.own_sd_of(point), wider = motion.sd_of(point) / own_sd_m;
  squares.push_back(std::pow(over_sd * wider, 2));
  fast.push_back(std::pow(v_m_s / own_sd_m, 2));
  top_m_s = std::max(top_m_s, std::abs(v_m_s));
  widest = std::max(widest, wider);
}

void SpeedScatter::add(const SpeedScatter& of_a_motion) {
  squares.insert(squares.end(), of_a_motion.squares.begin(), of_a_motion.squares.end());
  fast.insert(fast.end(), of_a_motion.fast.begin(), of_a_motion.fast.end());
  top_m_s = std::max(top_m_s, of_a_motion.top_m_s);
  widest = std::max(widest, of_a_motion.widest);
}

SpeedNoise find_speed_noise(const TrackSet& set, const SpeedScatter& scatter, double independent) {
  SpeedNoise found;
  double step = 0.0, sd = 0.0, m_per_px = 0.0;
  for (const TrackedMotion& motion : set.motions) {
    m_per_px = std::max(m_per_px, motion.m_per_px);
    step = std::max(step, 1.0 / set.clips[motion.clip].frame_rate_hz);
    sd += motion.sd_m / static_cast<double>(set.motions.size());
  }
  const auto n = static_cast<double>(scatter.squares.size());
  if (scatter.squares.size() < kFewestScatter || !(scatter.top_m_s > 0.0)) return found;
  double mean_square = 0.0;  // beside the jitter
  const auto log_likelihood = [&](double tau) {
    // The scale s² of both parts together is fitted: n log(mean(e²/w)) + sum log w.
    double weighted = 0.0, logs = 0.0;
    for (std::size_t p = 0; p < scatter.squares.size(); ++p) {
      const double w = 1.0 + tau * tau * scatter.fast[p];
      weighted += scatter.squares[p] / w;
      logs += std::log(w);
    }
    mean_square = weighted / n;
    return -0.5 * independent * (n * std::log(mean_square) + logs);
  };
  const double none = log_likelihood(0.0);
  std::vector<double> logs;
  // Starts at the size that begins to show among n points, in units of the jitter that makes one standard deviation of
  // position at top speed. In images it starts above what the marker's blur and its place in the pixel can cause, whose
  // noise grows with the speed as well.
  const double unit = sd / scatter.top_m_s;
  const double least = 2.0 * std::pow(2.0 / (independent * n), 0.25) * unit;
  const double least_s = set.images ? least_filmed_jitter_s(m_per_px > 0.0 ? scatter.top_m_s / m_per_px : 0.0) : 0.0;
  for (double tau = least; tau < 40.0 * scatter.widest * unit && tau < 0.5 * step; tau *= 1.3) {
    const double gain = log_likelihood(tau) - none;
    if (tau * std::sqrt(mean_square) < least_s) continue;
    logs.push_back(gain);
    if (gain <= found.gain) continue;
    found.gain = logs.back();
    found.jitter_s = tau * std::sqrt(mean_square);  // sd_m may already include the jitter at the mean speed
  }
  if (logs.empty()) return found;
  found.log_evidence = base::log_mean(logs);
  found.sd_s = found.jitter_s / std::sqrt(std::max(1.0, 2.0 * found.gain));
  return found;
}

bool give_fast_positions_their_noise(TrackSet& set, const Lateness& late) {
  std::vector<std::vector<double>> times;
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    times.push_back(set.motions[i].t_s);
    for (std::size_t p = 0; p < times.back().size() && !late.empty(); ++p) times.back()[p] += late[i][p];
  }
  for (const TrackedMotion& motion : set.motions) {
    const bool is_coarse = core::rounding_step(motion.x_m) > motion.sd_m || !motion.coarser.empty();
    if (is_coarse) return false;  // the errors of rounding depend on the position
  }
  bool any = false;
  for (int round = 0; round < kJitterRounds; ++round) {
    SpeedScatter all;
    std::vector<SpeedScatter> own(set.motions.size());
    for (std::size_t i = 0; i < set.motions.size(); ++i) {
      add_neighbours(set.motions[i], times[i], own[i]);
      all.add(own[i]);
    }
    const SpeedNoise found = find_speed_noise(set, all, kIndependent);
    if (found.log_evidence < kBeyondDoubt) return any;
    any = true;
    set_noise_at_rest(set.motions, own, found.jitter_s);
    for (std::size_t i = 0; i < set.motions.size(); ++i) {
      TrackedMotion& motion = set.motions[i];
      motion.wider.clear();
      for (std::size_t p = 0; p < motion.x_m.size(); ++p) {
        const std::size_t a = p - std::min<std::size_t>(p, 2), b = std::min(p + 2, motion.x_m.size() - 1);
        const double v = (motion.x_m[b] - motion.x_m[a]) / (times[i][b] - times[i][a]);
        motion.wider.push_back(std::hypot(1.0, found.jitter_s * v / motion.sd_m));
      }
    }
  }
  return any;
}

}  // namespace glidelab::diagnose
