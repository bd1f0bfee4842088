#include "core/motion/free/stretch_noise.h"

#include <algorithm>
#include <cmath>

#include "core/math/least_squares.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kFewestResiduals = 40;
constexpr int kPasses = 4;
constexpr double kLeastShare = 0.1;  // of the mean variance, kept at any speed: a line has no floor of its own

struct Line {
  double a = 0.0, b = 0.0, sd_b = 0.0;
};

/// y = a + b z with var y = 2 (a + b z)^2.
Line fit(const std::vector<double>& z, const std::vector<double>& y, double mean) {
  Line line{mean, 0.0, 0.0};
  for (int pass = 0; pass < kPasses; ++pass) {
    LineSums sums;
    for (std::size_t i = 0; i < z.size(); ++i) {
      const double expected = std::max(line.a + line.b * z[i], kLeastShare * mean);
      sums.add(1.0 / (2.0 * expected * expected), z[i], y[i]);
    }
    if (!sums.is_regular(1e-12)) return {mean, 0.0, 0.0};
    line.b = sums.slope();
    line.a = (sums.y - line.b * sums.x) / sums.w;
    line.sd_b = std::sqrt(sums.w / sums.determinant());
  }
  return line;
}

}  // namespace

std::vector<std::vector<double>> speed_factors(const std::vector<NoisePiece>& pieces) {
  std::vector<double> z, y;
  std::vector<std::vector<std::optional<SmoothedPoint>>> smoothed;
  for (const NoisePiece& piece : pieces) {
    const auto t = piece.cubic->times();
    const double margin = kCompleteKernel * piece.cubic->bandwidth_s();
    smoothed.push_back(piece.cubic->smooth(piece.x_m));
    for (std::size_t j = 0; j < t.size(); ++j) {
      if (t[j] < t.front() + margin || t[j] > t.back() - margin || !smoothed.back()[j]) continue;
      z.push_back(std::pow(smoothed.back()[j]->v_m_s, 2));
      y.push_back(std::pow(piece.x_m[j] - smoothed.back()[j]->x_m, 2));
    }
  }
  if (z.size() < kFewestResiduals) return {};
  double mean = 0.0;
  for (const double square : y) mean += square / static_cast<double>(y.size());
  if (!(mean > 0.0)) return {};
  Line line = fit(z, y, mean);
  if (!(line.b > line.sd_b)) return {};
  double mean_z = 0.0;
  for (const double square : z) mean_z += square / static_cast<double>(z.size());
  const double doubt = line.sd_b * line.sd_b / line.b;
  line.a += doubt * mean_z;
  line.b -= doubt;
  std::vector<std::vector<double>> factors;
  for (const auto& piece : smoothed) {
    factors.emplace_back();
    for (const auto& point : piece) {
      const double v = point ? point->v_m_s : 0.0;
      const double variance = point ? line.a + line.b * v * v : mean;
      factors.back().push_back(std::sqrt(std::max(variance, kLeastShare * mean) / mean));
    }
  }
  return factors;
}

namespace {

/// The stretches with their smoothers.
struct SmoothedStretches {
  std::vector<LocalCubic> cubics;
  std::vector<NoisePiece> pieces;
  SmoothedStretches(const Motion& motion, const std::vector<FreeStretch>& stretches, double bandwidth_s) {
    cubics.reserve(stretches.size());
    for (const FreeStretch& stretch : stretches) {
      cubics.emplace_back(std::span(motion.t_s).subspan(stretch.first, stretch.count), bandwidth_s);
      pieces.push_back({&cubics.back(), std::span(motion.y_m).subspan(stretch.first, stretch.count)});
    }
  }
};

}  // namespace

PositionNoise noise_at(const Motion& motion, const std::vector<FreeStretch>& stretches, double bandwidth_s) {
  PositionNoise noise = estimate_noise(SmoothedStretches(motion, stretches, bandwidth_s).pieces, motion.noise_m);
  const double least_m = coarsest_step(motion.x_m) / std::sqrt(12.0);
  if (noise.sd_m >= least_m) return noise;
  for (double& covariance : noise.autocovariance) covariance *= std::pow(least_m / noise.sd_m, 2);
  noise.sd_m = least_m;
  return noise;
}

std::vector<double> noise_factors(const Motion& motion, const std::vector<FreeStretch>& stretches, double bandwidth_s) {
  if (motion.forced) return {};  // y' is not the speed
  const auto of_stretches = speed_factors(SmoothedStretches(motion, stretches, bandwidth_s).pieces);
  if (of_stretches.empty()) return {};
  std::vector<double> factors(motion.t_s.size(), 1.0);
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    std::copy(of_stretches[s].begin(), of_stretches[s].end(),
              factors.begin() + static_cast<std::ptrdiff_t>(stretches[s].first));
  }
  return factors;
}

std::optional<double> coarse_rounding(const Motion& motion, const PositionNoise& noise) {
  const double step = rounding_step(motion.x_m);
  if (!(step > 0.0) || noise.sd_m > 1.5 * step / std::sqrt(12.0)) return std::nullopt;
  std::size_t repeated = 0;
  for (std::size_t i = 1; i < motion.x_m.size(); ++i) {
    repeated += std::abs(motion.x_m[i] - motion.x_m[i - 1]) < 0.5 * step;
  }
  return 5 * repeated > motion.x_m.size() ? std::optional(step) : std::nullopt;
}

}  // namespace glidelab::core
