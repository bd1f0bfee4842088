#include "core/characterize/photon_transfer.h"

#include <fmt/format.h>

#include <array>
#include <opencv2/imgproc.hpp>
#include <variant>

#include "core/characterize/flat_field_folder.h"
#include "tests/catch.h"
#include "tests/core/flat_fields.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using namespace glidelab::tests;
using By = core::HowMeasured::By;
namespace unmeasured = core::unmeasured;

namespace {

// A claim of a value and its standard deviation fails by chance beyond 4 sd once in 16,000 times.
constexpr double kClaim = 4.0;

core::CameraMeasurement measure(const TrueCamera& camera, const FlatFieldPlan& plan, unsigned seed = 1) {
  const TempDir dir;
  FlatFieldCamera source(camera, seed);
  write_flat_fields(dir.path(), source, plan);
  return core::measure_camera(core::read_flat_field_folder(dir.path()), base::no_progress);
}

void check(const std::string& name, const core::Measured& measured, double truth) {
  INFO(name << ": reason " << (measured.why ? static_cast<int>(measured.why->index()) : -1));
  REQUIRE(measured.value);
  INFO(name << " " << *measured.value << " sd " << measured.sd << " truth " << truth);
  CHECK(measured.sd > 0.0);
  CHECK(std::abs(*measured.value - truth) < kClaim * measured.sd);
}

/// Whether a number is missing for a reason of this kind.
template <class Reason>
bool lacks(const core::Measured& measured) {
  return !measured.value && measured.why && std::holds_alternative<Reason>(*measured.why);
}

bool found_by(const core::Measured& measured, core::HowMeasured::By by) {
  return measured.how && measured.how->by == by;
}

FlatFieldPlan usual_plan(const TrueCamera& camera) {
  FlatFieldPlan plan;
  plan.light_e = even_levels(14, 1.15 * camera.full_well_e);
  return plan;
}

TrueCamera camera_of_8_bits() {
  TrueCamera camera;
  camera.width = 320;
  camera.height = 240;
  camera.bit_depth = 8;
  camera.gain_dn_per_e = 0.025;
  camera.offset_dn = 4.3;
  camera.full_well_e = 10000.0;
  camera.read_noise_e = 6.0;
  return camera;
}

void check_all(const core::CameraMeasurement& found, const TrueCamera& camera) {
  check("gain", found.gain_dn_per_e, camera.gain_dn_per_e);
  check("read noise", found.read_noise_e, camera.read_noise_e);
  check("offset", found.offset_dn, camera.offset_dn);
  check("full well", found.full_well_e, camera.full_well_e);
  check("PRNU", found.prnu, camera.prnu);
  check("DSNU", found.dsnu_e, camera.dsnu_e);
}

}  // namespace

TEST_CASE("a camera of 12 bits comes out with all its numbers, its hot and its dead pixels") {
  TrueCamera camera;
  camera.dark_signal_e_s = 20.0;
  camera.hot_e = {{{10, 10}, 1e5}, {{50, 40}, 300.0}, {{0, 0}, 1e5}};
  camera.dead = {{30, 30}, {60, 60}};
  FlatFieldPlan plan = usual_plan(camera);
  plan.dark_exposures_s = {0.1, 0.3, 1.0};
  const core::CameraMeasurement found = measure(camera, plan);
  check_all(found, camera);
  check("dark signal", found.dark_signal_e_s, camera.dark_signal_e_s);
  CHECK(found.hot_pixels == 3);
  CHECK(found.dead_pixels == 2);
  CHECK(found.outlying_pixels == 5);
  CHECK_FALSE(found.mosaic);
  CHECK(found.notes.empty());
  CHECK(found.frames == 4 * 8 + 14 * 2);
  // EMVA's capacity lies two to three standard deviations of the shot noise below the full well, and is known to the
  // steps of the levels, 740 e-, which its sd says.
  REQUIRE(found.saturation_capacity_e.value);
  CHECK(*found.saturation_capacity_e.value < camera.full_well_e);
  CHECK(*found.saturation_capacity_e.value > camera.full_well_e - 2.5 * 740.0);
  // Not so precise as to be empty claims: 12,288 pixels, 9 levels of 2 frames give the gain to about 0.5 %.
  CHECK(found.gain_dn_per_e.sd < 0.01 * camera.gain_dn_per_e);
}

TEST_CASE("a claim fails where the truth is another one") {
  TrueCamera camera;
  const core::CameraMeasurement found = measure(camera, usual_plan(camera));
  CHECK(std::abs(*found.gain_dn_per_e.value - 1.05 * camera.gain_dn_per_e) > kClaim * found.gain_dn_per_e.sd);
  CHECK(std::abs(*found.read_noise_e.value - 1.05 * camera.read_noise_e) > kClaim * found.read_noise_e.sd);
  CHECK(std::abs(*found.full_well_e.value - 1.05 * camera.full_well_e) > kClaim * found.full_well_e.sd);
  CHECK(std::abs(*found.prnu.value - 1.2 * camera.prnu) > kClaim * found.prnu.sd);
  CHECK(std::abs(*found.dsnu_e.value - 1.2 * camera.dsnu_e) > kClaim * found.dsnu_e.sd);
}

TEST_CASE("over 20 cameras of one make the values scatter as their standard deviations say") {
  TrueCamera camera;
  camera.dark_signal_e_s = 20.0;
  FlatFieldPlan plan = usual_plan(camera);
  plan.dark_exposures_s = {0.3, 1.0};
  std::array<double, 7> chi2{};
  std::array<double, 7> sum{};
  constexpr unsigned kCameras = 20;
  for (unsigned seed = 1; seed <= kCameras; ++seed) {
    const core::CameraMeasurement found = measure(camera, plan, seed);
    const std::array<std::pair<const core::Measured*, double>, 7> numbers = {{
        {&found.gain_dn_per_e, camera.gain_dn_per_e},
        {&found.read_noise_e, camera.read_noise_e},
        {&found.offset_dn, camera.offset_dn},
        {&found.full_well_e, camera.full_well_e},
        {&found.dark_signal_e_s, camera.dark_signal_e_s},
        {&found.prnu, camera.prnu},
        {&found.dsnu_e, camera.dsnu_e},
    }};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      REQUIRE(numbers[i].first->value);
      const double z = (*numbers[i].first->value - numbers[i].second) / numbers[i].first->sd;
      chi2[i] += z * z;
      sum[i] += z;
    }
  }
  // chi² of 20 degrees of freedom: beyond 4.04 and 54.4 with a probability of 5e-5 each. A jackknife over 48 tiles
  // knows a variance to about 20 %, which widens the sum's own spread from 6.3 to 6.4. The mean of 20 z beyond
  // 4/sqrt(20): 6e-5.
  for (std::size_t i = 0; i < chi2.size(); ++i) {
    INFO("number " << i << ": chi2 " << chi2[i] << ", mean z " << sum[i] / kCameras);
    CHECK(chi2[i] > 4.04);
    CHECK(chi2[i] < 54.4);
    CHECK(std::abs(sum[i]) < kClaim * std::sqrt(static_cast<double>(kCameras)));
  }
}

TEST_CASE("a flat field that is darker by half in the corners gives the same numbers") {
  TrueCamera camera;
  camera.shading = 0.5;
  check_all(measure(camera, usual_plan(camera)), camera);
}

TEST_CASE("a level of which only the dark corners are in the linear range is shown with the mean of the whole image") {
  TrueCamera camera;
  camera.shading = 0.5;
  const core::CameraMeasurement found = measure(camera, usual_plan(camera));
  for (std::size_t i = 1; i < found.curve.size(); ++i) {
    // Levels are evenly spaced, and saturation only makes them closer; the means have errors of 0.03 %.
    CHECK(found.curve[i].image_dn > 0.999 * found.curve[i - 1].image_dn);
    if (!found.curve[i].used) CHECK(found.curve[i].mean_dn == found.curve[i].image_dn);
  }
}

TEST_CASE("a light that flickers by 3 % over a shaded field changes nothing but a note") {
  TrueCamera camera;
  camera.shading = 0.3;
  FlatFieldPlan plan = usual_plan(camera);
  plan.flicker = [](int frame) { return 1.0 + 0.03 * (frame % 2); };
  const core::CameraMeasurement found = measure(camera, plan);
  check_all(found, camera);
  REQUIRE(found.notes.size() == 1);
  CHECK(std::holds_alternative<core::Flicker>(found.notes[0]));
}

TEST_CASE("raw codes of a colour sensor are measured colour by colour") {
  TrueCamera camera;
  camera.width = 192;
  camera.height = 144;
  camera.mosaic = 0.6;
  const core::CameraMeasurement found = measure(camera, usual_plan(camera));
  check_all(found, camera);
  CHECK(found.mosaic);
}

TEST_CASE("more than two frames of a level are all used") {
  TrueCamera camera;
  FlatFieldPlan plan = usual_plan(camera);
  const double sd_of_two = measure(camera, plan).gain_dn_per_e.sd;
  plan.flat_frames = 5;
  const core::CameraMeasurement found = measure(camera, plan);
  check_all(found, camera);
  // Four times the degrees of freedom halve the error; a jackknife's own error is 10 %, so 0.5 within 3 sd of 14 %.
  CHECK(found.gain_dn_per_e.sd / sd_of_two > 0.29);
  CHECK(found.gain_dn_per_e.sd / sd_of_two < 0.71);
}

TEST_CASE("where 8 bits hide the dark noise, the line tells it or a limit is given, and the offset's error says so") {
  const TrueCamera camera = camera_of_8_bits();  // the read noise is 0.15 DN: every dark code is the same
  const core::CameraMeasurement found = measure(camera, usual_plan(camera));
  check("gain", found.gain_dn_per_e, camera.gain_dn_per_e);
  check("PRNU", found.prnu, camera.prnu);
  check("full well", found.full_well_e, camera.full_well_e);
  check("offset", found.offset_dn, camera.offset_dn);
  CHECK(found.offset_dn.sd > 0.05);  // the dark mean is up to 0.3 DN from the offset, and nothing tells by how much
  if (found.read_noise_e.value) {
    check("read noise", found.read_noise_e, camera.read_noise_e);
    CHECK(found_by(found.read_noise_e, By::line_at_dark));
  } else {
    REQUIRE(found.read_noise_e.limit);
    CHECK(*found.read_noise_e.limit > camera.read_noise_e);
    CHECK(lacks<unmeasured::BelowQuantisation>(found.read_noise_e));
  }
  REQUIRE_FALSE(found.dsnu_e.value);
  CHECK(*found.dsnu_e.limit > camera.dsnu_e);
}

TEST_CASE("with enough light and pixels the line tells a read noise that 8 bits hide") {
  TrueCamera camera = camera_of_8_bits();
  camera.read_noise_e = 12.0;  // 0.3 DN, 0.09 DN² beside the rounding's 0.083
  camera.dsnu_e = 0.0;
  FlatFieldPlan plan = usual_plan(camera);
  plan.flat_frames = 4;
  const core::CameraMeasurement found = measure(camera, plan);
  check("read noise", found.read_noise_e, camera.read_noise_e);
  CHECK(found_by(found.read_noise_e, By::line_at_dark));
}

TEST_CASE("the converter limits a sensor whose full well is above its codes") {
  TrueCamera camera;
  camera.full_well_e = 20000.0;  // 8000 DN, but the codes end at 4095
  FlatFieldPlan plan;
  plan.light_e = even_levels(14, 12000.0);
  const core::CameraMeasurement found = measure(camera, plan);
  check("full well", found.full_well_e, (camera.largest_code() - camera.offset_dn) / camera.gain_dn_per_e);
  CHECK(found_by(found.full_well_e, By::largest_code));
  check("gain", found.gain_dn_per_e, camera.gain_dn_per_e);
}

TEST_CASE("levels that do not reach saturation give a lower limit of the full well, and why") {
  const TrueCamera camera;
  FlatFieldPlan plan;
  plan.light_e = even_levels(8, 0.6 * camera.full_well_e);
  const core::CameraMeasurement found = measure(camera, plan);
  check("gain", found.gain_dn_per_e, camera.gain_dn_per_e);
  CHECK_FALSE(found.full_well_e.value);
  CHECK(lacks<unmeasured::NotSaturated>(found.full_well_e));
  // The brightest level is at 60 %; its mean carries the gain's error.
  CHECK(*found.full_well_e.limit == Approx(0.6 * camera.full_well_e).epsilon(0.03));
  CHECK_FALSE(found.saturation_capacity_e.value);
}

TEST_CASE("exposures of the levels give the linearity, which is perfect for a linear camera") {
  const TrueCamera camera;
  FlatFieldPlan plan = usual_plan(camera);
  plan.by_exposure = true;
  const core::CameraMeasurement found = measure(camera, plan);
  REQUIRE(found.linearity_error.value);
  // Means of 12,288 pixels and 2 frames at 5 to 95 % of 9000 e- are known to 3e-4 at worst, so is the mean deviation.
  CHECK(*found.linearity_error.value < 3e-4);
  CHECK(lacks<unmeasured::NoExposures>(measure(camera, usual_plan(camera)).linearity_error));
}

TEST_CASE("dark signal without exposures of its own is said to be missing") {
  const TrueCamera camera;
  CHECK(lacks<unmeasured::NoDarkExposures>(measure(camera, usual_plan(camera)).dark_signal_e_s));
}

TEST_CASE("codes that are not linear in light give no gain but the reason") {
  const auto [name, tone] = GENERATE(table<std::string, std::function<double(double)>>(
      {{"gamma 2.2", [](double x) { return std::pow(x, 1.0 / 2.2); }},
       {"gamma 1.3", [](double x) { return std::pow(x, 1.0 / 1.3); }},
       {"sRGB", [](double x) { return x < 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055; }},
       {"S-curve", [](double x) { return x * x * (3.0 - 2.0 * x); }}}));
  for (const int bits : {8, 12}) {
    TrueCamera camera = bits == 8 ? camera_of_8_bits() : TrueCamera();
    camera.tone = tone;
    const core::CameraMeasurement found = measure(camera, usual_plan(camera));
    INFO(name << ", " << bits << " bits: gain " << found.gain_dn_per_e.value.value_or(0.0));
    CHECK_FALSE(found.gain_dn_per_e.value);
    CHECK(lacks<unmeasured::NotLinear>(found.gain_dn_per_e));
    CHECK_FALSE(found.read_noise_e.value);
    CHECK_FALSE(found.full_well_e.value);
    CHECK_FALSE(found.prnu.value);
  }
}

TEST_CASE("exposures show a tone curve that hides in the variance") {
  TrueCamera camera = camera_of_8_bits();
  camera.tone = [](double x) { return std::pow(x, 1.0 / 1.1); };  // bends the variance by a few per cent only
  FlatFieldPlan plan = usual_plan(camera);
  plan.by_exposure = true;
  const core::CameraMeasurement found = measure(camera, plan);
  const bool refused = !found.gain_dn_per_e.value;
  bool noted = false;
  for (const core::CameraNote& note : found.notes) noted = noted || std::holds_alternative<core::BentMean>(note);
  CHECK((refused || noted));
}

TEST_CASE("a knee above the linear range takes the full well away, not the gain") {
  TrueCamera camera = camera_of_8_bits();
  camera.tone = [](double x) { return x < 0.5 ? x : 0.5 + 0.4 * (x - 0.5); };
  const core::CameraMeasurement found = measure(camera, usual_plan(camera));
  check("gain", found.gain_dn_per_e, camera.gain_dn_per_e);
  CHECK_FALSE(found.full_well_e.value);
  CHECK(lacks<unmeasured::Knee>(found.full_well_e));
}

TEST_CASE("images that were smoothed, compressed or averaged over time give no gain but the reason") {
  TrueCamera camera = camera_of_8_bits();
  FlatFieldPlan plan = usual_plan(camera);
  SECTION("smoothed") {
    camera.after = [](cv::Mat& codes) { cv::blur(codes, codes, {2, 1}); };
    CHECK(lacks<unmeasured::PixelsTogether>(measure(camera, plan).gain_dn_per_e));
  }
  SECTION("median") {
    camera.after = [](cv::Mat& codes) { cv::medianBlur(codes, codes, 3); };
    CHECK(lacks<unmeasured::PixelsTogether>(measure(camera, plan).gain_dn_per_e));
  }
  SECTION("JPEG of quality 90") {
    camera.after = [](cv::Mat& codes) {
      cv::Mat rounded;
      codes.convertTo(rounded, CV_8U);
      std::vector<unsigned char> file;
      cv::imencode(".jpg", rounded, file, {cv::IMWRITE_JPEG_QUALITY, 90});
      cv::imdecode(file, cv::IMREAD_GRAYSCALE).convertTo(codes, CV_32F);
    };
    CHECK_FALSE(measure(camera, plan).gain_dn_per_e.value);
  }
  SECTION("averaged over time") {
    cv::Mat last;
    camera.after = [&last](cv::Mat& codes) {
      const bool same_light = !last.empty() && std::abs(cv::mean(codes)[0] - cv::mean(last)[0]) < 1.0;
      if (same_light) codes = 0.6 * codes + 0.4 * last;
      last = codes.clone();
    };
    plan.flat_frames = 6;
    CHECK(lacks<unmeasured::FramesTogether>(measure(camera, plan).gain_dn_per_e));
  }
}

TEST_CASE("a dark level that is cut at code 0 gives no offset, and the line still gives the gain") {
  TrueCamera camera = camera_of_8_bits();
  camera.offset_dn = 0.0;
  const core::CameraMeasurement found = measure(camera, usual_plan(camera));
  check("gain", found.gain_dn_per_e, camera.gain_dn_per_e);
  CHECK_FALSE(found.offset_dn.value);
  CHECK(lacks<unmeasured::DarkLevelCut>(found.offset_dn));
}

TEST_CASE("rows with a noise of their own are noted and do not harm the gain") {
  TrueCamera camera;
  auto random = std::mt19937_64(5);
  camera.after = [&random](cv::Mat& codes) {
    std::normal_distribution<double> row_dn(0.0, 0.8);
    for (int y = 0; y < codes.rows; ++y) codes.row(y) += row_dn(random);
  };
  const core::CameraMeasurement found = measure(camera, usual_plan(camera));
  check("gain", found.gain_dn_per_e, camera.gain_dn_per_e);
  // The rows' noise counts as read noise: 0.8 DN are 2 e-.
  check("read noise", found.read_noise_e, std::hypot(camera.read_noise_e, 2.0));
  REQUIRE(found.notes.size() == 1);
  CHECK(std::holds_alternative<core::CorrelatedDark>(found.notes[0]));
}

TEST_CASE("few electrons for each code, and few codes for each electron, both come out") {
  TrueCamera camera;
  SECTION("0.02 DN/e-, 16 bits") {
    camera.bit_depth = 16;
    camera.gain_dn_per_e = 0.02;
    camera.offset_dn = 500.0;
    camera.full_well_e = 200000.0;
    camera.read_noise_e = 100.0;
    camera.dsnu_e = 60.0;
  }
  SECTION("20 DN/e-, 16 bits") {
    camera.bit_depth = 16;
    camera.gain_dn_per_e = 20.0;
    camera.offset_dn = 800.0;
    camera.full_well_e = 2500.0;
    camera.read_noise_e = 2.5;
    camera.dsnu_e = 0.8;
    camera.prnu = 0.02;
  }
  check_all(measure(camera, usual_plan(camera)), camera);
}
