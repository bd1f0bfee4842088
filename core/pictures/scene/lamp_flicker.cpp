#include "core/pictures/scene/lamp_flicker.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "core/pictures/scene/camera_traces.h"

namespace glidelab::core {
namespace {

constexpr double kLeastPassed = 0.1;  // of the amplitude: less tells no depth
constexpr double kSurelySeen = 3.0;   // log evidence
constexpr double kLeastDepth = 0.002, kLeastDepthLossy = 0.01;
constexpr double kOfDrift = 0.01;       // of the light, for each pixel that the scene has moved
constexpr double kLastingNoise = 1.25;  // of noise_memory: three standard deviations above its usual 1.1

}  // namespace

std::vector<Series> brightness_series(const ImageRecord& record, const CameraSettings& camera) {
  const bool rolling = camera.shutter == Shutter::rolling;
  std::vector<Series> bands(rolling ? kRowBands : 1);
  for (const SceneLook& look : record.scene) {
    double sum = 0.0, weight = 0.0;
    for (std::size_t b = 0; b < kRowBands; ++b) {
      if (!(look.gain_sd[b] > 0.0)) continue;
      const double w = 1.0 / (look.gain_sd[b] * look.gain_sd[b]);
      if (rolling) {
        bands[b].t_s.push_back(look.t_s);
        bands[b].value.push_back(look.gain[b]);
      }
      sum += w * look.gain[b];
      weight += w;
    }
    if (rolling || weight == 0.0) continue;
    bands[0].t_s.push_back(look.t_s);
    bands[0].value.push_back(sum / weight);
  }
  return bands;
}

double scene_brightness(const ImageRecord& record, std::size_t frame, double v_px) {
  if (frame >= record.scene.size()) return 1.0;
  const SceneLook& look = record.scene[frame];
  const double part = v_px / std::max(1, record.height_px) * static_cast<double>(kRowBands);
  const auto own = static_cast<std::size_t>(std::clamp(part, 0.0, static_cast<double>(kRowBands - 1)));
  if (look.gain_sd[own] > 0.0) return 1.0 + look.gain[own];
  double sum = 0.0, weight = 0.0;
  for (std::size_t b = 0; b < kRowBands; ++b) {
    if (!(look.gain_sd[b] > 0.0)) continue;
    const double w = 1.0 / (look.gain_sd[b] * look.gain_sd[b]);
    sum += w * look.gain[b];
    weight += w;
  }
  return weight > 0.0 ? 1.0 + sum / weight : 1.0;
}

double flicker_of_mains(const SeriesWave& wave, double frame_rate_hz) {
  for (const double mains : {100.0, 120.0}) {
    const double folded = std::abs(mains - frame_rate_hz * std::round(mains / frame_rate_hz));
    // Mains itself keeps to 0.2 %.
    if (std::abs(folded - wave.f_hz) < 0.002 * mains + 3.0 * wave.sd_hz + 0.1) return mains;
  }
  return wave.f_hz;
}

double passed_by_exposure(double f_hz, double exposure_s) {
  const double x = std::numbers::pi * f_hz * exposure_s;
  return x < 1e-6 ? 1.0 : std::sin(x) / x;
}

double flicker_displacement_px(const LightFlicker& flicker, const CameraSettings& camera, double speed_px_s,
                               double radius_px) {
  const double w = 2.0 * std::numbers::pi * flicker.f_hz;
  // Of an exposure that is not stated, the longest.
  const double exposure_s = camera.exposure_s.value_or(1.0 / camera.frame_rate_hz);
  double px = 0.0;
  if (exposure_s > 0.0 && w > 0.0) {
    const double x = 0.5 * w * exposure_s;
    px += speed_px_s * flicker.depth * std::abs(std::sin(x) - x * std::cos(x)) * 2.0 / (w * w * exposure_s);
  }
  if (camera.shutter == Shutter::rolling) {
    px += 0.25 * radius_px * radius_px * flicker.depth * w * std::abs(camera.line_readout_s);
  }
  return px;
}

std::optional<LightFlicker> find_flicker(const std::vector<std::shared_ptr<const ImageRecord>>& records,
                                         const CameraSettings& camera) {
  std::vector<Series> series;
  double least = kLeastDepth;
  for (const auto& record : records) {
    std::ranges::move(brightness_series(*record, camera), std::back_inserter(series));
    if (through_lossy_codec(*record) || record->noise_memory.value_or(1.0) > kLastingNoise) {
      least = std::max(least, kLeastDepthLossy);
    }
    for (const SceneLook& look : record->scene) least = std::max(least, kOfDrift * std::hypot(look.u_px, look.v_px));
  }
  const SeriesWave wave = strongest_wave(series);
  if (!(wave.f_hz > 0.0) || wave.log_evidence < kSurelySeen || wave.amplitude < least) return std::nullopt;
  const double f_hz = flicker_of_mains(wave, camera.frame_rate_hz);
  const double passed = std::abs(passed_by_exposure(f_hz, camera.exposure_s.value_or(0.0)));
  return LightFlicker{wave.amplitude / std::max(kLeastPassed, passed), f_hz, wave.f_hz};
}

}  // namespace glidelab::core
