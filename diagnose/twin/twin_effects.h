/// The named effects of the camera and its clock as sections of a scenario, and what no key can express.
///
/// What each effect makes of the camera stands in its own file (effects/effect_twin.h): exactly what [clock], [camera]
/// exposure, [shutter] and [light] say; of the same kind a codec of unknown strength, a pan with one phase for all
/// clips, a focal length or a direction that was changed after the calibration.
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
