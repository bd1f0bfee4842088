/// The motion of one clip whose speeds were measured and not its positions (an encoder, a tachometer, a radar): its
/// free stretches, the smoothed v and a, and the lines a = a0 - (K/m) v.
///
/// Speeds are not integrated. A sum of speeds with independent errors has errors that walk, and lines fitted to it as
/// if they were independent would have intervals that are too narrow. Instead the local cubic smooths v(t) itself,
///
///     v(t_i) = c_0 + c_1 u + c_2 u² + c_3 u³,   u = t_i - t,   v = c_0,   a = c_1,
///
/// so that v and a are linear in the measured speeds, and line_fit.h gives the covariance of the line from the noise of
/// the speeds, which is estimated from the residuals. For uniform times of step dt and white noise of standard
/// deviation s, far from an end,
///
///     var v = 0.4760 s² dt / h      var a = 0.4849 s² dt / h³      bias a = -h⁴ v'''''/8
///
/// The bandwidth, where none is stated, is that of the least mean square error of the lines, noise and bias together,
/// summed over the directions; for each, the error of a0 - (K/m) v is averaged from v = 0 to the line's highest speed.
/// Bandwidths are tried in ratios of 1.1, from 1.2 steps to a fifth of the longest stretch.
///
/// Free motion. The pilot has the smallest bandwidth at which the noise of a is a tenth of the median |a| of the moving
/// body, or 5 % of the clip if there is none below. Directions are the signs of v; within three standard deviations of
/// one speed about 0, and a pilot bandwidth beside, nothing counts. Of each direction the points count that agree with
/// the line of most points (free_motion.h); next to others two pilot bandwidths are left out. Stated start_s and end_s
/// are trusted: nothing after start_s is a hand, nothing before end_s a stop. The noise is taken to be the same at all
/// speeds. A scale error of the sensor is not known, and K/m does not depend on it.
#pragma once

#include "core/experiment/clip_setup.h"
#include "core/motion/analyze_motion.h"
#include "core/result/results.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// For a track with TrackData::v_m_s. The result's speed_noise_m_s is set; it has no x, and no blocks for a fit of the
/// whole motion. InputError for options that need positions: another smoother than the local polynomial, a bandwidth
/// rule, generalised lines; and for a bandwidth longer than the clip.
ClipResult analyze_speeds(const ClipSetup& setup, const TrackData& track, const MotionOptions& options);

}  // namespace glidelab::core
