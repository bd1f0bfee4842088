#include "diagnose/gap/clip_interval.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "core/result/estimate.h"

namespace glidelab::diagnose {
namespace {

/// With clip `left_out` left out; with all where it is no clip's index.
double rms(std::span<const ClipSquares> clips, std::size_t left_out) {
  double sum = 0.0, count = 0.0;
  for (std::size_t c = 0; c < clips.size(); ++c) {
    if (c == left_out) continue;
    sum += clips[c].sum;
    count += clips[c].count;
  }
  return std::sqrt(sum / count);
}

/// `of` the index of the clip that is left out, or n.
template <class Pooled>
std::optional<GapInterval> jackknife(std::size_t n, const Pooled& of) {
  std::vector<double> without;
  double mean = 0.0, square = 0.0;
  for (std::size_t c = 0; c < n; ++c) mean += without.emplace_back(of(c)) / static_cast<double>(n);
  for (const double value : without) square += (value - mean) * (value - mean);
  const double se = std::sqrt(square * (static_cast<double>(n) - 1.0) / static_cast<double>(n));
  const double half = core::student_t975(static_cast<double>(n) - 1.0) * se;
  const double all = of(n);
  if (!std::isfinite(all) || !std::isfinite(half)) return {};
  return GapInterval{all - half, all + half};
}

}  // namespace

std::optional<std::size_t> too_few_clips(std::size_t clips) {
  return clips < kFewestClips ? std::optional(clips) : std::nullopt;
}

std::optional<GapInterval> rms_interval(std::span<const ClipSquares> clips) {
  std::vector<ClipSquares> counted;
  std::copy_if(clips.begin(), clips.end(), std::back_inserter(counted), [](const auto& c) { return c.count > 0.0; });
  if (counted.size() < kFewestClips) return {};
  const auto log = jackknife(counted.size(), [&](std::size_t c) { return std::log(rms(counted, c)); });
  if (!log) return {};
  return GapInterval{std::exp(log->low), std::exp(log->high)};
}

std::optional<GapInterval> shrink_interval(std::span<const ClipSquares> before, std::span<const ClipSquares> after) {
  if (before.size() < kFewestClips || before.size() != after.size()) return {};
  for (std::size_t c = 0; c <= before.size(); ++c) {
    if (!(rms(before, c) > 1.0)) return {};
  }
  return jackknife(before.size(), [&](std::size_t c) {
    const double was = rms(before, c), is = rms(after, c);
    return (was - is) / (was - 1.0);
  });
}

}  // namespace glidelab::diagnose
