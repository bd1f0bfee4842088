#include "render/scenario/scenario.h"

#include <fmt/format.h>

#include <set>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "render/film/clip_renderer.h"
#include "render/paint/static_painter.h"
#include "render/scenario/scene.h"
#include "render/video/video_writer.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using namespace glidelab::render;
namespace fs = std::filesystem;

namespace {

constexpr const char* kCamera = R"(format = 1
name = "a phone"
price_class = "200 EUR"
[camera]
width_px = 320
height_px = 240
frame_rate_hz = 120.0
focal_px = [400.0, 400.0]
[shutter]
kind = "rolling"
line_readout_s = 2e-5
[sensor]
full_well_e = 5000.0
tone = "gamma"
gamma = 2.2
[clock]
variable = true
stamp_tick_s = 0.001
[codec]
name = "h264"
bitrate_kbit_s = 5000.0
gop = 120
)";

constexpr const char* kMotions =
    "[[configuration]]\nname = \"m1\"\nmass_kg = 0.335\nincline_deg = 2.0\n[[configuration.clip]]\nname = \"c\"\n"
    "launched = \"down\"\nx0_m = 0.0\nv0_m_s = 0.4\nduration_s = 0.05\n";

struct Files {
  tests::TempDir dir;
  Scenario read(const std::string& sections, const std::string& camera = kCamera) const {
    fs::create_directories(dir / "cameras");
    base::write_file(dir / "cameras/phone.toml", camera);
    base::write_file(dir / "scenario.toml",
                     "format = 1\nname = \"test\"\ncamera_file = \"cameras/phone.toml\"\n" + sections + kMotions);
    return read_scenario(dir / "scenario.toml");
  }
  std::string message(const std::string& sections, const std::string& camera = kCamera) const {
    try {
      read(sections, camera);
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "nothing";
  }
};

std::vector<fs::path> catalogue() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(fs::path(tests::kSourceDir) / "scenarios/cameras")) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

TEST_CASE("A camera file gives what the scenario does not say, and the scenario's own keys go first") {
  const Files files;
  const Scenario scenario = files.read("[camera]\nframe_rate_hz = 100.0\n[sensor]\nread_noise_e = 3.0\n");
  CHECK(scenario.camera_name == "a phone");
  CHECK(scenario.camera.width_px == 320);
  CHECK(scenario.camera.focal_px.x() == 400.0);
  CHECK(scenario.recording.frame_rate_hz == 100.0);
  CHECK(scenario.recording.shutter.rolling);
  CHECK(scenario.sensor.full_well_e == 5000.0);
  CHECK(scenario.sensor.read_noise_e == 3.0);
  CHECK(scenario.sensor.tone.kind == ToneCurve::Kind::gamma);
  CHECK(scenario.recording.clock.variable);
  CHECK(scenario.codec == Codec::h264);
  CHECK(scenario.compression.gop == 120);
}

TEST_CASE("Another choice of the scenario takes away what belonged to the camera's") {
  const Files files;
  const Scenario scenario = files.read(
      "[codec]\nname = \"ffv1\"\n[shutter]\nkind = \"global\"\n[sensor]\ntone = \"linear\"\n[clock]\nvariable = "
      "false\n");
  CHECK(scenario.codec == Codec::ffv1);
  CHECK_FALSE(scenario.recording.shutter.rolling);
  CHECK(scenario.sensor.tone.kind == ToneCurve::Kind::linear);
  CHECK(scenario.recording.clock.stamp_tick_s == 0.0);
  CHECK(files.read("[codec]\ncrf = 20.0\n").compression.bitrate_kbit_s == 0.0);
}

TEST_CASE("A camera file that is not there is named with the scenario's line and the place that was looked at") {
  const tests::TempDir dir;
  base::write_file(dir / "scenario.toml",
                   std::string("format = 1\nname = \"test\"\ncamera_file = \"cameras/phone.toml\"\n") + kMotions);
  try {
    read_scenario(dir / "scenario.toml");
    FAIL("read");
  } catch (const base::InputError& error) {
    const std::string message = error.what();
    INFO(message);
    CHECK(message.find((dir / "scenario.toml").string() + ":3: camera_file: found no file " +
                       (dir / "cameras/phone.toml").string()) != std::string::npos);
    CHECK(message.find("from the scenario's folder") != std::string::npos);
  }
}

TEST_CASE("What is wrong is named with the file that it stands in") {
  const Files files;
  using Catch::Contains;
  CHECK_THAT(files.message("", std::string(kCamera) + "quality = 90\n"),
             Contains("phone.toml:23: codec.quality") && Contains("unknown key"));
  CHECK_THAT(files.message("", std::string("[sensor]\nfull_well_e = nan\n")),
             Contains("phone.toml:2: sensor.full_well_e"));
  CHECK_THAT(files.message("[sensor]\nreadnoise_e = 3.0\n"), Contains("scenario.toml:5: sensor.readnoise_e"));
  CHECK_THAT(files.message("", "lens = 3\n"), Contains("phone.toml:1: lens") && Contains("unknown key"));
  CHECK_THAT(files.message("", "camera = 3\n"), Contains("phone.toml:1: camera") && Contains("table"));
  CHECK_THAT(files.message("camera_fil = \"x\"\n"), Contains("camera_fil"));
  fs::remove(files.dir / "cameras/phone.toml");
  CHECK_THROWS_WITH(read_scenario(files.dir / "scenario.toml"), Contains("phone.toml"));
}

TEST_CASE("Where a camera file has sources, every value must have its kind and one") {
  const Files files;
  using Catch::Contains;
  const std::string camera = "[sensor]\nfull_well_e = 5000.0\nread_noise_e = 3.0\n";
  const std::string source = "[source.sensor]\nfull_well_e = [\"measured\", \"S1\"]\n";
  CHECK_THAT(files.message("", camera + source), Contains("phone.toml:3: sensor.read_noise_e") && Contains("source"));
  CHECK_THAT(files.message("", camera + source + "read_noise_e = [\"guessed\", \"S1\"]\n"),
             Contains("source.sensor.read_noise_e") && Contains("assumed"));
  CHECK_THAT(files.message("", camera + source + "read_noise_e = [\"assumed\"]\n"), Contains("read_noise_e"));
  CHECK_THAT(
      files.message("", camera + source + "read_noise_e = [\"assumed\", \"G1\"]\nprnu = [\"assumed\", \"G1\"]\n"),
      Contains("source.sensor.prnu") && Contains("unknown key"));
  CHECK(files.message("", camera + source + "read_noise_e = [\"assumed\", \"G1\"]\n") == "nothing");
}

TEST_CASE("Every camera of the catalogue has its head and its sources, and takes a frame") {
  const std::vector<fs::path> cameras = catalogue();
  CHECK(cameras.size() >= 14);
  std::set<std::string> names;
  for (const fs::path& file : cameras) {
    CAPTURE(file.filename().string());
    const base::TomlFile toml = base::TomlFile::load(file);
    const base::TomlTable root = toml.root();
    CHECK(names.insert(root.text("name")).second);
    CHECK_FALSE(root.text("price_class").empty());
    CHECK(root.has("source"));
    for (const char* section : {"camera", "shutter", "sensor", "clock", "codec"}) CHECK(root.has(section));
    // From where 1.9 m of the track fill the image.
    const base::TomlTable camera = root.table("camera");
    const double distance_m = 1.9 * camera.numbers("focal_px", 2)[0] / camera.number("width_px");
    const tests::TempDir dir;
    base::write_file(
        dir / "scenario.toml",
        fmt::format("format = 1\nname = \"t\"\ncamera_file = \"{}\"\n[camera]\nposition_m = [0.0, 0.1, {}]\n"
                    "[calibration]\nplane_y_m = 0.05\nsquare_m = 0.03\n",
                    file.string(), distance_m) +
            kMotions);
    const Scenario scenario = read_scenario(dir / "scenario.toml");
    const sim::ConfigurationSetup& configuration = scenario.motion.configurations.front();
    const RayTable rays = make_ray_table(scenario.camera);
    const StaticScene scene = empty_track(scenario, configuration.body.incline_rad);
    FloatImage background_e(scenario.camera.width_px, scenario.camera.height_px);
    const auto white_e = static_cast<float>(electrons_of_white(scenario));
    std::fill(background_e.values.begin(), background_e.values.end(), 0.38f * white_e);
    ClipRenderer renderer(scenario, configuration, scene, rays, background_e, 1, 0);
    const auto writer =
        open_video(dir / file_name_of(scenario.codec, scenario.compression, "c"),
                   {scenario.codec, scenario.camera.width_px, scenario.camera.height_px,
                    scenario.recording.frame_rate_hz, 1, scenario.compression, scenario.recording.clock.variable});
    const PixelRect all{0, 0, scenario.camera.width_px, scenario.camera.height_px};
    std::vector<std::uint16_t> codes(background_e.values.size());
    bool once = false;
    for_each_frame(
        configuration.body, configuration.motions.front(), scenario.recording, renderer.longest_step_m(),
        [&](const FrameMotion& frame) {
          if (once) return;
          once = true;
          if (scenario.sensor.bit_depth > 8) {
            renderer.read(frame, all, std::span<std::uint16_t>(codes));
            writer->write(std::span<const std::uint16_t>(codes));
            return;
          }
          std::vector<std::uint8_t> narrow(codes.size());
          renderer.read(frame, all, std::span<std::uint8_t>(narrow));
          std::copy(narrow.begin(), narrow.end(), codes.begin());
          if (scenario.recording.clock.variable) {
            writer->write(std::span<const std::uint8_t>(narrow), 0.0);
          } else {
            writer->write(std::span<const std::uint8_t>(narrow));
          }
        },
        renderer.detail());
    writer->finish();
    // The wall is where the sensor and its tone put 0.38 of white, within the noise of half a million pixels.
    double mean = 0.0;
    for (const std::uint16_t code : codes) mean += code / static_cast<double>(codes.size());
    const Sensor& sensor = scenario.sensor;
    const double converter = sensor.offset_dn + 0.38 * static_cast<double>(white_e) * sensor.gain_dn_per_e;
    const double black = sensor.tone.kind == ToneCurve::Kind::linear ? 0.0 : sensor.offset_dn;
    const double expected =
        sensor.largest_code() * sensor.tone((converter - black) / (sensor.largest_converter_code() - black));
    CHECK(std::abs(mean / expected - 1.0) < 0.02);  // glider and marker cover 2 % of the image at most
  }
}
