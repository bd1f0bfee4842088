#include "render/moving_painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "render/coverage.h"
#include "render/moving_shapes.h"

namespace glidelab::render {
namespace {

/// The rays of a row of a tile.
struct RowRays {
  const float* x_y_dxdu_dxdv;
  const float* dydu_dydv;
};

using TileRow = std::array<double, kRayTile>;

/// Coverage of a row of pixels by a polygon of which only some edges may cross them.
void polygon_row(const Polygon& polygon, std::uint8_t crossing, double shift, const RowRays& rays, int count,
                 TileRow& coverage) {
  std::array<Eigen::Vector3d, 4> lines;
  std::size_t line_count = 0;
  for (std::size_t e = 0; e < polygon.edges.size(); ++e) {
    if ((crossing >> e & 1u) == 0) continue;
    lines[line_count++] = polygon.edges[e].fixed + shift * polygon.edges[e].moving;
  }
  std::array<PixelLine, 4> through;  // one for all pixels: to clear it is a quarter of the work
  for (int i = 0; i < count; ++i) {
    const auto ray = [&](int k) { return static_cast<double>(rays.x_y_dxdu_dxdv[4 * i + k]); };
    const auto slope = [&](int k) { return static_cast<double>(rays.dydu_dydv[2 * i + k]); };
    std::size_t through_count = 0;
    bool outside = false;
    for (std::size_t e = 0; e < line_count && !outside; ++e) {
      const Eigen::Vector3d& line = lines[e];
      const PixelLine here{line.x() * ray(0) + line.y() * ray(1) + line.z(), line.x() * ray(2) + line.y() * slope(0),
                           line.x() * ray(3) + line.y() * slope(1)};
      const double reach = 0.5 * (std::abs(here.gx) + std::abs(here.gy));
      outside = here.s <= -reach;
      if (here.s < reach) through[through_count++] = here;
    }
    coverage[i] = outside              ? 0.0
                  : through_count == 0 ? 1.0
                  : through_count == 1 ? half_plane_coverage(through[0])
                                       : convex_coverage(std::span(through).first(through_count));
  }
}

double sphere_coverage(const Sphere& sphere, const Eigen::Vector3d& c, const float* ray, const float* slope) {
  const Eigen::Vector2d du(ray[2], slope[0]);
  const Eigen::Vector2d dv(ray[3], slope[1]);
  const Eigen::Vector2d center = c.head<2>() / c.z();
  // Most pixels are not cut by the outline. The distance of a ray from the centre (below) changes by at most |c| times
  // what the ray does; half a pixel is in reach, and as much again for what the ray's own length changes.
  const Eigen::Vector2d off = Eigen::Vector2d(ray[0], ray[1]) - center;
  const double turned = off.x() * c.y() - off.y() * c.x();
  const double off2 = (c.z() * c.z() * off.squaredNorm() + turned * turned) / (1.0 + ray[0] * ray[0] + ray[1] * ray[1]);
  const double reach = c.norm() * (du.norm() + dv.norm());
  if (off2 > (sphere.radius_m + reach) * (sphere.radius_m + reach)) return 0.0;
  if (sphere.radius_m > reach && off2 < (sphere.radius_m - reach) * (sphere.radius_m - reach)) return 1.0;
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

/// What may be seen of a shape in a tile; `crossing` is that of InTile.
struct Step {
  const Polygon* polygon = nullptr;
  double radiance = 0.0;
  std::uint8_t crossing = 0;
};

/// How a tile is drawn as one view sees it: what may be seen of it, in order.
struct Plan {
  std::vector<Step> steps;
  bool with_sphere = false;
  bool even = true;  ///< the same in all its pixels at all shifts of the range
};

bool same_picture(const Plan& a, const Plan& b) {
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
    if (polygon.is_patch && first_of_box) continue;  // the box itself is not there
    if (place.crossing == 0 && polygon.is_patch && plan.steps.size() == 1 && plan.steps.front().crossing == 0) {
      plan.steps.front().radiance = polygon.radiance;  // hides the face and the patches under it
      continue;
    }
    plan.steps.push_back({&polygon, polygon.radiance, place.crossing});
    // A face that fills the tile hides the boxes before.
    if (place.crossing == 0 && !polygon.is_patch && first_of_box) {
      plan.steps.erase(plan.steps.begin(), plan.steps.end() - 1);
    }
  }
  plan.with_sphere = shapes.sphere() && overlap(shapes.sphere()->bounds, tile);
  plan.even = !plan.with_sphere &&
              std::all_of(plan.steps.begin(), plan.steps.end(), [](const Step& step) { return step.crossing == 0; });
}

/// Some pixels of a row of one tile.
struct TileSpan {
  int y = 0;
  int x = 0;
  int count = 0;
};

struct RowPicture {
  TileRow radiance{};
  TileRow coverage{};
};

/// Adds what a row of a tile shows at one instant.
void add_row(const Shapes& shapes, const Plan& plan, double shift, double weight, const RayTable& rays,
             const TileSpan& span, RowPicture& out) {
  const std::size_t at = static_cast<std::size_t>(span.y) * rays.width + span.x;
  const RowRays row{rays.x_y_dxdu_dxdv.data() + 4 * at, rays.dydu_dydv.data() + 2 * at};
  RowPicture seen;
  // One box after the other: its seen faces, which share its picture, then patches in their places, then the whole
  // over what was there.
  for (std::size_t k = 0; k < plan.steps.size();) {
    RowPicture box;
    const std::size_t number = plan.steps[k].polygon->box;
    for (; k < plan.steps.size() && plan.steps[k].polygon->box == number; ++k) {
      const Step& step = plan.steps[k];
      TileRow coverage;
      if (step.crossing == 0) {
        coverage.fill(1.0);
      } else {
        polygon_row(*step.polygon, step.crossing, shift, row, span.count, coverage);
      }
      for (int i = 0; i < span.count; ++i) {
        double& box_part = box.coverage[i];
        double& light = box.radiance[i];
        if (!step.polygon->is_patch) {
          light += coverage[i] * step.radiance;
          box_part += coverage[i];
        } else if (box_part > 0.0) {
          const double patched = std::min(coverage[i], box_part);
          light += patched * (step.radiance - light / box_part);
        }
      }
    }
    for (int i = 0; i < span.count; ++i) {
      seen.radiance[i] += box.radiance[i] - box.coverage[i] * seen.radiance[i];
      seen.coverage[i] += box.coverage[i] * (1.0 - seen.coverage[i]);
    }
  }
  if (plan.with_sphere) {
    const Sphere& sphere = *shapes.sphere();
    const Eigen::Vector3d c = sphere.center_C + shift * shapes.direction_C();
    for (int i = 0; i < span.count; ++i) {
      const double covered = sphere_coverage(sphere, c, row.x_y_dxdu_dxdv + 4 * i, row.dydu_dydv + 2 * i);
      seen.radiance[i] += covered * (sphere.radiance - seen.radiance[i]);
      seen.coverage[i] += covered * (1.0 - seen.coverage[i]);
    }
  }
  for (int i = 0; i < span.count; ++i) {
    out.radiance[i] += weight * seen.radiance[i];
    out.coverage[i] += weight * seen.coverage[i];
  }
}

/// Draws tile by tile. What is decided of a tile is decided of the whole of it, also where only a part is wanted: so a
/// pixel is the same in any part of the picture.
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
  /// The tiles within which anything may be seen.
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

  /// The instants of a row of tiles, and between which shifts each view is looked from.
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
      even = even && same_picture(*first, plans_[view]);
    }
    if (first == nullptr || (even && first->steps.empty())) return;
    const PixelRect rect = intersection(layer_.rect, {column * kRayTile, row * kRayTile, kRayTile, kRayTile});
    for (int y = rect.y; y < rect.y + rect.height; ++y) {
      const TileSpan span{y, rect.x, rect.width};
      RowPicture picture;
      if (even) {
        add_row(shapes_[first - plans_.data()], *first, 0.0, 1.0, rays_, span, picture);
      } else {
        for (const Instant& instant : instants_[y - row * kRayTile]) {
          add_row(shapes_[instant.view], plans_[instant.view], instant.x_m - middle_m_, instant.weight, rays_, span,
                  picture);
        }
      }
      const std::size_t at = static_cast<std::size_t>(y - layer_.rect.y) * layer_.rect.width + (rect.x - layer_.rect.x);
      for (int i = 0; i < rect.width; ++i) {
        layer_.radiance[at + i] = static_cast<float>(picture.radiance[i]);
        layer_.coverage[at + i] = static_cast<float>(picture.coverage[i]);
      }
    }
  }

  const RayTable& rays_;
  const std::vector<Shapes>& shapes_;
  double middle_m_;
  const Looks& looks_;
  std::vector<std::optional<ShiftRange>> ranges_;  ///< of each view, in the rows at hand; nothing: not looked from
  std::vector<Plan> plans_;                        ///< of each view, for the tile at hand
  std::array<std::vector<Instant>, kRayTile> instants_;  ///< of the rows at hand
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
