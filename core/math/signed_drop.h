/// Which way a body falls, where nobody states the sign of x.
///
/// A fall is downwards, whether its sensor is above or below. The direction is that of the displacement if the body
/// hardly turns, and otherwise that of the acceleration between both ends and the middle of the time. A body that
/// bounces turns up at the floor: if stretches of its motion are parabolas with an acceleration of 0.7 g to 1.3 g, the
/// direction of most of them is down. A body that is thrown upwards may land above its start, or not at all: if a
/// parabola describes the positions (rms residual at most 3 % of their range) with an acceleration of 0.7 g or more,
/// that acceleration points down. Drag makes it larger on the way up, and one of a fall towards its terminal velocity
/// is below g.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace glidelab::core {

/// How far the body falls, in m; negative if x decreases on the way down.
double signed_drop(const std::vector<double>& t_s, const std::vector<double>& x_m, double gravity_m_s2);

/// The direction of these speeds as a sum, in m/s; if the body turns, that of their change.
double signed_speed(const std::vector<double>& v_m_s);

/// Speeds that are all positive, fall to 0 and rise again at once: they lost their sign at a turn, which is returned.
/// At a rest between two motions in one direction, most speeds of the dip are near 0.
std::optional<std::size_t> lost_sign_at(std::span<const double> v);

}  // namespace glidelab::core
