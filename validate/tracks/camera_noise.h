/// How well a camera can locate the marker, before anything is rendered: the bound of the marker's centre
/// (core/pictures/marker/marker_bound.h) for the scenario's light, sensor, distance and speed, as metres in the plane
/// of motion.
///
///     variance of a pixel = shot + dark + read^2 + quantisation^2 + (PRNU signal)^2 + DSNU^2,
///
/// the mean of that on the marker and on the wall.
///
/// The marker moves by L = v exposure in a frame, which blurs its edge like a normal one of variance L^2 / 12. Not in
/// it: lens blur, tone curves, a mosaic, codecs, the calibration; rendered runs have them.
#pragma once

#include <vector>

#include "render/scenario/scenario.h"
#include "validate/truth/truth_folder.h"

namespace glidelab::validate {

/// What of a camera can be thought away, one at a time.
struct WithoutLimit {
  bool shot_noise = false;
  bool camera_noise = false;  ///< read noise, dark signal, quantisation, fixed patterns
  bool motion_blur = false;
  double finer = 1.0;  ///< pixels a metre, times this; each with the light of the old ones
};

/// Standard deviation of a position for each clip of the truth; infinite where the marker is no brighter than the wall
/// or smaller than two pixels.
std::vector<double> predicted_noise_m(const render::Scenario& scenario, const Truth& truth,
                                      const WithoutLimit& without = {});

}  // namespace glidelab::validate
