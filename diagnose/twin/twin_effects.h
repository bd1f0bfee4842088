/// What the named effects of the camera and its clock are in a scenario: sections of keys, and what no key can say.
///
/// Exactly: frame_rate_error, dropped_frames, timestamp_jitter ([clock]), exposure_blur ([camera]), rolling_shutter
/// ([shutter]), light_flicker, light_gradient ([light]). Of the same kind: compression ([codec]; how strong is not
/// known), camera_motion (a camera that pans; one phase for all clips), scale_error (a focal length that was changed
/// after the calibration by the factor 1 + e), perspective_error (a camera that was turned by
/// atan(downhill p' Z), p' = p/(1 + p x_f), x_f the place before which the camera stands, Z how far off).
#pragma once

#include <string>
#include <vector>

#include "diagnose/pictures/twin_camera.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

struct TwinEffects {
  double exposure_s = 0.0;
  double readout_s = 0.0;          ///< from the first row to the last
  std::string sections;            ///< each begins with an empty line
  std::vector<std::string> notes;  ///< what of the sizes is assumed
  std::vector<TwinLack> lacks;
};

/// `reference_m`: x in the data of the world's origin.
TwinEffects effects_of_camera(const std::vector<DiagnosedEffect>& effects, const std::optional<Filming>& filming,
                              const TwinView& view, double frame_rate_hz, double reference_m);

}  // namespace glidelab::diagnose
