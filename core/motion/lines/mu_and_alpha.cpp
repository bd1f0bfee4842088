#include "core/motion/lines/mu_and_alpha.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>
#include <vector>

#include "base/math/angles.h"
#include "core/motion/lines/line_fit.h"
#include "core/result/estimate.h"

namespace glidelab::core {
namespace {

/// A combination of both lines' coefficients: its gradient in one line, and that line.
struct OfLine {
  LineShift gradient;
  const LineFit* line;
};

/// The variance of a combination of lines: the random part with its degrees of freedom, and with what the lines share.
struct CombinedVariance {
  KnownVariance random;
  double total = 0.0;
};

/// Errors that lines share add up with their signs, and so does the scatter of the clips that they share.
CombinedVariance combined(const std::vector<OfLine>& lines) {
  KnownVariance own{0.0, std::numeric_limits<double>::infinity()}, of_clips = own;
  double explained = 0.0;  // of the clips' scatter, by the noise of the lines that have one
  std::vector<double> clips, shared;
  const auto add = [](const LineShift& gradient, const std::vector<LineShift>& shifts, std::vector<double>& sums) {
    if (sums.size() < shifts.size()) sums.resize(shifts.size(), 0.0);
    for (std::size_t i = 0; i < shifts.size(); ++i) sums[i] += gradient.k * shifts[i].k + gradient.a0 * shifts[i].a0;
  };
  for (const auto& [gradient, line] : lines) {
    const LineUncertainty& parts = line->parts;
    const double of_line = gradient.k * gradient.k * parts.var_k + gradient.a0 * gradient.a0 * parts.var_a0 +
                           2.0 * gradient.k * gradient.a0 * parts.cov;
    own.value += of_line;
    own.degrees = std::min(own.degrees, parts.degrees);
    if (!parts.clips.empty()) {
      of_clips.degrees = std::min(of_clips.degrees, parts.clip_degrees);
      explained += of_line;
    }
    add(gradient, parts.clips, clips);
    add(gradient, shared_shifts(*line), shared);
  }
  if (lines.size() == 2) {
    const LineShift &one = lines[0].gradient, &other = lines[1].gradient;
    const LineCross& cross = lines[0].line->parts.with_other;
    const double both = 2.0 * (one.k * (other.k * cross.k_k + other.a0 * cross.k_a0) +
                               one.a0 * (other.k * cross.a0_k + other.a0 * cross.a0_a0));
    own.value = std::max(0.0, own.value + both);
    if (!lines[0].line->parts.clips.empty() && !lines[1].line->parts.clips.empty()) explained += both;
  }
  for (const double sum : clips) of_clips.value += sum * sum;
  of_clips.value = std::max(0.0, of_clips.value - explained);
  CombinedVariance made{sum_of(own, of_clips), 0.0};
  made.total = made.random.value;
  for (const double sum : shared) made.total += sum * sum;
  return made;
}

/// What two lines whose slopes differ by more than three standard deviations leave unexplained, as a variance of each
/// slope; 0 for others.
double unexplained_of_slope(const LineFit& one, const LineFit& other) {
  const double apart = one.k_over_m_1_s.value - other.k_over_m_1_s.value;
  // Lines smoothed together may have one K/m but for rounding: a hundredth of their deviations is no difference.
  const double rounding = 1e-4 * (one.parts.var_k + other.parts.var_k);
  const double allowed = combined({{{1.0, 0.0}, &one}, {{-1.0, 0.0}, &other}}).total + rounding;
  return apart * apart > 9.0 * allowed ? 0.5 * (apart * apart - allowed) : 0.0;
}

/// How an intercept goes with its slope: a line is known best at the mean speed of its points.
double intercept_per_slope(const LineFit& line) {
  return line.parts.var_k > 0.0 ? line.parts.cov / line.parts.var_k : 0.0;
}

/// A quantity with the gradient (by_minus, by_plus) in (a0-, a0+), and its change for one standard deviation of
/// gravity.
Quantity of_intercepts(double value, double by_minus, double by_plus, double of_gravity, const LineFit& minus,
                       const LineFit& plus) {
  const auto [noise, total] = combined({{{0.0, by_minus}, &minus}, {{0.0, by_plus}, &plus}});
  const double by_slopes =
      std::pow(by_minus * intercept_per_slope(minus), 2) + std::pow(by_plus * intercept_per_slope(plus), 2);
  const KnownVariance random = sum_of(noise, {by_slopes * unexplained_of_slope(minus, plus), 1.0});
  return determined(estimate(value, random, total - noise.value + of_gravity * of_gravity), std::sqrt(random.value));
}

}  // namespace

Quantity mean_k(const std::vector<LineFit>& lines) {
  if (lines.empty()) return undetermined(unknown::NoLine{});
  const double between = lines.size() == 2 ? unexplained_of_slope(lines[0], lines[1]) : 0.0;
  std::vector<double> weights;
  double sum = 0.0, value = 0.0;
  for (const LineFit& line : lines) {
    // Noise-free points weigh the same.
    weights.push_back(1.0 / std::max(random_variance(line, {1.0, 0.0}).value + between, 1e-30));
    sum += weights.back();
    value += weights.back() * line.k_over_m_1_s.value;
  }
  std::vector<OfLine> mean;
  double squares = 0.0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    mean.push_back({{weights[i] / sum, 0.0}, &lines[i]});
    squares += weights[i] * weights[i] / (sum * sum);
  }
  const CombinedVariance variance = combined(mean);
  const KnownVariance random = sum_of(variance.random, {squares * between, 1.0});
  const double shared = variance.total - variance.random.value;
  return determined(estimate(value / sum, random, shared), std::sqrt(random.value));
}

MuAndAlpha mu_and_alpha_of_intercepts(const LineFit& minus, const LineFit& plus, const Gravity& gravity) {
  const double mean = 0.5 * (minus.a0_m_s2.value + plus.a0_m_s2.value);
  const double half_jump = 0.5 * (minus.a0_m_s2.value - plus.a0_m_s2.value);
  if (std::abs(mean) >= gravity.m_s2) {
    const Quantity none = undetermined(unknown::MeanBeyondGravity{mean});
    return {none, none};
  }
  const double alpha = std::asin(mean / gravity.m_s2);
  const double g_cos = gravity.m_s2 * std::cos(alpha);
  const double by_mean = base::kDegreesPerRad / g_cos, by_gravity = -by_mean * mean / gravity.m_s2;
  MuAndAlpha found;
  found.alpha_deg = of_intercepts(alpha * base::kDegreesPerRad, 0.5 * by_mean, 0.5 * by_mean,
                                  by_gravity * gravity.sd_m_s2, minus, plus);
  // mu = half_jump / sqrt(g^2 - mean^2)
  const double by_jump = 1.0 / g_cos, mu_by_mean = half_jump * mean / std::pow(g_cos, 3);
  const double mu_by_gravity = -half_jump * gravity.m_s2 / std::pow(g_cos, 3);
  found.mu = of_intercepts(half_jump / g_cos, 0.5 * (mu_by_mean + by_jump), 0.5 * (mu_by_mean - by_jump),
                           mu_by_gravity * gravity.sd_m_s2, minus, plus);
  return found;
}

namespace {

constexpr double kVertical_deg = 90.0, kClearOfVertical = 5.0;  // standard deviations

bool has_normal_force(const ConfigurationResult& stated, double sd_deg) {
  return std::abs(stated.incline_deg) + kClearOfVertical * sd_deg < kVertical_deg;
}

}  // namespace

std::optional<MuOfOneDirection> mu_of_one_direction(const ConfigurationResult& stated, int direction, double a0_m_s2,
                                                    double gravity_m_s2) {
  if (stated.incline_assumed || !(stated.incline_sd_deg.value_or(0.0) > 0.0)) return std::nullopt;
  if (!has_normal_force(stated, *stated.incline_sd_deg)) return std::nullopt;
  const double alpha = stated.incline_deg * base::kRadPerDegree;
  const double sine = std::sin(alpha), cosine = std::cos(alpha), over_g = a0_m_s2 / gravity_m_s2;
  MuOfOneDirection mu;
  mu.value = direction * (sine - over_g) / cosine;
  mu.by_a0 = -direction / (gravity_m_s2 * cosine);
  mu.of_incline = direction * (1.0 - over_g * sine) / (cosine * cosine) * *stated.incline_sd_deg * base::kRadPerDegree;
  mu.by_gravity = direction * over_g / (gravity_m_s2 * cosine);
  return mu;
}

bool incline_would_do(const ConfigurationResult& configuration) {
  const bool stated = !configuration.incline_assumed && configuration.incline_sd_deg.value_or(0.0) > 0.0;
  return !stated && has_normal_force(configuration, 0.0);
}

Quantity mu_of_line(const LineFit& line, const Gravity& gravity, const ConfigurationResult& stated) {
  const double a0 = line.a0_m_s2.value;
  const auto mu = mu_of_one_direction(stated, line.direction, a0, gravity.m_s2);
  if (!mu) {
    return undetermined(unknown::NotBothLines{
        .minus = line.direction > 0, .plus = line.direction < 0, .incline_would_do = incline_would_do(stated)});
  }
  const auto [random, total] = combined({{{0.0, mu->by_a0}, &line}});
  const double known = mu->of_incline * mu->of_incline + std::pow(mu->by_gravity * gravity.sd_m_s2, 2);
  return determined(estimate(mu->value, random, total - random.value + known), std::sqrt(random.value));
}

namespace {

template <typename Kind>
void erase_notes(std::vector<Note>& notes) {
  std::erase_if(notes, [](const Note& note) { return std::holds_alternative<Kind>(note); });
}

}  // namespace

void note_mu_from_incline(ConfigurationResult& configuration) {
  erase_notes<MuFromIncline>(configuration.notes);
  if (!configuration.mu.estimate || configuration.alpha_deg.estimate || !configuration.incline_sd_deg) return;
  configuration.notes.emplace_back(MuFromIncline{configuration.incline_deg, *configuration.incline_sd_deg});
}

void note_gravity(AnalysisResults& results) {
  for (ConfigurationResult& configuration : results.configurations) erase_notes<GravityAssumed>(configuration.notes);
  if (results.gravity_sd_m_s2 < kLocalGravity_sd_m_s2) return;  // the place is known
  for (ConfigurationResult& configuration : results.configurations) {
    if (!configuration.mu.estimate && !configuration.alpha_deg.estimate) continue;
    configuration.notes.emplace_back(GravityAssumed{results.gravity_m_s2, results.gravity_sd_m_s2});
    return;
  }
}

}  // namespace glidelab::core
