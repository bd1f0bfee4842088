#include "core/pictures/scene/scene_watch.h"

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <optional>
#include <random>

#include "core/pictures/scene/lamp_flicker.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr int kWidth = 240, kHeight = 160;
constexpr double kNoise = 1.0;  // codes
constexpr double kRate_hz = 100.0;

/// A wall with waves of some pixels' length in all directions.
double wall(double u, double v) {
  return 90.0 + 12.0 * std::sin(0.61 * u + 0.2 * v) + 9.0 * std::sin(0.5 * v - 0.13 * u) + 6.0 * std::sin(0.29 * u);
}

struct Made {
  std::function<double(double t)> shift_u = [](double) { return 0.0; };
  std::function<double(double t)> light = [](double) { return 1.0; };
  bool with_glider = false;  ///< a dark thing of 60 x 40 px that crosses the image in the clip
};

core::ImageRecord watched(const Made& made, int frames) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, kNoise);
  core::SceneWatch watch;
  for (int k = 0; k < frames; ++k) {
    const double t = k / kRate_hz;
    cv::Mat_<unsigned char> image(kHeight, kWidth);
    const double left = -60.0 + 300.0 * k / frames;
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        const bool hidden = made.with_glider && u > left && u < left + 60.0 && v > 60 && v < 100;
        const double value = hidden ? 30.0 : wall(u - made.shift_u(t), v);
        image(v, u) = cv::saturate_cast<unsigned char>(made.light(t) * value + noise(random));
      }
    }
    watch.add(image, t);
  }
  core::ImageRecord record;
  watch.finish(record);
  return record;
}

}  // namespace

TEST_CASE("A scene that sways is followed to its stated noise, and beyond the pixel that a first-order step covers",
          "[scene]") {
  const auto truth = [](double t) { return 1.6 * std::sin(2.0 * std::numbers::pi * 3.0 * t); };
  const core::ImageRecord record = watched({truth, [](double) { return 1.0; }, false}, 120);
  REQUIRE(record.scene.size() == 120);
  // The reference is the mean of six frames, over which the scene moves: its own place is theirs.
  double start = 0.0, off = 0.0, variance = 0.0;
  for (int k = 0; k < 6; ++k) start += truth(k / kRate_hz) / 6.0;
  for (const core::SceneLook& look : record.scene) {
    off += std::pow(look.u_px - (truth(look.t_s) - start), 2) / 120.0;
    variance += look.sd_u_px * look.sd_u_px / 120.0;
  }
  // 3 % of the amplitude for a reference that is smeared over a sixth of a period, beside three times the noise.
  CHECK(std::sqrt(off) < 0.05 + 3.0 * std::sqrt(variance));
  CHECK(std::sqrt(variance) < 0.05);
}

TEST_CASE("A scene at rest stays where it is while something dark passes before it", "[scene]") {
  const core::ImageRecord record = watched({[](double) { return 0.0; }, [](double) { return 1.0; }, true}, 150);
  for (const core::SceneLook& look : record.scene) {
    // Five standard deviations of 300 numbers, and a hundredth of a pixel for what touches a patch's rim.
    CHECK(std::abs(look.u_px) < 5.0 * look.sd_u_px + 0.01);
    CHECK(std::abs(look.v_px) < 5.0 * look.sd_v_px + 0.01);
  }
}

TEST_CASE("Light that flickers before a rolling shutter moves no scene, however weak its structure", "[scene]") {
  // A bench with light that falls off from the left, in bands of 11 % that run down the image; a row every 50 µs.
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.5);
  core::SceneWatch watch;
  for (int k = 0; k < 90; ++k) {
    cv::Mat_<unsigned char> image(kHeight, kWidth);
    for (int v = 0; v < kHeight; ++v) {
      const double t = k / kRate_hz + 5e-5 * v;
      const double light = 1.0 + 0.11 * std::cos(2.0 * std::numbers::pi * 120.0 * t);
      for (int u = 0; u < kWidth; ++u) {
        const double bench = 150.0 - 0.3 * u + 2.0 * std::sin(0.21 * u + 0.1 * v) + 2.0 * std::sin(0.17 * v);
        image(v, u) = cv::saturate_cast<unsigned char>(light * bench + noise(random));
      }
    }
    watch.add(image, k / kRate_hz);
  }
  core::ImageRecord record;
  watch.finish(record);
  REQUIRE(record.scene.size() == 90);
  // A twelfth of a patch's rows sees 0.0006 s, 0.45 of a radian of the light: its cubic part over the patch is
  // 0.11 * 0.45³/6 / 4 = 0.0004 of 100 codes, beside slopes of the scene of 0.4 codes a pixel.
  for (const core::SceneLook& look : record.scene) {
    CHECK(std::abs(look.u_px) < 5.0 * look.sd_u_px + 0.1);
    CHECK(std::abs(look.v_px) < 5.0 * look.sd_v_px + 0.1);
  }
}

TEST_CASE("Light that flickers before a camera with a tone curve moves no scene, and is found", "[scene]") {
  // Codes of sRGB: not proportional to the light, a change of which is a gain and an offset. Lamps of 100 Hz, ±25 %,
  // rows every 25 µs; the light falls off from the left, over weak structure.
  constexpr double kFilm_hz = 60.0, kLine_s = 2.5e-5, kFlicker_hz = 100.0, kDepth = 0.25;
  std::mt19937 random(9);
  std::normal_distribution<double> noise(0.0, 0.5);
  core::SceneWatch watch;
  for (int k = 0; k < 90; ++k) {
    cv::Mat_<unsigned char> image(kHeight, kWidth);
    for (int v = 0; v < kHeight; ++v) {
      const double t = k / kFilm_hz + kLine_s * v;
      const double light = 1.0 + kDepth * std::cos(2.0 * std::numbers::pi * kFlicker_hz * t);
      for (int u = 0; u < kWidth; ++u) {
        const double bench = 0.45 - 0.0013 * u + 0.009 * (std::sin(0.21 * u + 0.1 * v) + std::sin(0.17 * v));
        const double code = 255.0 * (1.055 * std::pow(light * bench, 1.0 / 2.4) - 0.055);
        image(v, u) = cv::saturate_cast<unsigned char>(code + noise(random));
      }
    }
    watch.add(image, k / kFilm_hz);
  }
  const auto record = std::make_shared<core::ImageRecord>();
  watch.finish(*record);
  REQUIRE(record->scene.size() == 90);
  for (const core::SceneLook& look : record->scene) {
    REQUIRE(look.sd_u_px > 0.0);
    // Half a patch's rows take 0.19 rad of the light: its cubic part is 0.25 * 0.19³/6/4 of 150 codes, 0.01 codes
    // beside slopes of 0.4 codes a pixel.
    CHECK(std::abs(look.u_px) < 5.0 * look.sd_u_px + 0.03);
    CHECK(std::abs(look.v_px) < 5.0 * look.sd_v_px + 0.03);
  }
  core::CameraSettings camera;
  camera.frame_rate_hz = kFilm_hz;
  camera.shutter = core::Shutter::rolling;
  camera.line_readout_s = kLine_s;
  camera.exposure_s = 0.0;
  const std::optional<core::LightFlicker> flicker = core::find_flicker({record}, camera);
  REQUIRE(flicker);
  CHECK(flicker->f_hz == 100.0);
  CHECK(std::abs(flicker->seen_hz - 20.0) < 0.1);
  // The codes change by (1 + 0.055 * 255 / code) / 2.4 of the light's change, 0.45 of it for 160 codes; a band of 40
  // rows, 0.63 rad, averages over 2 % of it.
  CHECK(std::abs(flicker->depth - 0.45 * kDepth) < 0.1 * kDepth);
}

TEST_CASE("A tone curve that changes during the clip moves no scene", "[scene]") {
  // A glow that falls off from the left: where the contrast lies beside its mean, an offset looks like a shift to a fit
  // that knows of a gain alone. The image is so narrow that all its patches are alike.
  constexpr int kNarrow = 60;
  std::mt19937 random(13);
  std::normal_distribution<double> noise(0.0, 0.5);
  core::SceneWatch watch;
  for (int k = 0; k < 100; ++k) {
    const double gamma = 1.0 + 0.1 * std::sin(2.0 * std::numbers::pi * k / 100.0);
    const double offset = 8.0 * std::sin(2.0 * std::numbers::pi * k / 70.0);
    cv::Mat_<unsigned char> image(kHeight, kNarrow);
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kNarrow; ++u) {
        const double level = 60.0 + 40.0 * std::exp((12.0 - u) / 12.0) + 4.0 * std::sin(0.4 * v);
        const double code = 255.0 * std::pow(level / 255.0, gamma) + offset;
        image(v, u) = cv::saturate_cast<unsigned char>(code + noise(random));
      }
    }
    watch.add(image, k / kRate_hz);
  }
  core::ImageRecord record;
  watch.finish(record);
  REQUIRE(record.scene.size() == 100);
  for (const core::SceneLook& look : record.scene) {
    REQUIRE(look.sd_u_px > 0.0);
    // The curve's second order, 255 g (g - 1) x^(g-2) / 2 * 0.07² for levels of x = 0.3 ± 0.07 in a patch, is 0.2 codes
    // beside slopes of up to 3 codes a pixel.
    CHECK(std::abs(look.u_px) < 5.0 * look.sd_u_px + 0.07);
    CHECK(std::abs(look.v_px) < 5.0 * look.sd_v_px + 0.07);
  }
}

TEST_CASE("The light's change is measured in each band of rows, whatever passes", "[scene]") {
  // The larger one has changed in the first frames by more than what passes changes.
  const double depth = GENERATE(0.02, 0.25);
  const auto light = [&](double t) { return 1.0 + depth * std::cos(2.0 * std::numbers::pi * 10.0 * t); };
  const core::ImageRecord record = watched({[](double) { return 0.0; }, light, true}, 100);
  double start = 0.0;
  for (int k = 0; k < 6; ++k) start += light(k / kRate_hz) / 6.0;
  for (const core::SceneLook& look : record.scene) {
    for (std::size_t b = 0; b < core::kRowBands; ++b) {
      if (look.gain_sd[b] == 0.0) continue;
      // The dark thing counts as passing once residuals are three times the usual 0.29 codes: one column of 24 of a
      // patch may until then be off by 0.87 sqrt(24) codes, 0.002 of the patch's mean of 90.
      CHECK(std::abs(look.gain[b] - (light(look.t_s) / start - 1.0)) < 5.0 * look.gain_sd[b] + 2e-3);
    }
  }
}

TEST_CASE("Noise that is new in every frame has no memory, and blocks of eight show at their edges", "[scene]") {
  const core::ImageRecord record = watched({}, 60);
  REQUIRE(record.noise_memory);
  // A ratio of two variances from 54 frames of thousands of pixels each, blurred: below 2 %.
  CHECK(std::abs(*record.noise_memory - 1.0) < 0.02);
  // sqrt(1 + 1/12) codes with rounding.
  CHECK(std::abs(record.noise_code - std::sqrt(kNoise * kNoise + 1.0 / 12.0)) < 0.05);

  core::SceneWatch blocks;
  cv::Mat_<unsigned char> image(kHeight, kWidth);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) image(v, u) = static_cast<unsigned char>(80 + (u / 8) % 3 + u % 2);
  }
  for (int k = 0; k < 8; ++k) blocks.add(image, k / kRate_hz);
  core::ImageRecord of_blocks;
  blocks.finish(of_blocks);
  for (std::size_t c = 1; c < 8; ++c) CHECK(of_blocks.steps.mean[c] == 1.0);
  CHECK(of_blocks.steps.mean[0] != 1.0);
}

TEST_CASE("Noise that a codec freezes and then replaces is no scene that moves", "[scene]") {
  // A plain wall with frozen noise of half a code, another one every 30 frames, as skipped blocks and key frames make
  // it.
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.5);
  core::SceneWatch watch(true);
  cv::Mat image(kHeight, kWidth, CV_8U);
  for (int k = 0; k < 120; ++k) {
    for (int i = 0; k % 30 == 0 && i < kHeight * kWidth; ++i) {
      image.at<unsigned char>(i / kWidth, i % kWidth) = cv::saturate_cast<unsigned char>(90.0 + noise(random));
    }
    watch.add(image, k / kRate_hz);
  }
  core::ImageRecord record;
  watch.finish(record);
  REQUIRE(record.scene.size() == 120);
  for (const core::SceneLook& look : record.scene) {
    CHECK(look.sd_u_px == 0.0);  // nothing there that a motion would show in
    CHECK(look.sd_v_px == 0.0);
  }
}

TEST_CASE("An image that is smaller than a patch has nothing to watch", "[scene]") {
  core::SceneWatch watch;
  for (int k = 0; k < 10; ++k) watch.add(cv::Mat(20, 20, CV_8U, cv::Scalar(80)), k / kRate_hz);
  core::ImageRecord record;
  watch.finish(record);
  CHECK(record.scene.empty());
  CHECK_FALSE(record.noise_memory);
}

TEST_CASE("A pixel's noise is measured at each brightness", "[scene]") {
  constexpr double kDark = 0.4, kGain = 0.02;  // codes², codes
  std::mt19937 random(11);
  core::SceneWatch watch;
  for (int k = 0; k < 60; ++k) {
    cv::Mat_<unsigned char> image(kHeight, kWidth);
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        const double level = 20.0 + 200.0 * u / kWidth;
        std::normal_distribution<double> noise(0.0, std::sqrt(kDark + kGain * level));
        image(v, u) = cv::saturate_cast<unsigned char>(level + noise(random));
      }
    }
    watch.add(image, k / kRate_hz);
  }
  core::ImageRecord record;
  watch.finish(record);
  REQUIRE(record.noise_levels.size() >= 6);
  CHECK(record.noise_levels.back().level_code - record.noise_levels.front().level_code > 100.0);
  double chi2 = 0.0;
  for (const core::NoiseAtLevel& one : record.noise_levels) {
    const double expected = std::sqrt(kDark + kGain * one.level_code + 1.0 / 12.0);  // with rounding
    CHECK(one.known_to < 0.05 * one.sd_code);
    // A group has pixels of a range of levels, whose mean variance is that of the mean level.
    CHECK(std::abs(one.sd_code - expected) < 5.0 * one.known_to);
    chi2 += std::pow((one.sd_code - expected) / one.known_to, 2) / static_cast<double>(record.noise_levels.size());
  }
  CHECK(chi2 < 2.5);
  CHECK(chi2 > 0.05);  // known_to is no mere bound
}

TEST_CASE("A scene whose blocks show is trusted as little as one of a file that says it is lossy", "[scene]") {
  const auto seen = [](bool said) {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0.0, 1.0);
    core::SceneWatch watch(said);
    for (int k = 0; k < 40; ++k) {
      cv::Mat_<double> blocks(kHeight / 8 + 1, kWidth / 8 + 1);
      for (double& one : blocks) one = 6.0 * noise(random);
      cv::Mat_<unsigned char> image(kHeight, kWidth);
      for (int v = 0; v < kHeight; ++v) {
        for (int u = 0; u < kWidth; ++u) {
          image(v, u) = cv::saturate_cast<unsigned char>(wall(u, v) + blocks(v / 8, u / 8) + noise(random));
        }
      }
      watch.add(image, k / kRate_hz);
    }
    core::ImageRecord record;
    watch.finish(record);
    return record;
  };
  const core::ImageRecord said = seen(true), silent = seen(false);
  REQUIRE(said.scene.size() == silent.scene.size());
  for (std::size_t k = 0; k < said.scene.size(); ++k) {
    // What patches differ by is weighed against a pixel's noise, then widened: up to twice as wide.
    CHECK(silent.scene[k].sd_u_px > 0.7 * said.scene[k].sd_u_px);
    CHECK(silent.scene[k].sd_u_px < 2.0 * said.scene[k].sd_u_px);
    for (std::size_t b = 0; b < core::kRowBands; ++b) {
      CHECK(silent.scene[k].gain_sd[b] == Approx(said.scene[k].gain_sd[b]).epsilon(0.3));
    }
  }
}
