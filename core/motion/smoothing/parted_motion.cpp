#include "core/motion/smoothing/parted_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

namespace glidelab::core {
namespace {

/// Size of a derivative at a start, in units of range d! / longest^d: an exponential of a few e-folds has about 4.
constexpr double kSize = 5.0;

template <int N>
std::optional<double> turn_near(const ChainPosterior<N>& posterior, double near_s) {
  std::optional<double> nearest;
  for (std::size_t k = 1; k < posterior.size(); ++k) {
    const double before = posterior.mean(k - 1)[1], after = posterior.mean(k)[1];
    if (before * after > 0.0 || before == after) continue;
    const double from = posterior.node(k - 1).t_s, to = posterior.node(k).t_s;
    const double at = from + (to - from) * before / (before - after);
    if (!nearest || std::abs(at - near_s) < std::abs(*nearest - near_s)) nearest = at;
  }
  return nearest;
}

}  // namespace

MotionParts::MotionParts(const SmoothingInput& of) : input(of) {
  std::size_t a = 0, b = 0;
  double span = 0.0, steps = 0.0;
  for (const SeriesPart& of_points : parts_of(input)) {
    const double from = input.t_s[of_points.first], to = input.t_s[of_points.first + of_points.count - 1];
    SmoothedPart part{of_points, {}, {}, 0};
    while (a < input.at_s.size() && input.at_s[a] < from) ++a;
    part.first_at = a;
    for (; a < input.at_s.size() && input.at_s[a] <= to; ++a) part.at_s.push_back(input.at_s[a]);
    while (b < input.breaks_s.size() && input.breaks_s[b] <= from) ++b;
    for (; b < input.breaks_s.size() && input.breaks_s[b] < to; ++b) part.breaks_s.push_back(input.breaks_s[b]);
    if (of_points.count < kFewestSmoothed) continue;
    while (!breaks_stand(part)) part.breaks_s.pop_back();
    span += to - from;
    steps += static_cast<double>(of_points.count - 1);
    points += static_cast<double>(of_points.count);
    longest_s = std::max(longest_s, to - from);
    parts.push_back(std::move(part));
  }
  step_s = steps > 0.0 ? span / steps : 0.0;
  if (input.x_m.empty()) return;
  const auto [low, high] = std::minmax_element(input.x_m.begin(), input.x_m.end());
  range_m = *high - *low;
}

bool MotionParts::breaks() const {
  return std::any_of(parts.begin(), parts.end(), [](const SmoothedPart& part) { return !part.breaks_s.empty(); });
}

bool MotionParts::breaks_stand(const SmoothedPart& part) const {
  const auto begin = input.t_s.begin() + static_cast<std::ptrdiff_t>(part.points.first);
  const auto end = begin + static_cast<std::ptrdiff_t>(part.points.count);
  auto from = begin;
  for (const double t : part.breaks_s) {
    const auto to = std::lower_bound(from, end, t);
    if (to - from < static_cast<std::ptrdiff_t>(kFewestSmoothed)) return false;
    from = to;
  }
  return part.breaks_s.empty() || end - from >= static_cast<std::ptrdiff_t>(kFewestSmoothed);
}

template <int N>
PartedMotion<N>::PartedMotion(const MotionParts& parts) : parts_(parts) {
  // Differences below double precision are not noise.
  const double rounding = std::numeric_limits<double>::epsilon() * parts.range_m;
  least_variance_ = std::max(rounding * rounding, std::numeric_limits<double>::min());
  const SmoothingInput& input = parts.input;
  for (const SmoothedPart& part : parts.parts) {
    const std::span factor = input.noise_factor.empty()
                                 ? std::span<const double>()
                                 : std::span(input.noise_factor).subspan(part.points.first, part.points.count);
    chains_.emplace_back(ChainData{std::span(input.t_s).subspan(part.points.first, part.points.count),
                                   std::span(input.x_m).subspan(part.points.first, part.points.count), factor,
                                   part.breaks_s, part.at_s});
  }
}

template <int N>
WienerRatio PartedMotion<N>::ratio(const Smoothness& how) const {
  return {parts_.step_s / std::pow(how.tau_s, 2 * N), how.jump_1_s2, how.tau_s, how.rate_1_s};
}

template <int N>
double PartedMotion<N>::noise_variance(const ChainFit& fit) const {
  if (parts_.input.noise_sd_m) return std::max(std::pow(*parts_.input.noise_sd_m, 2), least_variance_);
  return std::max(fit.noise_variance(), least_variance_);
}

template <int N>
ChainFit PartedMotion<N>::fit(const Smoothness& how) const {
  ChainFit all;
  for (const WienerChain<N>& chain : chains_) {
    parts_.input.stop_check();
    all += chain.fit(ratio(how));
  }
  return all;
}

template <int N>
double PartedMotion<N>::minus_two_log_likelihood(const Smoothness& how) const {
  const ChainFit all = fit(how);
  double value = all.minus_two_log_likelihood(noise_variance(all));
  double unknown = static_cast<double>(parts_.parts.size());
  if (std::isinf(how.jump_1_s2)) {
    for (const SmoothedPart& part : parts_.parts) unknown += static_cast<double>(part.breaks_s.size());
  }
  double size = kSize * parts_.range_m / parts_.longest_s;
  for (int d = 2; d < N; ++d) {
    size *= d / parts_.longest_s;
    const double decaying = d == N - 1 ? kSize * parts_.range_m * std::pow(std::abs(how.rate_1_s), d) : 0.0;
    value += unknown * std::log(2.0 * std::numbers::pi * std::pow(std::max(size, decaying), 2));
  }
  return value;
}

template <int N>
std::vector<ChainPosterior<N>> PartedMotion<N>::posteriors(const Smoothness& how) const {
  std::vector<ChainPosterior<N>> all;
  for (const WienerChain<N>& chain : chains_) {
    parts_.input.stop_check();
    all.push_back(chain.posterior(ratio(how)));
  }
  return all;
}

template <int N>
SmoothedSums sums_of(const std::vector<ChainPosterior<N>>& posteriors, const MotionParts& parts) {
  SmoothedSums sums;
  for (const ChainPosterior<N>& posterior : posteriors) {
    sums.squares_m2 += posterior.residual_squares_m2();
    sums.trace += posterior.trace();
  }
  sums.points = parts.points;
  return sums;
}

template <int N>
double refine_breaks(const std::vector<ChainPosterior<N>>& posteriors, MotionParts& parts) {
  double farthest = 0.0;
  for (std::size_t p = 0; p < parts.parts.size(); ++p) {
    SmoothedPart& part = parts.parts[p];
    for (double& at : part.breaks_s) {
      const std::optional<double> turn = turn_near(posteriors[p], at);
      if (!turn) continue;
      const double before = std::exchange(at, *turn);
      if (parts.breaks_stand(part)) {
        farthest = std::max(farthest, std::abs(*turn - before));
      } else {
        at = before;
      }
    }
  }
  return farthest;
}

template class PartedMotion<3>;
template class PartedMotion<4>;
template class PartedMotion<5>;
template SmoothedSums sums_of(const std::vector<ChainPosterior<3>>&, const MotionParts&);
template SmoothedSums sums_of(const std::vector<ChainPosterior<4>>&, const MotionParts&);
template SmoothedSums sums_of(const std::vector<ChainPosterior<5>>&, const MotionParts&);
template double refine_breaks(const std::vector<ChainPosterior<3>>&, MotionParts&);
template double refine_breaks(const std::vector<ChainPosterior<4>>&, MotionParts&);
template double refine_breaks(const std::vector<ChainPosterior<5>>&, MotionParts&);

}  // namespace glidelab::core
