#include "diagnose/picture_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "base/dense.h"
#include "diagnose/effect_list.h"
#include "diagnose/picture_scene.h"
#include "diagnose/picture_shape.h"
#include "diagnose/score_space.h"

namespace glidelab::diagnose {
namespace {

constexpr double kLeastFlicker = 0.002;      // of the light: below, nothing that a threshold would notice
constexpr double kLeastFlickerLossy = 0.01;  // a codec's key frames brighten and darken by as much
constexpr double kOfDrift = 0.01;            // of the light, for each pixel that the scene has moved
constexpr double kLeastSway_px = 0.02;       // what a patch of scene can be trusted to
// Of the stated exposure: a tone curve lifts the half-lit ends of a smear, by so much on a large marker.
constexpr double kToneOfShape = 0.4;
constexpr double kLeastSmear_px = 0.2;
constexpr double kUsualGradient_1_m = 0.1;  // of the light, in a room where nothing is wrong
constexpr double kMemory = 0.05;            // of a ratio of variances that should be 1
constexpr double kSeen = 3.0;               // log evidence

PictureFinding finding_of(std::string_view id) {
  PictureFinding finding;
  finding.id = id;
  return finding;
}

/// sinc of an exposure's average over a wave.
double averaged(double f_hz, double exposure_s) {
  const double x = std::numbers::pi * f_hz * exposure_s;
  return x < 1e-6 ? 1.0 : std::sin(x) / x;
}

/// Mains light flickers at 100 or 120 Hz, of which the frames see an alias; else what is seen.
double flicker_of_mains(double seen_hz, double sd_hz, double rate_hz) {
  for (const double mains : {100.0, 120.0}) {
    const double folded = std::abs(mains - rate_hz * std::round(mains / rate_hz));
    // Mains itself keeps to 0.2 %.
    if (std::abs(folded - seen_hz) < 0.002 * mains + 3.0 * sd_hz + 0.1) return mains;
  }
  return seen_hz;
}

void add_flicker(const std::vector<FilmedClip>& clips, PictureEvidence& evidence) {
  std::vector<Series> series;
  for (const FilmedClip& clip : clips) {
    const bool rolling = clip.camera.shutter == core::Shutter::rolling;
    std::vector<Series> bands(core::kRowBands);
    for (const core::SceneLook& look : clip.record->scene) {
      double sum = 0.0, weight = 0.0;
      for (std::size_t b = 0; b < core::kRowBands; ++b) {
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
    PictureCurve curve;
    curve.what = "brightness";
    curve.clip = clip.name;
    curve.at = bands[0].t_s;
    curve.value = bands[0].value;
    for (std::size_t b = 1; b < core::kRowBands && curve.at.empty(); ++b) {
      curve.at = bands[b].t_s;
      curve.value = bands[b].value;
    }
    if (!curve.at.empty()) evidence.curves.push_back(std::move(curve));
    for (Series& band : bands) series.push_back(std::move(band));
  }
  const Wave wave = strongest_wave(series);
  if (!(wave.f_hz > 0.0)) return;
  const core::CameraSettings& camera = clips.front().camera;
  const double f_hz = flicker_of_mains(wave.f_hz, wave.sd_hz, camera.frame_rate_hz);
  const double passed = std::max(0.1, std::abs(averaged(f_hz, camera.exposure_s.value_or(0.0))));
  PictureFinding finding = finding_of("light_flicker");
  double least = kLeastFlicker;
  for (const FilmedClip& clip : clips) {
    if (clip.record->lossy.value_or(false)) least = kLeastFlickerLossy;
    for (const core::SceneLook& look : clip.record->scene) {
      least = std::max(least, kOfDrift * std::hypot(look.u_px, look.v_px));
    }
  }
  finding.log_evidence = wave.amplitude < least ? std::min(wave.log_evidence, -2.0) : wave.log_evidence;
  finding.parameters = {{"depth", wave.amplitude / passed, wave.sd / passed}, {"f_hz", f_hz, wave.sd_hz}};
  finding.words =
      finding.log_evidence > kSeen
          ? fmt::format("The brightness of what rests in the scene varies by ±{:.2g} % with {:.4g} Hz{}.",
                        100.0 * wave.amplitude, wave.f_hz,
                        f_hz != wave.f_hz ? fmt::format(" (as {:.0f} Hz looks at this frame rate)", f_hz) : "")
          : fmt::format("Light does not flicker: no wave above {:.2g} % in what rests in the scene.",
                        100.0 * std::max(wave.amplitude, 3.0 * wave.sd));
  evidence.findings.push_back(std::move(finding));
}

void add_shape(const std::vector<FilmedClip>& clips, PictureEvidence& evidence) {
  ShapeFit fit = fit_marker_shape(clips);
  if (!fit.known) return;
  const core::CameraSettings& camera = clips.front().camera;
  evidence.fastest_px_s = fit.fastest_px_s;
  for (PictureCurve& curve : fit.curves) evidence.curves.push_back(std::move(curve));
  PictureFinding blur = finding_of("exposure_blur");
  const double least_s = kLeastSmear_px / fit.fastest_px_s;
  blur.parameters = {{"exposure_s", fit.exposure_s, std::hypot(fit.exposure_sd_s, 0.1 * fit.exposure_s)}};
  if (camera.exposure_s) {
    const double sd =
        std::sqrt(std::pow(fit.exposure_sd_s, 2) + std::pow(kToneOfShape * *camera.exposure_s, 2) + least_s * least_s);
    blur.log_evidence = log_evidence_of((fit.exposure_s - *camera.exposure_s) / sd, 1.0 / camera.frame_rate_hz / sd);
    blur.words = fmt::format("The marker is smeared as by an exposure of {:.3g} ± {:.1g} ms; {:.3g} ms is stated.",
                             1e3 * fit.exposure_s, 1e3 * sd, 1e3 * *camera.exposure_s);
  } else {
    blur.words = fmt::format("The marker is smeared as by an exposure of {:.3g} ± {:.1g} ms; none is stated.",
                             1e3 * fit.exposure_s, 1e3 * std::hypot(fit.exposure_sd_s, least_s));
  }
  evidence.findings.push_back(std::move(blur));

  PictureFinding shutter = finding_of("rolling_shutter");
  const double stated = stated_line_s(camera);
  // Of the height of the marker's image: a hundredth of a pixel is as far as its outline can be trusted.
  const double least_line_s = 0.01 / (2.0 * fit.radius_px * fit.fastest_px_s);
  const double sd = std::hypot(fit.line_sd_s, least_line_s, 0.05 * stated);
  const double rows = clips.front().record->height_px;
  shutter.parameters = {{"line_s", fit.line_s, sd}};
  shutter.log_evidence = log_evidence_of(std::abs(fit.line_s - stated) / sd, 1.0 / (camera.frame_rate_hz * rows) / sd);
  shutter.words =
      fmt::format("The marker is sheared as by {:.3g} ± {:.1g} µs from row to row; {:.3g} µs {}.", 1e6 * fit.line_s,
                  1e6 * sd, 1e6 * stated, stated == 0.0 ? "(a global shutter) is stated" : "is stated");
  evidence.findings.push_back(std::move(shutter));
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

void add_sway(const std::vector<FilmedClip>& clips, PictureEvidence& evidence) {
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
  const Wave wave = strongest_wave(series);
  PictureFinding finding = finding_of("camera_motion");
  const bool shakes = wave.log_evidence > kSeen && wave.amplitude > kLeastSway_px;
  const double drift_sd = std::hypot(drift.sd, kLeastSway_px);
  const double of_drift = log_evidence_of(drift.size / drift_sd, 100.0 / drift_sd);
  if (shakes) {
    finding.log_evidence = std::max(wave.log_evidence, of_drift);
    finding.parameters = {{"amplitude_px", wave.amplitude, wave.sd}, {"f_hz", wave.f_hz, wave.sd_hz}};
    finding.words =
        fmt::format("What rests in the scene sways in the picture by ±{:.2g} px with {:.3g} Hz: the camera shakes.",
                    wave.amplitude, wave.f_hz);
  } else if (of_drift > kSeen) {
    finding.log_evidence = of_drift;
    finding.parameters = {{"amplitude_px", 0.5 * drift.size, 0.5 * drift_sd}};
    finding.words = fmt::format(
        "What rests in the scene drifts in the picture by {:.2g} px within a clip: the camera moves.", drift.size);
  } else {
    finding.log_evidence = std::min({of_drift, wave.log_evidence, -2.0});
    finding.parameters = {{"amplitude_px", 0.0, std::max(kLeastSway_px, wave.amplitude)}};
    finding.words = fmt::format("The camera rests: what is fixed in the scene stays within {:.2g} px in the picture.",
                                std::max(kLeastSway_px, std::max(wave.amplitude, drift.size)));
  }
  evidence.findings.push_back(std::move(finding));
}

/// Light along the path from how bright the marker is: ln(brightness) = a + g s + q s² about the picture's middle.
void add_gradient(const std::vector<FilmedClip>& clips, PictureEvidence& evidence) {
  const auto columns = static_cast<Eigen::Index>(clips.size() + 2);
  std::vector<Eigen::VectorXd> rows;
  std::vector<double> values;
  double px_per_m = 0.0, reach = 0.0;
  for (std::size_t c = 0; c < clips.size(); ++c) {
    px_per_m += clips[c].px_per_m / static_cast<double>(clips.size());
    for (const core::MarkerLook& look : clips[c].record->marker) {
      if (!(look.amplitude + look.background > 0.0)) continue;
      Eigen::VectorXd row = Eigen::VectorXd::Zero(columns);
      const double s = (look.u_px - 0.5 * clips[c].record->width_px) / std::max(1.0, clips[c].px_per_m);
      row[static_cast<Eigen::Index>(c)] = 1.0;
      row[columns - 2] = s;
      row[columns - 1] = s * s;
      reach = std::max(reach, std::abs(s));
      rows.push_back(std::move(row));
      values.push_back(std::log(look.amplitude + look.background));
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
  const double gradient = found[columns - 2];
  // Neighbouring frames share what the pixels' own response does; one in ten counts.
  const double sd = std::sqrt(10.0 * variance * inverse(columns - 2, columns - 2));
  PictureFinding finding = finding_of("light_gradient");
  const double usual = std::hypot(sd, kUsualGradient_1_m);
  finding.log_evidence = log_evidence_of(std::abs(gradient) / usual, 10.0 / usual);
  finding.parameters = {{"gradient", gradient, sd}};
  finding.words = fmt::format("The light on the marker changes by {:.2g} ± {:.1g} % a metre to the right.",
                              100.0 * gradient, 100.0 * sd);
  evidence.findings.push_back(std::move(finding));
}

/// Larger steps between pixels where blocks of 8 meet, against the other seven columns' scatter.
double block_excess(const core::BlockSteps& steps, double& relative) {
  double mean = 0.0, square = 0.0;
  for (std::size_t c = 1; c < 8; ++c) mean += steps.mean[c] / 7.0;
  for (std::size_t c = 1; c < 8; ++c) square += std::pow(steps.mean[c] - mean, 2) / 6.0;
  relative = mean > 0.0 ? steps.mean[0] / mean - 1.0 : 0.0;
  const double floor = 0.02 * mean;  // columns of a real scene differ by as much
  return (steps.mean[0] - mean) / std::max(1e-12, std::hypot(std::sqrt(square), floor));
}

void add_codec(const std::vector<FilmedClip>& clips, PictureEvidence& evidence) {
  double excess = 0.0, relative = 0.0, memory = 0.0;
  std::size_t lossy = 0, lossless = 0;
  std::string codec;
  for (const FilmedClip& clip : clips) {
    double mine = 0.0;
    const double z = block_excess(clip.record->steps, mine);
    if (z > excess) {
      excess = z;
      relative = mine;
    }
    memory = std::max(memory, clip.record->noise_memory.value_or(1.0));
    if (clip.record->lossy) ++(*clip.record->lossy ? lossy : lossless);
    if (codec.empty()) codec = clip.record->codec;
  }
  PictureFinding finding = finding_of("compression");
  const double blocks = log_evidence_of((excess - 3.0) / 2.0, 100.0);  // seven columns tell their scatter poorly
  // A file that says that it is compressed with loss withholds nothing: it is named for what it does to the positions.
  finding.stated = lossy > 0;
  finding.log_evidence =
      std::max(lossy > 0 ? std::max(-1.0, blocks) : blocks, log_evidence_of((memory - 1.1) / kMemory, 1.0 / kMemory));
  finding.parameters = {{"block_steps", relative, relative / std::max(1.0, excess)}};
  finding.words = fmt::format("{}; steps between pixels are {:.1f} % {} at the edges of 8 x 8 blocks than elsewhere.",
                              lossy > 0      ? fmt::format("The file is compressed with loss ({})", codec)
                              : lossless > 0 ? fmt::format("The file is compressed without loss ({})", codec)
                                             : std::string("What the file was compressed with is not known"),
                              100.0 * std::abs(relative), relative < 0.0 ? "smaller" : "larger");
  if (memory > 1.1)
    finding.words +=
        fmt::format(" Noise lasts over frames (changes over two frames are {:.2f} times those over one).", memory);
  evidence.findings.push_back(std::move(finding));
}

void add_missing(const std::vector<FilmedClip>& clips, PictureEvidence& evidence) {
  std::size_t missing = 0, repeated = 0, frames = 0;
  for (const FilmedClip& clip : clips) {
    missing += clip.record->stamps_missing;
    const auto& looks = clip.record->marker;
    frames += looks.size();
    for (std::size_t i = 2; i < looks.size(); ++i) {
      const bool same = looks[i].u_px == looks[i - 1].u_px && looks[i].v_px == looks[i - 1].v_px;
      if (same && std::abs(looks[i - 1].u_px - looks[i - 2].u_px) > 0.05) ++repeated;
    }
  }
  if (missing + repeated == 0) return;
  PictureFinding finding = finding_of("dropped_frames");
  finding.log_evidence = std::min(50.0, 5.0 * static_cast<double>(missing + repeated));
  const double count = static_cast<double>(missing + repeated);
  finding.parameters = {
      {"fraction", count / static_cast<double>(frames), std::sqrt(count) / static_cast<double>(frames)}};
  finding.words =
      fmt::format("{} frames repeat the picture before, and the time stamps leave a gap for {}.", repeated, missing);
  evidence.findings.push_back(std::move(finding));
}

}  // namespace

double stated_line_s(const core::CameraSettings& camera) {
  if (camera.shutter == core::Shutter::global) return 0.0;
  return camera.bottom_row_first ? -camera.line_readout_s : camera.line_readout_s;
}

double log_evidence_of(double z, double largest) {
  std::vector<double> logs;
  for (double s = 1.0; s < std::max(2.0, largest); s *= 1.25) logs.push_back(z * s - 0.5 * s * s);
  return log_mean(logs);
}

std::vector<FilmedClip> filmed_clips(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups,
                                     const std::vector<std::optional<core::CameraSettings>>& cameras) {
  std::vector<FilmedClip> clips;
  std::map<std::string, std::size_t> views;
  for (std::size_t i = 0; i < results.clips.size(); ++i) {
    const core::ClipResult& clip = results.clips[i];
    if (!clip.pictures || !cameras[i] || clip.pictures->marker.empty()) continue;
    FilmedClip filmed;
    filmed.name = clip.name;
    filmed.view = views.emplace(clip.experiment + "/" + setups[i].group, views.size()).first->second;
    filmed.record = clip.pictures;
    filmed.camera = *cameras[i];
    double uu = 0.0, ux = 0.0, mean_u = 0.0, mean_x = 0.0, count = 0.0;
    for (int pass = 0; pass < 2; ++pass) {
      for (const core::MarkerLook& look : clip.pictures->marker) {
        if (look.frame >= clip.motion.size() || !clip.motion[look.frame].measured_m) continue;
        const double x = *clip.motion[look.frame].measured_m;
        if (pass == 0) {
          mean_u += look.u_px;
          mean_x += x;
          count += 1.0;
        } else {
          ux += (look.u_px - mean_u) * (x - mean_x);
          uu += (x - mean_x) * (x - mean_x);
        }
      }
      if (pass == 0) {
        mean_u /= std::max(1.0, count);
        mean_x /= std::max(1.0, count);
      }
    }
    if (uu > 0.0) filmed.px_per_m = std::abs(ux / uu);
    clips.push_back(std::move(filmed));
  }
  return clips;
}

PictureEvidence picture_evidence(std::vector<FilmedClip> clips) {
  PictureEvidence evidence;
  if (clips.empty()) return evidence;
  add_shape(clips, evidence);
  add_flicker(clips, evidence);
  add_sway(clips, evidence);
  add_gradient(clips, evidence);
  add_codec(clips, evidence);
  add_missing(clips, evidence);
  for (PictureFinding& finding : evidence.findings) {
    finding.seen = finding.log_evidence > kSeen;
    finding.stage = effect_list()[effect_index(finding.id)].stage;
  }
  evidence.clips = std::move(clips);
  return evidence;
}

double camera_sway_support(const std::vector<FilmedClip>& clips, double amplitude_m, double f_hz) {
  // How much less or more than the marker the background moves depends on its depth and the kind of motion.
  std::vector<double> logs;
  for (double ratio = 0.5; ratio < 2.1; ratio *= 1.26) {
    double sum = 0.0;
    for (const FilmedClip& clip : clips) {
      const Series u = drift_of(clip).front();
      const Amplitude seen = amplitude_at(u, f_hz);
      if (!(seen.sd > 0.0)) continue;
      const double sd = std::hypot(seen.sd, 0.3 * kLeastSway_px), expected = ratio * amplitude_m * clip.px_per_m;
      sum += 0.5 * (seen.size * seen.size - std::pow(seen.size - expected, 2)) / (sd * sd);
    }
    logs.push_back(sum);
  }
  return log_mean(logs);
}

}  // namespace glidelab::diagnose
