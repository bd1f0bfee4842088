#include "core/check/check_clip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include "core/check/motion_look.h"
#include "core/math/quantile.h"
#include "core/motion/smoothing/noise.h"
#include "core/pictures/marker/marker_search.h"
#include "core/pictures/scene/lamp_flicker.h"
#include "core/track/track_data.h"

namespace glidelab::core {

std::optional<SmearSlope> smear_slope(const std::vector<MarkerSighting>& sightings, const std::vector<MarkerFit>& fits,
                                      double frame_rate_hz) {
  constexpr std::size_t kFewest = 20;
  if (fits.size() != sightings.size()) return std::nullopt;
  std::vector<double> speed2, excess;  // px²/s², px²
  double step_u = 0.0, step_v = 0.0;   // of the fastest step: the glider runs along one line
  for (std::size_t i = 1; i + 1 < sightings.size(); ++i) {
    if (sightings[i + 1].frame - sightings[i - 1].frame != 2) continue;
    const double u = sightings[i + 1].u_px - sightings[i - 1].u_px, v = sightings[i + 1].v_px - sightings[i - 1].v_px;
    if (std::hypot(u, v) > std::hypot(step_u, step_v)) step_u = u, step_v = v;
  }
  const double length = std::hypot(step_u, step_v);
  if (!(length > 0.0)) return std::nullopt;
  const double c = step_u / length, s = step_v / length;
  for (std::size_t i = 1; i + 1 < sightings.size(); ++i) {
    if (sightings[i + 1].frame - sightings[i - 1].frame != 2) continue;
    const double u = sightings[i + 1].u_px - sightings[i - 1].u_px, v = sightings[i + 1].v_px - sightings[i - 1].v_px;
    const cv::Vec3d& m = fits[i].moments;
    speed2.push_back(0.25 * (u * u + v * v) * frame_rate_hz * frame_rate_hz);
    excess.push_back((c * c - s * s) * (m[0] - m[2]) + 4.0 * c * s * m[1]);
  }
  const auto n = static_cast<double>(speed2.size());
  if (speed2.size() < kFewest) return std::nullopt;
  const double mean_x = std::accumulate(speed2.begin(), speed2.end(), 0.0) / n;
  const double mean_y = std::accumulate(excess.begin(), excess.end(), 0.0) / n;
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < speed2.size(); ++i) {
    xx += (speed2[i] - mean_x) * (speed2[i] - mean_x);
    xy += (speed2[i] - mean_x) * (excess[i] - mean_y);
    yy += (excess[i] - mean_y) * (excess[i] - mean_y);
  }
  if (!(xx > 0.0)) return std::nullopt;
  const double slope = xy / xx;
  const double sd = std::sqrt(std::max(0.0, yy - slope * xy) / (n - 2.0) / xx);
  return SmearSlope{slope, sd};
}

std::optional<MarkerSmear> marker_smear(const std::optional<SmearSlope>& lengthening) {
  constexpr double kClear = 5.0;  // standard deviations
  if (!lengthening || !(lengthening->s2 > 0.0) || lengthening->s2 < kClear * lengthening->sd_s2) return std::nullopt;
  const double exposure_s = std::sqrt(12.0 * lengthening->s2);
  return MarkerSmear{exposure_s, 6.0 * lengthening->sd_s2 / exposure_s};  // dT = 12 dslope / (2 T)
}

std::optional<MarkerSmear> marker_smear(const std::vector<MarkerSighting>& sightings,
                                        const std::vector<MarkerFit>& fits, double frame_rate_hz) {
  return marker_smear(smear_slope(sightings, fits, frame_rate_hz));
}

namespace {

constexpr double kTopSpeedQuantile = 0.99;               // not the largest: single frames may be wrong
constexpr std::size_t kSpeedLag = 4;                     // sightings over which a speed is taken,
constexpr std::size_t kLongestSpeedLag = 2 * kSpeedLag;  // and frames: some may be left out
constexpr std::size_t kPathPlaces = 200;                 // of the marker's path that are kept
constexpr double kEdgeRadii = 3.0;  // of the marker: closer to the edge of the image it may have come from outside
constexpr double kLeastOverExposure = 2.0;  // times the stated exposure
constexpr double kLeastOverDiameter = 0.5;  // marker diameters: perspective may lengthen a marker by less
// A step counts as a stall if the two steps on either side lie within an eighth of a straight line and its deficit is
// six standard deviations of its noise: a clip has thousands of steps, and a codec's errors are not normal.
constexpr double kMostUneven = 0.125, kLongestStall = 0.4, kLeastOverNoise = 15.0;

struct Speeds {
  double px_s = 0.0, m_s = 0.0;
  double px_per_m = 0.0;  ///< along the path; 0 where nothing moves
};

Speeds speeds_of(const TrackData& track) {
  std::vector<double> px_s, m_s;
  double px = 0.0, m = 0.0;
  for (std::size_t i = kSpeedLag; i < track.x_m.size(); ++i) {
    const std::size_t k = i - kSpeedLag;
    const double dt_s = track.t_s[i] - track.t_s[k];
    if (track.frame[i] - track.frame[k] > kLongestSpeedLag) continue;
    const double distance_m = std::abs(track.x_m[i] - track.x_m[k]);
    m_s.push_back(distance_m / dt_s);
    if (track.sightings.empty()) continue;
    const double distance_px = std::hypot(track.sightings[i].u_px - track.sightings[k].u_px,
                                          track.sightings[i].v_px - track.sightings[k].v_px);
    px_s.push_back(distance_px / dt_s);
    px += distance_px;
    m += distance_m;
  }
  return {quantile(px_s, kTopSpeedQuantile), quantile(m_s, kTopSpeedQuantile), m > 0.0 ? px / m : 0.0};
}

/// Steps from frame to frame that are far shorter than their neighbours, of which two on either side agree.
std::size_t stalls_of(const std::vector<MarkerSighting>& sightings, double noise_px) {
  std::size_t stalls = 0;
  const auto step = [&](std::size_t i) {
    return std::hypot(sightings[i + 1].u_px - sightings[i].u_px, sightings[i + 1].v_px - sightings[i].v_px);
  };
  for (std::size_t i = 2; i + 3 < sightings.size(); ++i) {
    if (sightings[i + 3].frame - sightings[i - 2].frame != 5) continue;
    const std::array<double, 4> around = {step(i - 2), step(i - 1), step(i + 1), step(i + 2)};
    // A speed that changes evenly makes the four a straight line.
    const double middle = 0.25 * (around[0] + around[1] + around[2] + around[3]);
    const double rise = 0.1 * (2.0 * (around[3] - around[0]) + around[2] - around[1]);
    const std::array<double, 4> place = {-2.0, -1.0, 1.0, 2.0};
    double off = 0.0;
    for (std::size_t k = 0; k < 4; ++k) off = std::max(off, std::abs(around[k] - middle - rise * place[k]));
    if (middle < kLeastOverNoise * noise_px || off > kMostUneven * middle) continue;
    stalls += step(i) < kLongestStall * middle ? 1 : 0;
  }
  return stalls;
}

/// Closer to the edge of the image than a diameter and a half plus the smear: the marker may have come from outside.
bool at_edge(const MarkerSighting& sighting, const ClipCheck& clip, double smear_px) {
  const double margin_px = kEdgeRadii * sighting.radius_px + smear_px;
  return std::min({sighting.u_px, sighting.v_px, clip.width_px - 1.0 - sighting.u_px,
                   clip.height_px - 1.0 - sighting.v_px}) < margin_px;
}

/// Whether the marker came from outside the image and left it, with the smear that the clip is taken to have.
void judge_edges(ClipCheck& clip) {
  const double smear_px = clip.measured_blur_px.value_or(clip.blur_px.value_or(0.0));
  if (clip.sightings.empty()) return;
  clip.entered = at_edge(clip.sightings.front(), clip, smear_px);
  clip.left = at_edge(clip.sightings.back(), clip, smear_px);
}

/// The lengthening of the marker with speed, without the frames in which the edge of the image cuts it.
std::optional<SmearSlope> lengthening_of(const CameraSettings& camera, const ClipAttempt& attempt,
                                         const ClipCheck& clip) {
  const std::vector<MarkerSighting>& all = attempt.track.sightings;
  if (attempt.fits.size() != all.size()) return std::nullopt;
  std::vector<MarkerSighting> sightings;
  std::vector<MarkerFit> fits;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (at_edge(all[i], clip, 0.0)) continue;
    sightings.push_back(all[i]);
    fits.push_back(attempt.fits[i]);
  }
  return smear_slope(sightings, fits, camera.frame_rate_hz);
}

/// The exposure from the lengthening of the marker, if it exceeds what the stated exposure explains. Nothing is exposed
/// for longer than a frame: by more than its uncertainty, it comes from something else.
void measure_smear(const CameraSettings& camera, ClipCheck& clip) {
  const auto smear = marker_smear(clip.lengthening);
  const double frame_s = 1.0 / camera.frame_rate_hz;
  constexpr double kClearlyLonger_sd = 3.0;
  if (!smear || smear->exposure_s - kClearlyLonger_sd * smear->sd_s > frame_s) return;
  const double exposure_s = std::min(smear->exposure_s, frame_s);
  const double blur_px = clip.top_speed_px_s * exposure_s;
  const bool longer = !camera.exposure_s || exposure_s > kLeastOverExposure * *camera.exposure_s;
  if (!longer || blur_px <= kLeastOverDiameter * clip.marker_px) return;
  clip.measured_exposure_s = exposure_s;
  clip.measured_blur_px = blur_px;
}

void take_look(const ClipLook& look, ClipCheck& clip) {
  clip.width_px = look.size.width;
  clip.height_px = look.size.height;
  clip.container_rate_hz = look.file.container_rate_hz;
  clip.repeated = look.file.repeated;
  clip.irregular_steps = look.file.irregular_steps;
  clip.drift_frames = look.file.drift_frames;
  clip.saturated = look.exposure.saturated;
  clip.dark = look.exposure.dark;
  clip.bright_level = look.exposure.bright_level;
  clip.contrast = look.contrast;
  clip.marker_level = look.marker_level;
  clip.pixel_noise = look.pixel_noise;
  clip.block_steps = look.block_steps;
  clip.frames_alone = look.file.lossy.value_or(false) && !look.file.predicts.value_or(true);
}

/// Empty for fewer than some twenty outlines (a centroid has none).
std::optional<MarkerLighting> lighting_of(const std::vector<MarkerFit>& fits) {
  constexpr std::size_t kFewest = 20;
  constexpr double kTailQuantile = 0.05;
  std::vector<double> contrasts, pulls, along;
  std::vector<const MarkerFit*> outlines;
  for (const MarkerFit& fit : fits) {
    if (fit.rms > 0.0) outlines.push_back(&fit);
  }
  if (outlines.size() < kFewest) return std::nullopt;
  const cv::Point2d travel = outlines.back()->centre - outlines.front()->centre;
  const cv::Point2d direction = cv::norm(travel) > 0.0 ? travel / cv::norm(travel) : cv::Point2d(1.0, 0.0);
  for (const MarkerFit* fit : outlines) {
    contrasts.push_back(fit->amplitude);
    pulls.push_back(cv::norm(fit->light_px));
    along.push_back(fit->light_px.dot(direction));
  }
  MarkerLighting light;
  light.least_contrast = quantile(contrasts, kTailQuantile) / quantile(contrasts, 1.0 - kTailQuantile);
  light.pull_px = median_of(pulls);
  light.pull_change_px = 0.5 * (quantile(along, 1.0 - kTailQuantile) - quantile(along, kTailQuantile));
  return light;
}

/// The brightness that tells the light: a fit's own level of a bright marker; the background of a dark one, for glare
/// and the black level act on its own, and of one that was looked at again; the contrast of a pattern, which has no
/// outline. A change of the whole scene is taken out.
PathBrightness brightness_of(const MarkerSetup& marker, const ClipAttempt& attempt) {
  constexpr double kSaturated = 0.96;  // of the largest code
  const TrackData& track = attempt.track;
  const SignalKind kind = signal_kind(marker);
  PathBrightness brightness;
  if (kind == SignalKind::colored || !track.images || attempt.fits.size() != track.x_m.size()) return brightness;
  const double full = track.images->full_code;
  // A second look tells the size of a contrast, not its sign, and the background at rest.
  const bool again = std::ranges::any_of(
      track.notes, [](const Note& note) { return std::holds_alternative<MarkerFittedAgain>(note); });
  brightness.of_marker = kind == SignalKind::bright && !again;
  double x = 0.0, u = 0.0, v = 0.0, xx = 0.0, xu = 0.0, xv = 0.0;
  const auto n = static_cast<double>(track.x_m.size());
  for (std::size_t i = 0; i < track.x_m.size(); ++i) {
    const MarkerFit& fit = attempt.fits[i];
    x += track.x_m[i] / n;
    u += track.sightings[i].u_px / n;
    v += track.sightings[i].v_px / n;
    const bool is_pattern = !(fit.rms > 0.0);
    if (is_pattern) brightness.of_marker = true;
    const double level = is_pattern                 ? fit.amplitude
                         : again                    ? fit.background
                         : kind == SignalKind::dark ? full - fit.background
                                                    : fit.background + fit.amplitude;
    const bool at_rest = again && !is_pattern;
    const double scene = at_rest ? 1.0 : scene_brightness(*track.images, track.frame[i], track.sightings[i].v_px);
    if (level > 0.0 && level < kSaturated * full && scene > 0.0) {
      brightness.points.push_back({track.frame[i], track.x_m[i], level / scene});
    }
  }
  for (std::size_t i = 0; i < track.x_m.size(); ++i) {
    const double off = track.x_m[i] - x;
    xx += off * off;
    xu += off * (track.sightings[i].u_px - u);
    xv += off * (track.sightings[i].v_px - v);
  }
  if (xx > 0.0) {
    brightness.u_px_per_m = xu / xx;
    brightness.v_px_per_m = xv / xx;
  }
  return brightness;
}

void check_images(const Experiment& experiment, const ClipAttempt& attempt, const ClipWatch& watch, double px_per_m,
                  ClipCheck& clip) {
  const TrackData& track = attempt.track;
  MarkerSetup marker = *experiment.marker;
  if (track.dark_marker) marker.color_bgr = {0, 0, 0};
  take_look(watch.look(marker, track.sightings, attempt.fits), clip);
  std::vector<double> radii, sds;
  for (const MarkerSighting& sighting : track.sightings) {
    radii.push_back(sighting.radius_px);
    sds.push_back(sighting.sd_px);
  }
  clip.marker_px = 2.0 * median_of(radii);
  if (clip.contrast) clip.light = lighting_of(attempt.fits);
  clip.brightness = brightness_of(marker, attempt);
  clip.record = track.images;
  if (track.images) clip.combs = track.images->combs;
  clip.centre_sd_px = median_of(sds);
  clip.marker_expected_px = experiment.marker->diameter_m * px_per_m;
  const CameraSettings& camera = *experiment.camera;
  if (camera.exposure_s) clip.blur_px = clip.top_speed_px_s * *camera.exposure_s;
  clip.lengthening = lengthening_of(camera, attempt, clip);
  measure_smear(camera, clip);
  clip.sightings = track.sightings;
  judge_edges(clip);
  clip.longest_blur_px = clip.top_speed_px_s / camera.frame_rate_hz;
  if (!clip.repeats) {
    clip.stalls =
        stalls_of(track.sightings, std::max(clip.centre_sd_px, clip.position_noise_m.value_or(0.0) * px_per_m));
  }
  const std::size_t every = track.sightings.size() / kPathPlaces + 1;
  for (std::size_t i = 0; i < track.sightings.size(); i += every) {
    clip.path.push_back({track.sightings[i].u_px, track.sightings[i].v_px});
  }
}

}  // namespace

namespace {

/// Of what is stated to be free.
MotionLook look_between(const ClipSetup& setup, const TrackData& track) {
  const auto& t = track.t_s;
  const auto from = setup.start_s ? std::lower_bound(t.begin(), t.end(), *setup.start_s) - t.begin() : 0;
  const auto to = setup.end_s ? std::upper_bound(t.begin(), t.end(), *setup.end_s) - t.begin() : std::ssize(t);
  const auto first = static_cast<std::size_t>(from),
             many = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, to - from));
  std::span<const MarkerSighting> sightings;
  if (track.sightings.size() == t.size()) sightings = std::span(track.sightings).subspan(first, many);
  return look_at_motion(std::span(t).subspan(first, many), std::span(track.x_m).subspan(first, many), sightings,
                        !track.force_n.empty());
}

}  // namespace

ClipCheck check_clip(const Experiment& experiment, const ClipSetup& setup, const ClipAttempt& attempt,
                     const ClipWatches& watches) {
  const TrackData& track = attempt.track;
  ClipCheck clip;
  clip.name = setup.name;
  clip.images = !setup.file.empty();
  clip.failure = attempt.failure;
  if (!clip.failure.empty()) return clip;
  clip.notes = track.notes;
  for (const Note& note : track.notes) {
    if (const auto* const repeats = std::get_if<RepeatsLeftOut>(&note)) clip.repeats = *repeats;
  }
  if (clip.repeats) clip.stalls = clip.repeats->repeats;
  clip.frames = track.frame_t_s.size();
  clip.seen = track.x_m.size();
  if (!track.frame.empty()) {
    clip.first = track.frame.front();
    clip.spanned = track.frame.back() - clip.first + 1;
  }
  clip.frame_rate_hz = track.frame_rate_hz;
  if (track.x_m.size() >= kFewestTrackPoints) clip.position_noise_m = pilot_noise(track.t_s, track.x_m);
  if (!track.x_m.empty()) {
    const auto [least, most] = std::minmax_element(track.x_m.begin(), track.x_m.end());
    clip.distance_m = *most - *least;
  }
  clip.motion = look_between(setup, track);
  const Speeds speeds = speeds_of(track);
  clip.top_speed_m_s = speeds.m_s;
  clip.top_speed_px_s = speeds.px_s;
  if (clip.images && !track.sightings.empty()) {
    check_images(experiment, attempt, watches.of(setup.file), speeds.px_per_m, clip);
  }
  return clip;
}

void drop_contradicted_exposures(std::vector<ClipCheck>& clips) {
  constexpr double kHalfExposure = 0.25;  // of the slope; the disc of the moments cuts no more off a long smear
  constexpr double kSure = 3.0;           // standard deviations
  for (ClipCheck& clip : clips) {
    if (!clip.measured_exposure_s) continue;
    const SmearSlope own = *clip.lengthening;
    const bool contradicted = std::any_of(clips.begin(), clips.end(), [&](const ClipCheck& other) {
      if (!other.lengthening) return false;
      const double sd_s2 = std::hypot(other.lengthening->sd_s2, kHalfExposure * own.sd_s2);
      return other.lengthening->s2 + kSure * sd_s2 < kHalfExposure * own.s2;
    });
    if (!contradicted) continue;
    clip.measured_exposure_s.reset();
    clip.measured_blur_px.reset();
    judge_edges(clip);
  }
}

}  // namespace glidelab::core
