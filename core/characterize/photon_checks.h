/// Tests the assumptions of photon transfer on the images: codes proportional to the light, noise independent from
/// pixel to pixel and frame to frame. A violation is reported instead of a gain that would be wrong, or as a note.
#pragma once

#include <optional>
#include <vector>

#include "core/characterize/camera_evidence.h"
#include "core/characterize/camera_measurement.h"
#include "core/characterize/flat_field_folder.h"
#include "core/characterize/photon_numbers.h"

namespace glidelab::core {

/// The linearity of a camera: mean above dark against exposure, under constant light.
///
///     mean_i = a0 + a1 exposure_i  by least squares with weights 1 / mean_i²,   error = mean of |mean_i / line_i - 1|
///
/// over the levels from 5 % to 95 % of saturation (EMVA standard 1288, release 3.1: the regression of relative
/// deviations).
///
/// If fewer than three levels have different exposures, the result is the reason instead of a value. The standard
/// deviation includes the scatter of the frames' means within each level, but not a drift of the light from level to
/// level.
Measured linearity_error(const Evidence& evidence, const FlatFieldFolder& folder, double saturation_dn);

/// How well the levels lie on the line.
struct LineQuality {
  std::vector<TransferPoint> curve;  ///< by rising mean
  int points = 0;                    ///< in the fit, including the dark frames
  double misfit = 1.0;               ///< factor on standard deviations; above 1 if chi² is significantly above 1
  double bend = 0.0;                 ///< largest significant departure of a level from the line, relative
  double most_dn = 0.0;              ///< the brightest level in the fit
  std::optional<double> knee;        ///< variance over the line between 75 and 90 % of saturation, if it is below half
};
LineQuality line_quality(const CameraEvidence& gathered, const FlatFieldFolder& folder, const PhotonNumbers& numbers);

/// The line, with the standard deviations of its parameters.
struct FittedLine {
  double gain = 0.0;
  double gain_sd = 0.0;
  double intercept_dn2 = 0.0;
  double intercept_sd_dn2 = 0.0;
};

/// Why the variance over the mean does not give the gain; empty if it does.
std::optional<WhyUnmeasured> why_no_gain(const CameraEvidence& gathered, const LineQuality& quality,
                                         const FittedLine& line, const Measured& linearity);

/// What a reader should know about how the images were taken.
std::vector<CameraNote> condition_notes(const CameraEvidence& gathered, const LineQuality& quality,
                                        const Measured& linearity, bool gain_known);

}  // namespace glidelab::core
