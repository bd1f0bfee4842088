/// The terminal velocity of a body that is seen at it from the first position on, where no line a(v) has a slope.
#pragma once

#include <vector>

#include "core/result/results.h"

namespace glidelab::core {

/// Gives configurations of falls their terminal velocity from the mean speed, where the lines or the fit of the whole
/// motion gave none, and notes that (SteadyFall), in place of notes that it added before.
///
/// A parabola through the free positions of each clip has the speed v and the acceleration a at their middle. It needs
/// no kernel: positions count whose kernel reaches over an end or a gap. The fall is steady if a + 2 sd < 0.1 g and
/// a - 2 sd > -0.1 g in every clip, and if no a of more than two of its standard deviations changes v by more than a
/// tenth from the first position to the last. At such a speed, a drag in proportion to v or to v² leaves
///
///     v_lim = v (1 + a/g)    or    v_lim = v (1 + a/(2 g)),
///
/// and half of the difference is an uncertainty that all clips share, as they do the scale and the clock. A change of v
/// that lasts for more than 4 v/g is no approach to v_lim: half of it is a standard deviation of the clip. Clips count
/// by their inverse variances; where they differ by more than these allow, the standard deviation is larger by the root
/// of chi²/(n - 1). A body that a liquid bears nearly whole speeds up as little at any speed: `g` is taken as what
/// drives it. Units are SI.
void add_steady_falls(const std::vector<ClipResult>& clips, double gravity_m_s2,
                      std::vector<ConfigurationResult>& configurations);

}  // namespace glidelab::core
