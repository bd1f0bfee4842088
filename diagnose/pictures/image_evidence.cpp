#include "diagnose/pictures/image_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/pictures/image_recording.h"
#include "diagnose/pictures/image_scene.h"
#include "diagnose/pictures/twin_camera.h"

namespace glidelab::diagnose {
namespace {

// Of the stated exposure: a tone curve lifts the half-lit ends of a smear, by so much on a large marker.
constexpr double kToneOfShape = 0.4;
constexpr double kLeastSmear_px = 0.2;

/// Clips of one camera as it is stated.
std::vector<std::vector<FilmedClip>> by_camera(const std::vector<FilmedClip>& clips) {
  const auto same = [](const FilmedClip& a, const FilmedClip& b) {
    return a.camera.exposure_s == b.camera.exposure_s && stated_line_s(a.camera) == stated_line_s(b.camera) &&
           a.camera.frame_rate_hz == b.camera.frame_rate_hz && a.record->height_px == b.record->height_px;
  };
  std::vector<std::vector<FilmedClip>> cameras;
  for (const FilmedClip& clip : clips) {
    const auto camera =
        std::find_if(cameras.begin(), cameras.end(), [&](const auto& of) { return same(of.front(), clip); });
    if (camera != cameras.end()) {
      camera->push_back(clip);
    } else {
      cameras.push_back({clip});
    }
  }
  return cameras;
}

/// Adds the finding of one camera, unless another camera has shown the effect more clearly: then returns false.
bool add_clearest(ImageFinding finding, ImageEvidence& evidence) {
  for (ImageFinding& known : evidence.findings) {
    if (known.id != finding.id) continue;
    if (!(finding.log_evidence > known.log_evidence)) return false;
    known = std::move(finding);
    return true;
  }
  evidence.findings.push_back(std::move(finding));
  return true;
}

/// `clips` of one camera.
void add_shape(const std::vector<FilmedClip>& clips, ImageEvidence& evidence) {
  ShapeFit fit = fit_marker_shape(clips);
  if (!fit.known) return;
  const core::CameraSettings& camera = clips.front().camera;
  evidence.fastest_px_s = std::max(evidence.fastest_px_s, fit.fastest_px_s);
  for (ImageCurve& curve : fit.curves) evidence.curves.push_back(std::move(curve));
  ImageFinding blur = finding_of(ids::exposure_blur);
  const double least_s = kLeastSmear_px / fit.fastest_px_s;
  const double codec_sd_s2 = codec_squared_exposure_sd(fit, clips);
  // dT = d(T²) / (T + T0), exactly so from the stated T0.
  const double codec_sd_s = codec_sd_s2 / std::max(least_s, fit.exposure_s + camera.exposure_s.value_or(0.0));
  blur.parameters = {{"exposure_s", fit.exposure_s, std::hypot(fit.exposure_sd_s, 0.1 * fit.exposure_s, codec_sd_s)}};
  if (camera.exposure_s) {
    const double stated_s = *camera.exposure_s, agreed_s = std::sqrt(agreed_squared_exposure(fit, stated_s));
    const double of_codec_s = codec_sd_s2 / std::max(least_s, agreed_s + stated_s);
    const double sd = std::sqrt(std::pow(fit.exposure_sd_s, 2) + std::pow(kToneOfShape * stated_s, 2) +
                                least_s * least_s + of_codec_s * of_codec_s);
    blur.log_evidence = log_deviation_evidence((agreed_s - stated_s) / sd, 1.0 / camera.frame_rate_hz / sd);
    blur.fact = image::Smear{fit.exposure_s, sd, stated_s};
  } else {
    blur.fact = image::Smear{fit.exposure_s, std::hypot(fit.exposure_sd_s, least_s, codec_sd_s), {}};
  }
  add_clearest(std::move(blur), evidence);

  ImageFinding shutter = finding_of(ids::rolling_shutter);
  const double stated = stated_line_s(camera);
  // Of the height of the marker's image: a hundredth of a pixel is as far as its outline can be trusted.
  const double least_line_s = 0.01 / (2.0 * fit.radius_px * fit.fastest_px_s);
  const double sd = std::hypot(fit.line_sd_s, least_line_s, 0.05 * stated);
  const double rows = clips.front().record->height_px;
  shutter.parameters = {{"line_s", fit.line_s, sd}};
  // A frame is read before the next begins. What is sheared more than that is no shutter, but a marker whose outline
  // changes otherwise, by a codec or by its light.
  const double longest_line_s = 1.0 / (camera.frame_rate_hz * rows);
  const bool possible = std::abs(fit.line_s) < longest_line_s + 2.0 * sd;
  shutter.log_evidence =
      possible ? log_either_sign_evidence((fit.line_s - stated) / sd, longest_line_s / sd) : -kSeenInImages;
  shutter.fact = image::Shear{fit.line_s, sd, stated};
  if (add_clearest(std::move(shutter), evidence)) evidence.stated_line_s = stated;
}

/// One curve `noise` for the clips of each view: variance (codes²) of resting pixels over their level (codes), with the
/// law as fitted.
void add_noise(const std::vector<FilmedClip>& clips, ImageEvidence& evidence) {
  std::map<std::size_t, std::vector<core::NoiseAtLevel>> views;
  for (const FilmedClip& clip : clips) {
    auto& levels = views[clip.view];
    levels.insert(levels.end(), clip.record->noise_levels.begin(), clip.record->noise_levels.end());
  }
  for (auto& [view, levels] : views) {
    const std::optional<NoiseLaw> law = noise_law(levels);
    if (!law) continue;
    std::sort(levels.begin(), levels.end(), [](const auto& a, const auto& b) { return a.level_code < b.level_code; });
    ImageCurve curve;
    curve.what = "noise";
    for (const core::NoiseAtLevel& one : levels) {
      curve.at.push_back(one.level_code);
      curve.value.push_back(one.sd_code * one.sd_code);
      curve.sd.push_back(2.0 * one.sd_code * one.known_to);
      curve.fitted.push_back(law->at(one.level_code));
    }
    evidence.curves.push_back(std::move(curve));
  }
}

}  // namespace

std::vector<FilmedClip> filmed_clips(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups,
                                     const std::vector<std::optional<core::CameraSettings>>& cameras) {
  std::vector<FilmedClip> clips;
  std::map<std::string, std::size_t> views;
  for (std::size_t i = 0; i < results.clips.size(); ++i) {
    const core::ClipResult& clip = results.clips[i];
    if (!clip.images || !cameras[i] || clip.sightings.empty()) continue;
    FilmedClip filmed;
    filmed.name = clip.name;
    filmed.view = views.emplace(clip.experiment + "/" + setups[i].group, views.size()).first->second;
    filmed.record = clip.images;
    filmed.camera = *cameras[i];
    double xx = 0.0, ux = 0.0, vx = 0.0, mean_u = 0.0, mean_v = 0.0, mean_x = 0.0;
    std::vector<std::array<double, 3>> places;  // u and v in the image, x on the track
    for (const core::MarkerSighting& seen : clip.sightings) {
      if (seen.frame >= clip.motion.size() || !clip.motion[seen.frame].measured_m) continue;
      places.push_back({seen.u_px, seen.v_px, *clip.motion[seen.frame].measured_m});
    }
    const auto count = static_cast<double>(std::max<std::size_t>(1, places.size()));
    for (const auto& [u, v, x] : places) {
      mean_u += u / count;
      mean_v += v / count;
      mean_x += x / count;
    }
    for (const auto& [u, v, x] : places) {
      ux += (u - mean_u) * (x - mean_x);
      vx += (v - mean_v) * (x - mean_x);
      xx += (x - mean_x) * (x - mean_x);
    }
    filmed.down = std::abs(vx) > std::abs(ux);
    if (xx > 0.0) filmed.px_per_m = std::abs((filmed.down ? vx : ux) / xx);
    clips.push_back(std::move(filmed));
  }
  return clips;
}

ImageEvidence image_evidence(std::vector<FilmedClip> clips) {
  ImageEvidence evidence;
  if (clips.empty()) return evidence;
  evidence.stated_line_s = stated_line_s(clips.front().camera);
  for (const std::vector<FilmedClip>& of_one : by_camera(clips)) add_shape(of_one, evidence);
  add_flicker(clips, evidence);
  add_sway(clips, evidence);
  add_gradient(clips, evidence);
  add_codec(clips, evidence);
  add_missing(clips, evidence);
  add_noise(clips, evidence);
  for (ImageFinding& finding : evidence.findings) {
    finding.seen = finding.log_evidence > kSeenInImages;
    finding.stage = effect_of(finding.id).stage;
  }
  evidence.clips = std::move(clips);
  return evidence;
}

}  // namespace glidelab::diagnose
