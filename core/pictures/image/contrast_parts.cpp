#include "core/pictures/image/contrast_parts.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace glidelab::core {
namespace {

constexpr int kBlockPx = 8;

/// The darkest and the brightest pixel of each block.
template <class Pixel>
void block_extremes(const cv::Mat& values, const cv::Rect& region, cv::Mat& low, cv::Mat& high) {
  const int columns = (region.width + kBlockPx - 1) / kBlockPx, rows = (region.height + kBlockPx - 1) / kBlockPx;
  low.create(rows, columns, CV_16U);
  high.create(rows, columns, CV_16U);
  std::vector<Pixel> darkest(static_cast<std::size_t>(columns * kBlockPx)), brightest(darkest.size());
  for (int row = 0; row < rows; ++row) {
    std::ranges::fill(darkest, std::numeric_limits<Pixel>::max());
    std::ranges::fill(brightest, Pixel{0});
    for (int v = row * kBlockPx; v < std::min((row + 1) * kBlockPx, region.height); ++v) {
      const auto* from = values.ptr<Pixel>(region.y + v) + region.x;
      Pixel* const least = darkest.data();
      Pixel* const most = brightest.data();
      for (int u = 0; u < region.width; ++u) {
        least[u] = std::min(least[u], from[u]);
        most[u] = std::max(most[u], from[u]);
      }
    }
    for (int column = 0; column < columns; ++column) {
      const auto first = static_cast<std::ptrdiff_t>(column) * kBlockPx;
      low.at<std::uint16_t>(row, column) =
          *std::min_element(darkest.begin() + first, darkest.begin() + first + kBlockPx);
      high.at<std::uint16_t>(row, column) =
          *std::max_element(brightest.begin() + first, brightest.begin() + first + kBlockPx);
    }
  }
}

}  // namespace

std::vector<cv::Rect> parts_with_contrast(const cv::Mat& values, const cv::Rect& region, double contrast,
                                          int sight_px) {
  const cv::Rect seen = with_border(region, sight_px) & cv::Rect({}, values.size());
  cv::Mat low, high;
  if (values.depth() == CV_8U) {
    block_extremes<std::uint8_t>(values, seen, low, high);
  } else {
    block_extremes<std::uint16_t>(values, seen, low, high);
  }
  const int blocks = (sight_px + kBlockPx - 1) / kBlockPx;
  const cv::Mat around = cv::Mat::ones(2 * blocks + 1, 2 * blocks + 1, CV_8U);
  cv::erode(low, low, around);  // beyond the border nothing counts
  cv::dilate(high, high, around);
  cv::Mat apart, labels, stats, centroids;
  cv::subtract(high, low, apart);
  const cv::Mat wanted = apart >= contrast;
  const int count = cv::connectedComponentsWithStats(wanted, labels, stats, centroids);
  std::vector<cv::Rect> parts;
  for (int part = 1; part < count; ++part) {  // 0 is the rest
    const int* const of = stats.ptr<int>(part);
    const cv::Rect blocks_of(of[cv::CC_STAT_LEFT], of[cv::CC_STAT_TOP], of[cv::CC_STAT_WIDTH], of[cv::CC_STAT_HEIGHT]);
    const cv::Rect pixels(seen.x + blocks_of.x * kBlockPx, seen.y + blocks_of.y * kBlockPx, blocks_of.width * kBlockPx,
                          blocks_of.height * kBlockPx);
    if (const cv::Rect inside = pixels & region; !inside.empty()) parts.push_back(inside);
  }
  return parts;
}

}  // namespace glidelab::core
