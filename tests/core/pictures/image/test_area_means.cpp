#include "core/pictures/image/disc_search.h"

#include <opencv2/imgproc.hpp>
#include <random>

#include "tests/catch.h"

using namespace glidelab;

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
