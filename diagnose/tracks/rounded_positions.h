/// The noise of positions that are whole multiples of a step, as in a motion sensor's export.
///
/// The error of rounding to a step q is e = x - q round(x/q): a saw-tooth of the true position with a standard
/// deviation of q/sqrt(12). From frame to frame the position within the tooth advances by d = v dt/q less the nearest
/// whole number. With u the shift between two frames along it, the correlation of their errors is 1 - 6 u + 6 u², which
/// changes its sign at u = 0.21. So if the motion passes many steps per frame, and not a whole number of them, the
/// errors are practically independent. If it is slow, or passes a whole number of steps per frame, n successive frames
/// have the same error: they count as one measurement, each with sqrt(n) times the standard deviation. (In steady
/// motion the errors average out even faster; at a turn or at rest they do not.) Noise of the sensor itself, added
/// before the rounding, removes this correlation: if its standard deviation is s, the correlation falls by exp(-(2 pi
/// s/q)²).
///
/// Where the step grows with the size of the number (core/motion/smoothing/noise.h, written_steps()), the motion counts
/// as rounded to the coarsest step that a tenth of the positions have. If fewer have a coarse one, each position has
/// the noise of its own step, and the noise besides rounding is the likeliest for all residuals from the neighbours.
///
/// B. Widrow, I. Kollar, Quantization Noise (2008), 5 and 20.
#pragma once

#include <vector>

#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {

/// How many frames around each have the same error, itself included, for positions that are whole multiples of
/// `step_m`, in order of time.
std::vector<double> frames_alike(const std::vector<double>& t_s, const std::vector<double>& x_m, double step_m);

/// Raises sd_m to the noise that rounding causes, and sets `wider` and, if steps differ, `coarser`; a motion without a
/// step is left unchanged.
void add_rounding(TrackedMotion& motion);

/// Whether rounding causes most of the noise of some motion: then neighbouring positions show no other noise.
bool noise_is_rounding(const TrackSet& set);

}  // namespace glidelab::diagnose
