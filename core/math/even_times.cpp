#include "core/math/even_times.h"

#include <algorithm>
#include <cmath>

#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kFewestStamps = 20;
constexpr double kContainer_s = 2e-6;  // stamps are stored to a microsecond or better,
constexpr double kTable_s = 2e-9;      // and decimal fractions of up to eight places exactly
constexpr int kFewestDigits = 3, kMostDigits = 6;
constexpr double kMostSpreadOverTick = 1.05;    // allowed spread over a tick: exposures may jitter slightly
constexpr double kLongestStepOverMedian = 1.5;  // of the median step: a longer step may contain a missing frame
constexpr double kLeastTicks = 1.5;             // per step: with fewer, one tick more or less could be a frame
constexpr int kHalvings = 60;                   // of an interval, to the last bit

/// The longest step of which both are whole multiples, within `resolution`.
double common_step(double a, double b, double resolution) {
  while (b > resolution) {
    const double rest = std::abs(a - b * std::round(a / b));
    a = b;
    b = rest;
  }
  return a;
}

/// The unit of the last digit of the time farthest from 0, if all times have the same number of significant digits;
/// otherwise 0.
double last_significant_digit(std::span<const double> stamps_s) {
  const auto digit_of = [](double t, int digits) {
    return std::pow(10.0, std::floor(std::log10(std::abs(t)) + 1e-12) - digits + 1);
  };
  for (int digits = kFewestDigits; digits <= kMostDigits; ++digits) {
    const bool all = std::all_of(stamps_s.begin(), stamps_s.end(), [&](double t) {
      const double in_digits = t == 0.0 ? 0.0 : t / digit_of(t, digits);
      return std::abs(in_digits - std::round(in_digits)) < 1e-6;
    });
    if (all) return digit_of(std::max(std::abs(stamps_s.front()), std::abs(stamps_s.back())), digits);
  }
  return 0.0;
}

/// The frame slots of the stamps, for a step of about the mean of the single-frame steps.
std::vector<double> slots_of(const std::vector<double>& steps, double tick_s) {
  const double median_s = quantile(steps, 0.5);
  double sum = 0.0, count = 0.0;
  for (const double step : steps) {
    if (step > kLongestStepOverMedian * median_s) continue;
    sum += step;
    count += 1.0;
  }
  const double usual_s = sum / count;
  if (usual_s < kLeastTicks * tick_s) return {};
  std::vector<double> slots{0.0};
  for (const double step : steps) slots.push_back(slots.back() + std::max(1.0, std::round(step / usual_s)));
  return slots;
}

struct Spread {
  std::span<const double> stamps_s;
  const std::vector<double>& slots;

  /// The spread of stamp - T slot, which is convex in T.
  double operator()(double step_s) const {
    double low = stamps_s[0], high = low;
    for (std::size_t i = 0; i < slots.size(); ++i) {
      const double off = stamps_s[i] - step_s * slots[i];
      low = std::min(low, off);
      high = std::max(high, off);
    }
    return high - low;
  }
};

/// The step at which the spread crosses the limit, between `inside` (at most the limit) and `outside` (above it).
double edge(const Spread& spread, double limit, double inside, double outside) {
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (inside + outside);
    (spread(middle) <= limit ? inside : outside) = middle;
  }
  return inside;
}

std::optional<EvenTimes> even_by_ticks(std::span<const double> stamps_s, const std::vector<double>& steps,
                                       double tick_s) {
  const std::vector<double> slots = slots_of(steps, tick_s);
  if (slots.empty()) return std::nullopt;
  EvenTimes even;
  even.tick_s = tick_s;

  // At the minimum spread the ends are off by no more than two ticks.
  const Spread spread{stamps_s, slots};
  const double mean_s = (stamps_s.back() - stamps_s.front()) / slots.back();
  const double reach_s = 2.0 * even.tick_s / slots.back();
  double low = mean_s - reach_s, high = mean_s + reach_s;
  for (int i = 0; i < 2 * kHalvings; ++i) {
    const double third = (high - low) / 3.0;
    if (spread(low + third) < spread(high - third)) {
      high -= third;
    } else {
      low += third;
    }
  }
  const double best_s = 0.5 * (low + high), least = spread(best_s);
  if (least > kMostSpreadOverTick * even.tick_s) return std::nullopt;
  const double limit = std::max(least, even.tick_s) * (1.0 + 1e-9);
  const double from_s = edge(spread, limit, best_s, best_s - 2.0 * reach_s);
  const double to_s = edge(spread, limit, best_s, best_s + 2.0 * reach_s);
  even.step_s = 0.5 * (from_s + to_s);
  even.half_width_s = 0.5 * (to_s - from_s);
  for (const double slot : slots) even.t_s.push_back(even.step_s * slot);
  return even;
}

}  // namespace

std::optional<EvenTimes> even_times(std::span<const double> stamps_s, StampSource source) {
  if (stamps_s.size() < kFewestStamps) return std::nullopt;
  std::vector<double> steps;
  for (std::size_t i = 1; i < stamps_s.size(); ++i) steps.push_back(stamps_s[i] - stamps_s[i - 1]);
  const auto [shortest, longest] = std::minmax_element(steps.begin(), steps.end());
  const double resolution = source == StampSource::table ? kTable_s : kContainer_s;
  if (*longest - *shortest < resolution) return std::nullopt;
  double tick_s = *shortest;
  for (const double step : steps) tick_s = common_step(tick_s, step, resolution);
  std::optional<EvenTimes> even = even_by_ticks(stamps_s, steps, tick_s);
  if (even || source == StampSource::container) return even;
  const double coarsest = last_significant_digit(stamps_s);
  return coarsest > tick_s ? even_by_ticks(stamps_s, steps, coarsest) : std::nullopt;
}

}  // namespace glidelab::core
