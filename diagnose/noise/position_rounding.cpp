#include "diagnose/noise/position_rounding.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace glidelab::diagnose {
namespace {

constexpr double kWhole = 1e-3;           // of a step: how far a multiple of it may lie off
constexpr double kSame = 1e-7;            // of the range: what a number of eight digits errs by
constexpr std::size_t kFewestValues = 6;  // whose differences are whole by chance once in 1e10
constexpr double kOfNoise = 1.0 / 3.0;    // a smaller step is lost in the noise
constexpr double kNothing = 0.1;          // of the least step: a remainder below is none

/// Euclid's common divisor of a and b; what is left is nothing below `nothing`.
double common_divisor(double a, double b, double nothing) {
  while (b > nothing) {
    const double rest = std::abs(a - std::round(a / b) * b);
    a = std::exchange(b, rest);
  }
  return a;
}

}  // namespace

std::optional<double> rounding_step_m(const TrackedMotion& motion) {
  std::vector<double> x = motion.x_m;
  std::sort(x.begin(), x.end());
  if (x.empty()) return {};
  const double same = kSame * (x.back() - x.front()), least = std::max(kOfNoise * motion.sd_m, 10.0 * same);
  std::vector<double> off;  // of different positions from the least one, the least itself left out
  for (const double one : x) {
    if (one - x.front() > (off.empty() ? 0.0 : off.back()) + same) off.push_back(one - x.front());
  }
  if (off.size() + 1 < kFewestValues) return {};
  double step = off.front();
  for (const double one : off) {
    const double rest = std::abs(one - std::round(one / step) * step);
    step = rest > kNothing * least ? common_divisor(step, rest, kNothing * least) : one / std::round(one / step);
    if (step < (1.0 - kWhole) * least) return {};
  }
  for (const double one : off) {  // made finer by each multiple, from the smallest on
    const double times = std::round(one / step);
    if (!(times > 0.0) || std::abs(one - times * step) > kWhole * step) return {};
    step = one / times;
  }
  return step;
}

std::optional<double> rounding_step_m(const TrackSet& set) {
  std::optional<double> largest;
  for (const TrackedMotion& motion : set.motions) {
    const std::optional<double> step = rounding_step_m(motion);
    if (!step) return {};
    largest = std::max(largest.value_or(0.0), *step);
  }
  return largest;
}

}  // namespace glidelab::diagnose
