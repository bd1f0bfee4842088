#include "core/motion/steady_fall.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

#include "base/math/angles.h"
#include "base/math/dense.h"
#include "core/experiment/clip_setup.h"
#include "core/math/parabola.h"
#include "core/motion/lines/line_fit.h"
#include "core/result/estimate.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kFewestOfSteady = 5;
constexpr double kSteady = 0.1;    // of g: the next term of v_lim, (a/g)², is then below half of the laws' difference
constexpr double kConstant = 0.1;  // of the speed: its change from the first position to the last
constexpr double kSds = 2.0;
constexpr double kApproaches = 4.0;  // times v/g: of 1 - v/v_lim, an approach then leaves a fiftieth or less

struct Measured {
  double value = 0.0, variance = 0.0;
  double by_law = 0.0;  ///< half of the difference between the two laws of drag, common to all clips
};

/// Whether the body moves freely there. A parabola through positions needs no kernel, so that points count whose
/// kernel reaches too far or holds too few frames.
bool is_free(LeftOut reason) {
  switch (reason) {
    case LeftOut::used:
    case LeftOut::kernel_end:
    case LeftOut::kernel_reversal:
    case LeftOut::kernel_gap:
    case LeftOut::short_stretch:
      return true;
    default:
      return false;
  }
}

/// Of the parabola's v and a, per variance of one position.
struct Variances {
  double v = 0.0, a = 0.0;
};

/// Exact for any times: in a clip with gaps, most points may lie at its ends.
Variances variances_at(const std::vector<double>& t_s, double middle_s) {
  const double half_s = 0.5 * (t_s.back() - t_s.front());
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  for (const double at_s : t_s) {
    const double u = (at_s - middle_s) / half_s;
    const Eigen::Vector3d row(1.0, u, 0.5 * u * u);
    normal += row * row.transpose();
  }
  const Eigen::MatrixXd inverse = base::inverse_positive(normal);
  return {inverse(1, 1) / (half_s * half_s), inverse(2, 2) / std::pow(half_s, 4)};
}

/// v_lim of one clip; empty if it does not fall at a constant speed.
std::optional<Measured> steady_speed(const ClipResult& clip, double gravity_m_s2) {
  std::vector<double> t_s, x_m;
  for (const MotionPoint& point : clip.motion) {
    if (!is_free(point.left_out) || !point.measured_m) continue;
    t_s.push_back(point.t_s);
    x_m.push_back(*point.measured_m);
  }
  if (t_s.size() < kFewestOfSteady) return {};
  const Parabola parabola = parabola_through(t_s, x_m);
  const auto n = static_cast<double>(t_s.size());
  double squares = 0.0;
  for (std::size_t i = 0; i < t_s.size(); ++i) squares += std::pow(x_m[i] - parabola.at(t_s[i]), 2);
  const double noise2 = std::max(std::pow(clip.position_noise_m, 2), squares / (n - 3.0));
  const double span_s = t_s.back() - t_s.front();
  const Variances of_one = variances_at(t_s, parabola.middle_s);
  const double var_v = of_one.v * noise2, var_a = of_one.a * noise2;
  const double v = parabola.v, by_g = parabola.a / gravity_m_s2, sd_by_g = std::sqrt(var_a) / gravity_m_s2;
  if (!(v > 0.0) || !(std::abs(by_g) + kSds * sd_by_g < kSteady)) return {};
  // A liquid drives a body by far less than its weight, so that a small part of g may still change its speed.
  const double gained = std::abs(parabola.a) * span_s;
  const bool gains = std::abs(by_g) > kSds * sd_by_g;
  if (gains && gained > kConstant * v) return {};
  Measured speed{v * (1.0 + 0.75 * by_g), var_v + std::pow(0.75 * v * sd_by_g, 2), 0.25 * v * by_g};
  // An approach to v_lim ends within a few v/g. What lasts longer is another cause, at one end or the other.
  if (gains && span_s > kApproaches * v / gravity_m_s2) speed.variance += std::pow(0.5 * gained, 2);
  return speed.variance > 0.0 ? std::optional(speed) : std::nullopt;
}

std::optional<Quantity> steady_fall(const std::vector<const ClipResult*>& clips, double gravity_m_s2) {
  double weights = 0.0, sum = 0.0, scale = 0.0, by_law = 0.0;
  std::vector<Measured> speeds;
  for (const ClipResult* clip : clips) {
    const std::optional<Measured> speed = steady_speed(*clip, gravity_m_s2);
    if (!speed) return {};
    speeds.push_back(*speed);
    weights += 1.0 / speed->variance;
    sum += speed->value / speed->variance;
    by_law += speed->by_law / speed->variance;
    scale = std::max(scale, clip->scale_sd_relative);
  }
  if (speeds.empty()) return {};
  const double mean = sum / weights, degrees = static_cast<double>(speeds.size()) - 1.0;
  double chi2 = 0.0;
  for (const Measured& speed : speeds) chi2 += std::pow(speed.value - mean, 2) / speed.variance;
  KnownVariance random{1.0 / weights, std::numeric_limits<double>::infinity()};
  if (degrees > 0.0 && chi2 > degrees * chi2_ratio_limit(degrees)) random = {chi2 / degrees / weights, degrees};
  const double of_scale = std::hypot(scale, kClockSdRelative) * mean, of_law = by_law / weights;
  return determined(estimate(mean, random, of_scale * of_scale + of_law * of_law), std::sqrt(random.value));
}

}  // namespace

void add_steady_falls(const std::vector<ClipResult>& clips, double gravity_m_s2,
                      std::vector<ConfigurationResult>& configurations) {
  for (ConfigurationResult& configuration : configurations) {
    std::erase_if(configuration.notes, [](const Note& note) { return std::holds_alternative<SteadyFall>(note); });
    if (configuration.v_lim_m_s.estimate || !is_fall(configuration.incline_deg * base::kRadPerDegree)) continue;
    std::vector<const ClipResult*> members;
    for (const ClipResult& clip : clips) {
      const auto& names = configuration.clips;
      if (std::find(names.begin(), names.end(), clip.name) != names.end()) members.push_back(&clip);
    }
    const std::optional<Quantity> speed = steady_fall(members, gravity_m_s2);
    if (!speed) continue;
    configuration.v_lim_m_s = *speed;
    configuration.notes.emplace_back(SteadyFall{members.size()});
  }
}

}  // namespace glidelab::core
