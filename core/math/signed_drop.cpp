#include "core/math/signed_drop.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/math/parabola.h"
#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kHardlyTurns = 0.8;  // of the range of x: distance from the first position to the last
constexpr double kParabola = 0.03;    // of the range of x: rms residual
constexpr double kThrown = 0.7;       // of g

/// The positions without jumps to wrong echoes, or to where a tracker lost the object: no step is longer than a few
/// times the long ones. Only the direction of the motion is read from them.
std::vector<double> without_jumps(const std::vector<double>& x_m) {
  constexpr double kJump = 4.0, kLongStep = 0.8;  // times the quantile of the steps
  std::vector<double> steps;
  for (std::size_t i = 1; i < x_m.size(); ++i) steps.push_back(std::abs(x_m[i] - x_m[i - 1]));
  const double longest = kJump * quantile(steps, kLongStep);
  if (!(longest > 0.0)) return x_m;
  std::vector<double> smooth = {0.0};
  for (std::size_t i = 1; i < x_m.size(); ++i) {
    smooth.push_back(smooth.back() + std::clamp(x_m[i] - x_m[i - 1], -longest, longest));
  }
  return smooth;
}

}  // namespace

double signed_drop(const std::vector<double>& t_s, const std::vector<double>& x_m, double gravity_m_s2) {
  const std::vector<double> smooth_m = without_jumps(x_m);
  const auto [low, high] = std::minmax_element(smooth_m.begin(), smooth_m.end());
  const double range_m = *high - *low, displacement_m = smooth_m.back() - smooth_m.front();
  const Parabola parabola = parabola_through(t_s, smooth_m);
  double squares_m2 = 0.0;
  for (std::size_t i = 0; i < smooth_m.size(); ++i) squares_m2 += std::pow(smooth_m[i] - parabola.at(t_s[i]), 2);
  const bool follows = squares_m2 <= std::pow(kParabola * range_m, 2) * static_cast<double>(smooth_m.size());
  if (follows && std::abs(parabola.a) >= kThrown * gravity_m_s2) return std::copysign(range_m, parabola.a);
  if (std::abs(displacement_m) >= kHardlyTurns * range_m) return displacement_m;
  // From the positions at both ends and at the middle of the time: the direction of the acceleration.
  const double middle_s = 0.5 * (t_s.front() + t_s.back());
  const auto at = static_cast<std::size_t>(std::lower_bound(t_s.begin(), t_s.end(), middle_s) - t_s.begin());
  return smooth_m.front() + smooth_m.back() - 2.0 * smooth_m[at];
}

double signed_speed(const std::vector<double>& v_m_s) {
  double sum = 0.0, size = 0.0;
  for (const double v : v_m_s) {
    sum += v;
    size += std::abs(v);
  }
  return std::abs(sum) < kHardlyTurns * size ? v_m_s.back() - v_m_s.front() : sum;
}

}  // namespace glidelab::core
