#include "render/paint/moving_shapes.h"

#include <algorithm>

#include "base/errors.h"

namespace glidelab::render {
namespace {

using Corners = std::array<Eigen::Vector3d, 4>;  // camera frame, in order around

/// The six faces of a box, anticlockwise from outside; bit i of a corner's number says +half along axis i.
constexpr std::array<std::array<int, 4>, 6> kFaces = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

Eigen::Vector3d corner_sign(int number) {
  return {(number & 1) != 0 ? 1.0 : -1.0, (number & 2) != 0 ? 1.0 : -1.0, (number & 4) != 0 ? 1.0 : -1.0};
}

}  // namespace

InTile place_in_tile(const Polygon& polygon, const RayBounds& tile, const ShiftRange& shifts) {
  InTile place;
  if (!overlap(polygon.bounds, tile)) {
    place.outside = true;
    return place;
  }
  for (std::size_t e = 0; e < polygon.edges.size(); ++e) {
    const Edge& edge = polygon.edges[e];
    double least = 0.0;
    double largest = 0.0;
    for (const bool at_last : {false, true}) {
      const Eigen::Vector3d line = edge.fixed + (at_last ? shifts.last : shifts.first) * edge.moving;
      const double x_1 = line.x() * tile.low.x();
      const double x_2 = line.x() * tile.high.x();
      const double y_1 = line.y() * tile.low.y();
      const double y_2 = line.y() * tile.high.y();
      const double low = std::min(x_1, x_2) + std::min(y_1, y_2) + line.z();
      const double high = std::max(x_1, x_2) + std::max(y_1, y_2) + line.z();
      least = at_last ? std::min(least, low) : low;
      largest = at_last ? std::max(largest, high) : high;
    }
    if (largest <= 0.0) {
      place.outside = true;
      return place;
    }
    if (least < 0.0) place.crossing |= static_cast<std::uint8_t>(1u << e);
  }
  return place;
}

Shapes::Shapes(const Eigen::Affine3d& X_CW, const MovingBody& body, double middle_m, const ShiftRange& shifts)
    : X_CW_(X_CW),
      shift_W_(middle_m * body.direction_W),
      direction_C_(X_CW_.linear() * body.direction_W),
      shifts_(shifts) {
  for (std::size_t i = 0; i < body.boxes.size(); ++i) add_box(body.boxes[i], i);
  if (body.marker) add_sphere(*body.marker);
}

void Shapes::bound(RayBounds& bounds, const Eigen::Vector3d& p_C) const {
  for (const double shift : {shifts_.first, shifts_.last}) {
    const Eigen::Vector3d p = p_C + shift * direction_C_;
    if (!(p.z() > 0.0)) throw base::NumericalError("the glider reaches behind the camera");
    add_to(bounds, p.head<2>() / p.z());
  }
}

void Shapes::add_polygon(const Corners& corners, double radiance, std::size_t box, bool is_patch) {
  Polygon polygon;
  polygon.radiance = radiance;
  polygon.box = box;
  polygon.is_patch = is_patch;
  Eigen::Vector3d inside = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& c : corners) inside += c / c.z();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d& from = corners[i];
    const Eigen::Vector3d& to = corners[(i + 1) % corners.size()];
    const Eigen::Vector3d fixed = from.cross(to);
    const double scale = (fixed.dot(inside) > 0.0 ? 1.0 : -1.0) / fixed.head<2>().norm();
    polygon.edges[i] = {scale * fixed, scale * (from - to).cross(direction_C_)};
    bound(polygon.bounds, from);
  }
  add_to(bounds_, polygon.bounds);
  polygons_.push_back(polygon);
}

void Shapes::add_box(const MovingBox& box, std::size_t number) {
  std::array<Eigen::Vector3d, 8> corner;
  for (int i = 0; i < 8; ++i) {
    corner[i] = X_CW_ * (box.center_W + shift_W_ + box.axes_W * corner_sign(i).cwiseProduct(box.half_m));
  }
  bool any = false;
  for (std::size_t f = 0; f < kFaces.size(); ++f) {
    const Corners around{corner[kFaces[f][0]], corner[kFaces[f][1]], corner[kFaces[f][2]], corner[kFaces[f][3]]};
    // A face is seen where its outward normal points against the line of sight.
    if (!((around[1] - around[0]).cross(around[2] - around[1]).dot(around[0]) < 0.0)) continue;
    add_polygon(around, box.radiance[f], number, false);
    any = true;
  }
  if (!any) throw base::NumericalError("the camera is inside the glider");
  for (const Patch& patch : box.patches) {
    Corners around;
    for (std::size_t i = 0; i < around.size(); ++i) around[i] = X_CW_ * (patch.corners_W[i] + shift_W_);
    add_polygon(around, patch.radiance, number, true);
  }
}

void Shapes::add_sphere(const MarkerSphere& marker) {
  Sphere sphere{X_CW_ * (marker.center_W + shift_W_), marker.radius_m, marker.radiance, {}};
  for (int i = 0; i < 8; ++i) bound(sphere.bounds, sphere.center_C + marker.radius_m * corner_sign(i));
  add_to(bounds_, sphere.bounds);
  sphere_ = sphere;
}

}  // namespace glidelab::render
