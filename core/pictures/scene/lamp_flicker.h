/// Lamps that flicker, seen in the fixed scene of a clip, and how far that displaces a marker.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/math/strongest_wave.h"
#include "core/result/image_record.h"

namespace glidelab::core {

/// Brightness of the scene over that of the first frames, minus 1, as a function of time: one series, or one for each
/// band of rows of a rolling shutter, which exposes them at different times.
std::vector<Series> brightness_series(const ImageRecord& record, const CameraSettings& camera);

/// Brightness of the scene over that of the first frames, in the row of the image; 1 where it is not known.
double scene_brightness(const ImageRecord& record, std::size_t frame, double v_px);

/// Mains light flickers at 100 or 120 Hz, of which the frames see an alias; otherwise the frequency is the one seen.
double flicker_of_mains(const SeriesWave& wave, double frame_rate_hz);

/// The part of a wave's amplitude that is left after averaging over the exposure, sin(x) / x with x = pi f T.
double passed_by_exposure(double f_hz, double exposure_s);

/// 1 + depth cos(2 pi f_hz t), of the light; the frames see it at seen_hz.
struct LightFlicker {
  double depth = 0.0, f_hz = 0.0, seen_hz = 0.0;
};

/// How far the image of a marker may be displaced, at most:
///
/// - The light's centre of time within an exposure T moves to either side of its middle by
///   depth |2 sin(w T/2) / w² - T cos(w T/2) / w| / T, w = 2 pi f, and a marker at v px/s with it.
/// - With a rolling shutter the light changes by depth w `line` from row to row, and the centroid of a disc of radius
///   r by r²/4 times that.
double flicker_displacement_px(const LightFlicker& flicker, const CameraSettings& camera, double speed_px_s,
                               double radius_px);

/// The flicker that the scenes of clips of one camera have in common. Empty where the frames show none beyond doubt:
/// its log evidence is below 3, or it is smaller than what a codec's key frames change (1 % of the light; lossless:
/// 0.2 %).
std::optional<LightFlicker> find_flicker(const std::vector<std::shared_ptr<const ImageRecord>>& records,
                                         const CameraSettings& camera);

}  // namespace glidelab::core
