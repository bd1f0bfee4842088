#include "core/characterize/saturation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

namespace glidelab::core {
namespace {

constexpr double kCollapsedVariance = 0.1;     // of its largest: nearly every electron above is cut
constexpr double kLeastSaturatedShare = 0.2;   // of the image: some tiles more than one, also in small images
constexpr double kLeastShareAtLargest = 0.05;  // of the samples at the largest code: the output is clipped there
constexpr double kPeakBinWidth = 0.02;         // of saturation
constexpr double kLeastPeakPixels = 0.02;      // of the image: enough that a bin's variance is not off by chance
constexpr double kFallenVariance = 0.7;        // of its largest, where light rises on: more than noise and shading do

/// The level with the largest value of `variance_dn2(level)`.
template <typename Variance>
std::size_t largest_level(std::size_t levels, const Variance& variance_dn2) {
  std::size_t largest = 0;
  for (std::size_t level = 1; level < levels; ++level) {
    if (variance_dn2(level) > variance_dn2(largest)) largest = level;
  }
  return largest;
}

/// The cells of the brightest level whose variance has collapsed.
struct Plateau {
  std::vector<char> cells;
  double pixels = 0.0;
  double mean_dn = 0.0;  // above dark
};

Plateau plateau_at(const FlatFieldStack& dark, const std::vector<FlatFieldStack>& flats, std::size_t top) {
  Plateau plateau{std::vector<char>(flats[top].cells.size(), 0), 0.0, 0.0};
  for (std::size_t c = 0; c < plateau.cells.size(); ++c) {
    const CellStatistics& cell = flats[top].cells[c];
    const auto excess = [&](std::size_t level) {
      return flats[level].cells[c].temporal_dn2 - dark.cells[c].temporal_dn2;
    };
    const std::size_t most = largest_level(flats.size(), excess);
    if (most == top || cell.pixels == 0.0 || cell.mean_dn <= flats[most].cells[c].mean_dn) continue;
    if (excess(top) > kCollapsedVariance * excess(most)) continue;
    plateau.cells[c] = 1;
    plateau.pixels += cell.pixels;
    plateau.mean_dn += cell.pixels * (cell.mean_dn - dark.cells[c].mean_dn);
  }
  if (plateau.pixels > 0.0) plateau.mean_dn /= plateau.pixels;
  return plateau;
}

/// Where the variance is largest, over all cells by their own light, so that shading and colours do not blur it.
std::optional<VariancePeak> find_peak(const FlatFieldStack& dark, const std::vector<FlatFieldStack>& flats,
                                      double saturation_dn) {
  struct Bin {
    double pixels = 0.0;
    double light = 0.0;
    double variance = 0.0;
  };
  std::map<long, Bin> bins;
  for (const FlatFieldStack& flat : flats) {
    for (std::size_t c = 0; c < flat.cells.size(); ++c) {
      const CellStatistics& cell = flat.cells[c];
      const double light = cell.mean_dn - dark.cells[c].mean_dn;
      Bin& bin = bins[std::lround(light / (kPeakBinWidth * saturation_dn))];
      bin.pixels += cell.pixels;
      bin.light += cell.pixels * light;
      bin.variance += cell.pixels * cell.temporal_dn2;
    }
  }
  std::erase_if(bins, [&](const auto& bin) { return bin.second.pixels < kLeastPeakPixels * dark.all.pixels; });
  const auto variance = [](const auto& bin) { return bin.second.variance / bin.second.pixels; };
  const auto light = [](const auto& bin) { return bin.second.light / bin.second.pixels; };
  const auto peak = std::max_element(bins.begin(), bins.end(),
                                     [&](const auto& a, const auto& b) { return variance(a) < variance(b); });
  if (peak == bins.end()) return std::nullopt;
  // Chance may have raised any of those that come near it; two frames are the fewest.
  const double error = variance(*peak) * std::sqrt(2.0 / peak->second.pixels);
  const auto near = [&](const auto& bin) { return variance(bin) > variance(*peak) - 3.0 * error; };
  const auto first = std::find_if(bins.begin(), bins.end(), near);
  const auto after = std::find_if(bins.rbegin(), bins.rend(), near).base();
  if (after == bins.end()) return std::nullopt;
  const double below = first == bins.begin() ? 0.0 : light(*std::prev(first));
  return VariancePeak{0.5 * (below + light(*after)), light(*after) - below};
}

}  // namespace

Saturation find_saturation(const FlatFieldStack& dark, const std::vector<FlatFieldStack>& flats, int largest_code) {
  std::size_t top = 0;
  double at_largest = 0.0;
  for (std::size_t level = 0; level < flats.size(); ++level) {
    if (flats[level].all.mean_dn > flats[top].all.mean_dn) top = level;
    at_largest = std::max(at_largest, flats[level].all.at_largest);
  }
  const auto excess = [&](std::size_t level) { return flats[level].all.temporal_dn2 - dark.all.temporal_dn2; };
  const std::size_t peak = largest_level(flats.size(), excess);
  Plateau plateau = plateau_at(dark, flats, top);
  Saturation saturation;
  saturation.level_dn = largest_code - dark.all.mean_dn;
  saturation.converter_clips = at_largest >= kLeastShareAtLargest;
  if (plateau.pixels >= kLeastSaturatedShare * flats[top].all.pixels) {
    saturation.plateau_level = top;
    saturation.plateau_cells = std::move(plateau.cells);
    saturation.level_dn = plateau.mean_dn;
  } else if (saturation.converter_clips) {
    saturation.top_dn = largest_code;
  } else if (peak != top && excess(top) < kFallenVariance * excess(peak)) {
    saturation.level_dn = flats[peak].all.mean_dn - dark.all.mean_dn;
  } else {
    return saturation;
  }
  saturation.peak = find_peak(dark, flats, saturation.level_dn);
  return saturation;
}

}  // namespace glidelab::core
