/// The exposure time, from the lengthening of the marker's image with its speed.
#pragma once

#include <optional>
#include <vector>

#include "core/pictures/marker/marker.h"
#include "core/result/results.h"

namespace glidelab::core {

struct MarkerSmear {
  double exposure_s = 0.0, sd_s = 0.0;
};

/// A disc that moves by L = T v while the shutter is open has second moments that are L²/12 larger along its path
/// than across it: T² / 12 is the slope of their difference over v² (px/s). sd_s follows from the scatter about the
/// straight line. `fits` are those of the sightings, one each. Nothing with fewer than 20 sightings whose neighbours
/// were seen too, or if the slope is not above zero by five standard deviations. Moments are taken in a disc a little
/// larger than the marker, so that a smear as long as the marker comes out too short.
std::optional<MarkerSmear> marker_smear(const std::vector<MarkerSighting>& sightings,
                                        const std::vector<MarkerFit>& fits, double frame_rate_hz);

}  // namespace glidelab::core
