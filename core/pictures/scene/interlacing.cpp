#include "core/pictures/scene/interlacing.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace glidelab::core {
namespace {

constexpr std::size_t kEvery = 8;          // frames
constexpr double kLeastStep = 1.0 / 30;    // of the largest code of the image
constexpr double kFewestCombs = 200.0;     // pixels, of all frames
constexpr double kBeyondNeighbours = 2.0;  // steps of a comb over the difference of the rows around it
constexpr int kRows = 4;                   // in turn

}  // namespace

void CombWatch::add(const cv::Mat& grey, std::size_t frame) {
  const bool first = frame % kEvery == 0, second = frame % kEvery == 1;
  if (!first && !second) return;
  cv::Mat_<float> now;
  grey.convertTo(now, CV_32F);
  if (first || before_.size() != now.size()) {
    before_ = now;
    return;
  }
  double largest = 0.0;
  cv::minMaxLoc(now, nullptr, &largest);
  const auto step = static_cast<float>(std::max(1.0, kLeastStep * largest));
  run_.assign(static_cast<std::size_t>(now.cols), 0);
  for (int row = 1; row + 1 < now.rows; ++row) {
    const float* const above = now.ptr<float>(row - 1);
    const float* const here = now.ptr<float>(row);
    const float* const below = now.ptr<float>(row + 1);
    const float* const earlier = before_.ptr<float>(row);
    for (int column = 0; column < now.cols; ++column) {
      int& run = run_[static_cast<std::size_t>(column)];
      const float up = here[column] - above[column], down = here[column] - below[column];
      const float least = std::min(std::abs(up), std::abs(down));
      const bool comb = up * down > 0.0F && least > step &&
                        least > static_cast<float>(kBeyondNeighbours) * std::abs(above[column] - below[column]);
      if (!comb) {
        run = 0;
        continue;
      }
      const int sign = up > 0.0F ? 1 : -1;
      run = run * sign < 0 ? sign * (std::abs(run) + 1) : sign;
      if (std::abs(here[column] - earlier[column]) < step) continue;  // at rest, or of the field that has passed
      combs_ += 1.0;
      go_on_ += std::abs(run) >= kRows ? 1.0 : 0.0;
    }
  }
  before_.release();
}

double CombWatch::share() const {
  return combs_ < kFewestCombs ? 0.0 : go_on_ / combs_;
}

}  // namespace glidelab::core
