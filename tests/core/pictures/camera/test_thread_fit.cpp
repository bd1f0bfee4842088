#include "core/pictures/camera/thread_fit.h"

#include <cmath>

#include "tests/catch.h"
#include "tests/core/painter.h"

using namespace glidelab;

namespace {

constexpr int kRows = 160, kColumns = 31;

/// A stripe `width` pixels wide whose middle is at column c0 + slant * row, on a background that slopes: the mean over
/// 64 points across the row and 4 along it in every pixel, of edges blurred by a Gaussian.
cv::Mat image_of(double c0, double slant, double width, double blur_px) {
  const double length = std::hypot(1.0, slant);
  cv::Mat image(kRows, kColumns, CV_64F);
  const auto step = [&](double t) {
    return blur_px > 0.0 ? 0.5 * std::erfc(-t / (std::sqrt(2.0) * blur_px)) : t > 0.0 ? 1.0 : 0.0;
  };
  for (int v = 0; v < kRows; ++v) {
    for (int u = 0; u < kColumns; ++u) {
      double share = 0.0;
      for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 64; ++i) {
          const double du = u + (i + 0.5) / 64.0 - 0.5, dv = v + (j + 0.5) / 4.0 - 0.5;
          const double s = (du - c0 - slant * dv) / length;
          share += (step(s + 0.5 * width) - step(s - 0.5 * width)) / 256.0;
        }
      }
      image.at<double>(v, u) = 120.0 + 0.5 * u - 90.0 * share;
    }
  }
  return image;
}

/// As a thread is found: to a whole pixel.
std::vector<core::ThreadRow> rows_of(const cv::Mat& image, double c0, double slant) {
  std::vector<core::ThreadRow> rows;
  for (int v = 0; v < image.rows; ++v) {
    core::ThreadRow row;
    row.row = v;
    for (int u = 0; u < image.cols; ++u) row.values.push_back(image.at<double>(v, u));
    row.middle = std::round(c0) + slant * v + 0.3;
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

TEST_CASE("the direction of a thread is known as well as it says, however slowly it crosses the pixels") {
  for (const double blur_px : {0.0, 0.4}) {
    for (const double width : {0.7, 1.06, 2.4}) {
      if (blur_px == 0.0 && width < 1.0) continue;  // see the header
      double z2 = 0.0, squares = 0.0;
      constexpr int kThreads = 16;
      for (int k = 0; k < kThreads; ++k) {
        // From a third of a pixel over the whole height to five of them.
        const double c0 = 14.0 + 0.37 * k - std::floor(0.37 * k), slant = (k % 2 == 0 ? 1.0 : -1.0) * 0.002 * (k + 1);
        const cv::Mat seen = tests::expose(image_of(c0, slant, width, blur_px), 2.0, static_cast<std::uint64_t>(k + 1));
        cv::Mat image;
        seen.convertTo(image, CV_64F);
        const auto fit = core::fit_thread(rows_of(image, c0, slant), slant, 1.0);
        REQUIRE(fit);
        INFO("blur " << blur_px << ", width " << width << ", slant " << slant << ": off by " << fit->turn << ", sd "
                     << fit->sd_turn);
        CHECK(fit->rows >= kRows * 9 / 10);
        // 0.02 to 0.1 px a row over lever arms of 46 rows rms and 160 rows.
        CHECK(fit->sd_turn < 4e-4);
        CHECK(std::abs(fit->turn) < 4.5 * fit->sd_turn);
        z2 += std::pow(fit->turn / fit->sd_turn, 2);
        squares += fit->turn * fit->turn / kThreads;
      }
      INFO("blur " << blur_px << ", width " << width << ": mean square of error / sd " << z2 / kThreads
                   << ", error rms " << std::sqrt(squares));
      // Chi-squared of 16 over 16: 0.27 to 2.3 at 0.1 % and 0.3 %.
      CHECK(z2 / kThreads < 2.3);
      CHECK(z2 / kThreads > 0.27);
    }
  }
}

TEST_CASE("rows in which something crosses the thread are left out of it") {
  const double c0 = 14.3, slant = 0.011;
  cv::Mat seen = tests::expose(image_of(c0, slant, 1.5, 0.4), 2.0, 3);
  seen(cv::Rect(0, 40, 15, 12)).setTo(30.0);  // its edge runs beside the thread's middle
  cv::Mat image;
  seen.convertTo(image, CV_64F);
  const auto fit = core::fit_thread(rows_of(image, c0, slant), slant, 1.0);
  REQUIRE(fit);
  CHECK(fit->rows <= kRows - 12);
  CHECK(std::abs(fit->turn) < 1e-3);
}

TEST_CASE("too few rows make no thread") {
  auto rows = rows_of(image_of(14.3, 0.0, 1.5, 0.4), 14.3, 0.0);
  rows.resize(9);
  CHECK_FALSE(core::fit_thread(rows, 0.0, 1.0));
}
