#include "core/pictures/image/disc_response.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

namespace glidelab::core {
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

/// Of the means at eight places around each of a row the one at a rank, in falling order, against the mean inside.
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
