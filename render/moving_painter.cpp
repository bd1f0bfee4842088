#include "render/moving_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/errors.h"
#include "render/coverage.h"

namespace glidelab::render {
namespace {

/// Grows a rectangle of pixels by points of the picture.
class Bounds {
 public:
  void add(const Camera& camera, double fold_radius, const Eigen::Vector3d& p_C) {
    if (!(p_C.z() > 0.0)) throw base::NumericalError("the glider reaches behind the camera");
    const std::optional<Eigen::Vector2d> pixel = pixel_of(camera, p_C.head<2>() / p_C.z(), fold_radius);
    if (!pixel) {
      beyond_the_lens_ = true;
      return;
    }
    low_ = low_.cwiseMin(*pixel);
    high_ = high_.cwiseMax(*pixel);
  }

  /// What of `all` may be touched; all of it where a part has no picture of its own and another part is seen.
  PixelRect pixels(const Camera& camera, const PixelRect& all) const {
    if (!(high_.x() >= low_.x())) return {};
    constexpr double kMargin = 2.0;  // half a pixel, and what the lens bends an edge between the points that were added
    const double widest = 4.0 * (camera.width_px + camera.height_px);  // keeps the conversion to int defined
    const auto pixel = [&](double value) { return static_cast<int>(std::floor(std::clamp(value, -widest, widest))); };
    const int left = pixel(low_.x() - kMargin);
    const int top = pixel(low_.y() - kMargin);
    const PixelRect seen =
        intersection(all, {left, top, pixel(high_.x() + kMargin) + 1 - left, pixel(high_.y() + kMargin) + 1 - top});
    return beyond_the_lens_ && !seen.empty() ? all : seen;
  }

 private:
  Eigen::Vector2d low_ = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d high_ = Eigen::Vector2d::Constant(-std::numeric_limits<double>::infinity());
  bool beyond_the_lens_ = false;
};

/// A line in undistorted coordinates, a x + b y + c, positive inside. It moves linearly with the body's shift s along
/// the track, fixed + s moving: (p + s d) x (q + s d) has no square of s.
struct Edge {
  Eigen::Vector3d fixed;
  Eigen::Vector3d moving;
};

/// What a polygon is: the first or another seen face of a box (faces share the box's picture among them), or a patch on
/// the box, over what was there.
enum class Part { first_face, face, patch };

struct Polygon {
  std::array<Edge, 4> edges;
  double radiance = 0.0;
  Part part = Part::face;
  PixelRect rect;
};

struct Sphere {
  Eigen::Vector3d center_C;
  double radius_m = 0.0;
  double radiance = 0.0;
  PixelRect rect;
};

using Corners = std::array<Eigen::Vector3d, 4>;  // camera frame, in order around

/// The six faces of a box, anticlockwise from outside; bit i of a corner's number says +half along axis i.
constexpr std::array<std::array<int, 4>, 6> kFaces = {
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

Eigen::Vector3d corner_sign(int number) {
  return {(number & 1) != 0 ? 1.0 : -1.0, (number & 2) != 0 ? 1.0 : -1.0, (number & 4) != 0 ? 1.0 : -1.0};
}

/// Where shapes are drawn: the camera's lens, and the pixels that are wanted.
struct Target {
  const Camera& camera;
  double fold_radius;
  PixelRect within;
};

/// All shapes of the body in the camera frame, for shifts from `first` to `last` about where it stands.
class Shapes {
 public:
  template <typename Transform>
  Shapes(const Target& target, const Transform& X_CW, const MovingBody& body, double middle, double first, double last)
      : target_(target),
        X_CW_(X_CW),
        shift_W_(middle * body.direction_W),
        direction_C_(X_CW_.linear() * body.direction_W),
        first_(first),
        last_(last) {
    for (const MovingBox& box : body.boxes) add_box(box);
    if (body.marker) add_sphere(*body.marker);
  }

  const std::vector<Polygon>& polygons() const { return polygons_; }
  const std::optional<Sphere>& sphere() const { return sphere_; }
  const Eigen::Vector3d& direction_C() const { return direction_C_; }

 private:
  void bound(Bounds& bounds, const Eigen::Vector3d& p_C) const {
    bounds.add(target_.camera, target_.fold_radius, p_C + first_ * direction_C_);
    bounds.add(target_.camera, target_.fold_radius, p_C + last_ * direction_C_);
  }

  Edge edge_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const Eigen::Vector3d& inside) const {
    const Eigen::Vector3d fixed = from.cross(to);
    const double scale = (fixed.dot(inside) > 0.0 ? 1.0 : -1.0) / fixed.head<2>().norm();
    return {scale * fixed, scale * (from - to).cross(direction_C_)};
  }

  void add_polygon(const Corners& corners, Part part, double radiance) {
    Polygon polygon;
    polygon.radiance = radiance;
    polygon.part = part;
    Eigen::Vector3d inside = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& c : corners) inside += c / c.z();
    Bounds bounds;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const Eigen::Vector3d& next = corners[(i + 1) % corners.size()];
      polygon.edges[i] = edge_between(corners[i], next, inside);
      constexpr int kSteps = 4;  // the lens bends long edges
      for (int k = 0; k < kSteps; ++k) bound(bounds, corners[i] + (next - corners[i]) * k / kSteps);
    }
    polygon.rect = bounds.pixels(target_.camera, target_.within);
    polygons_.push_back(polygon);
  }

  void add_box(const MovingBox& box) {
    std::array<Eigen::Vector3d, 8> corner;
    for (int i = 0; i < 8; ++i) {
      corner[i] = X_CW_ * (box.center_W + shift_W_ + box.axes_W * corner_sign(i).cwiseProduct(box.half_m));
    }
    bool any = false;
    for (std::size_t f = 0; f < kFaces.size(); ++f) {
      const Corners around{corner[kFaces[f][0]], corner[kFaces[f][1]], corner[kFaces[f][2]], corner[kFaces[f][3]]};
      // A face is seen where its outward normal points against the line of sight.
      if (!((around[1] - around[0]).cross(around[2] - around[1]).dot(around[0]) < 0.0)) continue;
      add_polygon(around, any ? Part::face : Part::first_face, box.radiance[f]);
      any = true;
    }
    if (!any) throw base::NumericalError("the camera is inside the glider");
    for (const Patch& patch : box.patches) {
      Corners around;
      for (std::size_t i = 0; i < around.size(); ++i) around[i] = X_CW_ * (patch.corners_W[i] + shift_W_);
      add_polygon(around, Part::patch, patch.radiance);
    }
  }

  void add_sphere(const MarkerSphere& marker) {
    Sphere sphere{X_CW_ * (marker.center_W + shift_W_), marker.radius_m, marker.radiance, {}};
    Bounds bounds;
    for (int i = 0; i < 8; ++i) bound(bounds, sphere.center_C + marker.radius_m * corner_sign(i));
    sphere.rect = bounds.pixels(target_.camera, target_.within);
    sphere_ = sphere;
  }

  Target target_;
  Eigen::Affine3d X_CW_;
  Eigen::Vector3d shift_W_;
  Eigen::Vector3d direction_C_;
  double first_, last_;
  std::vector<Polygon> polygons_;
  std::optional<Sphere> sphere_;
};

/// The rays of a row of pixels.
struct RowRays {
  const float* x_y_dxdu_dxdv;
  const float* dydu_dydv;
};

/// Coverage of a row of pixels by a polygon.
void polygon_row(const Polygon& polygon, double shift, const RowRays& rays, int count, double* coverage) {
  constexpr std::size_t kEdges = 4;
  std::array<Eigen::Vector3d, kEdges> lines;
  for (std::size_t e = 0; e < kEdges; ++e) lines[e] = polygon.edges[e].fixed + shift * polygon.edges[e].moving;
  for (int i = 0; i < count; ++i) {
    const auto ray = [&](int k) { return static_cast<double>(rays.x_y_dxdu_dxdv[4 * i + k]); };
    const auto slope = [&](int k) { return static_cast<double>(rays.dydu_dydv[2 * i + k]); };
    std::array<PixelLine, kEdges> through;
    std::size_t crossing = 0;
    bool outside = false;
    for (std::size_t e = 0; e < kEdges && !outside; ++e) {
      const Eigen::Vector3d& line = lines[e];
      const PixelLine here{line.x() * ray(0) + line.y() * ray(1) + line.z(), line.x() * ray(2) + line.y() * slope(0),
                           line.x() * ray(3) + line.y() * slope(1)};
      const double reach = 0.5 * (std::abs(here.gx) + std::abs(here.gy));
      outside = here.s <= -reach;
      if (here.s < reach) through[crossing++] = here;
    }
    coverage[i] = outside         ? 0.0
                  : crossing == 0 ? 1.0
                  : crossing == 1 ? half_plane_coverage(through[0])
                                  : convex_coverage(std::span(through).first(crossing));
  }
}

double sphere_coverage(const Sphere& sphere, const Eigen::Vector3d& c, const float* ray, const float* slope) {
  const Eigen::Vector2d du(ray[2], slope[0]);
  const Eigen::Vector2d dv(ray[3], slope[1]);
  const Eigen::Vector2d center = c.head<2>() / c.z();
  double coverage = 0.0;
  for (int quarter = 0; quarter < 4; ++quarter) {
    const Eigen::Vector2d p = Eigen::Vector2d(ray[0], ray[1]) + ((quarter & 1) == 0 ? -0.25 : 0.25) * du +
                              ((quarter & 2) == 0 ? -0.25 : 0.25) * dv;
    // Distance of the ray (x, y, 1) from the centre c = Z (x_c, y_c, 1): |(e, 0) x c| / |(x, y, 1)|, with
    // e = (x, y) - (x_c, y_c); its gradient in the picture makes it a distance in pixels.
    const Eigen::Vector2d e = p - center;
    const double ray2 = 1.0 + p.squaredNorm();
    const double turn = e.x() * c.y() - e.y() * c.x();
    const double distance2 = (c.z() * c.z() * e.squaredNorm() + turn * turn) / ray2;
    const double distance = std::max(std::sqrt(distance2), 1e-3 * sphere.radius_m);
    const Eigen::Vector2d rise =
        (c.z() * c.z() * e + turn * Eigen::Vector2d(c.y(), -c.x()) - distance2 * p) / (ray2 * distance);
    const double gu = 0.5 * rise.dot(du);
    const double gv = 0.5 * rise.dot(dv);
    // The arc lies inside its tangent: on average over a square's side by 1/(24 R) of it.
    const double bulge = (gu * gu + gv * gv) / (24.0 * sphere.radius_m);
    coverage += 0.25 * half_plane_coverage({sphere.radius_m - distance - bulge, gu, gv});
  }
  return coverage;
}

/// Pictures of rows, one instant after the other.
class RowPainter {
 public:
  RowPainter(const RayTable& rays, const PixelRect& rect)
      : rays_(rays), rect_(rect), buffer_(static_cast<std::size_t>(rect.width) * 5) {}

  /// Adds what the row y shows of the shapes, shifted along the track.
  void add(const Shapes& shapes, double shift, double weight, int y, float* out_radiance, float* out_coverage) {
    const int width = rect_.width;
    double* const seen_radiance = buffer_.data();
    double* const seen_coverage = seen_radiance + width;
    double* const box_radiance = seen_coverage + width;
    double* const box_coverage = box_radiance + width;
    double* const coverage = box_coverage + width;
    const auto rays_from = [&](int x) {
      const std::size_t at = static_cast<std::size_t>(y) * rays_.width + x;
      return RowRays{rays_.x_y_dxdu_dxdv.data() + 4 * at, rays_.dydu_dydv.data() + 2 * at};
    };
    const auto row_of = [&](const PixelRect& rect) { return y >= rect.y && y < rect.y + rect.height; };
    std::fill_n(seen_radiance, 2 * width, 0.0);
    // One box after the other: its seen faces, which share its picture, then patches in their places, then the whole
    // over what was there.
    for (std::size_t k = 0; k < shapes.polygons().size();) {
      std::fill_n(box_radiance, 2 * width, 0.0);
      do {
        const Polygon& polygon = shapes.polygons()[k];
        if (!row_of(polygon.rect)) continue;
        const int left = polygon.rect.x - rect_.x;
        polygon_row(polygon, shift, rays_from(polygon.rect.x), polygon.rect.width, coverage);
        for (int i = 0; i < polygon.rect.width; ++i) {
          double& box_part = box_coverage[left + i];
          double& light = box_radiance[left + i];
          if (polygon.part != Part::patch) {
            light += coverage[i] * polygon.radiance;
            box_part += coverage[i];
          } else if (box_part > 0.0) {
            const double patched = std::min(coverage[i], box_part);
            light += patched * (polygon.radiance - light / box_part);
          }
        }
      } while (++k < shapes.polygons().size() && shapes.polygons()[k].part != Part::first_face);
      for (int i = 0; i < width; ++i) {
        seen_radiance[i] += box_radiance[i] - box_coverage[i] * seen_radiance[i];
        seen_coverage[i] += box_coverage[i] * (1.0 - seen_coverage[i]);
      }
    }
    if (const auto& sphere = shapes.sphere(); sphere && row_of(sphere->rect)) {
      const Eigen::Vector3d c = sphere->center_C + shift * shapes.direction_C();
      const RowRays row = rays_from(sphere->rect.x);
      for (int i = 0; i < sphere->rect.width; ++i) {
        const double covered = sphere_coverage(*sphere, c, row.x_y_dxdu_dxdv + 4 * i, row.dydu_dydv + 2 * i);
        const int at = sphere->rect.x - rect_.x + i;
        seen_radiance[at] += covered * (sphere->radiance - seen_radiance[at]);
        seen_coverage[at] += covered * (1.0 - seen_coverage[at]);
      }
    }
    for (int i = 0; i < width; ++i) {
      out_radiance[i] += static_cast<float>(weight * seen_radiance[i]);
      out_coverage[i] += static_cast<float>(weight * seen_coverage[i]);
    }
  }

 private:
  const RayTable& rays_;
  PixelRect rect_;
  std::vector<double> buffer_;
};

void include(PixelRect& whole, const Shapes& shapes) {
  for (const Polygon& polygon : shapes.polygons()) whole = united(whole, polygon.rect);
  if (shapes.sphere()) whole = united(whole, shapes.sphere()->rect);
}

MovingLayer empty_layer(const PixelRect& rect) {
  const std::size_t size = rect.empty() ? 0 : static_cast<std::size_t>(rect.width) * rect.height;
  return {rect, std::vector<float>(size, 0.0f), std::vector<float>(size, 0.0f)};
}

void darken(const RayTable& rays, MovingLayer& layer) {
  if (rays.gain.empty()) return;
  for (int y = 0; y < layer.rect.height; ++y) {
    const float* const gain = rays.gain.data() + static_cast<std::size_t>(layer.rect.y + y) * rays.width + layer.rect.x;
    float* const row = layer.radiance.data() + static_cast<std::size_t>(y) * layer.rect.width;
    for (int x = 0; x < layer.rect.width; ++x) row[x] *= gain[x];
  }
}

}  // namespace

MovingLayer paint(const Camera& camera, const RayTable& rays, const MovingBody& body, std::span<const double> x_m) {
  return paint(camera, rays, body, x_m, {0, 0, camera.width_px, camera.height_px});
}

MovingLayer paint(const Camera& camera, const RayTable& rays, const MovingBody& body, std::span<const double> x_m,
                  const PixelRect& within) {
  if (x_m.empty()) throw std::logic_error("no instant to paint");
  const double first = *std::min_element(x_m.begin(), x_m.end());
  const double last = *std::max_element(x_m.begin(), x_m.end());
  const double middle = 0.5 * (first + last);
  const Shapes shapes({camera, rays.fold_radius, within}, camera.X_WC.inverse(), body, middle, first - middle,
                      last - middle);
  PixelRect rect;
  include(rect, shapes);
  MovingLayer layer = empty_layer(rect);
  if (rect.empty()) return layer;
  RowPainter painter(rays, rect);
  const double share = 1.0 / static_cast<double>(x_m.size());
  for (int y = 0; y < rect.height; ++y) {
    const std::size_t at = static_cast<std::size_t>(y) * rect.width;
    for (const double x : x_m) {
      painter.add(shapes, x - middle, share, rect.y + y, layer.radiance.data() + at, layer.coverage.data() + at);
    }
  }
  darken(rays, layer);
  return layer;
}

MovingLayer paint(const Camera& camera, const RayTable& rays, const MovingBody& body, const Looks& looks,
                  const PixelRect& within) {
  const double middle = 0.5 * (looks.first_x_m + looks.last_x_m);
  std::vector<Shapes> shapes;
  PixelRect rect;
  for (const Eigen::Affine3d& X_CW : looks.views) {
    shapes.emplace_back(Target{camera, rays.fold_radius, within}, X_CW, body, middle, looks.first_x_m - middle,
                        looks.last_x_m - middle);
    include(rect, shapes.back());
  }
  MovingLayer layer = empty_layer(rect);
  if (rect.empty()) return layer;
  RowPainter painter(rays, rect);
  for (int y = 0; y < rect.height; ++y) {
    const std::size_t at = static_cast<std::size_t>(y) * rect.width;
    for (const Instant& instant : looks.of_row(rect.y + y)) {
      painter.add(shapes[instant.view], instant.x_m - middle, instant.weight, rect.y + y, layer.radiance.data() + at,
                  layer.coverage.data() + at);
    }
  }
  darken(rays, layer);
  return layer;
}

void put_over(const MovingLayer& layer, float scale, FloatPicture& picture) {
  for (int y = 0; y < layer.rect.height; ++y) {
    const std::span<float> row = picture.row(layer.rect.y + y, layer.rect.x, layer.rect.width);
    const std::size_t start = static_cast<std::size_t>(y) * layer.rect.width;
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = scale * layer.radiance[start + i] + (1.0f - layer.coverage[start + i]) * row[i];
    }
  }
}

}  // namespace glidelab::render
