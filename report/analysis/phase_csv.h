/// `phase-<clip>.csv`: the smoothed motion of one clip, one row for each frame that has smoothed values.
///
///     t_s,x_m,v_m_s,a_m_s2,used,sd_v_m_s,sd_a_m_s2,measured_x_m,reason
///
/// The first seven columns are numbers in every row; `used` is 1 where the point is in a fit of a line and 0 where it
/// is not, for the reason in the last column. `measured_x_m` is empty where no marker was found. Frames that were not
/// smoothed (before the start, at rest, …) have no row; "left_out" of results.json lists them.
#pragma once

#include <string>

#include "core/result/results.h"

namespace glidelab::report {

/// NumericalError where a value is not finite.
std::string phase_csv(const core::ClipResult& clip);

}  // namespace glidelab::report
