#include "core/characterize/pixel_pattern.h"
#include "core/math/quantile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <opencv2/imgproc.hpp>

namespace glidelab::core {
namespace {

constexpr double kFewestInCell = 4.0;
constexpr double kMosaicContrast = 0.05;
constexpr int kFilterReach = 9;  // half width of box 7, box 11 and binomial 3 in sequence: 3 + 5 + 1

/// Applies `work` to the image, or to each of the four images that a mosaic is made of.
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

/// Part of a white pattern's variance that the filter leaves: the sum of the squares of its answer to one bright pixel.
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
  filled -= cv::mean(filled)[0];  // near zero single precision keeps more digits
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
