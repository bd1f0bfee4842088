#include "core/pictures/image/disc_search.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

namespace {

/// The mean of what lies in the image of the square around (u, v); nothing where it is none of it.
std::optional<double> mean_of(const cv::Mat& image, int u, int v, int half) {
  const cv::Rect square = cv::Rect(u - half, v - half, 2 * half + 1, 2 * half + 1) & cv::Rect({}, image.size());
  if (square.empty()) return std::nullopt;
  return cv::mean(image(square))[0];
}

/// As the header says it, with the squares to the sides of and across the disc.
double expected_at(const cv::Mat& image, int u, int v, const core::DiscSquares& squares, int bright_neighbours) {
  const int away = squares.away, diagonal = static_cast<int>(std::lround(0.75 * away));
  std::vector<double> around;
  for (int du = -1; du <= 1; ++du) {
    for (int dv = -1; dv <= 1; ++dv) {
      if (du == 0 && dv == 0) continue;
      const int step = du != 0 && dv != 0 ? diagonal : away;
      if (const auto mean = mean_of(image, u + du * step, v + dv * step, squares.outer)) around.push_back(*mean);
    }
  }
  std::ranges::sort(around, std::greater<>());
  if (around.size() <= static_cast<std::size_t>(bright_neighbours)) return 0.0;
  return std::max(0.0, *mean_of(image, u, v, squares.inner) - around[static_cast<std::size_t>(bright_neighbours)]);
}

}  // namespace

TEST_CASE("a disc's response is its mean above the brightest but some of those around it") {
  cv::Mat image(43, 61, CV_32F);
  std::mt19937 engine(11);
  std::uniform_real_distribution<float> grey(0.0F, 255.0F);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) image.at<float>(v, u) = grey(engine);
  }
  for (const double radius : {1.2, 3.0}) {
    const core::DiscSquares squares(radius);
    for (int bright = 0; bright <= core::kMostBrightNeighbours; ++bright) {
      for (const cv::Rect& region : {cv::Rect({}, image.size()), cv::Rect(7, 5, 31, 22)}) {
        const cv::Mat response = core::disc_response(image, region, squares, bright);
        double worst = 0.0;
        for (int v = 0; v < image.rows; ++v) {
          for (int u = 0; u < image.cols; ++u) {
            const double wanted = region.contains({u, v}) ? expected_at(image, u, v, squares, bright) : 0.0;
            worst = std::max(worst, std::abs(static_cast<double>(response.at<float>(v, u)) - wanted));
          }
        }
        // Two means and their difference are rounded to single precision, each by 2^-25 of 255 at most.
        INFO("radius " << radius << ", " << bright << " bright neighbours");
        CHECK(worst < 3.0 * 255.0 / 33554432.0 + 1e-9);
        const cv::Mat plain = core::disc_response(image, region, squares, bright, base::Simd::baseline);
        CHECK(cv::norm(response, plain, cv::NORM_INF) == 0.0);
      }
    }
  }
}

TEST_CASE("nothing is around a place in an image of one pixel") {
  const cv::Mat image(1, 1, CV_32F, cv::Scalar(200.0F));
  CHECK(core::disc_response(image, {0, 0, 1, 1}, core::DiscSquares(3.0), 1).at<float>(0, 0) == 0.0F);
}
