/// Where the marker truly is in each frame's image, for the truth folder.
///
/// A frame shows the marker as it is at the middle of the exposure of the row that its centre lies on (with a global
/// shutter, of any row). Centre: the projection of the sphere's centre. Centroid: of the area of the sphere's sharp
/// image at that instant, which differs by what perspective and lens do to a sphere (some 1e-3 px of a small one).
#pragma once

#include <optional>

#include "render/scenario/clip_motion.h"
#include "render/scenario/scenario.h"

namespace glidelab::render {

struct MarkerInPicture {
  double t_s = 0.0;  ///< the instant, on the recording's clock
  double x_m = 0.0;  ///< on the track, then
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d centroid_px = Eigen::Vector2d::Zero();
};

/// Nothing where the centre lies outside the image. NumericalError where the marker outruns a rolling readout.
std::optional<MarkerInPicture> marker_in_picture(const Scenario& scenario, const sim::Body& body,
                                                 const FrameMotion& frame);

}  // namespace glidelab::render
