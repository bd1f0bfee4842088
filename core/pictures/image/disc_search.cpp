#include "core/pictures/image/disc_search.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

namespace glidelab::core {
namespace {

/// Which of `from` pixels in a line make each of `to` means, and how much each counts: the same number for all.
struct Taps {
  int count = 0;
  std::vector<int> first;      // of each mean
  std::vector<float> weights;  // the first weight of all means, then the second of all, …

  Taps(int from, int to) {
    const double scale = static_cast<double>(from) / to;
    const auto means = static_cast<std::size_t>(to);
    count = std::min(from, static_cast<int>(std::ceil(scale)) + 1);
    first.resize(means);
    weights.assign(means * static_cast<std::size_t>(count), 0.0F);
    for (std::size_t i = 0; i < means; ++i) {
      const double begin = static_cast<double>(i) * scale, end = begin + scale;
      first[i] = std::min(static_cast<int>(begin), from - count);
      for (int k = 0; k < count; ++k) {
        const double pixel = first[i] + k, part = std::min(end, pixel + 1.0) - std::max(begin, pixel);
        weights[static_cast<std::size_t>(k) * means + i] = static_cast<float>(std::max(part, 0.0) / scale);
      }
    }
  }
};

/// The weighted sum of `count` rows.
template <class Pixel>
[[gnu::always_inline]] inline void sum_rows(const cv::Mat& values, int first, const Taps& taps, int row,
                                            float* __restrict line) {
  const auto means = taps.first.size();
  const int width = values.cols;
  for (int k = 0; k < taps.count; ++k) {
    const float weight = taps.weights[static_cast<std::size_t>(k) * means + static_cast<std::size_t>(row)];
    const Pixel* __restrict from = values.ptr<Pixel>(first + k);
    if (k == 0) {
      for (int u = 0; u < width; ++u) line[u] = weight * static_cast<float>(from[u]);
    } else if (weight > 0.0F) {
      for (int u = 0; u < width; ++u) line[u] += weight * static_cast<float>(from[u]);
    }
  }
}

[[gnu::always_inline]] inline void sum_columns(const float* __restrict line, const Taps& taps, float* __restrict to) {
  const int means = static_cast<int>(taps.first.size());
  const int* const first = taps.first.data();
  for (int k = 0; k < taps.count; ++k) {
    const float* const weight = taps.weights.data() + static_cast<std::ptrdiff_t>(k) * means;
    const float* const from = line + k;
    if (k == 0) {
      for (int u = 0; u < means; ++u) to[u] = weight[u] * from[first[u]];
    } else {
      for (int u = 0; u < means; ++u) to[u] += weight[u] * from[first[u]];
    }
  }
}

template <class Pixel>
[[gnu::always_inline]] inline void all_means(const cv::Mat& values, const Taps& down, const Taps& across, float* line,
                                             cv::Mat& means) {
  for (int row = 0; row < means.rows; ++row) {
    sum_rows<Pixel>(values, down.first[static_cast<std::size_t>(row)], down, row, line);
    sum_columns(line, across, means.ptr<float>(row));
  }
}

template <class Pixel>
void all_means_baseline(const cv::Mat& values, const Taps& down, const Taps& across, float* line, cv::Mat& means) {
  all_means<Pixel>(values, down, across, line, means);
}

#if defined(__x86_64__)
// AVX2 without FMA: the same operations on more lanes.
template <class Pixel>
[[gnu::target("avx2")]] void all_means_avx2(const cv::Mat& values, const Taps& down, const Taps& across, float* line,
                                            cv::Mat& means) {
  all_means<Pixel>(values, down, across, line, means);
}
#endif

template <class Pixel>
void means_of(const cv::Mat& values, cv::Mat& means, base::Simd simd) {
  const Taps down(values.rows, means.rows), across(values.cols, means.cols);
  std::vector<float> line(static_cast<std::size_t>(values.cols));
#if defined(__x86_64__)
  if (base::uses_avx2(simd)) {
    all_means_avx2<Pixel>(values, down, across, line.data(), means);
    return;
  }
#endif
  all_means_baseline<Pixel>(values, down, across, line.data(), means);
}

}  // namespace

cv::Mat area_means(const cv::Mat& values, cv::Size size, base::Simd simd) {
  assert(size.width > 0 && size.height > 0 && size.width <= values.cols && size.height <= values.rows);
  assert(values.type() == CV_8U || values.type() == CV_16U);
  cv::Mat means(size, CV_32F);
  if (values.depth() == CV_8U) {
    means_of<std::uint8_t>(values, means, simd);
  } else {
    means_of<std::uint16_t>(values, means, simd);
  }
  return means;
}

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

namespace {

/// Means over squares of 2 half + 1 pixels, of what of them lies inside the image, for centres in the image and up
/// to `beyond` pixels outside; NaN where nothing does. Sums are those of an integral image.
cv::Mat square_means(const cv::Mat& sums, int half, int beyond) {
  const int width = sums.cols - 1, height = sums.rows - 1;
  cv::Mat means(height + 2 * beyond, width + 2 * beyond, CV_32F);
  std::vector<int> left(static_cast<std::size_t>(means.cols)), right(left.size());
  for (int u = 0; u < means.cols; ++u) {
    left[static_cast<std::size_t>(u)] = std::max(u - beyond - half, 0);
    right[static_cast<std::size_t>(u)] = std::min(u - beyond + half + 1, width);
  }
  for (int v = 0; v < means.rows; ++v) {
    const int top = std::max(v - beyond - half, 0), bottom = std::min(v - beyond + half + 1, height);
    auto* row = means.ptr<float>(v);
    if (top >= bottom) {
      std::fill(row, row + means.cols, std::numeric_limits<float>::quiet_NaN());
      continue;
    }
    const auto* upper = sums.ptr<double>(top);
    const auto* lower = sums.ptr<double>(bottom);
    const auto mean_at = [&](int u) {
      const int l = left[static_cast<std::size_t>(u)], r = right[static_cast<std::size_t>(u)];
      if (l >= r) return std::numeric_limits<float>::quiet_NaN();
      const double area = static_cast<double>(r - l) * (bottom - top);
      return static_cast<float>((lower[r] - upper[r] - lower[l] + upper[l]) / area);
    };
    // Between the borders all squares are whole.
    const int first = std::min(half + beyond, means.cols), last = std::max(first, width - half + beyond);
    for (int u = 0; u < first; ++u) row[u] = mean_at(u);
    const double share = 1.0 / (static_cast<double>(2 * half + 1) * (bottom - top));
    for (int u = first; u < last; ++u) {
      const int l = u - beyond - half, r = u - beyond + half + 1;
      const double sum = lower[r] - upper[r] - lower[l] + upper[l];
      row[u] = static_cast<float>(sum * share);
    }
    for (int u = last; u < means.cols; ++u) row[u] = mean_at(u);
  }
  return means;
}

using Steps = std::array<std::ptrdiff_t, 8>;  // from a place to the squares around it

/// For each position in a row: the mean inside minus the mean of a given rank, in decreasing order, of the eight around
/// it.
template <int kRank>
[[gnu::always_inline]] inline void row_response(const float* __restrict inside, const float* __restrict beside,
                                                const Steps& steps, int count, float* __restrict result) {
  constexpr float kNone = -std::numeric_limits<float>::infinity();
  for (int u = 0; u < count; ++u) {
    std::array<float, kRank + 1> brightest;
#pragma GCC unroll 4
    for (int rank = 0; rank <= kRank; ++rank) brightest[rank] = kNone;
#pragma GCC unroll 8
    for (int k = 0; k < 8; ++k) {
      float next = beside[u + steps[k]];
#pragma GCC unroll 4
      for (int rank = 0; rank <= kRank; ++rank) {
        const float here = brightest[rank];
        const bool brighter = next > here;  // never of a NaN, which is passed on to the end
        brightest[rank] = brighter ? next : here;
        next = brighter ? here : next;
      }
    }
    const float other = brightest[kRank], in = inside[u];
    result[u] = in > other && other > kNone ? in - other : 0.0F;
  }
}

using RowResponse = void(const float*, const float*, const Steps&, int, float*);

template <int kRank>
void row_response_baseline(const float* inside, const float* beside, const Steps& steps, int count, float* result) {
  row_response<kRank>(inside, beside, steps, count, result);
}

#if defined(__x86_64__)
// AVX2 without FMA: the same operations on more lanes.
template <int kRank>
[[gnu::target("avx2")]] void row_response_avx2(const float* inside, const float* beside, const Steps& steps, int count,
                                               float* result) {
  row_response<kRank>(inside, beside, steps, count, result);
}
#endif

template <int kRank>
RowResponse* best_row_response([[maybe_unused]] base::Simd simd) {
#if defined(__x86_64__)
  if (base::uses_avx2(simd)) return row_response_avx2<kRank>;
#endif
  return row_response_baseline<kRank>;
}

RowResponse* row_response_of(int bright_neighbours, base::Simd simd) {
  switch (bright_neighbours) {
    case 0:
      return best_row_response<0>(simd);
    case 1:
      return best_row_response<1>(simd);
    case 2:
      return best_row_response<2>(simd);
    case kMostBrightNeighbours:
      return best_row_response<kMostBrightNeighbours>(simd);
    default:
      throw std::logic_error("more bright neighbours than are looked for");
  }
}

}  // namespace

DiscSquares::DiscSquares(double radius_px)
    : inner(std::max(0, static_cast<int>(std::lround(0.6 * radius_px - 0.3)))),
      outer(std::max(0, static_cast<int>(std::lround(0.4 * radius_px - 0.3)))),
      away(static_cast<int>(std::lround(radius_px + 1.0 + outer + 0.3 * radius_px))) {}

cv::Mat disc_response(const cv::Mat& values, const cv::Rect& region, const DiscSquares& squares, int bright_neighbours,
                      base::Simd simd) {
  RowResponse* const row_response = row_response_of(bright_neighbours, simd);
  const int away = squares.away;
  const int diagonal = static_cast<int>(std::lround(away * 0.75));
  const std::array<cv::Point, 8> around{
      cv::Point(away, 0),  cv::Point(diagonal, diagonal),   cv::Point(0, away),  cv::Point(-diagonal, diagonal),
      cv::Point(-away, 0), cv::Point(-diagonal, -diagonal), cv::Point(0, -away), cv::Point(diagonal, -diagonal)};
  cv::Mat sums;
  cv::integral(values, sums, CV_64F);
  const cv::Mat in = square_means(sums, squares.inner, 0);
  const cv::Mat out = square_means(sums, squares.outer, away);
  Steps steps{};
  for (std::size_t k = 0; k < around.size(); ++k) {
    steps[k] = static_cast<std::ptrdiff_t>(around[k].y) * out.cols + around[k].x;
  }
  cv::Mat response(values.size(), CV_32F);
  for (int v = 0; v < response.rows; ++v) {
    float* const row = response.ptr<float>(v);
    if (v < region.y || v >= region.br().y) {
      std::fill_n(row, response.cols, 0.0F);
      continue;
    }
    std::fill_n(row, region.x, 0.0F);
    std::fill(row + region.br().x, row + response.cols, 0.0F);
    row_response(in.ptr<float>(v) + region.x, out.ptr<float>(v + away) + away + region.x, steps, region.width,
                 row + region.x);
  }
  return response;
}

}  // namespace glidelab::core
