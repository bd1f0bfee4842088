/// How much of a scenario's motions the camera sees: the frames in which the marker's centre lies outside the image.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/scenario/scenario.h"

namespace glidelab::render {

struct ClipView {
  std::string clip;
  std::size_t frames = 0;
  std::size_t outside = 0;  ///< of these, with the marker's centre outside the image
  double moved_m = 0.0;     ///< from the smallest to the largest x of the frames
  double seen_m = 0.0;      ///< the same for the frames that show the marker
};

/// The view of every clip, at the frames' times for the stated rate, without clock error: only simulated, nothing is
/// drawn. NumericalError if a motion cannot be simulated.
std::vector<ClipView> views_of(const Scenario& scenario);

/// "m1-up: the marker leaves the image in 88 of 361 frames: the camera sees 0.99 m of the 1.2 m that it moves"
std::string sentence(const ClipView& view);

}  // namespace glidelab::render
