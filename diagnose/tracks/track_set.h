/// The motions that a diagnosis fits (tracked_motions.h), from the results of an analysis, with their noise and the
/// errors of square pixels.
///
/// The fit of a blurred edge to pixels has an error that depends on where the centre lies between two pixels: a few
/// thousandths of a pixel, the same wherever that sub-pixel position is the same. All clips of an experiment share
/// these errors:
///
///     x error = (a sin 2 pi s + b cos 2 pi s + c sin 4 pi s + d cos 4 pi s) / (pixels a metre),
///
/// with s the centre's coordinate (column or row) along which it moves more. a to d are unknown. Each is N(0, (0.01
/// px)²): the accuracy reported for good trackers, and ten times the error that this one showed on sharp images. Over
/// many pixels this cannot imitate a force. Without it, such errors are taken for waves as soon as the noise is small.
#pragma once

#include <vector>

#include "core/experiment/experiment.h"
#include "core/result/results.h"
#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {

inline constexpr std::size_t kPixelModes = 4;

/// Adds the marker's rows and the errors by sub-pixel position to the filmed motion of a clip; `frames` are those of
/// its points. These shared errors begin at `first_mode` of the motion's. A tracked clip is left unchanged, and so is
/// one in which the marker moves by less than a pixel.
void add_pixel_modes(const core::ClipResult& clip, const std::vector<std::size_t>& frames, std::size_t first_mode,
                     TrackedMotion& motion);

/// Positions without such errors, as far as neighbouring positions show them; the noise is measured from these. The
/// errors differ between neighbours as noise does: most if the marker moves by half a pixel a frame, not at all if it
/// moves by a whole one. Least squares over these differences, weighted by sd_m, with the prior of the amplitudes.
std::vector<std::vector<double>> without_pixel_errors(const std::vector<TrackedMotion>& motions);

/// `setups` are the clips of all folders, in the results' order. With `all`, the parts that the analysis took for a
/// hand at the start or for a stop stay in the motion; otherwise they are left out. Motions with fewer than 6 points
/// are left out, and so are pieces with fewer than 12 of a clip that has a longer one. If there are more than 30,000
/// positions in all, every second, third, ... is taken (thin_out()).
TrackSet track_set(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups, bool all);

/// The noise of each motion from its neighbouring positions (`late_s`, unless empty, is the delay of each relative to
/// its time), and one level for all if the motions' levels differ by no more than their own errors; otherwise half way
/// between. At least 1e-7 of the longest distance covered, which no camera or sensor undercuts.
void measure_noise(std::vector<TrackedMotion>& motions, const std::vector<std::vector<double>>& late_s = {});

/// Noise of one position, from the distance of each from the cubic through its four nearest neighbours, without
/// outliers; never below the noise that rounding to a step causes.
double neighbour_noise(const std::vector<double>& t_s, const std::vector<double>& x_m,
                       const std::vector<char>& outlier);

}  // namespace glidelab::diagnose
