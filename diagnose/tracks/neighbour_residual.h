/// The noise of one position, as its neighbours show it.
#pragma once

#include <cstddef>
#include <vector>

namespace glidelab::diagnose {

/// Distance of point i from the cubic through its four nearest neighbours, over the standard deviation that unit noise
/// gives it: its own noise, independent of the motion. 2 <= i < n - 2.
double neighbour_residual(const std::vector<double>& t_s, const std::vector<double>& x_m, std::size_t i);

}  // namespace glidelab::diagnose
