#include "diagnose/pictures/picture_sway.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/pictures/scene/codec_blocks.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/score_space.h"
#include "diagnose/pictures/series_wave.h"

namespace glidelab::diagnose {
namespace {

constexpr double kLeastSway_px = 0.02;      // what a patch of scene can be trusted to
constexpr double kLeastSwayLossy_px = 0.3;  // of a codec, which keeps the scene where it was, or moves it, by blocks

double least_sway_px(const std::vector<FilmedClip>& clips) {
  const bool lossy = std::any_of(clips.begin(), clips.end(),
                                 [](const FilmedClip& clip) { return core::through_lossy_codec(*clip.record); });
  return lossy ? kLeastSwayLossy_px : kLeastSway_px;
}

std::vector<Series> drift_of(const FilmedClip& clip) {
  Series u, v;
  for (const core::SceneLook& look : clip.record->scene) {
    if (look.sd_u_px > 0.0) {
      u.t_s.push_back(look.t_s);
      u.value.push_back(look.u_px);
    }
    if (look.sd_v_px > 0.0) {
      v.t_s.push_back(look.t_s);
      v.value.push_back(look.v_px);
    }
  }
  return {std::move(u), std::move(v)};
}

/// Range of the means of eight parts of a series beyond what its noise makes of it, with its standard error.
struct Drift {
  double size = 0.0, sd = 0.0;
};

Drift slow_drift(const Series& series) {
  constexpr std::size_t kParts = 8;
  const std::size_t n = series.value.size() / kParts;
  if (n < 3) return {};
  std::vector<double> means;
  double within = 0.0;
  for (std::size_t p = 0; p < kParts; ++p) {
    double mean = 0.0, square = 0.0;
    for (std::size_t i = p * n; i < (p + 1) * n; ++i) mean += series.value[i] / static_cast<double>(n);
    for (std::size_t i = p * n; i < (p + 1) * n; ++i) square += std::pow(series.value[i] - mean, 2);
    means.push_back(mean);
    within += square / static_cast<double>((n - 1) * kParts);
  }
  const auto [low, high] = std::minmax_element(means.begin(), means.end());
  // The range of eight means of noise is 2.85 of their standard deviations, with a spread of 0.82.
  const double sd = std::sqrt(within / static_cast<double>(n));
  return {*high - *low - 2.85 * sd, 0.82 * sd};
}

}  // namespace

void add_sway(const std::vector<FilmedClip>& clips, PictureEvidence& evidence) {
  const double least_px = least_sway_px(clips);
  std::vector<Series> series;
  Drift drift;
  for (const FilmedClip& clip : clips) {
    std::vector<Series> both = drift_of(clip);
    for (std::size_t axis = 0; axis < both.size(); ++axis) {
      if (both[axis].value.empty()) continue;
      PictureCurve curve;
      curve.what = axis == 0 ? "drift across" : "drift down";
      curve.clip = clip.name;
      curve.at = both[axis].t_s;
      curve.value = both[axis].value;
      evidence.curves.push_back(std::move(curve));
      const Drift mine = slow_drift(both[axis]);
      if (mine.size > drift.size) drift = mine;
      series.push_back(std::move(both[axis]));
    }
  }
  if (series.empty()) return;
  const SeriesWave wave = strongest_wave(series);
  PictureFinding finding = finding_of(ids::camera_motion);
  const bool shakes = wave.log_evidence > kSeenInPictures && wave.amplitude > least_px;
  const double drift_sd = std::hypot(drift.sd, least_px);
  const double of_drift = log_evidence_of(drift.size / drift_sd, 100.0 / drift_sd);
  if (shakes) {
    finding.log_evidence = std::max(wave.log_evidence, of_drift);
    finding.parameters = {{"amplitude_px", wave.amplitude, wave.sd}, {"f_hz", wave.f_hz, wave.sd_hz}};
    finding.words = fmt::format("The fixed scene sways in the image by ±{:.2g} px at {:.3g} Hz: the camera shakes.",
                                wave.amplitude, wave.f_hz);
  } else if (of_drift > kSeenInPictures) {
    finding.log_evidence = of_drift;
    finding.parameters = {{"amplitude_px", 0.5 * drift.size, 0.5 * drift_sd}};
    finding.words =
        fmt::format("The fixed scene drifts in the image by {:.2g} px within a clip: the camera moves.", drift.size);
  } else {
    finding.log_evidence = std::min({of_drift, wave.log_evidence, -2.0});
    finding.parameters = {{"amplitude_px", 0.0, std::max(least_px, wave.amplitude)}};
    finding.words = fmt::format("The camera is at rest: the fixed scene stays within {:.2g} px in the image.",
                                std::max(least_px, std::max(wave.amplitude, drift.size)));
  }
  evidence.findings.push_back(std::move(finding));
}

double camera_sway_support(const std::vector<FilmedClip>& clips, double amplitude_m, double f_hz) {
  const double least_px = least_sway_px(clips);
  // How much less or more than the marker the background moves depends on its depth and the kind of motion.
  std::vector<double> logs;
  for (double ratio = 0.5; ratio < 2.1; ratio *= 1.26) {
    double sum = 0.0;
    for (const FilmedClip& clip : clips) {
      const Series u = drift_of(clip).front();
      const Amplitude seen = amplitude_at(u, f_hz);
      if (!(seen.sd > 0.0)) continue;
      const double sd = std::hypot(seen.sd, 0.3 * least_px), expected = ratio * amplitude_m * clip.px_per_m;
      sum += 0.5 * (seen.size * seen.size - std::pow(seen.size - expected, 2)) / (sd * sd);
    }
    logs.push_back(sum);
  }
  return log_mean(logs);
}

}  // namespace glidelab::diagnose
