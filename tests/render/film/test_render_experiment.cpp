#include "render/film/render_experiment.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <set>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/csv.h"
#include "base/toml/strict_toml.h"
#include "core/experiment/experiment.h"
#include "render/film/truth_files.h"
#include "render/scenario/scene.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using namespace glidelab::render;
namespace fs = std::filesystem;

namespace {

constexpr const char* kScenario = R"(
format = 1
name = "small \"one\""
seed = 5
[camera]
width_px = 240
height_px = 180
frame_rate_hz = 120.0
exposure_s = 0.002
focal_px = [360.0, 361.0]
position_m = [0.1, 0.1, 2.4]
roll_deg = 1.0
distortion = { k1 = -0.1, p1 = 0.001 }
[calibration]
inner_corners = [5, 4]
square_m = 0.08
views = 3
[marker]
diameter_m = 0.06
height_m = 0.02
[plumb]
x_m = 0.4
[[configuration]]
name = "m1"
mass_kg = 0.335
incline_deg = 4.1
stated_incline_deg = 4.0
stated_incline_sd_deg = 0.3
group = "a"
[[configuration.force]]
law = "viscous"
k_over_m_1_s = 2.8
[[configuration.force]]
law = "coulomb"
mu = 0.007
[[configuration.clip]]
name = "m1-up"
launched = "up"
x0_m = 0.2
v0_m_s = -1.3
duration_s = 0.1
[[configuration.clip]]
name = "m1-down"
launched = "down"
x0_m = -0.5
v0_m_s = 1.1
duration_s = 0.08
[[configuration]]
name = "m2"
mass_kg = 0.435
incline_deg = 0.0
group = "b"
[[configuration.force]]
law = "quadratic"
c_kg_m = 0.1
[[configuration.clip]]
name = "m2-down"
launched = "down"
x0_m = -0.2
v0_m_s = 1.0
duration_s = 0.05
)";

Scenario small_scenario(const std::string& extra = "") {
  const tests::TempDir dir;
  std::string text = kScenario;
  text.insert(text.find("[camera]"), extra);
  base::write_file(dir / "s.toml", text);
  return read_scenario(dir / "s.toml");
}

struct Rendered {
  tests::TempDir dir;
  RenderSummary summary;
  fs::path experiment() const { return dir / "e"; }
  fs::path truth() const { return dir / "e.truth"; }
  Rendered(const Scenario& scenario, const RenderOptions& options, const base::Progress& progress = base::no_progress) {
    fs::create_directories(experiment());
    fs::create_directories(truth());
    summary = render_experiment(scenario, experiment(), truth(), options, progress);
  }
  /// Every file's bytes, by its path.
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> found;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(dir.path())) {
      if (entry.is_regular_file()) found[entry.path().lexically_relative(dir.path())] = base::read_file(entry.path());
    }
    return found;
  }
};

std::vector<cv::Mat> frames_of(const fs::path& path) {
  cv::VideoCapture capture(path.string(), cv::CAP_FFMPEG);
  std::vector<cv::Mat> frames;
  cv::Mat frame;
  while (capture.read(frame)) {
    cv::Mat grey;
    cv::extractChannel(frame, grey, 0);
    frames.push_back(grey);
  }
  return frames;
}

}  // namespace

TEST_CASE("An experiment folder holds what the contract says, and the analysis reads it") {
  const Rendered made(small_scenario(), {.seed = 5, .jobs = 2});
  CHECK(made.summary.clips == 3);
  CHECK(made.summary.frames == 12 + 10 + 6);
  std::set<std::string> names;
  for (const auto& [name, bytes] : made.files()) names.insert(name);
  CHECK(names == std::set<std::string>{
                     "e/experiment.toml", "e/clips/m1-up.mkv", "e/clips/m1-down.mkv", "e/clips/m2-down.mkv",
                     "e/calibration/view-00.png", "e/calibration/view-01.png", "e/calibration/view-02.png",
                     "e/calibration/plane.png", "e/plumb.png", "e.truth/truth.json", "e.truth/trajectory-m1-up.csv",
                     "e.truth/trajectory-m1-down.csv", "e.truth/trajectory-m2-down.csv", "e.truth/marker-m1-up.csv",
                     "e.truth/marker-m1-down.csv", "e.truth/marker-m2-down.csv", "e.truth/frames-m1-up.csv",
                     "e.truth/frames-m1-down.csv", "e.truth/frames-m2-down.csv"});
  const core::Experiment experiment = core::read_experiment(made.experiment());
  CHECK(experiment.name == "small \"one\"");
  REQUIRE(experiment.clips.size() == 3);
  CHECK(experiment.clips[0].launched == core::Launched::up);
  CHECK(std::abs(experiment.clips[0].incline_rad * 180.0 / M_PI - 4.0) < 1e-12);  // as stated, not as true
  CHECK(experiment.clips[0].group == "a");
  CHECK(experiment.clips[2].group == "b");
  CHECK(experiment.calibration->views.size() == 3);
  CHECK(experiment.calibration->inner_corners == core::BoardSize{5, 4});
  CHECK(experiment.marker->height_m == 0.02);
  REQUIRE(experiment.plumb);
  CHECK(experiment.plumb->region.width > 0);
  const std::string text = base::read_file(made.experiment() / "experiment.toml");
  for (const char* secret : {"4.1", "2.8", "0.007", "truth", "seed", "focal", "glidelab", "synthetic"}) {
    CAPTURE(secret);
    CHECK(text.find(secret) == std::string::npos);
  }
}

TEST_CASE("A name with a control character reads back from experiment.toml as it was") {
  Scenario scenario = small_scenario();
  scenario.motion.name = "a\x7f\"b\"";
  base::TomlFile file = base::TomlFile::parse(experiment_toml(scenario), "experiment.toml");
  CHECK(file.root().text("name") == scenario.motion.name);
}

TEST_CASE("The truth folder holds the motion at mid-exposure, and the parameters where the law has them") {
  const Scenario scenario = small_scenario();
  const Rendered made(scenario, {.seed = 5, .jobs = 1});
  const auto truth = nlohmann::json::parse(base::read_file(made.truth() / "truth.json"));
  CHECK(truth["format"] == 1);
  CHECK(truth["seed"] == 5);
  CHECK(std::abs(truth["configurations"][0]["k_over_m_1_s"].get<double>() - 2.8) < 1e-12);
  CHECK(truth["configurations"][0]["mu"] == 0.007);
  CHECK(std::abs(truth["configurations"][0]["alpha_deg"].get<double>() - 4.1) < 1e-12);
  CHECK(truth["configurations"][0]["v_lim_m_s"].get<double>() > 0.0);
  CHECK(truth["configurations"][0]["clips"] == nlohmann::json({"m1-up", "m1-down"}));
  CHECK(truth["configurations"][1]["k_over_m_1_s"].is_null());
  CHECK(truth["configurations"][1]["v_lim_m_s"].is_null());
  CHECK(truth["clips"][0]["frames"] == 12);
  CHECK(truth["clips"][0]["trajectory"] == "trajectory-m1-up.csv");
  CHECK(truth["camera"]["distortion"]["k1"] == -0.1);
  const base::CsvTable table =
      base::read_csv(made.truth() / "trajectory-m1-up.csv", {"t_s", "x_m", "v_m_s", "a_m_s2"}, {}, true);
  REQUIRE(table.column("t_s").size() == 12);
  for (std::size_t k = 0; k < 12; ++k) CHECK(table.column("t_s")[k] == static_cast<double>(k) / 120.0);
  // Mid-exposure of the first frame: 1 ms after the launch from 0.2 m with -1.3 m/s; a ~ 4.4 m/s² adds 2e-6 m.
  CHECK(std::abs(table.column("x_m")[0] - (0.2 - 0.0013)) < 5e-6);
}

TEST_CASE("Every byte is the same for any number of jobs, and others for another seed") {
  const Scenario scenario = small_scenario();
  const auto one = Rendered(scenario, {.seed = 5, .jobs = 1}).files();
  const auto three = Rendered(scenario, {.seed = 5, .jobs = 3}).files();
  CHECK(one == three);
  const auto other = Rendered(scenario, {.seed = 6, .jobs = 1}).files();
  CHECK(one.at("e/clips/m1-up.mkv") != other.at("e/clips/m1-up.mkv"));
  CHECK(one.at("e/calibration/view-00.png") != other.at("e/calibration/view-00.png"));
  CHECK(one.at("e/experiment.toml") == other.at("e/experiment.toml"));
  CHECK(one.at("e.truth/trajectory-m1-up.csv") == other.at("e.truth/trajectory-m1-up.csv"));
}

TEST_CASE("The marker in the frames is where the truth says, through the true camera") {
  // All else is black, so that the photometric centre needs no threshold. Of R = 3 px: the pixels' own sampling errs
  // by up to 0.009 px (test_moving_painter), rounding to codes and noise (0.9 codes in 28 pixels of 190) by 0.002 px,
  // and the mean over the exposure of 2 ms lies off its middle by a T²/24 = 1e-6 m, 1e-4 px.
  Scenario scenario = small_scenario();
  scenario.marker.diameter_m = 0.04;
  scenario.scene.wall_albedo = scenario.scene.track_albedo = scenario.scene.glider_albedo = 0.0;
  const Rendered made(scenario, {.seed = 5, .jobs = 2});
  for (const sim::MotionSetup& motion : scenario.motion.configurations[0].motions) {
    const base::CsvTable table =
        base::read_csv(made.truth() / ("trajectory-" + motion.name + ".csv"), {"x_m"}, {}, true);
    const auto frames = frames_of(made.experiment() / "clips" / (motion.name + ".mkv"));
    REQUIRE(frames.size() == table.column("x_m").size());
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const double incline = scenario.motion.configurations[0].body.incline_rad;
      const Eigen::Vector3d marker_C =
          scenario.camera.X_WC.inverse() * marker_position_W(scenario, incline, table.column("x_m")[k]);
      const Eigen::Vector2d expected = image_of(scenario.camera, image_of_sphere(marker_C, 0.02).value()).centroid_px;
      double sum = 0.0;
      Eigen::Vector2d moment = Eigen::Vector2d::Zero();
      const int middle_u = static_cast<int>(std::lround(expected.x()));
      const int middle_v = static_cast<int>(std::lround(expected.y()));
      for (int v = middle_v - 4; v <= middle_v + 4; ++v) {
        for (int u = middle_u - 4; u <= middle_u + 4; ++u) {
          const double value = frames[k].at<std::uint8_t>(v, u) - scenario.sensor.offset_dn;
          sum += value;
          moment += value * Eigen::Vector2d(u, v);
        }
      }
      CAPTURE(motion.name, k);
      CHECK((moment / sum - expected).norm() < 0.015);
    }
  }
}

TEST_CASE("16-bit clips are folders of images, raw ones are AVI, and the folder says so") {
  Scenario scenario = small_scenario();
  scenario.codec = Codec::raw;
  {
    const Rendered made(scenario, {.seed = 5, .jobs = 2});
    CHECK(frames_of(made.experiment() / "clips" / "m1-up.avi").size() == 12);
    CHECK(core::read_experiment(made.experiment()).clips[0].file.filename() == "m1-up.avi");
  }
  const Scenario deep = small_scenario("[sensor]\nbit_depth = 12\n");
  const Rendered made(deep, {.seed = 5, .jobs = 2});
  const core::Experiment experiment = core::read_experiment(made.experiment());
  CHECK(experiment.camera->bit_depth == 12);
  CHECK(fs::is_directory(experiment.clips[0].file));
  const cv::Mat frame = cv::imread((made.experiment() / "clips/m1-up/000000.png").string(), cv::IMREAD_UNCHANGED);
  REQUIRE(frame.type() == CV_16U);
  double most = 0.0;
  cv::minMaxLoc(frame, nullptr, &most);
  CHECK(most > 2048.0);
  CHECK(most <= 4095.0);
  CHECK(cv::imread((made.experiment() / "calibration/plane.png").string(), cv::IMREAD_UNCHANGED).type() == CV_8U);
}

TEST_CASE("Progress rises to 1, and an interruption comes out of render_experiment") {
  double last = 0.0;
  double largest = 0.0;
  const Rendered made(small_scenario(), {.seed = 5, .jobs = 1}, [&](std::string_view, double fraction) {
    CHECK(fraction >= last);
    last = fraction;
    largest = std::max(largest, fraction);
  });
  CHECK(std::abs(largest - 1.0) < 1e-9);
  for (const double at : {0.0, 0.9}) {
    const auto interrupt = [at](std::string_view, double fraction) {
      if (fraction > at) throw base::Interrupted();
    };
    CHECK_THROWS_AS(Rendered(small_scenario(), {.seed = 5, .jobs = 2}, interrupt), base::Interrupted);
  }
}

TEST_CASE("A folder that cannot be written is an error of the environment") {
  const tests::TempDir dir;
  base::write_file(dir / "file", "x");
  CHECK_THROWS_AS(render_experiment(small_scenario(), dir / "file" / "e", dir / "t", {}), base::EnvironmentError);
}
