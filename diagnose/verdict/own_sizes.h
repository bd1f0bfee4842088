/// The sizes that are stated for an effect whose parameters have a meaning only together: deviations of each
/// configuration or clip from a common mu or K, a friction along the track, a drag for each direction.
///
///     direction_dependent_drag   k_plus_n_s_m, k_minus_n_s_m: K (1 + d) and K (1 - d), towards larger x and back
///     place_friction             sd: root mean square of s over the range of positions; s.at X m: s there
///     configuration_friction     sd: standard deviation of mu over the configurations; mu.NAME: mu of each
///     configuration_drag         sd_n_s_m: of K; k_n_s_m.NAME: K of each
///     clip_scatter               sd_mu, sd_k_n_s_m: standard deviations of mu and K over the clips
///
/// In a fall in which the drag of air takes the place of K (fit/drag_of_air.h), sd_c_kg_m and c_kg_m.NAME stand in
/// place of those of K.
///
/// Each comes with its standard deviation by the fit's covariance, to first order. For a spread this holds only if the
/// spread is larger than the errors of the sizes themselves.
#pragma once

#include <string>
#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// The name of a group, with its inclination if another set-up has the same name.
std::string own_name(const TrackSet& set, std::size_t group);

/// The sizes of an effect in a fit that contains it. Empty for an effect whose parameters have a meaning by themselves.
std::vector<DiagnosedParameter> own_sizes(const TrackSet& set, const MotionFit& fit, std::size_t effect);

}  // namespace glidelab::diagnose
