#include "core/pictures/scene/camera_traces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace glidelab::core {
namespace {

constexpr std::size_t kGroups = 12;
constexpr double kPixelsCountedAsOne = 2.0 * std::numbers::pi * 1.5;
constexpr double kMostRelativeSd = 0.1;
constexpr double kShareTakenUp = 0.02;  // of a standard deviation: a fit takes more from some pixels than from others

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

namespace {

constexpr std::size_t kImageStep = 4;  // images
constexpr int kRowsLookedAt = 24;
constexpr float kLargestStep = 12.0F / 255.0F;  // of full scale: larger ones are edges of things
constexpr double kLeastScatter = 0.02;          // of the mean step
constexpr double kLeastZOfCodec = 10.0;

double mean_of_middle_half(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t cut = values.size() / 4;
  double sum = 0.0;
  for (std::size_t i = cut; i < values.size() - cut; ++i) sum += values[i];
  return sum / static_cast<double>(values.size() - 2 * cut);
}

}  // namespace

void BlockStepSums::add(const cv::Mat& grey) {
  if (images_++ % kImageStep != 0) return;
  const float scale = grey.depth() == CV_8U ? 1.0F : 1.0F / 257.0F, most = 255.0F * kLargestStep;
  const int apart = std::max(1, grey.rows / kRowsLookedAt);
  const std::size_t whole = static_cast<std::size_t>(grey.cols) / 8 * 8;  // of each column modulo 8 as many
  sums_.resize(whole, 0.0);
  cv::Mat_<float> row;
  for (int v = apart / 2; v < grey.rows; v += apart) {
    grey.row(v).convertTo(row, CV_32F, static_cast<double>(scale));
    for (std::size_t u = 8; u < whole; ++u) {
      const int at = static_cast<int>(u);
      sums_[u] += static_cast<double>(std::min(most, std::abs(row(at) - row(at - 1))));
    }
    rows_ += 1.0;
  }
}

BlockSteps BlockStepSums::finish() const {
  BlockSteps steps;
  std::array<std::vector<double>, 8> columns;
  for (std::size_t u = 8; u < sums_.size(); ++u) columns[u % 8].push_back(sums_[u] / rows_);
  if (columns[0].empty()) return steps;
  for (std::size_t c = 0; c < 8; ++c) steps.mean[c] = mean_of_middle_half(columns[c]);
  steps.count = rows_ * static_cast<double>(columns[0].size());
  return steps;
}

BlockEdges block_edges(const BlockSteps& steps) {
  double mean = 0.0, largest = 0.0, unlike = 0.0;
  for (std::size_t c = 1; c < 8; ++c) {
    mean += steps.mean[c] / 7.0;
    largest = std::max(largest, steps.mean[c]);
  }
  for (std::size_t c = 1; c < 4; ++c) unlike += std::pow(steps.mean[c] - steps.mean[8 - c], 2) / 2.0 / 3.0;
  if (!(mean > 0.0)) return {};
  return {steps.mean[0] / mean - 1.0, (steps.mean[0] - largest) / std::hypot(std::sqrt(unlike), kLeastScatter * mean)};
}

double sure_block_steps(const BlockSteps& steps) {
  const BlockEdges edges = block_edges(steps);
  return edges.z > kLeastZOfCodec ? edges.relative : 0.0;
}

bool through_lossy_codec(const ImageRecord& record) {
  return record.lossy.value_or(false) || sure_block_steps(record.steps) > 0.0;
}

}  // namespace glidelab::core
