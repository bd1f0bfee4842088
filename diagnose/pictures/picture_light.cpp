#include "diagnose/pictures/picture_light.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/math/dense.h"
#include "base/text/number_text.h"
#include "core/pictures/scene/codec_blocks.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/pictures/picture_file.h"
#include "diagnose/pictures/series_wave.h"

namespace glidelab::diagnose {
namespace {

constexpr double kLeastFlicker = 0.002;      // of the light: below, nothing that a threshold would notice
constexpr double kLeastFlickerLossy = 0.01;  // a codec's key frames brighten and darken by as much
constexpr double kOfDrift = 0.01;            // of the light, for each pixel that the scene has moved
constexpr double kUsualGradient_1_m = 0.1;   // of the light, in a room where nothing is wrong
constexpr double kFull = 0.96;               // of the largest code: a marker as bright may be cut off there

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

}  // namespace

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
  const SeriesWave wave = strongest_wave(series);
  if (!(wave.f_hz > 0.0)) return;
  const core::CameraSettings& camera = clips.front().camera;
  const double f_hz = flicker_of_mains(wave.f_hz, wave.sd_hz, camera.frame_rate_hz);
  const double passed = std::max(0.1, std::abs(averaged(f_hz, camera.exposure_s.value_or(0.0))));
  PictureFinding finding = finding_of(ids::light_flicker);
  // Where the file does not tell, pixels that remember do: light that changes by less than 1 % cannot make them.
  double least = memory_log_evidence(clips) > kSeenInPictures ? kLeastFlickerLossy : kLeastFlicker;
  for (const FilmedClip& clip : clips) {
    if (core::through_lossy_codec(*clip.record)) least = kLeastFlickerLossy;
    for (const core::SceneLook& look : clip.record->scene) {
      least = std::max(least, kOfDrift * std::hypot(look.u_px, look.v_px));
    }
  }
  finding.log_evidence = wave.amplitude < least ? std::min(wave.log_evidence, -2.0) : wave.log_evidence;
  finding.parameters = {{"depth", wave.amplitude / passed, wave.sd / passed}, {"f_hz", f_hz, wave.sd_hz}};
  finding.words =
      finding.log_evidence > kSeenInPictures
          ? fmt::format("The brightness of the fixed scene varies by ±{:.2g} % at {:.4g} Hz{}.", 100.0 * wave.amplitude,
                        wave.f_hz,
                        f_hz != wave.f_hz ? fmt::format(" ({:.0f} Hz looks like this at this frame rate)", f_hz) : "")
          : fmt::format("The light does not flicker: no wave above {:.2g} % in the fixed scene.",
                        100.0 * std::max(wave.amplitude, 3.0 * wave.sd));
  evidence.findings.push_back(std::move(finding));
}

/// Light along the path from how bright the marker is: ln(brightness) = a + g s + q s² about the image's middle.
void add_gradient(const std::vector<FilmedClip>& clips, PictureEvidence& evidence) {
  const auto columns = static_cast<Eigen::Index>(clips.size() + 2);
  std::vector<Eigen::VectorXd> rows;
  std::vector<double> values;
  double px_per_m = 0.0, reach = 0.0;
  for (std::size_t c = 0; c < clips.size(); ++c) {
    px_per_m += clips[c].px_per_m / static_cast<double>(clips.size());
    for (const core::MarkerLook& look : clips[c].record->marker) {
      const double code = look.amplitude + look.background;
      if (!(code > 0.0) || code > kFull * clips[c].record->full_code) continue;
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
  PictureFinding finding = finding_of(ids::light_gradient);
  const double usual = std::hypot(sd, kUsualGradient_1_m);
  finding.log_evidence = log_evidence_of(std::abs(gradient) / usual, 10.0 / usual);
  finding.parameters = {{"gradient", gradient, sd}};
  finding.words =
      fmt::format("The light on the marker changes by {} % a metre to the right; {:.0f} % is usual in a room.",
                  base::value_and_sd_text(100.0 * gradient, 100.0 * sd), 100.0 * kUsualGradient_1_m);
  evidence.findings.push_back(std::move(finding));
}

}  // namespace glidelab::diagnose
