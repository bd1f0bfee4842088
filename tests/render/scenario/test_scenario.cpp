#include "render/scenario/scenario.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "render/scenario/scene.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using namespace glidelab::render;

namespace {

constexpr const char* kMotions = R"(
[[configuration]]
name = "m1"
mass_kg = 0.335
incline_deg = 4.0
group = "g"
[[configuration.force]]
law = "viscous"
k_over_m_1_s = 2.8
[[configuration.clip]]
name = "m1-up"
launched = "up"
x0_m = 0.2
v0_m_s = -1.3
duration_s = 0.1
)";

Scenario read(const std::string& sections, const std::string& motions = kMotions) {
  const tests::TempDir dir;
  base::write_file(dir / "scenario.toml", "format = 1\nname = \"test\"\n" + sections + motions);
  return read_scenario(dir / "scenario.toml");
}

std::string message(const std::string& sections, const std::string& motions = kMotions) {
  try {
    read(sections, motions);
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "nothing";
}

}  // namespace

TEST_CASE("An exposure longer than the frame time is one error, with a clock that has a jitter as well") {
  const std::string camera = "[camera]\nframe_rate_hz = 200.0\nexposure_s = 0.006\n";
  for (const std::string clock : {"rate_error_ppm = 50.0\n", "jitter_s = 1e-5\n"}) {
    const std::string text = message(camera + "[clock]\n" + clock);
    CHECK_THAT(text, Catch::Contains("frame time") && !Catch::Contains("overlap"));
  }
  CHECK_THAT(message("[camera]\nframe_rate_hz = 200.0\nexposure_s = 0.005\n[clock]\njitter_s = 1e-5\n"),
             Catch::Contains("overlap"));
}

TEST_CASE("The paper's scenarios read, with the camera that is written there") {
  for (const char* name : {"level", "inclined"}) {
    const Scenario scenario = read_scenario(fmt::format("{}/scenarios/paper/{}.toml", tests::kSourceDir, name));
    CHECK(scenario.camera.width_px == 800);
    CHECK(scenario.camera.height_px == 600);
    CHECK(scenario.recording.frame_rate_hz == 200.0);
    CHECK(scenario.recording.exposure_s == 0.001);
    CHECK(scenario.plumb);
    CHECK(scenario.motion.configurations.size() == 3);
    // A field of about 1.6 m.
    const double left = project(scenario.camera, {-0.75, 0.0, 0.0})->x();
    const double right = project(scenario.camera, {0.75, 0.0, 0.0})->x();
    CHECK(left > 0.0);
    CHECK(right < 799.0);
    CHECK(right - left > 700.0);
  }
}

TEST_CASE("A scenario of motions alone gets a camera that sees them") {
  const Scenario scenario = read("");
  CHECK(scenario.seed == 1);
  CHECK(scenario.codec == Codec::magicyuv);
  CHECK_FALSE(scenario.plumb);
  CHECK(std::abs(scenario.camera.center_px.x() - 399.5) < 1e-12);
  CHECK(std::abs(scenario.sensor.gain_dn_per_e * scenario.sensor.full_well_e + scenario.sensor.offset_dn - 255.0) <
        1e-9);
}

TEST_CASE("Keys are converted to SI and radians where they are read") {
  const Scenario scenario = read(
      "seed = 12\n[camera]\nroll_deg = 90.0\nposition_m = [0.0, 0.0, 3.0]\n[camera.distortion]\nk1 = -0.05\n"
      "[sensor]\nbit_depth = 12\n[calibration]\nplane_rotation_deg = 2.0\ninner_corners = [7, 5]\n[track]\ndownhill = "
      "\"-X\"\n"
      "[marker]\nheight_m = 0.01\n");
  CHECK(scenario.seed == 12);
  CHECK(scenario.camera.lens.k1 == -0.05);
  // Turned clockwise by 90 degrees, the camera's x points down.
  CHECK((scenario.camera.X_WC.linear().col(0) - Eigen::Vector3d(0.0, -1.0, 0.0)).norm() < 1e-12);
  CHECK(std::abs(scenario.pattern.plane_rotation_rad - 2.0 * std::numbers::pi / 180.0) < 1e-15);
  CHECK(scenario.codec == Codec::png);
  CHECK(scenario.sensor.largest_code() == 4095);
  CHECK(scenario.track.downhill == -1);
}

TEST_CASE("White is given as a code, through a tone curve too, or in photons") {
  const double linear_e = electrons_of_white(read("[sensor]\nfull_well_e = 10000.0\nwhite_level = 0.5\n"));
  // Full well at code 255, offset 2: white is at 125.5 of 253 codes above it.
  CHECK(std::abs(linear_e - 10000.0 * 125.5 / 253.0) < 1e-9);
  const double gamma_e = electrons_of_white(
      read("[sensor]\nfull_well_e = 10000.0\nwhite_level = 0.5\ntone = \"gamma\"\ngamma = 2.0\nconverter_bits = 12\n"));
  CHECK(std::abs(gamma_e - 2500.0) < 1e-9);
  const std::string photons = "[sensor]\nquantum_efficiency = 0.5\nwhite_photons_s = 1e7\n[camera]\nexposure_s = ";
  CHECK(std::abs(electrons_of_white(read(photons + "0.001\n")) - 5000.0) < 1e-9);
  CHECK(std::abs(electrons_of_white(read(photons + "0.002\n")) - 10000.0) < 1e-9);
}

TEST_CASE("What makes no sense is refused by its key, with the line") {
  struct Case {
    const char* sections;
    const char* key;
    const char* words;
  };
  const Case cases[] = {
      {"[camera]\nframe_rate_hz = 200.0\nexposure_s = 0.006\n", "camera.exposure_s", "frame time"},
      {"[camera]\nframe_rate_hz = 0.0\n", "camera.frame_rate_hz", "number"},
      {"[camera]\nexposure_s = 0.0\n", "camera.exposure_s", "above 0"},
      {"[camera]\nfocal_px = [1200.0]\n", "camera.focal_px", "2 numbers"},
      {"[camera]\nfocal_px = [-1200.0, 1200.0]\n", "camera.focal_px", "from 1"},
      {"[camera]\nwidth_px = 10\n", "camera.width_px", "whole number"},
      {"[camera]\nwidth_px = 8192\nheight_px = 8192\n", "camera.height_px", "8192 with width_px = 8192, 67.1 million"},
      {"[camera]\nposition_m = [0.0, 0.0, -2.0]\n", "camera.position_m", "in front of the plane"},
      {"[camera]\nposition_m = [0.0, 0.0, 2.0]\ntarget_m = [0.0, 1.0, 2.0]\n", "camera.target_m", "farther"},
      {"[camera]\ndistortion = { k1 = -3.0 }\n", "camera", "folds"},
      {"[camera]\ndistortion = { k4 = 0.1 }\n", "camera.distortion.k4", "unknown key"},
      {"[shutter]\nkind = \"rolling\"\n", "shutter.line_readout_s", "found nothing"},
      {"[shutter]\nkind = \"rolling\"\nline_readout_s = 0.0\n", "shutter.line_readout_s", "above 0"},
      {"[shutter]\nkind = \"rolling\"\nline_readout_s = 1e-5\n", "shutter.line_readout_s", "frame time"},
      {"[shutter]\nkind = \"global\"\nline_readout_s = 1e-6\n", "shutter.line_readout_s", "rolling"},
      {"[shutter]\nkind = \"global\"\nfirst_row = \"bottom\"\n", "shutter.first_row", "rolling"},
      {"[shutter]\nkind = \"slow\"\n", "shutter.kind", "global"},
      {"[camera]\nlens = \"pinhole\"\n", "camera.lens", "fisheye"},
      {"[camera]\nlens = \"fisheye\"\ndistortion = { p1 = 0.1 }\n", "camera.distortion.p1", "unknown key"},
      {"[camera]\nlens = \"rational\"\ndistortion = { k4 = 20.0 }\n", "camera", "folds"},
      {"[vignetting]\nradius_px = [0.0, 100.0]\ngain = [1.0, 0.5]\n", "vignetting.radius_px", "farthest corner"},
      {"[vignetting]\nradius_px = [0.0, 900.0]\ngain = [1.0]\n", "vignetting.gain", "one for each"},
      {"[vignetting]\nradius_px = [5.0, 900.0]\ngain = [1.0, 0.5]\n", "vignetting.radius_px", "from 0"},
      {"[focus]\nf_number = 2.0\nfocus_distance_m = 2.0\n", "focus.pixel_pitch_m", "found nothing"},
      {"[focus]\nf_number = 0.0\nfocus_distance_m = 2.0\npixel_pitch_m = 1e-6\n", "focus.f_number", "0.5"},
      {"[light]\nlevel = 0.0\n", "light.level", "above 0"},
      {"[light]\nflicker_depth = 1.5\n", "light.flicker_depth", "0 to 1"},
      {"[[light.reflection]]\nradius_m = 0.0\n", "radius_m", "number"},
      {"[mount]\nfocal_change = 0.5\n", "mount.focal_change", "0.2"},
      {"[[mount.motion]]\naxis = \"w\"\n", "axis", "pan"},
      {"[[mount.motion]]\naxis = \"pan\"\noffset_m = 0.1\n", "offset_m", "unknown key"},
      {"[[mount.motion]]\naxis = \"x\"\namplitude_m = 0.001\n", "frequency_hz", "amplitude"},
      {"[sensor]\nbit_depth = 7\n", "sensor.bit_depth", "8 to 16"},
      {"[sensor]\nfull_well_e = 0.0\n", "sensor.full_well_e", "number"},
      {"[sensor]\nread_noise_e = -1.0\n", "sensor.read_noise_e", "0"},
      {"[sensor]\noffset_dn = 100.0\nwhite_level = 0.1\n", "sensor.white_level", "above the offset"},
      {"[sensor]\nconverter_bits = 10\nbit_depth = 12\n", "sensor.converter_bits", "at least the 12"},
      {"[sensor]\nprnu = 0.7\n", "sensor.prnu", "0.5"},
      {"[sensor]\nhot_fraction = 0.1\n", "sensor.hot_signal_e_s", "hot pixel"},
      {"[sensor]\ntone = \"gamma\"\n", "sensor.gamma", "number"},
      {"[sensor]\ngamma = 2.2\n", "sensor.gamma", "unknown key"},
      {"[sensor]\ntone = \"table\"\ntone_from = [0.0, 0.5, 1.0]\ntone_to = [0.0, 1.0]\n", "sensor.tone_to", "rising"},
      {"[sensor]\ntone = \"table\"\ntone_from = [0.0, 0.5, 1.0]\ntone_to = [0.0, 0.6, 0.5]\n", "sensor.tone_to",
       "rising"},
      {"[sensor]\ntone = \"table\"\n", "sensor.tone_to", "found nothing"},
      {"[sensor]\ntone = \"bt709\"\nwhite_level = 1.5\n", "sensor.white_level", "to 1"},
      {"[sensor]\nwhite_photons_s = 1e6\nwhite_level = 0.5\n", "sensor.white_level", "one of the two"},
      {"[sensor]\nquantum_efficiency = 1.2\n", "sensor.quantum_efficiency", "1"},
      {"[codec]\nname = \"h266\"\n", "codec.name", "ffv1"},
      {"[sensor]\nbit_depth = 12\n[codec]\nname = \"ffv1\"\n", "codec.name", "png"},
      {"[calibration]\ninner_corners = [6, 9]\n", "calibration.inner_corners", "larger one first"},
      {"[calibration]\ninner_corners = [9.5, 6]\n", "calibration.inner_corners", "whole"},
      {"[calibration]\nviews = 2\n", "calibration.views", "3 to 99"},
      {"[calibration]\nplane_x_m = []\n", "calibration.plane_x_m", "1 to 99"},
      {"[calibration]\nplane_x_m = [0.7]\n", "calibration", "wholly in the image"},
      {"[calibration]\nsquare_m = 0.2\n", "calibration", "wholly in the image"},
      {"[marker]\ndiameter_m = 0.0\n", "marker.diameter_m", "number"},
      {"[marker]\ndiametre_m = 0.02\n", "marker.diametre_m", "diameter_m"},
      {"[track]\ndownhill = \"+Y\"\n", "track.downhill", "-X"},
      {"[scene]\nwall_albedo = 1.5\n", "scene.wall_albedo", "0 to 1"},
      {"[plumb]\nx_m = 4.0\n", "plumb", "camera sees"},
      {"seed = -1\n", "seed", "whole number"},
      {"camera = 3\n", "camera", "table"},
  };
  for (const Case& one : cases) {
    const std::string text = message(one.sections);
    CAPTURE(one.sections, text);
    CHECK_THAT(text, Catch::Contains(one.key) && Catch::Contains(one.words) && Catch::Contains("scenario.toml:"));
  }
}

TEST_CASE("A marker that is never seen is refused, one that is seen for a while is not") {
  const auto motion = [](double x0_m, double v0_m_s) {
    return fmt::format(
        "[[configuration]]\nname = \"m\"\nmass_kg = 0.3\nincline_deg = 0.0\n[[configuration.clip]]\nname = \"c\"\n"
        "launched = \"{}\"\nx0_m = {}\nv0_m_s = {}\nduration_s = 1.0\n",
        v0_m_s > 0 ? "down" : "up", x0_m, v0_m_s);
  };
  CHECK_THAT(message("", motion(5.0, 1.0)), Catch::Contains("clip \"c\"") && Catch::Contains("never in the image"));
  CHECK(message("", motion(-1.5, 1.2)) == "nothing");
  // A fisheye-like barrel maps what is far outside back into the image by its formula; that is not seen either.
  CHECK_THAT(message("[camera]\ndistortion = { k1 = -0.3 }\n", motion(-3.4, -0.1)),
             Catch::Contains("never in the image"));
}

TEST_CASE("All errors of a file are reported together") {
  const std::string text = message("[camera]\nexposure_s = 1.0\nwidth_px = 1\n[sensor]\nbit_depth = 99\n");
  CHECK_THAT(text, Catch::Contains("exposure_s") && Catch::Contains("width_px") && Catch::Contains("bit_depth"));
}

TEST_CASE(
    "A clip of more frames than memory and time allow is refused with what it would take, and a long one is not") {
  const auto refusal = [](const std::string& rate, const std::string& duration) {
    std::string motions = kMotions;
    motions.replace(motions.find("duration_s = 0.1"), 16, "duration_s = " + duration);
    return message("[camera]\nexposure_s = 1e-6\nframe_rate_hz = " + rate + "\n", motions);
  };
  // 3.6e8 frames of 480 kilopixels are 173 TB.
  CHECK_THAT(refusal("1e5", "3600.0"), Catch::Contains("clip \"m1-up\" with 360000000 frames (3600 s at 100000 Hz; "
                                                       "1.73e+05 GB of pixels), expected at most 5000000 frames"));
  CHECK(refusal("240.0", "3600.0") == "nothing");
}
