/// What a marker is, by its outlines: a sphere, or a disc that lies in the plane of motion.
///
/// A camera that faces the plane shows a disc as a circle everywhere and a sphere stretched away from the axis, by
/// 1 / cos of the angle. The outline's axes, as the deviator E = ln(long / short) (cos 2a, sin 2a) of M (a the long
/// axis's direction), are compared with those that either body would show:
///
///     E = E_disc + b (E_sphere - E_disc) + k |v|^2 / r^2 (cos 2a_v, sin 2a_v) + e
///
/// v is the motion from frame to frame, whose smear makes an outline long (k); e is the same in all frames (a disc that
/// is cut or tilted so); b is 0 for a disc and 1 for a sphere. Assumes a global shutter: a rolling one shears outlines
/// in proportion to v, by as much as the two bodies differ.
#pragma once

#include <opencv2/core.hpp>

#include <optional>
#include <vector>

namespace glidelab::core {

enum class MarkerBody { sphere, disc };

/// M as its elements uu, uv, vv (1/px).
struct OutlineSeen {
  cv::Vec3d seen;          ///< as it was fitted
  cv::Vec3d sphere, disc;  ///< as the camera would show either there
  cv::Point2d motion_px;   ///< from frame to frame
};

/// The body, if the outlines determine it: b is five standard deviations from the other body, and near this one.
std::optional<MarkerBody> body_by_outline(const std::vector<OutlineSeen>& outlines);

}  // namespace glidelab::core
