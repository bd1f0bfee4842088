#include "validate/blind/case/blind_picture_effects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnose/effects/effect_list.h"
#include "validate/blind/case/blind_strength.h"

namespace glidelab::validate {
namespace {

constexpr double kNear = 0.8;  // of the wanted size, where the camera cannot do more

double top_speed(const BlindScene& scene) {
  double top = 0.0;
  const BlindDetection nominal(scene.motion);
  for (const auto& clip : nominal.speed_m_s()) {
    for (const double v : clip) top = std::max(top, std::abs(v));
  }
  return top;
}

std::optional<BlindCause> by_pictures(const char* id, double size, double usual, double largest, double wanted,
                                      const char* parameter) {
  if (size > largest) {
    if (kNear * size > largest) return std::nullopt;
    size = largest;
    wanted = 0.5 * std::pow(size / usual, 2);
  }
  return BlindCause{id, size, {{parameter, size}}, "", wanted};
}

}  // namespace

std::optional<BlindCause> long_exposure(double wanted, BlindScene& scene, BlindRandom&) {
  BlindCamera& camera = scene.camera;
  const double stated_s = camera.exposure_s;
  const double usual_s = std::hypot(0.4 * stated_s, 0.2 / camera.px_per_m() / top_speed(scene));
  // Rows that are read one after the other must still end within the frame time.
  const double largest_s = 0.85 / camera.rate_hz - camera.line_s * camera.height_px - stated_s;
  auto cause = by_pictures(diagnose::ids::exposure_blur, usual_s * std::sqrt(2.0 * wanted), usual_s, largest_s, wanted,
                           "exposure_s");
  if (!cause) return cause;
  camera.exposure_s = stated_s + cause->size;
  cause->parameters["exposure_s"] = camera.exposure_s;
  scene.stated.push_back({"exposure_s", fmt::format("{:.9g}", stated_s)});
  return cause;
}

std::optional<BlindCause> hidden_rolling(double wanted, BlindScene& scene, BlindRandom&) {
  BlindCamera& camera = scene.camera;
  const double marker_px = 0.02 * camera.px_per_m();
  const double usual_s = 0.02 / (marker_px * top_speed(scene) * camera.px_per_m());
  const double largest_s = (1.0 / camera.rate_hz - camera.exposure_s) / camera.height_px;
  camera.line_s = 0.0;
  auto cause = by_pictures(diagnose::ids::rolling_shutter, usual_s * std::sqrt(2.0 * wanted), usual_s, largest_s,
                           wanted, "line_s");
  if (!cause) return cause;
  camera.line_s = cause->size;
  scene.stated.push_back({"shutter", "\"global\""});
  scene.stated.push_back({"line_readout_s", ""});
  return cause;
}

std::optional<BlindCause> flicker(double wanted, BlindScene& scene, BlindRandom& random) {
  const BlindCamera& camera = scene.camera;
  const double hz = uniform(random, 0.0, 1.0) < 0.7 ? (uniform(random, 0.0, 1.0) < 0.5 ? 100.0 : 120.0)
                                                    : uniform(random, 8.0, 0.45 * camera.rate_hz);
  // What the frames see of it must be a wave: five periods in the shortest clip, and not a multiple of the rate.
  const double folded = std::abs(hz - camera.rate_hz * std::round(hz / camera.rate_hz));
  double shortest_s = 10.0;
  for (const BlindClip& clip : scene.motion.clips) {
    shortest_s = std::min(shortest_s, static_cast<double>(clip.frames) / clip.rate_hz);
  }
  if (folded * shortest_s < 5.0 || folded > 0.47 * camera.rate_hz) return std::nullopt;
  const double half_turns = std::numbers::pi * hz * camera.exposure_s;
  const double usual = (camera.lossy() ? 0.01 : 0.002) / (std::sin(half_turns) / half_turns);
  auto cause = by_pictures(diagnose::ids::light_flicker, usual * std::sqrt(2.0 * wanted), usual, 0.25, wanted, "depth");
  if (!cause) return cause;
  scene.flicker_depth = cause->size;
  scene.flicker_hz = hz;
  cause->parameters["f_hz"] = hz;
  return cause;
}

std::optional<BlindCause> gradient(double wanted, BlindScene& scene, BlindRandom& random) {
  constexpr double kUsual_1_m = 0.1, kMost_1_m = 1.2;
  auto cause = by_pictures(diagnose::ids::light_gradient, kUsual_1_m * std::sqrt(2.0 * wanted), kUsual_1_m, kMost_1_m,
                           wanted, "gradient");
  if (!cause) return cause;
  scene.gradient_1_m = uniform(random, 0.0, 1.0) < 0.5 ? -cause->size : cause->size;
  cause->parameters["gradient"] = scene.gradient_1_m;
  return cause;
}

std::optional<BlindCause> hidden_codec(double wanted, BlindScene& scene, BlindRandom& random) {
  BlindCamera& camera = scene.camera;
  const double wall_e = 0.285 * camera.full_well_e;
  const double noise_code = 253.0 / camera.full_well_e * std::hypot(std::sqrt(wall_e), camera.read_noise_e);
  const double usual = 3.0 * std::hypot(noise_code, 0.3), step = usual * std::sqrt(2.0 * wanted);
  scene.retouch.rewritten = true;
  BlindCause cause{diagnose::ids::compression, step, {}, "", wanted};
  if (uniform(random, 0.0, 1.0) < 0.5) {
    // The quantiser's step doubles every 6 of crf, 0.625 at 0.
    camera.codec = "h264";
    camera.crf = std::round(6.0 * std::log2(step / 0.625));
    if (camera.crf < 20.0 || camera.crf > 44.0) return std::nullopt;
    return cause;
  }
  // libjpeg's table begins at 16 and is scaled by 50/quality below 50 and 2 - quality/50 above.
  camera.codec = "mjpeg";
  const double scaled = step / 16.0;
  camera.quality = static_cast<int>(std::round(scaled > 1.0 ? 50.0 / scaled : 100.0 - 50.0 * scaled));
  if (camera.quality < 8 || camera.quality > 90) return std::nullopt;
  return cause;
}

}  // namespace glidelab::validate
