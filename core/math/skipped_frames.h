/// Frames that a camera lost, by the path of an object: it moves by the steps of two or three frames within one.
///
/// The places x_i have the clocks c_i = k_i + s_i, with the frame's number k_i and the number s_i of frames lost before
/// it. A boundary between two places has a loss where a quadratic in c through the places on both sides leaves far less
/// with one or two frames more than without. A loss whose step is not larger than the noise is not seen.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace glidelab::core {

struct PlaceAtFrame {
  std::size_t frame = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
};

/// For each place, the number of frames lost before it. `places` must be in order of frames. Losses within three places
/// of an end, or of each other, are not seen. `least_sum`: the sum of squares of a few places that does not matter.
std::vector<std::size_t> lost_before(std::vector<PlaceAtFrame> places, double least_sum);

}  // namespace glidelab::core
