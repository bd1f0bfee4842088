#include "report/characterize/camera_report.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "base/errors.h"
#include "base/toml/strict_toml.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

core::Measured measured(double value, double sd, std::optional<core::HowMeasured> how = {}) {
  return {value, sd, how, {}, {}};
}

core::Measured missing(core::WhyUnmeasured why, std::optional<double> limit = {}) {
  return {{}, 0.0, {}, why, limit};
}

core::CameraMeasurement made_camera() {
  core::CameraMeasurement camera;
  camera.folder.name = "a <b> camera";
  camera.folder.bit_depth = 12;
  camera.width_px = 640;
  camera.height_px = 480;
  camera.frames = 44;
  camera.gain_dn_per_e = measured(0.40123, 0.0017);
  camera.read_noise_e = missing(core::unmeasured::BelowQuantisation{}, 3.2);
  camera.offset_dn = measured(64.02, 0.01);
  camera.full_well_e = missing(core::unmeasured::NotSaturated{}, 5400.0);
  camera.saturation_capacity_e = missing(core::unmeasured::NoLargestVariance{});
  camera.dark_signal_e_s = missing(core::unmeasured::NoDarkExposures{});
  camera.prnu = measured(0.0101, 0.0002, core::HowMeasured{core::HowMeasured::By::one_level, 0.49});
  camera.dsnu_e = measured(3.01, 0.04);
  camera.linearity_error = measured(0.0004, 0.0001);
  camera.curve = {{"flat-00", 0.001, 300.0, 300.0, 125.0, 0.5, 0.0, true},
                  {"flat-01", 0.002, 600.0, 600.0, 245.0, 1.0, 0.0, true},
                  {"flat-02", 0.003, 900.0, 900.0, 365.0, 1.5, 0.0, true},
                  {"flat-03", 0.2, 3600.0, 3600.0, 3.0, 0.1, 0.9, false}};
  camera.intercept_dn2 = 5.0;
  camera.saturation_dn = 3600.0;
  camera.notes = {core::Flicker{0.021, 2, 12}};
  return camera;
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Without a width and a height; its name holds a line break.
core::CameraMeasurement camera_of_a_file() {
  core::CameraMeasurement camera;
  camera.folder.name = "two\nlines";
  camera.folder.bit_depth = 10;
  camera.folder.frame_rate_hz = 120.0;
  camera.folder.pixel_pitch_m = 3.45e-6;
  camera.folder.price_class = "300 EUR";
  camera.gain_dn_per_e = {0.0812345, 0.0004, {}, {}, {}};
  camera.read_noise_e = {4.123456, 0.05, core::HowMeasured{core::HowMeasured::By::dark_frames}, {}, {}};
  camera.offset_dn = {64.0, 0.01, {}, {}, {}};
  camera.full_well_e = {12000.0, 60.0, {}, {}, {}};
  camera.dark_signal_e_s = {3.0, 0.5, {}, {}, {}};
  camera.prnu = {0.0101, 0.0002, {}, {}, {}};
  camera.dsnu_e = {{}, 0.0, {}, core::unmeasured::PatternNotSeen{true}, 0.5};
  return camera;
}

}  // namespace

TEST_CASE("characterize.json holds values with their sd, and null with reason and limit for what is missing") {
  const nlohmann::json json = nlohmann::json::parse(report::camera_json(made_camera()));
  const nlohmann::json& sensor = json.at("sensor");
  CHECK(sensor.at("gain_dn_per_e").at("value") == 0.40123);
  CHECK(sensor.at("gain_dn_per_e").at("sd") == 0.0017);
  CHECK(sensor.at("prnu").at("how") == "at 49 % of saturation");
  CHECK(sensor.at("read_noise_e").is_null());
  CHECK(sensor.at("limit").at("read_noise_e") == 3.2);
  CHECK(contains(sensor.at("why").at("full_well_e"), "no level reaches saturation"));
  CHECK(contains(sensor.at("why").at("dark_signal_e_s"), "it requires dark frames at two or more exposures"));
  CHECK(json.at("photon_transfer").size() == 4);
  CHECK(json.at("photon_transfer")[3].at("used") == false);
  CHECK(json.at("line_intercept_dn2") == 5.0);
  CHECK(json.at("width_px") == 640);
}

TEST_CASE("the camera's table shows digits that the sd supports, limits as such, and reasons below") {
  const std::string text = report::camera_text(made_camera());
  for (const char* part :
       {"0.4012  0.0017", "< 3.2", "> 5400", "1.010   0.020", "full well: no level reaches",
        "note: The light changes from frame to frame by up to 2.1 %, in 2 of 12 levels", "640 x 480"}) {
    INFO(part << "\n" << text);
    CHECK(contains(text, part));
  }
}

TEST_CASE("the camera's page holds both plots and escapes names") {
  const std::string page = report::camera_report(made_camera()).html;
  CHECK(contains(page, "a &lt;b&gt; camera"));
  CHECK_FALSE(contains(page, "a <b> camera"));
  CHECK(contains(page, "Photon transfer"));
  CHECK(contains(page, "Linearity"));
  CHECK(contains(page, "in 2 of 12 levels: the lamp flickers"));
}

TEST_CASE("a camera without a gain still has a page, which says why") {
  core::CameraMeasurement camera = made_camera();
  camera.gain_dn_per_e = missing(core::unmeasured::PixelsTogether{0.3});
  camera.intercept_dn2.reset();
  for (core::TransferPoint& point : camera.curve) {
    point.used = false;
    point.exposure_s.reset();
  }
  const std::string page = report::camera_report(camera).html;
  CHECK(contains(page, "neighbouring pixels is correlated"));
  CHECK_FALSE(contains(page, "Linearity: mean over exposure"));
  CHECK(nlohmann::json::parse(report::camera_json(camera)).at("line_intercept_dn2").is_null());
}

TEST_CASE("a camera file is strict TOML with the keys of a scenario's sensor") {
  const std::string text = report::camera_toml(camera_of_a_file());
  const base::TomlFile file = base::TomlFile::parse(text, "camera.toml");
  const base::TomlTable sensor = file.root().table("sensor");
  CHECK(sensor.integer("bit_depth", 8, 16) == 10);
  // Written with three digits of the standard deviation, so right to less than 1 % of it.
  CHECK(std::abs(sensor.number("gain_dn_per_e") - 0.0812345) < 0.01 * 0.0004);
  CHECK(std::abs(sensor.number("read_noise_e") - 4.123456) < 0.01 * 0.05);
  CHECK(sensor.number("offset_dn") == 64.0);
  CHECK(sensor.number("full_well_e") == 12000.0);
  CHECK(sensor.number("dark_signal_e_s") == 3.0);
  CHECK(sensor.number("prnu") == 0.0101);
  CHECK(sensor.number("dsnu_e") == 0.5);  // at its limit
  file.finish();
  for (const char* part : {"# two lines\n", "measured, sd 0.0004", "from the dark frames",
                           "NOT measured, this is the limit: not seen", "120 Hz", "3.45 um", "300 EUR"}) {
    INFO(part);
    CHECK(text.find(part) != std::string::npos);
  }
}

TEST_CASE("a number that was not measured is nan, which a strict reader refuses by name") {
  core::CameraMeasurement camera = camera_of_a_file();
  camera.gain_dn_per_e = {{}, 0.0, {}, core::unmeasured::NotLinear{}, {}};
  camera.dark_signal_e_s = {{}, 0.0, {}, core::unmeasured::NoDarkExposures{}, {}};
  const std::string text = report::camera_toml(camera);
  CHECK(text.find("# dark_signal_e_s: not measured: it requires dark frames") != std::string::npos);
  const base::TomlFile file = base::TomlFile::parse(text, "camera.toml");
  const base::TomlTable sensor = file.root().table("sensor");
  for (const char* key : {"bit_depth", "full_well_e", "read_noise_e", "offset_dn", "prnu", "dsnu_e"})
    sensor.number(key);
  sensor.number("gain_dn_per_e");
  try {
    file.finish();
    FAIL("nan was taken for a number");
  } catch (const base::InputError& error) {
    REQUIRE(error.issues().size() == 1);
    CHECK(error.issues()[0].key == "sensor.gain_dn_per_e");
  }
}

TEST_CASE("a dark signal below zero is written as none seen") {
  core::CameraMeasurement camera = camera_of_a_file();
  camera.dark_signal_e_s = {-0.2, 0.3, {}, {}, {}};
  const std::string text = report::camera_toml(camera);
  CHECK(text.find("dark_signal_e_s = 0.0  # measured as -0.2, sd 0.3: not significant") != std::string::npos);
}
