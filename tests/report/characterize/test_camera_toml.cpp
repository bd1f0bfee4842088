#include "report/characterize/camera_toml.h"

#include <cmath>

#include "base/errors.h"
#include "base/toml/strict_toml.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

core::CameraMeasurement made_camera() {
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

TEST_CASE("a camera file is strict TOML with the keys of a scenario's sensor") {
  const std::string text = report::camera_toml(made_camera());
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
  core::CameraMeasurement camera = made_camera();
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
  core::CameraMeasurement camera = made_camera();
  camera.dark_signal_e_s = {-0.2, 0.3, {}, {}, {}};
  const std::string text = report::camera_toml(camera);
  CHECK(text.find("dark_signal_e_s = 0.0  # measured as -0.2, sd 0.3: not significant") != std::string::npos);
}
