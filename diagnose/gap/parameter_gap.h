/// The gap in the parameters: K between masses, mu between masses and directions.
///
/// The nominal model (K, mu, inclinations, masses; effects held) is fitted to the motions of one mass alone, and to
/// those stretches of them that go one way; q is what it gives for K or mu. Against the fit to all,
///
///     z = (q_alone - q_all) / sd,    sd² = var q_alone - var q_all,
///
/// as all is efficient and what is alone is a part of it. With a named effect in the model, whose size s is that of the
/// fit to all,
///
///     sd² = a' N a - 2 a' N C b + b' C b,    a = N_θθ^-1 e,    b = e + N_sθ a,
///
/// with θ what is fitted alone, N the normal equations of the part, C the inverse of those of all, e the quantity's
/// unit vector; without effects it is the same as above. `after` is one least squares' step from the fit to all.
///
/// Both sd are those of the linear neighbourhood of the fit to all. Motions with a recorded force are not cut into
/// directions.
#pragma once

#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// Quantities `k_n_s_m` (N s/m) and `mu`, against "all clips", the part ("0.335 kg", "0.335 kg, downhill") as group.
/// `after` is the fit with the named effect, the nominal one where nothing is named, or null where what is missing has
/// no name (then nothing is said of after). A part that does not determine the quantity has no z.
std::vector<GapOfParameter> parameter_gaps(const TrackSet& set, const MotionFit& nominal, const MotionFit* after);

}  // namespace glidelab::diagnose
