/// What a perfect camera would have taken, written beside the truth.
#include "render/film/truth_files.h"

#include <cmath>

#include "base/files/file_io.h"
#include "base/text/csv.h"
#include "core/experiment/experiment.h"
#include "core/pictures/frames/frame_source.h"
#include "render/film/render_experiment.h"
#include "tests/catch.h"
#include "tests/one_glider.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using namespace glidelab::render;

namespace {

/// A bad camera: bent lens, dark corners, much noise, a long exposure, a light that flickers, a mount that shakes.
const std::string kScenario = R"(format = 1
name = "ideal"
[camera]
width_px = 240
height_px = 160
frame_rate_hz = 100.0
exposure_s = 0.008
focal_px = [360.0, 360.0]
[camera.distortion]
k1 = -0.2
k2 = 0.05
p1 = 0.001
p2 = 0.002
[sensor]
full_well_e = 2000
read_noise_e = 20
[vignetting]
cos4 = true
[light]
flicker_depth = 0.3
flicker_hz = 37.0
[calibration]
inner_corners = [5, 4]
square_m = 0.12
views = 3
[marker]
diameter_m = 0.06
)" + tests::one_glider(0.0, 2.0, 0.0, {{"c", -0.3, 1.2, 0.31}});

struct Spot {
  double u = 0.0, v = 0.0;
  int pixels = 0;
};

/// Centroid of what is brighter than white: the retro-reflective marker alone.
Spot brightest(const cv::Mat& grey) {
  Spot spot;
  double weight = 0.0;
  for (int v = 0; v < grey.rows; ++v) {
    for (int u = 0; u < grey.cols; ++u) {
      if (grey.at<unsigned char>(v, u) <= 195) continue;
      weight += 1.0;
      spot.u += u;
      spot.v += v;
      ++spot.pixels;
    }
  }
  spot.u /= weight;
  spot.v /= weight;
  return spot;
}

}  // namespace

TEST_CASE("ideal frames hold no noise, no flicker and no lens, and the marker where the truth says") {
  const tests::TempDir dir;
  base::write_file(dir / "scenario.toml", kScenario);
  std::filesystem::create_directories(dir / "e");
  std::filesystem::create_directories(dir / "e.truth");
  const Scenario scenario = read_scenario(dir / "scenario.toml");
  render_experiment(scenario, dir / "e", dir / "e.truth", {.seed = 1, .jobs = 1, .ideal = true});
  const base::CsvTable centres =
      base::read_csv(dir / "e.truth/ideal-c.csv", {"frame", "t_s", "u_px", "v_px"}, {}, false);
  REQUIRE(centres.columns[0].size() == 31);

  const core::CameraSettings camera = *core::read_experiment(dir / "e").camera;
  const auto frames = core::open_frames(dir / "e.truth/ideal-c.mkv", camera, false, {});
  std::size_t k = 0;
  cv::Mat first;
  double previous_u = 0.0;
  while (auto frame = frames->next()) {
    const cv::Mat& grey = frame->grey;
    REQUIRE(grey.type() == CV_8UC1);
    if (k == 0) first = grey.clone();
    // The image's top corners show the wall alone, which neither moves nor changes.
    CHECK(cv::norm(grey(cv::Rect(0, 0, 40, 20)), first(cv::Rect(0, 0, 40, 20)), cv::NORM_INF) == 0.0);
    const Spot spot = brightest(grey);
    INFO("frame " << k);
    CHECK(spot.pixels > 50);
    // Pixels that are covered to 92 % or more count whole: a disc of r = 4 px has some 25 at its edge, each in or out
    // by chance, which moves its centroid by r sqrt(25 / 12) / (pi r²) = 0.11 px; three of these. This lens, or half
    // the exposure, would move it by a pixel and more.
    CHECK(std::abs(spot.u - centres.columns[2][k]) < 0.35);
    CHECK(std::abs(spot.v - centres.columns[3][k]) < 0.35);
    if (k > 0) CHECK(centres.columns[2][k] > previous_u);
    previous_u = centres.columns[2][k];
    ++k;
  }
  CHECK(k == 31);
}

TEST_CASE("without the option there are no ideal frames") {
  const tests::TempDir dir;
  base::write_file(dir / "scenario.toml", kScenario);
  std::filesystem::create_directories(dir / "e");
  std::filesystem::create_directories(dir / "e.truth");
  render_experiment(read_scenario(dir / "scenario.toml"), dir / "e", dir / "e.truth", {.seed = 1, .jobs = 1});
  CHECK_FALSE(std::filesystem::exists(dir / "e.truth/ideal-c.mkv"));
  CHECK_FALSE(std::filesystem::exists(dir / "e.truth/ideal-c.csv"));
}
