#include "core/pixel_noise.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace glidelab::core {
namespace {

constexpr int kNoiseStrips = 24;

/// Adds the second differences along a row, whose noise has the variance 1 + 4 + 1.
void add_differences(const float* row, int count, std::vector<float>& differences) {
  for (int u = 1; u + 1 < count; ++u) differences.push_back(std::abs(row[u - 1] - 2.0F * row[u] + row[u + 1]));
}

/// Standard deviation of the noise; the median is not moved by edges.
double noise_by(std::vector<float>& differences) {
  if (differences.empty()) return 0.0;
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return static_cast<double>(*middle) / (0.6745 * std::sqrt(6.0));
}

}  // namespace

double noise_of(const cv::Mat& values) {
  std::vector<float> differences;
  const int step = std::max(1, values.rows / 60);
  for (int v = 0; v < values.rows; v += step) add_differences(values.ptr<float>(v), values.cols, differences);
  return noise_by(differences);
}

double noise_when_shrunk(const cv::Mat& values, int shrink) {
  std::vector<float> differences;
  const int rows = values.rows / shrink, columns = values.cols / shrink;
  const int step = std::max(1, rows / kNoiseStrips);
  cv::Mat strip, row;
  for (int v = 0; v < rows; v += step) {
    values(cv::Rect(0, v * shrink, columns * shrink, shrink)).convertTo(strip, CV_32F);
    cv::resize(strip, row, cv::Size(columns, 1), 0, 0, cv::INTER_AREA);
    add_differences(row.ptr<float>(), columns, differences);
  }
  return noise_by(differences);
}

}  // namespace glidelab::core
