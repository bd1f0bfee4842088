/// The measurements of one clip, from its track and its images: speeds, size and smear of the marker, the exposure time
/// from that smear, light, steps that are too short.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/check/check_result.h"
#include "core/experiment/experiment.h"
#include "core/pictures/marker/marker_fit.h"
#include "core/pictures/scene/clip_look.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// The exposure time, from the lengthening of the marker's image with its speed.
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

/// The slope alone, whatever its sign. Nothing with fewer than 20 such sightings.
std::optional<SmearSlope> smear_slope(const std::vector<MarkerSighting>& sightings, const std::vector<MarkerFit>& fits,
                                      double frame_rate_hz);

/// One track with the fits behind it, or why there is none.
struct ClipAttempt {
  TrackData track;
  std::vector<MarkerFit> fits;
  std::string failure;
};

/// `watches` have seen the clip's images if it has any and they could be tracked.
ClipCheck check_clip(const Experiment& experiment, const ClipSetup& setup, const ClipAttempt& attempt,
                     const ClipWatches& watches);

/// The clips of one camera have one exposure: takes back a measured one that is more than twice what another clip
/// shows, by three standard deviations.
void drop_contradicted_exposures(std::vector<ClipCheck>& clips);

}  // namespace glidelab::core
