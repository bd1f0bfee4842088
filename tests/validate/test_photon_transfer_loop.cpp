/// The photon-transfer loop: flat fields that the renderer's sensor reads out, and the sensor that core/ recovers from
/// the pictures alone. Neither knows of the other.
#include <fmt/format.h>

#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <random>

#include "base/staged_output.h"
#include "catch.h"
#include "core/flat_field_folder.h"
#include "core/photon_transfer.h"
#include "render/sensor.h"
#include "temp_dir.h"

using namespace glidelab;
using glidelab::tests::TempDir;
namespace fs = std::filesystem;

namespace {

constexpr int kWidth = 256;
constexpr int kHeight = 192;
constexpr double kPrnu = 0.012;
// A claim of a value and its standard deviation fails by chance beyond 4 sd once in 16,000 times.
constexpr double kClaim = 4.0;

/// Light on the sensor: a field that is darker in the corners, and pixels that answer a little differently. (What the
/// sensor does not have of its own yet stands in the light, where it is the same to the pictures.)
render::FloatPicture answers() {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal(1.0, kPrnu);
  render::FloatPicture picture(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double u = 2.0 * x / kWidth - 1.0;
      const double v = 2.0 * y / kHeight - 1.0;
      picture.at(x, y) = static_cast<float>(normal(random) * (1.0 - 0.1 * (u * u + v * v)));
    }
  }
  return picture;
}

template <typename Code>
cv::Mat frame(const render::Sensor& sensor, const render::FloatPicture& expected_e, const render::NoiseKey& key,
              int type) {
  std::vector<Code> codes(expected_e.values.size());
  render::read_out(sensor, expected_e, key, {0, 0, kWidth, kHeight}, std::span<Code>(codes));
  return cv::Mat(kHeight, kWidth, type, codes.data()).clone();
}

void write_set(const fs::path& folder, const render::Sensor& sensor, const render::FloatPicture& answer, double light_e,
               int frames, std::uint32_t stream) {
  fs::create_directories(folder);
  render::FloatPicture expected_e = answer;
  for (float& value : expected_e.values) value *= static_cast<float>(light_e);
  for (int f = 0; f < frames; ++f) {
    const render::NoiseKey key{7, stream, static_cast<std::uint32_t>(f)};
    const cv::Mat codes = sensor.bit_depth == 8 ? frame<std::uint8_t>(sensor, expected_e, key, CV_8U)
                                                : frame<std::uint16_t>(sensor, expected_e, key, CV_16U);
    cv::imwrite((folder / fmt::format("{:03}.png", f)).string(), codes, {cv::IMWRITE_PNG_COMPRESSION, 1});
  }
}

core::CameraMeasurement measure(const render::Sensor& sensor, int levels) {
  const TempDir dir;
  const render::FloatPicture answer = answers();
  write_set(dir / "dark", sensor, answer, 0.0, 8, 0);
  for (int i = 1; i <= levels; ++i) {
    // The corners get 0.8 of the light; they saturate too, at the last levels.
    const double light_e = 1.4 * sensor.full_well_e * i / levels;
    write_set(dir / fmt::format("flat-{:02}", i), sensor, answer, light_e, 2, static_cast<std::uint32_t>(i));
  }
  base::write_file(dir / "characterize.toml",
                   fmt::format("format = 1\nname = \"rendered\"\nbit_depth = {}\n", sensor.bit_depth));
  return core::measure_camera(core::read_flat_field_folder(dir.path()), base::no_progress);
}

void check(const std::string& name, const core::Measured& measured, double truth) {
  INFO(name << ": " << measured.why);
  REQUIRE(measured.value);
  INFO(name << " " << *measured.value << " sd " << measured.sd << " truth " << truth);
  CHECK(std::abs(*measured.value - truth) < kClaim * measured.sd);
}

}  // namespace

TEST_CASE("photon transfer on rendered flat fields of 12 bits recovers the renderer's sensor") {
  render::Sensor sensor;
  sensor.bit_depth = 12;
  SECTION("a sensor of 10,000 electrons") {
    sensor.full_well_e = 10000.0;
    sensor.read_noise_e = 8.0;
    sensor.gain_dn_per_e = 0.35;
    sensor.offset_dn = 80.0;
  }
  SECTION("a sensor of 900 electrons, where noise is not normal at low light") {
    sensor.full_well_e = 900.0;
    sensor.read_noise_e = 2.0;
    sensor.gain_dn_per_e = 4.0;
    sensor.offset_dn = 100.0;
  }
  const core::CameraMeasurement found = measure(sensor, 16);
  check("gain", found.gain_dn_per_e, sensor.gain_dn_per_e);
  check("read noise", found.read_noise_e, sensor.read_noise_e);
  check("offset", found.offset_dn, sensor.offset_dn);
  check("full well", found.full_well_e, sensor.full_well_e);
  check("PRNU", found.prnu, kPrnu);
  CHECK_FALSE(found.dsnu_e.value);  // the sensor has none yet
  CHECK(found.notes.empty());
}

TEST_CASE("photon transfer on rendered flat fields of 8 bits recovers what the codes show, and limits the rest") {
  const render::Sensor sensor;  // the paper's camera: 60,000 e- in 253 codes, a read noise of 0.13 DN
  const core::CameraMeasurement found = measure(sensor, 16);
  check("gain", found.gain_dn_per_e, sensor.gain_dn_per_e);
  check("offset", found.offset_dn, sensor.offset_dn);
  check("full well", found.full_well_e, sensor.full_well_e);
  check("PRNU", found.prnu, kPrnu);
  if (found.read_noise_e.value) {
    check("read noise", found.read_noise_e, sensor.read_noise_e);
  } else {
    REQUIRE(found.read_noise_e.limit);
    CHECK(*found.read_noise_e.limit > sensor.read_noise_e);
  }
}
