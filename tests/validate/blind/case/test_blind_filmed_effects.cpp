/// What a filmed case has in its images alone: how large it is, and when a camera has no room for it.
#include "validate/blind/case/blind_filmed_effects.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "tests/catch.h"
#include "validate/blind/case/blind_filmed_case.h"
#include "validate/blind/case/blind_strength.h"

using namespace glidelab;
using validate::BlindCause;
using validate::BlindScene;

namespace {

constexpr int kScenes = 150;
const std::vector<double> kGains = {8.0, 100.0, 1500.0};

double fastest(const BlindScene& scene) {
  double most = 0.0;
  const validate::BlindDetection nominal(scene.motion);
  for (const auto& clip : nominal.speed_m_s()) {
    for (const double v : clip) most = std::max(most, std::abs(v));
  }
  return most;
}

/// How often an effect had the size that was wanted, the largest that there is room for, or no room.
struct Rooms {
  int wanted = 0, largest = 0, none = 0;

  void check(const std::optional<BlindCause>& cause, double usual, double largest_size, double gain) {
    const double size = usual * std::sqrt(2.0 * gain);
    INFO("size " << size << ", at most " << largest_size);
    if (0.8 * size > largest_size) {
      ++none;
      CHECK_FALSE(cause);
      return;
    }
    REQUIRE(cause);
    const bool fits = size <= largest_size;
    ++(fits ? wanted : largest);
    const double taken = fits ? size : largest_size;
    CHECK(cause->size == Approx(taken).epsilon(1e-12));
    CHECK(cause->gain == Approx(0.5 * std::pow(taken / usual, 2)).epsilon(1e-12));
  }
};

std::string stated(const BlindScene& scene, const std::string& key) {
  for (const validate::BlindStated& one : scene.stated) {
    if (one.key == key) return one.value;
  }
  return "not stated anew";
}

}  // namespace

TEST_CASE(
    "a shutter that is open longer than stated, or reads rows late, has the wanted size or what the frame has room "
    "for") {
  std::mt19937_64 random(1);
  Rooms exposures, rows;
  for (int i = 0; i < kScenes; ++i) {
    const BlindScene drawn = validate::draw_scene(random, false);
    const validate::BlindCamera& camera = drawn.camera;
    const double frame_s = 1.0 / camera.rate_hz, px_per_m = camera.focal_px / camera.z_m;
    for (const double gain : kGains) {
      BlindScene scene = drawn;
      const auto longer = validate::long_exposure(gain, scene, random);
      exposures.check(longer, std::hypot(0.4 * camera.exposure_s, 0.2 / px_per_m / fastest(drawn)),
                      0.85 * frame_s - camera.line_s * camera.height_px - camera.exposure_s, gain);
      if (longer) {
        CHECK(scene.camera.exposure_s == Approx(camera.exposure_s + longer->size).epsilon(1e-12));
        CHECK(longer->parameters.at("exposure_s") == scene.camera.exposure_s);
        CHECK(std::stod(stated(scene, "exposure_s")) == Approx(camera.exposure_s).epsilon(1e-8));
      }
      scene = drawn;
      const auto late = validate::hidden_rolling(gain, scene, random);
      // 0.02 px over a marker of 20 mm: px/m * v * line time * marker's rows.
      rows.check(late, 0.02 / (px_per_m * fastest(drawn) * 0.02 * px_per_m),
                 (frame_s - camera.exposure_s) / camera.height_px, gain);
      if (late) {
        CHECK(scene.camera.line_s == late->size);
        CHECK(late->parameters.at("line_s") == late->size);
        CHECK(stated(scene, "shutter") == "\"global\"");
        CHECK(stated(scene, "line_readout_s").empty());
      }
    }
  }
  for (const Rooms& of : {exposures, rows}) CHECK(of.wanted > 0);
  CHECK(exposures.largest > 0);
  CHECK(exposures.none > 0);
}

TEST_CASE("a flicker is one that the frames of the shortest clip see as a wave, and no stronger than a quarter") {
  std::mt19937_64 random(2);
  Rooms rooms;
  int folded_away = 0;
  for (int i = 0; i < kScenes; ++i) {
    const BlindScene drawn = validate::draw_scene(random, false);
    const validate::BlindCamera& camera = drawn.camera;
    double shortest_s = 1e3;
    for (const validate::BlindClip& clip : drawn.motion.clips) {
      shortest_s = std::min(shortest_s, static_cast<double>(clip.frames) / clip.rate_hz);
    }
    for (const double gain : kGains) {
      std::mt19937_64 same = random;  // what the lamp is drawn from
      BlindScene scene = drawn;
      const auto cause = validate::flicker(gain, scene, random);
      const bool mains = validate::uniform(same, 0.0, 1.0) < 0.7;
      const double hz = mains ? (validate::uniform(same, 0.0, 1.0) < 0.5 ? 100.0 : 120.0)
                              : validate::uniform(same, 8.0, 0.45 * camera.rate_hz);
      const double folded = std::abs(std::remainder(hz, camera.rate_hz));
      if (folded * shortest_s < 5.0 || folded > 0.47 * camera.rate_hz) {
        ++folded_away;
        CHECK_FALSE(cause);
        continue;
      }
      // An exposure averages a wave to sin(pi f T) / (pi f T) of it.
      const double turns = std::numbers::pi * hz * camera.exposure_s;
      rooms.check(cause, (camera.codec == "magicyuv" ? 0.002 : 0.01) * turns / std::sin(turns), 0.25, gain);
      if (!cause) continue;
      CHECK(scene.flicker_hz == hz);
      CHECK(cause->parameters.at("f_hz") == hz);
      CHECK(scene.flicker_depth == cause->size);
      CHECK(cause->parameters.at("depth") == cause->size);
    }
  }
  CHECK(folded_away > 0);
  CHECK(rooms.wanted > 0);
  CHECK(rooms.none > 0);
}

TEST_CASE("light that changes along the track has either sign, and a hidden codec the step of its setting") {
  std::mt19937_64 random(3);
  Rooms rooms;
  std::map<std::string, int> codecs;
  int left = 0, right = 0, refused = 0;
  for (int i = 0; i < kScenes; ++i) {
    const BlindScene drawn = validate::draw_scene(random, true);
    for (const double gain : kGains) {
      BlindScene scene = drawn;
      const auto light = validate::gradient(gain, scene, random);
      rooms.check(light, 0.1, 1.2, gain);
      if (light) {
        CHECK(std::abs(scene.gradient_1_m) == light->size);
        CHECK(light->parameters.at("gradient") == scene.gradient_1_m);
        ++(scene.gradient_1_m < 0.0 ? left : right);
      }
      scene = drawn;
      const auto codec = validate::hidden_codec(gain, scene, random);
      CHECK(scene.retouch.rewritten);
      // Noise of a wall at 0.285 of the full well, in codes of which 253 are the full well, beside rounding to 0.3.
      const double well = drawn.camera.full_well_e;
      const double noise =
          std::hypot(253.0 / well * std::sqrt(0.285 * well + std::pow(drawn.camera.read_noise_e, 2)), 0.3);
      const double step = 3.0 * noise * std::sqrt(2.0 * gain);
      ++codecs[scene.camera.codec];
      if (scene.camera.codec == "h264") {
        CHECK(std::abs(std::log2(0.625 * std::exp2(scene.camera.crf / 6.0) / step)) < 0.5 / 6.0 + 1e-9);
        CHECK(codec.has_value() == (scene.camera.crf >= 20.0 && scene.camera.crf <= 44.0));
      } else {
        const auto scale = [](double quality) { return quality < 50.0 ? 50.0 / quality : 2.0 - quality / 50.0; };
        const int quality = scene.camera.quality;
        if (quality > 0) CHECK(16.0 * scale(quality + 0.5) <= step * (1.0 + 1e-9));
        if (quality > 1) CHECK(16.0 * scale(quality - 0.5) >= step * (1.0 - 1e-9));
        CHECK(codec.has_value() == (quality >= 8 && quality <= 90));
      }
      if (codec) CHECK(codec->size == Approx(step).epsilon(1e-12));
      refused += codec ? 0 : 1;
    }
  }
  CHECK((rooms.wanted > 0 && rooms.none > 0));
  CHECK((left > 0 && right > 0));
  CHECK((codecs.size() == 2 && codecs["h264"] > 0 && codecs["mjpeg"] > 0));
  CHECK(refused > 0);
}

TEST_CASE("of filmed cases a quarter lacks nothing, and 18 in a hundred something outside the list") {
  std::map<validate::BlindKind, double> seen;
  constexpr std::size_t kCases = 60;
  for (std::size_t i = 0; i < kCases; ++i) seen[validate::make_filmed_case(5, i, {}).kind] += 1.0;
  const std::map<validate::BlindKind, double> share = {
      {validate::BlindKind::none, 0.25}, {validate::BlindKind::single, 0.57}, {validate::BlindKind::outside, 0.18}};
  double chi2 = 0.0;
  for (const auto& [kind, p] : share) chi2 += std::pow(seen[kind] - p * kCases, 2) / (p * kCases);
  CHECK(chi2 < 13.8);  // two degrees of freedom, p = 0.001
}
