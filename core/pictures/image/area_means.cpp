#include "core/pictures/image/area_means.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
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

}  // namespace glidelab::core
