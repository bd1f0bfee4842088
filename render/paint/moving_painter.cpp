#include "render/paint/moving_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/errors.h"
#include "base/math/simd.h"
#include "render/paint/tile_row.h"

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

namespace {

/// The potentially visible part of a shape in a tile; `crossing` is that of InTile.
struct Step {
  const Polygon* polygon = nullptr;
  double radiance = 0.0;
  std::uint8_t crossing = 0;
};

/// How a tile is drawn for one view: the potentially visible shapes, in order.
struct Plan {
  std::vector<Step> steps;
  bool with_sphere = false;
  bool even = true;  ///< uniform over all its pixels at all shifts of the range
};

bool same_image(const Plan& a, const Plan& b) {
  return a.even && b.even &&
         std::equal(a.steps.begin(), a.steps.end(), b.steps.begin(), b.steps.end(), [](const Step& s, const Step& t) {
           return s.radiance == t.radiance && s.polygon->box == t.polygon->box &&
                  s.polygon->is_patch == t.polygon->is_patch;
         });
}

void make_plan(const Shapes& shapes, const RayBounds& tile, const ShiftRange& shifts, Plan& plan) {
  plan.steps.clear();
  for (const Polygon& polygon : shapes.polygons()) {
    const InTile place = place_in_tile(polygon, tile, shifts);
    if (place.outside) continue;
    const bool first_of_box = plan.steps.empty() || plan.steps.back().polygon->box != polygon.box;
    if (polygon.is_patch && first_of_box) continue;  // the box itself does not reach here
    if (place.crossing == 0 && polygon.is_patch && plan.steps.size() == 1 && plan.steps.front().crossing == 0) {
      plan.steps.front().radiance = polygon.radiance;  // hides the face and the patches under it
      continue;
    }
    plan.steps.push_back({&polygon, polygon.radiance, place.crossing});
    // A face that fills the tile hides the previous boxes.
    if (place.crossing == 0 && !polygon.is_patch && first_of_box) {
      plan.steps.erase(plan.steps.begin(), plan.steps.end() - 1);
    }
  }
  plan.with_sphere = shapes.sphere() && overlap(shapes.sphere()->bounds, tile);
  plan.even = !plan.with_sphere &&
              std::all_of(plan.steps.begin(), plan.steps.end(), [](const Step& step) { return step.crossing == 0; });
}

struct RowImage {
  TileRow radiance;
  TileRow coverage;
};

constexpr RowImage kDark{};

/// Coverage by a polygon, only some of whose edges may cross the tile.
TileRow coverage_by(const Step& step, double shift, const RowRays& rays) {
  std::array<Eigen::Vector3d, 4> lines;
  std::size_t count = 0;
  for (std::size_t e = 0; e < step.polygon->edges.size(); ++e) {
    const Edge& edge = step.polygon->edges[e];
    if ((step.crossing >> e & 1u) != 0) lines[count++] = edge.fixed + shift * edge.moving;
  }
  return polygon_row(std::span(lines).first(count), rays);
}

/// Adds the content of a row of a tile at one instant.
[[gnu::always_inline]] inline void add_row(const Shapes& shapes, const Plan& plan, double shift, double weight,
                                           const RowRays& rays, RowImage& out) {
  RowImage seen = kDark;
  // One box after another: its visible faces, which together make up its image, then the patches on them, then the
  // whole over the previous content.
  for (std::size_t k = 0; k < plan.steps.size();) {
    RowImage box = kDark;
    const std::size_t number = plan.steps[k].polygon->box;
    for (; k < plan.steps.size() && plan.steps[k].polygon->box == number; ++k) {
      const Step& step = plan.steps[k];
      TileRow coverage;
      if (step.crossing == 0) {
        coverage.fill(1.0);
      } else {
        coverage = coverage_by(step, shift, rays);
      }
      for (int i = 0; i < kRayTile; ++i) {
        double& box_part = box.coverage[i];
        double& light = box.radiance[i];
        if (!step.polygon->is_patch) {
          light += coverage[i] * step.radiance;
          box_part += coverage[i];
        } else {  // nothing if there is no part of the box
          const double patched = std::min(coverage[i], box_part), part = box_part > 0.0 ? box_part : 1.0;
          light += patched * (step.radiance - light / part);
        }
      }
    }
    for (int i = 0; i < kRayTile; ++i) {
      seen.radiance[i] += box.radiance[i] - box.coverage[i] * seen.radiance[i];
      seen.coverage[i] += box.coverage[i] * (1.0 - seen.coverage[i]);
    }
  }
  if (plan.with_sphere) {
    const Sphere& sphere = *shapes.sphere();
    const TileRow covered = sphere_row(sphere.center_C + shift * shapes.direction_C(), sphere.radius_m, rays);
    for (int i = 0; i < kRayTile; ++i) {
      seen.radiance[i] += covered[i] * (sphere.radiance - seen.radiance[i]);
      seen.coverage[i] += covered[i] * (1.0 - seen.coverage[i]);
    }
  }
  for (int i = 0; i < kRayTile; ++i) {
    out.radiance[i] += weight * seen.radiance[i];
    out.coverage[i] += weight * seen.coverage[i];
  }
}

using AddRow = void(const Shapes&, const Plan&, double shift, double weight, const RowRays&, RowImage&);

void add_row_baseline(const Shapes& shapes, const Plan& plan, double shift, double weight, const RowRays& rays,
                      RowImage& out) {
  add_row(shapes, plan, shift, weight, rays, out);
}

#if defined(__x86_64__)
// AVX2 without FMA: the same operations on more lanes.
[[gnu::target("avx2")]] void add_row_avx2(const Shapes& shapes, const Plan& plan, double shift, double weight,
                                          const RowRays& rays, RowImage& out) {
  add_row(shapes, plan, shift, weight, rays, out);
}
#endif

AddRow* best_add_row() {
#if defined(__x86_64__)
  if (base::uses_avx2(base::Simd::best)) return add_row_avx2;
#endif
  return add_row_baseline;
}

/// Draws tile by tile. Decisions apply to a whole tile, even if only a part is requested, so that a pixel is the same
/// in any part of the image.
class TilePainter {
 public:
  TilePainter(const RayTable& rays, const std::vector<Shapes>& shapes, double middle_m, const Looks& looks)
      : rays_(rays),
        shapes_(shapes),
        middle_m_(middle_m),
        looks_(looks),
        ranges_(shapes.size()),
        plans_(shapes.size()) {}

  MovingLayer paint(const PixelRect& within) {
    layer_ = {touched(within), {}, {}};
    const PixelRect& rect = layer_.rect;
    if (rect.empty()) return std::move(layer_);
    const auto size = static_cast<std::size_t>(rect.width) * rect.height;
    layer_.radiance.assign(size, 0.0f);
    layer_.coverage.assign(size, 0.0f);
    for (int row = rect.y / kRayTile; row * kRayTile < rect.y + rect.height; ++row) {
      look_at_rows(row);
      for (int column = rect.x / kRayTile; column * kRayTile < rect.x + rect.width; ++column) paint_tile(column, row);
    }
    return std::move(layer_);
  }

 private:
  /// The tiles in which anything may be visible.
  PixelRect touched(const PixelRect& within) const {
    RayBounds body;
    for (const Shapes& shapes : shapes_) add_to(body, shapes.bounds());
    PixelRect all;
    for (int row = within.y / kRayTile; row * kRayTile < within.y + within.height; ++row) {
      for (int column = within.x / kRayTile; column * kRayTile < within.x + within.width; ++column) {
        if (overlap(body, rays_.tile(column, row)))
          all = united(all, {column * kRayTile, row * kRayTile, kRayTile, kRayTile});
      }
    }
    return intersection(all, within);
  }

  /// Finds the instants of a row of tiles, and the range of shifts for each view.
  void look_at_rows(int tile_row) {
    std::fill(ranges_.begin(), ranges_.end(), std::nullopt);
    for (int i = 0; i < kRayTile; ++i) {
      const int y = std::min(tile_row * kRayTile + i, rays_.height - 1);
      const std::span<const Instant> instants = looks_.of_row(y);
      instants_[i].assign(instants.begin(), instants.end());
      for (const Instant& instant : instants) {
        const double shift = instant.x_m - middle_m_;
        std::optional<ShiftRange>& range = ranges_.at(instant.view);
        range =
            range ? ShiftRange{std::min(range->first, shift), std::max(range->last, shift)} : ShiftRange{shift, shift};
      }
    }
  }

  void paint_tile(int column, int row) {
    const RayBounds& bounds = rays_.tile(column, row);
    const Plan* first = nullptr;
    bool even = true;
    for (std::size_t view = 0; view < shapes_.size(); ++view) {
      if (!ranges_[view]) continue;
      make_plan(shapes_[view], bounds, *ranges_[view], plans_[view]);
      if (first == nullptr) first = &plans_[view];
      even = even && same_image(*first, plans_[view]);
    }
    if (first == nullptr || (even && first->steps.empty())) return;
    const PixelRect rect = intersection(layer_.rect, {column * kRayTile, row * kRayTile, kRayTile, kRayTile});
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
      const RowRays rays = rays_of_row(rays_, rect.x, y, rect.width);
      RowImage image = kDark;
      if (even) {
        add_row_(shapes_[first - plans_.data()], *first, 0.0, 1.0, rays, image);
      } else {
        for (const Instant& instant : instants_[y - row * kRayTile]) {
          add_row_(shapes_[instant.view], plans_[instant.view], instant.x_m - middle_m_, instant.weight, rays, image);
        }
      }
      const std::size_t at = static_cast<std::size_t>(y - layer_.rect.y) * layer_.rect.width + (rect.x - layer_.rect.x);
      for (int i = 0; i < rect.width; ++i) {
        layer_.radiance[at + i] = static_cast<float>(image.radiance[i]);
        layer_.coverage[at + i] = static_cast<float>(image.coverage[i]);
      }
    }
  }

  AddRow* add_row_ = best_add_row();
  const RayTable& rays_;
  const std::vector<Shapes>& shapes_;
  double middle_m_;
  const Looks& looks_;
  std::vector<std::optional<ShiftRange>> ranges_;  ///< of each view, in the current rows; empty: the view is not used
  std::vector<Plan> plans_;                        ///< of each view, for the current tile
  std::array<std::vector<Instant>, kRayTile> instants_;  ///< of the current rows
  MovingLayer layer_;
};

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
  std::vector<Instant> instants;
  for (const double x : x_m) instants.push_back({0, x, 1.0 / static_cast<double>(x_m.size())});
  Looks looks;
  looks.views.emplace_back(camera.X_WC.inverse());
  looks.first_x_m = *std::min_element(x_m.begin(), x_m.end());
  looks.last_x_m = *std::max_element(x_m.begin(), x_m.end());
  looks.of_row = [&](int) -> std::span<const Instant> { return instants; };
  return paint(rays, body, looks, within);
}

MovingLayer paint(const RayTable& rays, const MovingBody& body, const Looks& looks, const PixelRect& within) {
  const double middle_m = 0.5 * (looks.first_x_m + looks.last_x_m);
  std::vector<Shapes> shapes;
  shapes.reserve(looks.views.size());
  for (const Eigen::Affine3d& X_CW : looks.views) {
    shapes.emplace_back(X_CW, body, middle_m, ShiftRange{looks.first_x_m - middle_m, looks.last_x_m - middle_m});
  }
  MovingLayer layer = TilePainter(rays, shapes, middle_m, looks).paint(within);
  darken(rays, layer);
  return layer;
}

void put_over(const MovingLayer& layer, float scale, FloatImage& image) {
  for (int y = 0; y < layer.rect.height; ++y) {
    const std::span<float> row = image.row(layer.rect.y + y, layer.rect.x, layer.rect.width);
    const std::size_t start = static_cast<std::size_t>(y) * layer.rect.width;
    for (std::size_t i = 0; i < row.size(); ++i) {
      row[i] = scale * layer.radiance[start + i] + (1.0f - layer.coverage[start + i]) * row[i];
    }
  }
}

}  // namespace glidelab::render
