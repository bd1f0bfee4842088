#include "core/math/signed_drop.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>

#include "core/math/parabola.h"
#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kHardlyTurns = 0.8;  // of the range of x: distance from the first position to the last
constexpr double kParabola = 0.03;    // of the range of x: rms residual
constexpr double kThrown = 0.7;       // of g
// Stretches of a free flight, of which a body that bounces has several:
constexpr std::size_t kFewestOfStretch = 7;
constexpr double kFlightAccurate = 0.1;  // of g: standard deviation of the acceleration of a stretch
constexpr double kMostInFlight = 1.3;    // of g: a bounce has more

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

/// The direction of the acceleration of nearly g that most stretches have, by the number of stretches; 0 if none has.
/// A stretch with a bounce in it is no parabola, and its scatter leaves its acceleration uncertain.
int direction_of_flights(const std::vector<double>& t_s, const std::vector<double>& x_m, double gravity_m_s2) {
  int direction = 0;
  for (const std::size_t parts : {3, 5, 10, 20, 40}) {
    const std::size_t size = x_m.size() / parts;
    if (size < kFewestOfStretch) break;
    for (std::size_t from = 0; from + size <= x_m.size(); from += size / 2) {
      const auto times = std::span(t_s).subspan(from, size), places = std::span(x_m).subspan(from, size);
      const Parabola parabola = parabola_through(times, places);
      double squares_m2 = 0.0;
      for (std::size_t i = 0; i < size; ++i) squares_m2 += std::pow(places[i] - parabola.at(times[i]), 2);
      // Variance of a by n even points over a time T: 720 s²/(n T⁴).
      const auto n = static_cast<double>(size);
      const double span_s = times.back() - times.front();
      const double sd_m_s2 = std::sqrt(720.0 / n * squares_m2 / (n - 3.0)) / (span_s * span_s);
      const double a = std::abs(parabola.a) / gravity_m_s2;
      if (sd_m_s2 > kFlightAccurate * gravity_m_s2 || a < kThrown || a > kMostInFlight) continue;
      direction += parabola.a > 0.0 ? 1 : -1;
    }
  }
  return direction;
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
  const int flights = direction_of_flights(t_s, smooth_m, gravity_m_s2);
  if (flights != 0) return flights > 0 ? range_m : -range_m;
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

std::optional<std::size_t> lost_sign_at(std::span<const double> v) {
  constexpr double kDip = 0.3, kNearZero = 0.05;  // of the lower of the highest speeds before and after
  constexpr double kSlowReturn = 0.2;             // of kDip of the highest: a glider may return far more slowly
  constexpr double kMostNearZero = 0.4;  // of the dip: a V has a sixth of its points below a sixth of its height
  if (v.empty() || *std::min_element(v.begin(), v.end()) < 0.0) return {};
  // The lowest between the first and the last speed that is fast: a rest at either end is no dip.
  const double fast = kDip * *std::max_element(v.begin(), v.end());
  const auto moves = [&](double one) { return one > kSlowReturn * fast; };
  const auto first = std::find_if(v.begin(), v.end(), moves);
  const auto last = std::find_if(v.rbegin(), v.rend(), moves).base();
  if (first >= last) return {};
  const auto lowest = std::min_element(first, last);
  if (lowest == first) return {};
  const double height = std::min(*std::max_element(v.begin(), lowest), *std::max_element(lowest, v.end()));
  if (*lowest > kNearZero * height) return {};
  const auto is_out = [&](double one) { return one > kDip * height; };
  const auto from = std::find_if(std::make_reverse_iterator(lowest), v.rend(), is_out).base();
  const auto to = std::find_if(lowest, v.end(), is_out);
  const auto near_zero = std::count_if(from, to, [&](double one) { return one <= kNearZero * height; });
  if (to == v.end() || static_cast<double>(near_zero) > kMostNearZero * static_cast<double>(to - from)) return {};
  return static_cast<std::size_t>(lowest - v.begin());
}

}  // namespace glidelab::core
