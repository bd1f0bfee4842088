/// The errors that square pixels cause in the positions of a marker, shared by all clips of an experiment.
///
/// The fit of a blurred edge to pixels errs with the place of the centre between two pixels, a few thousandths of a
/// pixel, the same wherever that place is the same:
///
///     x error = (a sin 2 pi s + b cos 2 pi s + c sin 4 pi s + d cos 4 pi s) / (pixels a metre),
///
/// s the centre's coordinate (column or row) along which it moves more. a to d are not known: each N(0, (0.01 px)²),
/// which is what good trackers are reported to reach, and ten times what this one was seen to do on sharp images.
/// Over many pixels this cannot imitate a force; left out, it is taken for waves as soon as the noise is small.
#pragma once

#include "core/result/results.h"
#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {

inline constexpr std::size_t kPixelModes = 4;

/// Rows of the marker and errors by the place between pixels, for the filmed motion of a clip;
/// `frames` are those of its points. Shared errors begin at `first_mode` of the motion's. A tracked clip is left as it
/// is, and so is one in which the marker does not move over a pixel.
void add_pixel_modes(const core::ClipResult& clip, const std::vector<std::size_t>& frames, std::size_t first_mode,
                     TrackedMotion& motion);

/// Positions without such errors, as far as neighbouring positions show them, for the measure of their noise. They
/// differ between neighbours as noise does: most where the marker moves by half a pixel a frame, not at all by a whole
/// one. Least squares over those differences, sd_m being the weights, with what is known of the amplitudes beforehand.
std::vector<std::vector<double>> without_pixel_errors(const std::vector<TrackedMotion>& motions);

}  // namespace glidelab::diagnose
