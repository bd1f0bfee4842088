/// Every section of the table: one that is added passes these tests or they name what it lacks.
#include "render/scenario/scenario_sections.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "base/files/file_io.h"
#include "test_paths.h"
#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::render;

namespace {

/// The block of TOML in which the documentation shows all sections.
std::string documented_sections() {
  const std::string text = base::read_file(std::filesystem::path(tests::kSourceDir) / "docs/reference/scenario.md");
  const std::size_t start = text.find("\n[camera]\nwidth_px");
  return text.substr(start, text.find("\n```", start) - start + 1);
}

Scenario read(const std::string& sections) {
  const base::TomlFile file = base::TomlFile::parse(sections, "s.toml");
  Scenario scenario;
  read_sections(file.root(), scenario);
  file.finish();
  return scenario;
}

}  // namespace

TEST_CASE("each section has a name of its own, a help, a reader and what a perfect camera makes of it") {
  std::set<std::string_view> names;
  for (const ScenarioSection* section : scenario_sections()) {
    INFO(section->name);
    CHECK(names.insert(section->name).second);
    CHECK_FALSE(section->help.empty());
    CHECK(section->read != nullptr);
    CHECK(section->ideal != nullptr);
  }
}

TEST_CASE("the documentation of scenarios shows each section, and no section that is not in the table") {
  const std::string text = documented_sections();
  std::set<std::string> shown, listed;
  for (std::size_t at = text.find("\n["); at != std::string::npos; at = text.find("\n[", at + 1)) {
    if (text[at + 2] != '[') shown.insert(text.substr(at + 2, text.find(']', at) - at - 2));
  }
  for (const ScenarioSection* section : scenario_sections()) listed.insert(std::string(section->name));
  CHECK(shown == listed);
}

TEST_CASE("without any section a scenario is what the documentation shows, which is read without an error") {
  const Scenario documented = read("[camera]\nwidth_px = 800\nheight_px = 600\n[track]\ndownhill = \"+X\"\n");
  const Scenario empty = read("");
  CHECK(sections_truth(documented) == sections_truth(empty));
  CHECK(empty.camera.center_px == Eigen::Vector2d(399.5, 299.5));
  CHECK(empty.recording.shutter.rows == 600);
  CHECK(empty.codec == Codec::magicyuv);
}

TEST_CASE(
    "a perfect camera has no lens error, blur, flicker, shake, clock error or rolling shutter, and all else stays") {
  const Scenario scenario = read(R"(
[camera]
width_px = 640
distortion = { k1 = -0.1 }
[clock]
jitter_s = 1e-5
[shutter]
kind = "rolling"
line_readout_s = 1e-6
[sensor]
read_noise_e = 12.0
[vignetting]
cos4 = true
[focus]
f_number = 2.0
focus_distance_m = 2.4
pixel_pitch_m = 5e-6
[light]
flicker_depth = 0.5
[mount]
focal_change = 0.01
[marker]
diameter_m = 0.03
[plumb]
x_m = 0.3
)");
  const Scenario ideal = ideal_of(scenario);
  CHECK(ideal.camera.lens.k1 == 0.0);
  CHECK(ideal.recording.clock.jitter_s == 0.0);
  CHECK_FALSE(ideal.recording.shutter.rolling);
  CHECK(ideal.recording.shutter.rows == 600);
  CHECK(ideal.vignetting.none());
  CHECK_FALSE(ideal.focus);
  CHECK_FALSE(ideal.light.flickers());
  CHECK_FALSE(ideal.mount.moves());
  CHECK(ideal.mount.focal_change == 0.0);
  CHECK(ideal.camera.width_px == 640);
  CHECK(ideal.camera.focal_px == scenario.camera.focal_px);
  CHECK(ideal.sensor.read_noise_e == 12.0);
  CHECK(ideal.marker.diameter_m == 0.03);
  CHECK(ideal.plumb->x_m == 0.3);
}

TEST_CASE("a sensor of more than 8 bits is kept as PNG unless another codec is asked for, which is refused") {
  CHECK(read("[sensor]\nbit_depth = 12\n").codec == Codec::png);
  CHECK(read("[sensor]\nbit_depth = 12\n[codec]\nname = \"png\"\n").codec == Codec::png);
  const auto message = [](const std::string& text) -> std::string {
    try {
      read(text);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "nothing";
  };
  CHECK_THAT(message("[sensor]\nbit_depth = 12\n[codec]\nname = \"mjpeg\"\n"),
             Catch::StartsWith("s.toml:4: codec.name: found text \"mjpeg\""));
  // Without a codec the container follows from the depth, and a folder holds no time stamps.
  CHECK_THAT(message("[sensor]\nbit_depth = 12\n[clock]\nvariable = true\n"),
             Catch::StartsWith("s.toml:4: clock.variable: found a variable rate for png"));
  CHECK_THAT(message("[codec]\nname = \"hevc\"\n[sensor]\nbit_depth = 12\n"),
             Catch::StartsWith("s.toml:2: codec.name: found text \"hevc\"") && !Catch::Contains("others hold 8"));
}
