#include "core/pictures/image/pixel_signal.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/math/quantile.h"

namespace glidelab::core {

NormalNodes make_normal_nodes() {
  NormalNodes nodes;
  for (int i = 0; i < NormalNodes::kCount; ++i) {
    const double z = static_cast<double>(i) / kNormalNodesPerUnit - kFarFromEdge;
    const auto at = static_cast<std::size_t>(i);
    nodes.density[at] = std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi);
    nodes.distribution[at] = 0.5 * std::erfc(-z * (1.0 / std::numbers::sqrt2));
  }
  nodes.density.front() = nodes.distribution.front() = nodes.density.back() = 0.0;
  nodes.distribution.back() = 1.0;
  return nodes;
}

PixelEdge pixel_edge(double s, double nu, double nv, double blur) {
  static const NormalNodes nodes = make_normal_nodes();
  const EdgeBoxes boxes = edge_boxes(nu, nv, blur);
  return edge_of(boxes, edge_corners(nodes, s, boxes));
}

namespace {

constexpr int kNoiseStrips = 24;

/// Adds the second differences along a row, whose noise has the variance 1 + 4 + 1.
void add_differences(const float* row, int count, std::vector<float>& differences) {
  for (int u = 1; u + 1 < count; ++u) differences.push_back(std::abs(row[u - 1] - 2.0F * row[u] + row[u + 1]));
}

/// Standard deviation of the noise; edges do not affect the median.
double noise_by(std::vector<float>& differences) {
  if (differences.empty()) return 0.0;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return kSdOverMedian * static_cast<double>(*middle) / std::sqrt(6.0);
}

template <class Pixel>
double shrunk_noise(const cv::Mat& values, int shrink) {
  std::vector<float> differences;
  const int rows = values.rows / shrink, columns = values.cols / shrink;
  const int step = std::max(1, rows / kNoiseStrips);
  const float share = 1.0F / static_cast<float>(shrink * shrink);
  std::vector<std::int64_t> sums(static_cast<std::size_t>(columns));
  std::vector<float> row(sums.size());
  for (int strip = 0; strip < rows; strip += step) {
    std::ranges::fill(sums, 0);
    for (int v = strip * shrink; v < (strip + 1) * shrink; ++v) {
      const Pixel* from = values.ptr<Pixel>(v);
      for (std::int64_t& sum : sums) {
        for (int u = 0; u < shrink; ++u) sum += *from++;
      }
    }
    std::ranges::transform(sums, row.begin(), [&](std::int64_t sum) { return share * static_cast<float>(sum); });
    add_differences(row.data(), columns, differences);
  }
  return noise_by(differences);
}

}  // namespace

double noise_of(const cv::Mat& values) {
  std::vector<float> differences;
  const int step = std::max(1, values.rows / 60);
  for (int v = 0; v < values.rows; v += step) add_differences(values.ptr<float>(v), values.cols, differences);
  return noise_by(differences);
}

double noise_when_shrunk(const cv::Mat& values, int shrink) {
  return values.depth() == CV_8U ? shrunk_noise<std::uint8_t>(values, shrink)
                                 : shrunk_noise<std::uint16_t>(values, shrink);
}

double light_of_code(ToneCurve tone, double code) {
  const double share = std::clamp(code, 0.0, 1.0);
  if (tone == ToneCurve::linear) return share;
  return share <= 0.04045 ? share / 12.92 : std::pow((share + 0.055) / 1.055, 2.4);
}

double code_of_light(ToneCurve tone, double light) {
  const double share = std::clamp(light, 0.0, 1.0);
  if (tone == ToneCurve::linear) return share;
  return share <= 0.0031308 ? 12.92 * share : 1.055 * std::pow(share, 1.0 / 2.4) - 0.055;
}

}  // namespace glidelab::core
