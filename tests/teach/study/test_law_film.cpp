#include "teach/study/law_study.h"

#include <cmath>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "base/files/file_io.h"
#include "sim/oracle/closed_forms.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

/// The middle along the row of the white pixels about a place, and their number. The window is lower than the marker,
/// and than the distance from it to the glider's magnets.
struct Seen {
  double u_px = 0.0;
  int pixels = 0;
};

Seen white_about(const cv::Mat& image, double u, double v) {
  const cv::Rect window(static_cast<int>(std::lround(u)) - 12, static_cast<int>(std::lround(v)) - 2, 25, 5);
  Seen seen;
  for (int y = window.y; y < window.y + window.height; ++y) {
    for (int x = window.x; x < window.x + window.width; ++x) {
      if (image.at<unsigned char>(y, x) < 220) continue;
      seen.u_px += x;
      ++seen.pixels;
    }
  }
  seen.u_px /= seen.pixels;
  return seen;
}

}  // namespace

TEST_CASE("A law's film is small, and in each of its rows the marker is where equation (2) has it") {
  const auto file = std::filesystem::path(tests::kSourceDir) / "scenarios/laws/1-viscous.toml";
  const teach::LawFilm film = teach::film_law(file);
  CHECK(film.mp4.size() < 200'000);
  // The level and the inclined motions of the file: x0, v0, duration.
  const double k = 2.768, alpha = 4.311 * std::acos(-1.0) / 180.0, v_lim = 9.80665 * std::sin(alpha) / k;
  struct Motion {
    double x0, v0, duration_s, alpha, v_lim;
  };
  const std::vector<Motion> motions = {{-0.4, 1.6, 1.6, 0.0, 0.0},
                                       {0.4, -1.6, 1.6, 0.0, 0.0},
                                       {0.1, -1.3, 2.0, alpha, v_lim},
                                       {-0.3, 0.0, 2.0, alpha, v_lim},
                                       {-0.5, 1.2, 2.0, alpha, v_lim}};
  REQUIRE(film.clips.size() == motions.size());
  CHECK(film.clips[0] == "level-down");
  CHECK(film.frames == 51);  // 2 s at 25 a second, with both ends
  const tests::TempDir temp;
  base::write_file(temp / "film.mp4", film.mp4);
  cv::VideoCapture video((temp / "film.mp4").string());
  REQUIRE(video.isOpened());
  cv::Mat image, grey;
  std::size_t k_frame = 0;
  for (; video.read(image); ++k_frame) {
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
    REQUIRE(grey.size() == cv::Size(film.width_px, film.height_px));
    const int height = grey.rows / static_cast<int>(motions.size());
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const Motion& m = motions[i];
      const double t = std::min(static_cast<double>(k_frame) / film.frame_rate_hz, m.duration_s);
      const double x = sim::viscous_motion(k, m.v_lim, m.x0, m.v0, t).x_m;
      // Half the width is half the track and 0.1 m, and the marker is on the line of motion.
      const double px_m = 0.5 * film.width_px / 1.1;
      const double u = 0.5 * (film.width_px - 1) + px_m * x * std::cos(m.alpha);
      const double v = (static_cast<double>(i) + 0.5) * height - 0.5 + px_m * x * std::sin(m.alpha);
      INFO("frame " << k_frame << ", row " << i);
      const Seen marker = white_about(grey, u, v);
      // A disc of 7 px: more than half of 5 lines of it, and its middle to half a pixel in an encoded image.
      CHECK(marker.pixels > 15);
      CHECK(std::abs(marker.u_px - u) < 0.8);
    }
  }
  CHECK(k_frame == film.frames);
}
