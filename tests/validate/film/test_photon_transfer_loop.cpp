/// The photon-transfer loop: flat fields that the renderer's sensor reads out, and the sensor that core/ recovers from
/// the images alone. Neither knows of the other.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <variant>

#include "base/files/file_io.h"
#include "core/characterize/flat_field_folder.h"
#include "core/characterize/photon_transfer.h"
#include "render/sensor/readout.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using glidelab::tests::TempDir;
namespace fs = std::filesystem;

namespace {

constexpr int kWidth = 256;
constexpr int kHeight = 192;
constexpr double kPrnu = 0.012;
constexpr double kExposure = 0.01;
// A claim of a value and its standard deviation fails by chance beyond 4 sd once in 16,000 times.
constexpr double kClaim = 4.0;

/// An even light that falls off towards the corners.
render::FloatImage light() {
  render::FloatImage image(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double u = 2.0 * x / kWidth - 1.0;
      const double v = 2.0 * y / kHeight - 1.0;
      image.at(x, y) = static_cast<float>(1.0 - 0.1 * (u * u + v * v));
    }
  }
  return image;
}

template <typename Code>
cv::Mat frame(const render::Readout& readout, const render::FloatImage& expected_e, std::uint32_t stream,
              std::uint32_t number, int type) {
  std::vector<Code> codes(expected_e.values.size());
  readout.read(expected_e, stream, number, {0, 0, kWidth, kHeight}, std::span<Code>(codes));
  return cv::Mat(kHeight, kWidth, type, codes.data()).clone();
}

/// One set of frames of a light of so many electrons.
struct Set {
  std::string name;
  double light_e = 0.0;
  double exposure_s = kExposure;
  std::uint32_t frames = 2;
};

void write_set(const fs::path& folder, const render::Sensor& sensor, const Set& set, std::uint32_t stream) {
  fs::create_directories(folder / set.name);
  render::FloatImage expected_e = light();
  for (float& value : expected_e.values) value *= static_cast<float>(set.light_e);
  const render::Readout readout(sensor, set.exposure_s, 7, kWidth, kHeight);  // the seed is the camera
  for (std::uint32_t f = 0; f < set.frames; ++f) {
    const cv::Mat codes = sensor.bit_depth == 8 ? frame<std::uint8_t>(readout, expected_e, stream, f, CV_8U)
                                                : frame<std::uint16_t>(readout, expected_e, stream, f, CV_16U);
    cv::imwrite((folder / set.name / fmt::format("{:03}.png", f)).string(), codes, {cv::IMWRITE_PNG_COMPRESSION, 1});
  }
}

core::CameraMeasurement measure(const render::Sensor& sensor, int levels) {
  const TempDir dir;
  std::vector<Set> sets = {{"dark", 0.0, kExposure, 8}, {"dark-0", 0.0, 0.3, 8}, {"dark-1", 0.0, 1.0, 8}};
  for (int i = 1; i <= levels; ++i) {
    // The corners get 0.8 of the light; they saturate too, at the last levels.
    sets.push_back({fmt::format("flat-{:02}", i), 1.4 * sensor.full_well_e * i / levels});
  }
  std::uint32_t stream = 0;
  for (const Set& set : sets) write_set(dir.path(), sensor, set, stream++);
  base::write_file(dir / "characterize.toml",
                   fmt::format("format = 1\nname = \"rendered\"\nbit_depth = {}\nexposure_s = {}\n"
                               "[exposures_s]\ndark-0 = 0.3\ndark-1 = 1.0\n",
                               sensor.bit_depth, kExposure));
  return core::measure_camera(core::read_flat_field_folder(dir.path()), base::no_progress);
}

void check(const std::string& name, const core::Measured& measured, double truth) {
  INFO(name << ": reason " << (measured.why ? static_cast<int>(measured.why->index()) : -1));
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
    sensor.pixels = {30.0, 0.012, 4.0, 0.0, 0.0, 0.0};
  }
  SECTION("a sensor of 900 electrons, where noise is not normal at low light") {
    sensor.full_well_e = 900.0;
    sensor.read_noise_e = 2.0;
    sensor.gain_dn_per_e = 4.0;
    sensor.offset_dn = 100.0;
    sensor.pixels = {12.0, 0.02, 1.5, 0.0, 0.0, 0.0};
  }
  const core::CameraMeasurement found = measure(sensor, 16);
  check("gain", found.gain_dn_per_e, sensor.gain_dn_per_e);
  check("read noise", found.read_noise_e, sensor.read_noise_e);
  check("offset", found.offset_dn, sensor.offset_dn);
  check("full well", found.full_well_e, sensor.full_well_e);
  check("dark signal", found.dark_signal_e_s, sensor.pixels.dark_signal_e_s);
  check("PRNU", found.prnu, sensor.pixels.prnu);
  check("DSNU", found.dsnu_e, sensor.pixels.dsnu_e);
  CHECK(found.outlying_pixels == 0);
  CHECK(found.notes.empty());
}

TEST_CASE("photon transfer counts the renderer's hot and dead pixels, and they do not disturb the numbers") {
  render::Sensor sensor;
  sensor.bit_depth = 12;
  sensor.full_well_e = 10000.0;
  sensor.read_noise_e = 5.0;
  sensor.gain_dn_per_e = 0.35;
  sensor.offset_dn = 80.0;
  sensor.pixels = {0.0, 0.01, 2.0, 0.002, 2e5, 0.001};
  const core::CameraMeasurement found = measure(sensor, 12);
  check("gain", found.gain_dn_per_e, sensor.gain_dn_per_e);
  check("PRNU", found.prnu, sensor.pixels.prnu);
  check("DSNU", found.dsnu_e, sensor.pixels.dsnu_e);
  const render::FixedPattern pattern = render::make_fixed_pattern(sensor.pixels, kExposure, 7, kWidth, kHeight);
  // Hot pixels add 2000 e- on average in 10 ms. Those below 6 sd of the dark pattern, 2 e- and its noise, stay hidden,
  // those above a few times that are found.
  const auto surely_hot =
      std::count_if(pattern.dark_e.begin(), pattern.dark_e.end(), [](float e) { return e > 30.0f; });
  const auto hot = std::count_if(pattern.dark_e.begin(), pattern.dark_e.end(), [](float e) { return e > 5.0f; });
  CHECK(static_cast<long>(found.hot_pixels) >= surely_hot);
  CHECK(static_cast<long>(found.hot_pixels) <= hot);
  const auto dead = std::count(pattern.response.begin(), pattern.response.end(), 0.0f);
  CHECK(surely_hot > 50);
  CHECK(dead > 20);
  // A pixel that is hot and dead counts as hot.
  CHECK(static_cast<long>(found.dead_pixels) <= dead);
  CHECK(static_cast<long>(found.dead_pixels) >= dead - 2);
}

TEST_CASE("photon transfer on rendered flat fields of 8 bits recovers what the codes show, and limits the rest") {
  render::Sensor sensor;  // the paper's camera: 60,000 e- in 253 codes, a read noise of 0.13 DN
  sensor.pixels.prnu = kPrnu;
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

TEST_CASE("photon transfer refuses the renderer's images with a tone curve, and those of a demosaiced sensor") {
  render::Sensor sensor;
  sensor.converter_bits = 12;
  sensor.full_well_e = 10000.0;
  sensor.read_noise_e = 8.0;
  sensor.gain_dn_per_e = 0.4;
  sensor.offset_dn = 64.0;
  SECTION("tone curve") {
    sensor.tone.kind = render::ToneCurve::Kind::bt709;
    CHECK(std::holds_alternative<core::unmeasured::NotLinear>(measure(sensor, 12).gain_dn_per_e.why.value()));
  }
  SECTION("mosaic") {
    sensor.colour = render::Colour::bayer;
    CHECK(std::holds_alternative<core::unmeasured::PixelsTogether>(measure(sensor, 12).gain_dn_per_e.why.value()));
  }
}
