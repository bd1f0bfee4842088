/// Plots of deviations of a camera's images from its model: the calibration's residuals over the image, pixel noise as
/// a function of brightness, and pixel locking.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/result/results.h"
#include "diagnose/result/diagnosis.h"
#include "report/html/plot.h"
#include "validate/truth/comparison.h"

namespace glidelab::report {

/// Mean residuals of the pattern's corners in cells of the image, as arrows; empty if there are none. `experiment` is
/// named if there are several.
std::vector<Plot> calibration_plots(const core::CornerMap& rests, const std::string& experiment);

/// A curve `noise` (diagnosis.h).
Plot noise_plot(const diagnose::ImageCurve& curve);

/// RMS of a curve's deviations from the fit, over their standard deviations.
double curve_excess(const diagnose::ImageCurve& curve);

/// One marker's centre, along the image's axis in which the marker moves most: its phase (distance from the pixel's
/// middle) and its error in pixels, that is the measured position minus the smoothed one (or, in a rehearsal, minus the
/// true one) times the pixels per metre of its clip.
struct PixelPhase {
  double phase_px = 0.0;  ///< from the middle of its pixel, -0.5 to 0.5
  double error_px = 0.0;
};

/// For the points used by the fits; empty for tracks.
std::vector<PixelPhase> phase_points(const core::AnalysisResults& results);
/// For every centre, from the truth.
std::vector<PixelPhase> phase_points(const core::AnalysisResults& results,
                                     const validate::RestitutionComparison& restitution);

/// Does the error of a centre depend on its position within the pixel? A centre biased towards whole pixels shows a
/// wave (pixel locking); its first harmonic is fitted, error = m + A cos(2 pi phase) + B sin(2 pi phase).
struct PixelLocking {
  double amplitude_px = 0.0;  ///< of the first harmonic
  double sd_px = 0.0;         ///< of A and of B, with errors taken as independent
};

/// Empty for fewer than 20 points, and if they leave a quarter of the pixel empty.
std::optional<PixelLocking> pixel_locking(const std::vector<PixelPhase>& points);

/// The points, their means over twentieths of a pixel, and the harmonic. Empty if pixel_locking() is empty.
std::vector<Plot> pixel_phase_plot(const std::vector<PixelPhase>& points, bool from_truth);

}  // namespace glidelab::report
