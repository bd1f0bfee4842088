#include "core/pictures/scene/interlacing.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/result/image_record.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

/// A white disc of 9 px radius that moves by so many pixels a frame before a grey wall, with noise of 2 codes; in each
/// frame the odd rows see it half a frame later if it is interlaced. A body that goes with it may have stripes of three
/// rows.
double share_of_combs(double speed_px, bool interlaced, bool with_stripes = false) {
  constexpr int kWidth = 200, kHeight = 80;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, 2.0);
  core::CombWatch watch;
  for (std::size_t k = 0; k < 34; ++k) {
    cv::Mat_<unsigned char> image(kHeight, kWidth);
    for (int v = 0; v < kHeight; ++v) {
      const double late = interlaced && v % 2 == 1 ? 0.5 : 0.0;
      const double at = 20.0 + speed_px * (static_cast<double>(k) + late);
      for (int u = 0; u < kWidth; ++u) {
        const double edge = std::clamp(9.5 - std::hypot(u - at, v - 30.0), 0.0, 1.0);
        const bool striped = with_stripes && std::abs(u - at) < 12.0 && v > 50 && v < 70;
        const double body = striped ? (v / 3 % 2 == 0 ? 150.0 : 60.0) : 90.0;
        image(v, u) = cv::saturate_cast<unsigned char>(body + edge * (220.0 - body) + noise(random));
      }
    }
    watch.add(image, k);
  }
  return watch.share();
}

}  // namespace

TEST_CASE("combs at the edges of what moves show that a film is interlaced, and stripes and noise do not", "[scene]") {
  for (const double speed_px : {4.0, 4.5, 5.0}) {
    CAPTURE(speed_px);
    CHECK(share_of_combs(speed_px, true) > core::kInterlacedShare);
    CHECK(share_of_combs(speed_px, false) < 0.5 * core::kInterlacedShare);
    CHECK(share_of_combs(speed_px, false, true) < 0.5 * core::kInterlacedShare);
  }
  CHECK(share_of_combs(0.0, true) == 0.0);  // at rest, both fields see the same
}
