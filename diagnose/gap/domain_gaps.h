/// The gap in two of its domains, the phase plane and the parameters.
#pragma once

#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// The gap in the phase plane: how much more the measured motion accelerates than the modelled one at the same speed,
///
///     d(v) = mean over the points of a bin of speeds of   a[x] - a[x^] + (K/m) (v[x] - v[x^]),
///
/// in m/s². Here v[] and a[] are core's local cubic of measured positions x and of modelled ones x^ at the same times,
/// with the bandwidth of the analysis, so that its own bias cancels. The last term carries the modelled acceleration
/// from the modelled speed to the measured one (the nominal model's a falls by K/m with v). A force f that the model
/// lacks makes d = f/m. The v on the axis is v[x].
///
/// The modelled motion is that of the clip held out: its common parameters come from the other clips, as in held_out.h.
/// d is linear in the noise of all positions, and its variance is that of exactly this sum. It includes what
/// neighbouring values of a share through the kernel and the noise's own correlation, the fitted start, and the errors
/// of the parameters.
///
/// Points within two bandwidths of a motion's ends are left out. There are twelve bins over the range of all speeds,
/// with one edge at v = 0. A bin of fewer than five points is left out.
///
/// `before` and `after` are fits of the same set, of two clips or more. The result has all masses together and then, if
/// there are several, each mass. It is empty if no clip has a bandwidth.
std::vector<PhaseGap> phase_gaps(const TrackSet& set, const MotionFit& before, const MotionFit& after);

/// The gap in the parameters: K between masses, mu between masses and directions.
///
/// The nominal model (K, mu, inclinations, masses; effects held) is fitted to the motions of one mass alone, and to
/// those stretches of them that go in one direction; q is the K or mu that it gives. Against the fit to all,
///
///     z = (q_alone - q_all) / sd,    sd² = var q_alone - var q_all,
///
/// because the fit to all is efficient and the part's data are among its data. With a named effect in the model, whose
/// size s is that of the fit to all,
///
///     sd² = a' N a - 2 a' N C b + b' C b,    a = N_θθ^-1 e,    b = e + N_sθ a,
///
/// with θ what is fitted alone, N the normal equations of the part, C the inverse of those of all, and e the quantity's
/// unit vector. Without effects it is the same as above. Both sd are those of the linear neighbourhood of the fit to
/// all.
///
/// Quantities are `k_n_s_m` (N s/m) and `mu`, against "all clips", with the part ("0.335 kg", "0.335 kg, downhill") as
/// group. `after` is the fit with the named effect, the nominal fit if no effect is named, or null if what is missing
/// has no name (then there are no values after). The value of a part is one least-squares step from the fit to all. A
/// part that does not determine the quantity has no z. Motions with a recorded force are not cut into directions.
std::vector<GapOfParameter> parameter_gaps(const TrackSet& set, const MotionFit& nominal, const MotionFit* after);

}  // namespace glidelab::diagnose
