#include "diagnose/pictures/image_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "base/math/dense.h"
#include "base/math/log_sum.h"
#include "core/math/least_squares.h"
#include "core/math/quantile.h"
#include "core/pictures/scene/camera_traces.h"
#include "core/pictures/scene/lamp_flicker.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/pictures/image_recording.h"
#include "diagnose/pictures/image_search.h"

namespace glidelab::diagnose {
namespace {

constexpr double kLeastFlicker = 0.002;      // of the light: below this, no threshold would notice it
constexpr double kLeastFlickerLossy = 0.01;  // a codec's key frames change the brightness by as much
constexpr double kOfDrift = 0.01;            // of the light, for each pixel that the scene has moved
constexpr double kUsualGradient_1_m = 0.1;   // of the light, in an ordinary room
constexpr double kSaturatedCode = 0.96;      // of the largest code: a marker this bright may be saturated

}  // namespace

void add_flicker(const std::vector<FilmedClip>& clips, ImageEvidence& evidence) {
  std::vector<Series> series;
  for (const FilmedClip& clip : clips) {
    std::vector<Series> bands = core::brightness_series(*clip.record, clip.camera);
    ImageCurve curve;
    curve.what = "brightness";
    curve.clip = clip.name;
    curve.at = bands[0].t_s;
    curve.value = bands[0].value;
    for (std::size_t b = 1; b < bands.size() && curve.at.empty(); ++b) {
      curve.at = bands[b].t_s;
      curve.value = bands[b].value;
    }
    if (!curve.at.empty()) evidence.curves.push_back(std::move(curve));
    for (Series& band : bands) series.push_back(std::move(band));
  }
  const SeriesWave wave = strongest_wave(series);
  if (!(wave.f_hz > 0.0)) return;
  const core::CameraSettings& camera = clips.front().camera;
  const double f_hz = core::flicker_of_mains(wave, camera.frame_rate_hz);
  const double passed = std::max(0.1, std::abs(core::passed_by_exposure(f_hz, camera.exposure_s.value_or(0.0))));
  ImageFinding finding = finding_of(ids::light_flicker);
  // If the file does not say so, pixels that keep their values show it: light that changes by less than 1 % cannot
  // cause that.
  double least = memory_log_evidence(clips) > kSeenInImages ? kLeastFlickerLossy : kLeastFlicker;
  for (const FilmedClip& clip : clips) {
    if (core::through_lossy_codec(*clip.record)) least = kLeastFlickerLossy;
    for (const core::SceneLook& look : clip.record->scene) {
      least = std::max(least, kOfDrift * std::hypot(look.u_px, look.v_px));
    }
  }
  finding.log_evidence = wave.amplitude < least ? std::min(wave.log_evidence, -2.0) : wave.log_evidence;
  finding.parameters = {{"depth", wave.amplitude / passed, wave.sd / passed}, {"f_hz", f_hz, wave.sd_hz}};
  const bool flickers = finding.log_evidence > kSeenInImages;
  finding.fact =
      image::Flicker{flickers, flickers ? wave.amplitude : std::max(wave.amplitude, 3.0 * wave.sd), wave.f_hz, f_hz};
  evidence.findings.push_back(std::move(finding));
}

namespace {

/// The effect of light from one side on the centroid of the marker's light, if it exceeds the noise.
std::optional<image::LightAlong::Pull> pull_of_light(const std::vector<FilmedClip>& clips) {
  constexpr double kLeastPull_px = 0.1, kTailQuantile = 0.05;
  std::vector<double> pulls, along;
  for (const FilmedClip& clip : clips) {
    for (const core::MarkerLook& look : clip.record->marker) {
      pulls.push_back(std::hypot(look.light_u_px, look.light_v_px));
      along.push_back(clip.down ? look.light_v_px : look.light_u_px);
    }
  }
  const double pull = core::quantile(pulls, 0.5);
  if (pull < kLeastPull_px) return std::nullopt;
  const double change = 0.5 * (core::quantile(along, 1.0 - kTailQuantile) - core::quantile(along, kTailQuantile));
  return image::LightAlong::Pull{pull, change};
}

/// The speed of the marker's image at each look, px/s, from the looks before and after.
std::vector<double> image_speeds(const std::vector<core::MarkerLook>& looks) {
  std::vector<double> speeds(looks.size(), 0.0);
  for (std::size_t i = 0; i < looks.size(); ++i) {
    const core::MarkerLook &before = looks[i == 0 ? i : i - 1], &after = looks[std::min(i + 1, looks.size() - 1)];
    const double time_s = after.t_s - before.t_s;
    if (time_s > 0.0) speeds[i] = std::hypot(after.u_px - before.u_px, after.v_px - before.v_px) / time_s;
  }
  return speeds;
}

}  // namespace

/// Light along the path from the brightness of the marker or, if that is dark, of what is behind it, for glare, a codec
/// and the black level act on a dark one: ln(brightness) = a + g s + q s² + r w about the image's middle. w is the
/// speed of the marker's image over the largest: a long exposure smears what is fast, and makes it paler.
void add_gradient(const std::vector<FilmedClip>& clips, ImageEvidence& evidence) {
  const auto columns = static_cast<Eigen::Index>(clips.size() + 3);
  std::vector<Eigen::VectorXd> rows;
  std::vector<double> values;
  double px_per_m = 0.0, reach = 0.0;
  double fastest = 0.0;
  for (const FilmedClip& clip : clips) {
    for (const double speed : image_speeds(clip.record->marker)) fastest = std::max(fastest, speed);
  }
  for (std::size_t c = 0; c < clips.size(); ++c) {
    px_per_m += clips[c].px_per_m / static_cast<double>(clips.size());
    const std::vector<double> speeds = image_speeds(clips[c].record->marker);
    for (std::size_t i = 0; i < speeds.size(); ++i) {
      const core::MarkerLook& look = clips[c].record->marker[i];
      const double code = look.background + std::max(0.0, look.amplitude);
      if (!(code > 0.0) || code > kSaturatedCode * clips[c].record->full_code) continue;
      Eigen::VectorXd row = Eigen::VectorXd::Zero(columns);
      const double along_px =
          clips[c].down ? look.v_px - 0.5 * clips[c].record->height_px : look.u_px - 0.5 * clips[c].record->width_px;
      const double s = along_px / std::max(1.0, clips[c].px_per_m);
      row[static_cast<Eigen::Index>(c)] = 1.0;
      row[columns - 3] = s;
      row[columns - 2] = s * s;
      row[columns - 1] = fastest > 0.0 ? speeds[i] / fastest : 0.0;
      reach = std::max(reach, std::abs(s));
      rows.push_back(std::move(row));
      values.push_back(std::log(code));
    }
  }
  if (!(px_per_m > 0.0) || rows.size() < 40 || reach < 0.05) return;
  Eigen::MatrixXd design(std::ssize(rows), columns);
  for (std::size_t i = 0; i < rows.size(); ++i) design.row(static_cast<Eigen::Index>(i)) = rows[i].transpose();
  const Eigen::VectorXd data = Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values));
  Eigen::MatrixXd normal = base::transposed_product(design, design);
  normal.diagonal().array() += 1e-9 * normal.diagonal().maxCoeff();
  const Eigen::MatrixXd inverse = base::inverse_positive(normal);
  const Eigen::VectorXd found = base::product(inverse, base::transposed_product(design, data));
  const double variance = (data - base::product(design, found)).squaredNorm() / static_cast<double>(rows.size());
  const double gradient = found[columns - 3];
  // Neighbouring frames share the pixels' own response; one in ten counts.
  const double sd = std::sqrt(10.0 * variance * inverse(columns - 3, columns - 3));
  ImageFinding finding = finding_of(ids::light_gradient);
  const double usual = std::hypot(sd, kUsualGradient_1_m);
  finding.log_evidence = log_either_sign_evidence(gradient / usual, 10.0 / usual);
  finding.parameters = {{"gradient", gradient, sd}};
  finding.fact = image::LightAlong{gradient, sd, kUsualGradient_1_m, clips.front().down, pull_of_light(clips)};
  evidence.findings.push_back(std::move(finding));
}

namespace {

constexpr double kLeastSway_px = 0.02;      // accuracy of the shift of a patch of the scene
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

/// Range of the means of eight parts of a series beyond that due to its noise, with its standard error.
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

/// The slope of the straight line through a series, per second; 0 for a single time.
double slope_of(const Series& series) {
  constexpr double kRegular = 1e-12;  // of W Stt
  if (series.t_s.empty()) return 0.0;
  core::LineSums sums;
  for (std::size_t i = 0; i < series.t_s.size(); ++i) {
    sums.add(1.0, series.t_s[i] - series.t_s.front(), series.value[i]);
  }
  return sums.is_regular(kRegular) ? sums.slope() : 0.0;
}

}  // namespace

void add_sway(const std::vector<FilmedClip>& clips, ImageEvidence& evidence) {
  const double least_px = least_sway_px(clips);
  std::vector<Series> series;
  Drift drift;
  double speed_m_s = 0.0;  // of the drift, along the motion
  for (const FilmedClip& clip : clips) {
    std::vector<Series> both = drift_of(clip);
    if (clip.px_per_m > 0.0) {
      speed_m_s = std::max(speed_m_s, std::abs(slope_of(both[clip.down ? 1 : 0])) / clip.px_per_m);
    }
    for (std::size_t axis = 0; axis < both.size(); ++axis) {
      if (both[axis].value.empty()) continue;
      ImageCurve curve;
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
  ImageFinding finding = finding_of(ids::camera_motion);
  const bool shakes = wave.log_evidence > kSeenInImages && wave.amplitude > least_px;
  const double drift_sd = std::hypot(drift.sd, least_px);
  const double of_drift = log_deviation_evidence(drift.size / drift_sd, 100.0 / drift_sd);
  if (shakes) {
    finding.log_evidence = std::max(wave.log_evidence, of_drift);
    // The wave is one of both axes alike, and a camera may sway along one of them.
    const double amplitude_px = std::numbers::sqrt2 * wave.amplitude;
    finding.parameters = {{"amplitude_px", amplitude_px, std::numbers::sqrt2 * wave.sd},
                          {"f_hz", wave.f_hz, wave.sd_hz}};
    finding.fact = image::Sway{image::Sway::How::shakes, amplitude_px, wave.f_hz};
  } else if (of_drift > kSeenInImages) {
    finding.log_evidence = of_drift;
    finding.parameters = {{"amplitude_px", 0.5 * drift.size, 0.5 * drift_sd}};
    finding.fact = image::Sway{image::Sway::How::drifts, drift.size, 0.0, speed_m_s};
  } else {
    finding.log_evidence = std::min({of_drift, wave.log_evidence, -2.0});
    finding.parameters = {{"amplitude_px", 0.0, std::max(least_px, wave.amplitude)}};
    finding.fact = image::Sway{image::Sway::How::rests, std::max({least_px, wave.amplitude, drift.size}), 0.0};
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
      const Series along = drift_of(clip)[clip.down ? 1 : 0];
      const Amplitude seen = amplitude_at(along, f_hz);
      if (!(seen.sd > 0.0)) continue;
      const double sd = std::hypot(seen.sd, 0.3 * least_px), expected = ratio * amplitude_m * clip.px_per_m;
      sum += 0.5 * (seen.size * seen.size - std::pow(seen.size - expected, 2)) / (sd * sd);
    }
    logs.push_back(sum);
  }
  return base::log_mean(logs);
}

}  // namespace glidelab::diagnose
