#include "core/pictures/image/disc_search.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "core/pictures/marker/marker_search.h"
#include "tests/catch.h"
#include "tests/core/painter.h"
#include "tests/core/small_clip.h"

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

namespace {

cv::Mat random_image(cv::Size size, int type) {
  cv::Mat image(size, CV_32S);
  std::mt19937 engine(7);
  std::uniform_int_distribution<int> code(0, type == CV_8U ? 255 : 65535);
  for (int v = 0; v < size.height; ++v) {
    for (int u = 0; u < size.width; ++u) image.at<int>(v, u) = code(engine);
  }
  cv::Mat shallow;
  image.convertTo(shallow, type);
  return shallow;
}

}  // namespace

TEST_CASE("an image made smaller has the means over areas, as OpenCV gives them") {
  for (const int type : {CV_8U, CV_16U}) {
    const cv::Mat image = random_image({101, 67}, type);
    for (const cv::Size size : {cv::Size(101, 67), cv::Size(60, 40), cv::Size(50, 33), cv::Size(34, 67),
                                cv::Size(101, 9), cv::Size(1, 67), cv::Size(1, 1)}) {
      cv::Mat exact, theirs;
      image.convertTo(exact, CV_64F);
      cv::resize(exact, theirs, size, 0, 0, cv::INTER_AREA);
      const cv::Mat ours = core::area_means(image, size);
      REQUIRE(ours.type() == CV_32F);
      cv::Mat wide;
      ours.convertTo(wide, CV_64F);
      // A weight is rounded once, a product and a sum once each: 1 + 2 * taps roundings of 2^-24 of the largest value
      // in either direction, with 102 taps at most. OpenCV's weights are of single precision as well.
      const double allowed = (type == CV_8U ? 255.0 : 65535.0) * 2.0 * 206.0 / 16777216.0;
      INFO(size << " of " << image.size());
      CHECK(cv::norm(wide, theirs, cv::NORM_INF) < allowed);
    }
  }
}

TEST_CASE("wide vectors make an image smaller to the last bit as narrow ones do") {
  const cv::Mat image = random_image({203, 58}, CV_8U);
  const cv::Mat best = core::area_means(image, {123, 35}),
                plain = core::area_means(image, {123, 35}, base::Simd::baseline);
  CHECK(cv::norm(best, plain, cv::NORM_INF) == 0.0);
}

namespace {

const cv::Size kSize(500, 300);

/// A wall with noise, a bright bar and discs of several brightnesses.
cv::Mat scene() {
  cv::Mat image(kSize, CV_64F, cv::Scalar(60.0));
  image(cv::Rect(0, 200, 500, 20)).setTo(150.0);
  for (int i = 0; i < 9; ++i) tests::put_disc(image, {30.3 + 55.0 * i, 60.7 + 11.0 * i}, 5.0, 80.0 + 18.0 * i);
  return image;
}

}  // namespace

TEST_CASE("every place from which pixels within sight differ by the contrast lies in one of the parts") {
  for (const int depth : {CV_8U, CV_16U}) {
    const cv::Mat image = tests::expose(scene(), 2.0, 5, depth);
    const cv::Rect region(37, 21, 411, 253);
    constexpr int kSight = 11;
    constexpr double kContrast = 40.0;
    const std::vector<cv::Rect> parts = core::parts_with_contrast(image, region, kContrast, kSight);
    std::size_t inside = 0, wanted = 0;
    for (int v = region.y; v < region.br().y; ++v) {
      for (int u = region.x; u < region.br().x; ++u) {
        const cv::Rect sight = core::with_border({u, v, 1, 1}, kSight) & cv::Rect({}, kSize);
        double low = 0.0, high = 0.0;
        cv::minMaxLoc(image(sight), &low, &high);
        const bool in = std::any_of(parts.begin(), parts.end(),
                                    [&](const cv::Rect& part) { return part.contains(cv::Point(u, v)); });
        inside += in ? 1 : 0;
        if (high - low < kContrast) continue;
        ++wanted;
        REQUIRE(in);
      }
    }
    CHECK(wanted > 0);
    CHECK(inside < static_cast<std::size_t>(region.area()));  // some of it is left out
  }
}

TEST_CASE("blobs of a contrast asked for are those of a search for all, as far as they have it") {
  core::Signal signal{tests::expose(scene(), 2.0, 5), {}};
  core::BlobSearch search;
  search.radius_px = 5.0;
  search.region = cv::Rect({}, kSize);
  std::vector<core::Blob> all = core::find_blobs(signal, search);
  search.least_contrast = 40.0;
  const std::vector<core::Blob> some = core::find_blobs(signal, search);
  std::erase_if(all, [](const core::Blob& blob) { return blob.contrast < 42.0; });
  REQUIRE(all.size() >= 6);
  // The shrunk image's grid lies elsewhere: a contrast changes by some per cent, and a centre is known to a quarter
  // of the radius.
  for (const core::Blob& blob : all) {
    INFO(blob.centre << " " << blob.contrast);
    CHECK(std::any_of(some.begin(), some.end(), [&](const core::Blob& other) {
      return cv::norm(other.centre - blob.centre) < 1.5 && std::abs(other.contrast / blob.contrast - 1.0) < 0.3;
    }));
  }
}
