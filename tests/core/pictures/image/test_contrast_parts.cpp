#include "core/pictures/image/disc_search.h"

#include <algorithm>
#include <random>

#include "core/pictures/marker/marker_search.h"
#include "tests/catch.h"
#include "tests/core/painter.h"
#include "tests/core/small_clip.h"

using namespace glidelab;

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
