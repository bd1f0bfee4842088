#include "core/math/held_values.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

/// The first row of each run of equal values.
std::vector<std::size_t> starts_of_runs(std::span<const double> x) {
  std::vector<std::size_t> starts;
  for (std::size_t row = 0; row < x.size(); ++row) {
    if (row == 0 || x[row] != x[row - 1]) starts.push_back(row);
  }
  return starts;
}

}  // namespace

double common_step(std::span<const double> steps) {
  constexpr double kOff = 0.01;  // of it
  double least = HUGE_VAL;
  for (const double step : steps) {
    if (step != 0.0) least = std::min(least, std::abs(step));
  }
  const bool common =
      std::ranges::all_of(steps, [&](double step) { return std::abs(step / least - std::round(step / least)) < kOff; });
  return common && std::isfinite(least) ? least : 0.0;
}

std::optional<HeldValues> held_values(std::span<const double> x) {
  constexpr std::size_t kFewestRuns = 6;
  constexpr double kFewestRows = 2.0, kMostRuns = 0.6;
  constexpr double kFewestUnits = 1.5;  // whole numbers of them: two or more
  constexpr double kUsualPart = 0.9;
  const std::vector<std::size_t> starts = starts_of_runs(x);
  if (starts.size() < kFewestRuns + 2) return {};
  std::vector<double> rows, steps, sizes;
  for (std::size_t run = 1; run + 1 < starts.size(); ++run) {
    rows.push_back(static_cast<double>(starts[run + 1] - starts[run]));
    steps.push_back(x[starts[run]] - x[starts[run - 1]]);
    sizes.push_back(std::abs(steps.back()));
  }
  const auto long_runs = std::ranges::count_if(rows, [&](double n) { return n >= kFewestRows; });
  if (static_cast<double>(long_runs) < kMostRuns * static_cast<double>(rows.size())) return {};
  if (quantile(std::move(sizes), 0.5) < kFewestUnits * common_step(steps)) return {};
  HeldValues held;
  held.is_held.assign(x.size(), true);
  held.usual = static_cast<std::size_t>(std::lround(quantile(std::move(rows), kUsualPart)));
  held.count = x.size();
  for (std::size_t run = 0; run < starts.size(); ++run) {
    const std::size_t end = run + 1 < starts.size() ? starts[run + 1] : x.size();
    for (std::size_t row = starts[run]; row < end; row += held.usual) {
      if (row > starts[run] && 2 * (end - row) < held.usual) break;  // the next value is only somewhat late
      held.is_held[row] = false;
      --held.count;
    }
  }
  return held;
}

}  // namespace glidelab::core
