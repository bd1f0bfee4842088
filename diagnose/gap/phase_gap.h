/// The gap in the phase plane: how much more the measured motion accelerates than the modelled one at the same speed,
///
///     d(v) = mean over the points of a bin of speeds of   a[x] - a[x^] + (K/m) (v[x] - v[x^]),
///
/// m/s². v[] and a[] are core's local cubic of measured positions x and of modelled ones x^ at the same times, with the
/// bandwidth that the analysis took, so that its own bias cancels; the last term takes the modelled acceleration from
/// the modelled speed to the measured one (the nominal model's a falls by K/m with v). A force f that the model lacks
/// makes d = f/m. v on the axis is v[x].
///
/// The modelled motion is that of the clip held out: its common parameters come from the other clips, as in held_out.h.
/// d is linear in the noise of all positions, and its variance is that of exactly this sum: what neighbouring a share
/// by the kernel and the noise's own correlation, the fitted start, and the parameters' errors are in it.
///
/// Points within two bandwidths of a motion's ends are left out. There are twelve bins over the range of all speeds,
/// one edge at v = 0; a bin of fewer than five points is left out.
#pragma once

#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// `before` and `after` are fits of the same set, of two clips or more. All masses together, then, where there are
/// several, each. Empty where no clip has a bandwidth.
std::vector<PhaseGap> phase_gaps(const TrackSet& set, const MotionFit& before, const MotionFit& after);

}  // namespace glidelab::diagnose
