#include "core/pictures/scene/level_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace glidelab::core {
namespace {

constexpr std::size_t kGroups = 12;
constexpr double kPixelsCountedAsOne = 2.0 * std::numbers::pi * 1.5;
constexpr double kMostRelativeSd = 0.1;
constexpr double kShareTakenUp = 0.02;  // of a standard deviation: half of what three fitted numbers take from a patch

}  // namespace

std::vector<NoiseAtLevel> noise_by_level(const PixelChanges& pixels) {
  if (pixels.empty()) return {};
  const auto [low, high] = std::minmax_element(
      pixels.begin(), pixels.end(), [](const auto& a, const auto& b) { return a.level_code < b.level_code; });
  const double range = std::max(high->level_code - low->level_code, 1e-9);
  std::vector<PixelChange> sums(kGroups);
  for (const PixelChange& pixel : pixels) {
    const auto group =
        static_cast<std::size_t>((pixel.level_code - low->level_code) / range * static_cast<double>(kGroups));
    PixelChange& sum = sums[std::min(group, kGroups - 1)];
    sum.level_code += pixel.level_code * pixel.changes;
    sum.squares += pixel.squares;
    sum.changes += pixel.changes;
  }
  std::vector<NoiseAtLevel> levels;
  for (const PixelChange& sum : sums) {
    if (!(sum.changes > 0.0)) continue;
    // The relative error of a variance of n is sqrt(2 / n), that of its root half of it.
    const double known_to = std::sqrt(0.5 * kPixelsCountedAsOne / sum.changes);
    if (known_to > kMostRelativeSd) continue;
    const double sd = std::sqrt(0.5 * sum.squares / sum.changes);
    levels.push_back({sum.level_code / sum.changes, sd, sd * std::hypot(known_to, kShareTakenUp)});
  }
  return levels;
}

}  // namespace glidelab::core
