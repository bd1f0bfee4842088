#include "core/characterize/pixel_response.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <utility>

#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kCollapsedVariance = 0.1;     // of its largest: nearly every electron above is lost
constexpr double kLeastSaturatedShare = 0.2;   // of the image: a few tiles, even in small images
constexpr double kLeastShareAtLargest = 0.05;  // of the samples at the largest code: the output is clipped there
constexpr double kPeakBinWidth = 0.02;         // of saturation
constexpr double kLeastPeakPixels = 0.02;      // of the image: enough that a bin's variance is not off by chance
constexpr double kFallenVariance = 0.7;        // of its largest, while the light still rises: more than noise and
                                               // shading cause

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

/// The point of largest variance over all cells, each at its own light level, so that shading and colours do not blur
/// it.
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
  // Any of the values close to it may be the true maximum, given chance; two frames are the minimum.
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

namespace {

constexpr double kFewestInCell = 4.0;
constexpr double kMosaicContrast = 0.05;
constexpr int kFilterReach = 9;  // half width of box 7, box 11 and binomial 3 in sequence: 3 + 5 + 1

/// Applies `work` to the image, or to each of the four images of which a mosaic consists.
cv::Mat by_color(const cv::Mat& image, bool mosaic, const std::function<cv::Mat(const cv::Mat&)>& work) {
  if (!mosaic) return work(image);
  cv::Mat result(image.size(), CV_32F);
  for (int oy = 0; oy < 2; ++oy) {
    for (int ox = 0; ox < 2; ++ox) {
      cv::Mat_<float> plane((image.rows - oy + 1) / 2, (image.cols - ox + 1) / 2);
      for (int y = 0; y < plane.rows; ++y) {
        for (int x = 0; x < plane.cols; ++x) plane(y, x) = image.at<float>(2 * y + oy, 2 * x + ox);
      }
      const cv::Mat done = work(plane);
      for (int y = 0; y < plane.rows; ++y) {
        for (int x = 0; x < plane.cols; ++x) result.at<float>(2 * y + oy, 2 * x + ox) = done.at<float>(y, x);
      }
    }
  }
  return result;
}

cv::Mat high_pass(const cv::Mat& image) {
  cv::Mat smooth;
  cv::Mat smoother;
  cv::blur(image, smooth, {7, 7}, {-1, -1}, cv::BORDER_REFLECT_101);
  cv::blur(smooth, smoother, {11, 11}, {-1, -1}, cv::BORDER_REFLECT_101);
  cv::GaussianBlur(smoother, smooth, {3, 3}, 0.0, 0.0, cv::BORDER_REFLECT_101);  // for a width of 3: 1/4, 1/2, 1/4
  return image - smooth;
}

/// Fraction of a white pattern's variance that the filter leaves: the sum of the squares of its impulse response.
double white_part() {
  constexpr int kMiddle = 2 * kFilterReach;
  cv::Mat impulse(2 * kMiddle + 1, 2 * kMiddle + 1, CV_32F, cv::Scalar(0));
  impulse.at<float>(kMiddle, kMiddle) = 1.0F;
  const cv::Mat answer = high_pass(impulse);
  return answer.dot(answer);
}

struct CellSquares {
  std::vector<double> pixels;
  std::vector<double> mean_dn;  // before the filter
  std::vector<double> sum_dn2;
};

/// n / (n - 1) times the squares of a cell's high-passed pixels about their mean.
CellSquares squares(const cv::Mat& image, const TileGrid& grid, const cv::Mat& mask, bool mosaic) {
  cv::Mat filled = image.clone();
  if (!mask.empty()) neighbourhood_median(image, mosaic).copyTo(filled, mask == 0);
  filled -= cv::mean(filled)[0];  // single precision keeps more digits near zero
  const cv::Mat pattern = by_color(filled, mosaic, high_pass);
  const int reach = mosaic ? 2 * kFilterReach : kFilterReach;
  const cv::Rect inside =
      cv::Rect(cv::Point(0, 0), image.size()) & cv::Rect(reach, reach, image.cols - 2 * reach, image.rows - 2 * reach);
  const std::vector<double> zeros(grid.cells(), 0.0);
  CellSquares cells{zeros, zeros, zeros};
  std::vector<double> sums = zeros;
  for (std::size_t tile = 0; tile < grid.tiles(); ++tile) {
    const cv::Rect area = grid.tile(tile) & inside;
    for (int y = area.y; y < area.y + area.height; ++y) {
      for (int x = area.x; x < area.x + area.width; ++x) {
        if (!mask.empty() && mask.at<std::uint8_t>(y, x) == 0) continue;
        const std::size_t cell = TileGrid::cell(tile, x, y);
        const double value = pattern.at<float>(y, x);
        cells.pixels[cell] += 1.0;
        cells.mean_dn[cell] += image.at<float>(y, x);
        cells.sum_dn2[cell] += value * value;
        sums[cell] += value;
      }
    }
  }
  const double part = white_part();
  for (std::size_t c = 0; c < grid.cells(); ++c) {
    double& n = cells.pixels[c];
    if (n < kFewestInCell) n = 0.0;
    cells.mean_dn[c] = n == 0.0 ? 0.0 : cells.mean_dn[c] / n;
    cells.sum_dn2[c] = n == 0.0 ? 0.0 : (cells.sum_dn2[c] - sums[c] * sums[c] / n) * n / (n - 1.0) / part;
  }
  return cells;
}

}  // namespace

cv::Mat neighbourhood_median(const cv::Mat& mean_dn, bool mosaic) {
  return by_color(mean_dn, mosaic, [](const cv::Mat& plane) {
    cv::Mat median;
    cv::medianBlur(plane, median, 5);
    return median;
  });
}

std::vector<CellPattern> spatial_pattern(const cv::Mat& mean_dn, const cv::Mat& contrast_dn, const TileGrid& grid,
                                         const cv::Mat& mask, bool mosaic) {
  const CellSquares mean = squares(mean_dn, grid, mask, mosaic);
  const CellSquares contrast = squares(contrast_dn, grid, mask, mosaic);
  std::vector<CellPattern> cells;
  for (std::size_t c = 0; c < grid.cells(); ++c) {
    cells.push_back({mean.pixels[c], mean.mean_dn[c], mean.sum_dn2[c], contrast.sum_dn2[c]});
  }
  return cells;
}

double robust_sd(const cv::Mat& deviations, const cv::Mat& mask) {
  std::vector<float> sizes;
  sizes.reserve(deviations.total());
  for (int y = 0; y < deviations.rows; ++y) {
    for (int x = 0; x < deviations.cols; ++x) {
      if (mask.empty() || mask.at<std::uint8_t>(y, x) != 0) sizes.push_back(std::abs(deviations.at<float>(y, x)));
    }
  }
  if (sizes.empty()) return 0.0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return kSdOverMedian * *middle;
}

bool has_mosaic(const FlatFieldStack& flat, const FlatFieldStack& dark) {
  std::array<double, 4> light{};
  std::array<double, 4> pixels{};
  for (std::size_t c = 0; c < flat.cells.size(); ++c) {
    light[c % 4] += flat.cells[c].pixels * (flat.cells[c].mean_dn - dark.cells[c].mean_dn);
    pixels[c % 4] += flat.cells[c].pixels;
  }
  for (std::size_t k = 0; k < 4; ++k) light[k] /= pixels[k];
  const auto [least, most] = std::minmax_element(light.begin(), light.end());
  return *most - *least > kMosaicContrast * *most;
}

}  // namespace glidelab::core
