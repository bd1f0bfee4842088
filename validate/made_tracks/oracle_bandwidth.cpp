#include "validate/made_tracks/oracle_bandwidth.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "base/errors.h"
#include "core/math/quantile.h"
#include "core/motion/analyze_motion.h"
#include "core/motion/configurations.h"
#include "core/motion/smoothing/local_polynomial.h"

namespace glidelab::validate {

std::optional<double> true_error(const std::vector<TrueStretch>& stretches, const std::vector<double>& autocovariance,
                                 double bandwidth_s) {
  core::RowVariance variance(autocovariance);
  double sum = 0.0;
  std::size_t points = 0;
  for (const TrueStretch& stretch : stretches) {
    if (stretch.t_s.size() < 2) continue;
    const core::LocalCubic cubic(stretch.t_s, bandwidth_s);
    const double margin = 0.1 * (stretch.t_s.back() - stretch.t_s.front());
    for (std::size_t j = 0; j < stretch.t_s.size(); ++j) {
      if (stretch.t_s[j] < stretch.t_s.front() + margin || stretch.t_s[j] > stretch.t_s.back() - margin) continue;
      const auto row = cubic.row_of_point(j);
      if (!row) return {};
      const double bias = core::weighted_sums(*row, stretch.x_m).a_m_s2 - stretch.a_m_s2[j];
      sum += bias * bias + variance.of_a(*row);
      ++points;
    }
  }
  if (points == 0) return {};
  return sum / static_cast<double>(points);
}

std::optional<OracleBandwidth> best_bandwidth(const std::vector<TrueStretch>& stretches,
                                              const std::vector<double>& autocovariance) {
  double longest = 0.0, step = 0.0;
  for (const TrueStretch& stretch : stretches) {
    if (stretch.t_s.size() < 2) continue;
    longest = std::max(longest, stretch.t_s.back() - stretch.t_s.front());
    step = std::max(step, core::median_step(stretch.t_s));
  }
  std::optional<OracleBandwidth> best;
  const auto search = [&](double from, double to, double ratio) {
    for (double h = from; h > 0.0 && h <= to; h *= ratio) {
      const auto error = true_error(stretches, autocovariance, h);
      if (error && (!best || *error < best->mean_square_m2_s4)) best = OracleBandwidth{h, *error};
    }
  };
  search(1.2 * step, 0.2 * longest, 1.1);
  for (const double ratio : {1.01, 1.001}) {
    if (!best) break;
    const double reach = ratio == 1.01 ? 1.1 : 1.01, centre = best->bandwidth_s;
    search(std::max(1.2 * step, centre / reach), std::min(0.2 * longest, centre * reach), ratio);
  }
  return best;
}

core::AnalysisResults with_best_bandwidths(const MadeTracks& made) {
  core::AnalysisResults results;
  results.gravity_m_s2 = made.gravity_m_s2;
  for (std::size_t c = 0; c < made.tracks.size(); ++c) {
    const core::ClipResult first = core::analyze_motion(made.setups[c], made.tracks[c], core::MotionOptions{});
    const TrueClip& truth = made.truth.clips[c];
    std::vector<TrueStretch> stretches;
    for (const core::Stretch& stretch : first.stretches) {
      const auto from = std::lower_bound(truth.t_s.begin(), truth.t_s.end(), stretch.from_s) - truth.t_s.begin();
      const auto to = std::upper_bound(truth.t_s.begin(), truth.t_s.end(), stretch.to_s) - truth.t_s.begin();
      const auto part = [&](const std::vector<double>& values) {
        return std::span(values).subspan(static_cast<std::size_t>(from), static_cast<std::size_t>(to - from));
      };
      stretches.push_back({part(truth.t_s), part(truth.x_m), part(truth.a_m_s2)});
    }
    const auto best = best_bandwidth(stretches, first.noise_autocovariance_m2);
    if (!best) throw base::NumericalError("clip \"" + truth.name + "\": too short for a best possible bandwidth");
    core::ClipResult clip =
        core::analyze_motion(made.setups[c], made.tracks[c], core::MotionOptions{.bandwidth_s = best->bandwidth_s});
    clip.bandwidth_method = core::chosen_by::Truth{};
    results.clips.push_back(std::move(clip));
  }
  results.configurations = core::configurations_of_clips(made.setups, results.clips, made.gravity_m_s2);
  return results;
}

std::optional<double> acceleration_error_m_s2(const core::ClipResult& clip, const TrueClip& truth) {
  assert(clip.motion.size() == truth.a_m_s2.size());
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t k = 0; k < clip.motion.size(); ++k) {
    const core::MotionPoint& point = clip.motion[k];
    if (!point.smoothed || point.left_out != core::LeftOut::used) continue;
    const double error = point.a_m_s2 - truth.a_m_s2[k];
    sum += error * error;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(sum / static_cast<double>(count));
}

}  // namespace glidelab::validate
