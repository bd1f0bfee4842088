#include "validate/study/coverage/naive_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/math/angles.h"
#include "core/math/quantile.h"
#include "core/motion/smoothing/local_polynomial.h"

namespace glidelab::validate {
namespace {

struct Line {
  double k = 0.0, a0 = 0.0;
  double var_k = 0.0, var_a0 = 0.0, cov = 0.0;
  double n = 0.0, r2 = 0.0;
};

/// a = a0 - k v through the points used by the analysis; s² from the residuals, with independent errors in a only.
std::optional<Line> line_of(const std::vector<core::ClipResult>& all, const std::vector<std::string>& names,
                            int direction) {
  double n = 0.0, sum_v = 0.0, sum_a = 0.0, sum_vv = 0.0, sum_va = 0.0, sum_aa = 0.0;
  for (const core::ClipResult& clip : all) {
    if (std::find(names.begin(), names.end(), clip.name) == names.end()) continue;
    for (const core::MotionPoint& point : clip.motion) {
      if (point.left_out != core::LeftOut::used || !(point.v_m_s * direction > 0.0)) continue;
      n += 1.0;
      sum_v += point.v_m_s;
      sum_a += point.a_m_s2;
      sum_vv += point.v_m_s * point.v_m_s;
      sum_va += point.v_m_s * point.a_m_s2;
      sum_aa += point.a_m_s2 * point.a_m_s2;
    }
  }
  const double spread = sum_vv - sum_v * sum_v / n;
  if (n < 3.0 || !(spread > 0.0)) return std::nullopt;
  const double together = sum_va - sum_v * sum_a / n;
  Line line;
  line.k = -together / spread;
  line.a0 = sum_a / n + line.k * sum_v / n;
  const double left = sum_aa - sum_a * sum_a / n - together * together / spread;
  const double variance = std::max(left, 0.0) / (n - 2.0);
  line.var_k = variance / spread;
  line.var_a0 = variance * sum_vv / (n * spread);
  line.cov = variance * sum_v / (n * spread);
  line.n = n;
  line.r2 = 1.0 - std::max(left, 0.0) / (sum_aa - sum_a * sum_a / n);
  return line;
}

core::Quantity interval(double value, double variance) {
  const double sd = std::sqrt(variance);
  return {core::Estimate{value, sd, value - core::kNormal95 * sd, value + core::kNormal95 * sd}, {}};
}

core::Quantity nothing(core::AnyReason why) {
  return {std::nullopt, core::WhyUnknown{std::move(why)}};
}

core::Quantity limit_of(const std::optional<Line>& line) {
  if (!line) return nothing(core::unknown::NoDownhillLine{});
  if (!(line->k > 0.0)) return nothing(core::unknown::RateNotPositive{.of_line = true});
  if (!(line->a0 > 0.0)) return nothing(core::unknown::InterceptNotPositive{});
  const double by_k = -line->a0 / (line->k * line->k), by_a0 = 1.0 / line->k;
  return interval(line->a0 / line->k,
                  by_k * by_k * line->var_k + by_a0 * by_a0 * line->var_a0 + 2.0 * by_k * by_a0 * line->cov);
}

}  // namespace

core::AnalysisResults with_naive_lines(core::AnalysisResults results) {
  results.estimator = kNaiveLines;
  const double g = results.gravity_m_s2;
  for (core::ConfigurationResult& configuration : results.configurations) {
    const std::optional<Line> minus = line_of(results.clips, configuration.clips, -1);
    const std::optional<Line> plus = line_of(results.clips, configuration.clips, 1);
    configuration.k_over_m_1_s = configuration.mu = configuration.alpha_deg = nothing(core::unknown::NoLine{});
    configuration.v_lim_m_s = limit_of(plus);
    if (!minus && !plus) continue;
    if (!minus || !plus) {
      const Line& only = minus ? *minus : *plus;
      configuration.k_over_m_1_s = interval(only.k, only.var_k);
      configuration.mu = configuration.alpha_deg = nothing(core::unknown::NotBothLines{!minus, !plus});
      continue;
    }
    const double weight = 1.0 / minus->var_k + 1.0 / plus->var_k;
    configuration.k_over_m_1_s = interval((minus->k / minus->var_k + plus->k / plus->var_k) / weight, 1.0 / weight);
    // The paper's equation (13): the half sum of the intercepts is g sin(alpha), the half difference mu g cos(alpha).
    const double drive = 0.5 * (minus->a0 + plus->a0), friction = 0.5 * (minus->a0 - plus->a0);
    const double variance = 0.25 * (minus->var_a0 + plus->var_a0);
    if (!(std::abs(drive) < g)) {
      configuration.mu = configuration.alpha_deg = nothing(core::unknown::MeanBeyondGravity{drive});
      continue;
    }
    const double level = std::sqrt(g * g - drive * drive);
    configuration.alpha_deg =
        interval(std::asin(drive / g) * base::kDegreesPerRad, variance * std::pow(base::kDegreesPerRad / level, 2));
    configuration.mu = interval(friction / level, variance / (level * level));
  }
  return results;
}

core::AnalysisResults lines_through_all_points(const MadeTracks& made, double bandwidth_s) {
  core::AnalysisResults results;
  results.gravity_m_s2 = made.gravity_m_s2;
  for (std::size_t c = 0; c < made.tracks.size(); ++c) {
    const core::TrackData& track = made.tracks[c];
    core::ClipResult clip;
    clip.name = made.setups[c].name;
    clip.frames = track.frame_t_s.size();
    clip.detected = track.t_s.size();
    clip.frame_rate_hz = track.frame_rate_hz;
    clip.bandwidth_s = bandwidth_s;
    clip.bandwidth_method = core::chosen_by::User{};
    clip.motion.resize(clip.frames);
    for (core::MotionPoint& point : clip.motion) point.left_out = core::LeftOut::no_marker;
    const core::LocalCubic cubic(track.t_s, bandwidth_s);
    for (std::size_t i = 0; i < track.t_s.size(); ++i) {
      const auto row = cubic.row_of_point(i);
      if (!row) {
        throw base::NumericalError(fmt::format("clip \"{}\": a kernel of {} s holds too few points at {} s", clip.name,
                                               bandwidth_s, track.t_s[i]));
      }
      const auto sums = core::weighted_sums(*row, track.x_m);
      core::MotionPoint& point = clip.motion[track.frame[i]];
      point = {.t_s = track.t_s[i],
               .measured_m = track.x_m[i],
               .x_m = sums.x_m,
               .v_m_s = sums.v_m_s,
               .a_m_s2 = sums.a_m_s2,
               .smoothed = true};
    }
    const std::vector<core::ClipResult> alone = {clip};
    for (const int direction : {-1, 1}) {
      const std::optional<Line> line = line_of(alone, {clip.name}, direction);
      if (!line) continue;
      core::LineFit fit;
      fit.direction = direction;
      fit.points = static_cast<std::size_t>(line->n);
      fit.k_over_m_1_s = *interval(line->k, line->var_k).estimate;
      fit.a0_m_s2 = *interval(line->a0, line->var_a0).estimate;
      fit.covariance = line->cov;
      fit.r2 = line->r2;
      clip.segments.push_back(fit);
    }
    results.clips.push_back(std::move(clip));
  }
  for (const TrueConfiguration& configuration : made.truth.configurations) {
    core::ConfigurationResult result;
    result.mass_kg = configuration.mass_kg;
    result.incline_deg = configuration.stated_incline_deg;
    result.group = configuration.group;
    result.clips = configuration.clips;
    results.configurations.push_back(std::move(result));
  }
  results = with_naive_lines(std::move(results));
  results.estimator = kAllPoints;
  return results;
}

}  // namespace glidelab::validate
