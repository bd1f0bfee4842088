#include "render/paint/static_painter.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "render/paint/static_shader.h"

namespace glidelab::render {
namespace {

constexpr double kMarginPx = 6.0;  // for the bulge of a long edge between its points, and for rays of neighbouring
                                   // pixels

/// The rectangle that contains the images of points, with a margin; the whole image if one of them has no image.
class Extent {
 public:
  explicit Extent(const Camera& camera) : camera_(camera) {}

  void add(const Eigen::Vector3d& p_W) {
    const auto pixel = project(camera_, p_W);
    if (!pixel) {
      is_whole_ = true;
      return;
    }
    low_ = low_.cwiseMin(*pixel);
    high_ = high_.cwiseMax(*pixel);
  }
  /// The lens bends long edges, so points are added along them.
  void add_edge(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W) {
    constexpr int kSteps = 16;
    for (int i = 0; i <= kSteps; ++i) add(from_W + (to_W - from_W) * (static_cast<double>(i) / kSteps));
  }
  void add(const StaticBox& box) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(box.turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    for (int axis = 0; axis < 3; ++axis) {
      for (int corner = 0; corner < 4; ++corner) {
        Eigen::Vector3d sign;
        sign[axis] = -1.0;
        sign[(axis + 1) % 3] = (corner & 1) != 0 ? 1.0 : -1.0;
        sign[(axis + 2) % 3] = (corner & 2) != 0 ? 1.0 : -1.0;
        const Eigen::Vector3d from = box.center_W + turn * sign.cwiseProduct(box.half_m);
        sign[axis] = 1.0;
        add_edge(from, box.center_W + turn * sign.cwiseProduct(box.half_m));
      }
    }
  }
  PixelRect rect(int more_px = 0) const {
    const PixelRect all{0, 0, camera_.width_px, camera_.height_px};
    if (is_whole_) return all;
    const auto whole = [](double value) { return static_cast<int>(std::floor(std::clamp(value, -1e6, 1e6))); };
    const double margin = kMarginPx + more_px;
    return intersection(
        all, {whole(low_.x() - margin), whole(low_.y() - margin), whole(high_.x() - low_.x() + 2 * margin) + 1,
              whole(high_.y() - low_.y() + 2 * margin) + 1});
  }

 private:
  const Camera& camera_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Constant(1e9), high_ = Eigen::Vector2d::Constant(-1e9);
  bool is_whole_ = false;
};

}  // namespace

PixelRect pixels_of(const Camera& camera, const StaticBox& box) {
  Extent extent(camera);
  extent.add(box);
  return extent.rect();
}

PixelRect pixels_before(const Camera& camera, const StaticScene& scene, int reach_px) {
  Extent extent(camera);
  if (scene.board) {
    const std::vector<Eigen::Vector3d> outline = outline_of(*scene.board);
    for (std::size_t i = 0; i < outline.size(); ++i) extent.add_edge(outline[i], outline[(i + 1) % outline.size()]);
  }
  if (scene.plumb) {
    const PlumbLine& plumb = *scene.plumb;
    const double radius = 0.5 * std::max(plumb.diameter_m, plumb.bob_diameter_m);
    const double bottom = plumb.bottom_y_m - plumb.bob_diameter_m;
    StaticBox around;
    around.center_W = {plumb.x_m, 0.5 * (plumb.top_y_m + bottom), plumb.z_m};
    around.half_m = {radius, 0.5 * (plumb.top_y_m - bottom), radius};
    extent.add(around);
  }
  return extent.rect(reach_px);
}

namespace {

// Radiance relative to white: the change allowed within a pixel that gets 4 rays, or 16. The mean is then accurate to
// about 1e-3, a quarter of an 8-bit code.
constexpr float kUneven = 0.006f;
constexpr float kEdge = 0.04f;

}  // namespace

FloatImage wanted_rays(const FloatImage& image, const FloatImage& spread) {
  FloatImage change = spread;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const float here = image.at(x, y);
      float& most = change.at(x, y);
      if (x + 1 < image.width) most = std::max(most, std::abs(image.at(x + 1, y) - here));
      if (y + 1 < image.height) most = std::max(most, std::abs(image.at(x, y + 1) - here));
    }
  }
  FloatImage wanted(image.width, image.height);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (change.at(x, y) <= kUneven) continue;
      const float rays = change.at(x, y) > kEdge ? 64.0f : 16.0f;
      for (int v = std::max(0, y - 1); v < std::min(image.height, y + 2); ++v) {
        for (int u = std::max(0, x - 1); u < std::min(image.width, x + 2); ++u) {
          wanted.at(u, v) = std::max(wanted.at(u, v), rays);
        }
      }
    }
  }
  return wanted;
}

std::vector<Eigen::Vector2f> pixel_places() {
  std::vector<Eigen::Vector2f> points;
  for (unsigned i = 0; i < kPixelRays; ++i) {
    unsigned x = 0;
    unsigned y = 0;
    unsigned direction = 32;
    for (unsigned bit = 0; bit < 6; ++bit, direction ^= direction >> 1) {
      if (((i >> bit) & 1u) == 0) continue;
      x ^= 32u >> bit;
      y ^= direction;
    }
    points.emplace_back(static_cast<float>(x) / kPixelRays, static_cast<float>(y) / kPixelRays);
  }
  return points;
}

std::vector<float> lens_rays(const Focus& focus, const Camera& camera) {
  const double aperture_m = aperture_radius_m(focus, camera);
  const double core = core_sigma_px(focus, camera);
  std::vector<float> values;
  for (const FocusSample& sample : focus_samples(kFocusRays)) {
    const Eigen::Vector2d a = aperture_m * sample.aperture;
    const Eigen::Vector2d g = core * sample.core.cwiseQuotient(camera.focal_px);
    for (const double value : {a.x(), a.y(), g.x(), g.y()}) values.push_back(static_cast<float>(value));
  }
  for (const FocusSample& sample : focus_samples(kFocusRays)) {
    for (const double value : {sample.place.x(), sample.place.y(), 0.0, 0.0}) {
      values.push_back(static_cast<float>(value));
    }
  }
  return values;
}

namespace {

Eigen::Vector4f center_of(const StaticBox& box) {
  Eigen::Vector4d value;
  value << box.center_W, std::cos(box.turn_rad);
  return value.cast<float>();
}
Eigen::Vector4f half_of(const StaticBox& box) {
  Eigen::Vector4d value;
  value << box.half_m, std::sin(box.turn_rad);
  return value.cast<float>();
}

}  // namespace

StaticPainter::StaticPainter(const Camera& camera, const RayTable& rays, const std::optional<Focus>& focus)
    : camera_(camera), focus_(focus), canvas_(camera.width_px, camera.height_px, 2), gain_(rays.gain) {
  const int rays_unit = canvas_.add_texture(rays.width, rays.height, 4, rays.x_y_dxdu_dxdv);
  const int slopes_unit = canvas_.add_texture(rays.width, rays.height, 2, rays.dydu_dydv);
  canvas_.add_program(static_shader(focus_.has_value()));
  if (focus_) {
    canvas_.set("lens", canvas_.add_texture(kFocusRays, 2, 4, lens_rays(*focus_, camera_)));
    canvas_.set("focus_distance", static_cast<float>(focus_->focus_distance_m));
  }
  canvas_.set("rays", rays_unit);
  canvas_.set("slopes", slopes_unit);
  wanted_unit_ = canvas_.add_texture(1, 1, 1, std::vector<float>{0.0f});
  canvas_.set("wanted", wanted_unit_);
  canvas_.set_array("offset", std::span<const Eigen::Vector2f>(pixel_places()));
  canvas_.set("rotation", Eigen::Matrix3f(camera.X_WC.linear().cast<float>()));
  canvas_.set("eye", Eigen::Vector3f(camera.X_WC.translation().cast<float>()));
  canvas_.set("to_light", Eigen::Vector3f(kToLight.cast<float>()));
  canvas_.set("ambient", static_cast<float>(kAmbient));
}

int StaticPainter::blur_reach_px(const StaticScene& scene) const {
  const Eigen::Isometry3d X_CW = camera_.X_WC.inverse();
  double nearest = std::numeric_limits<double>::infinity();
  double farthest = 0.0;
  const auto add = [&](const Eigen::Vector3d& p_W) {
    constexpr double kBefore = 0.2;  // m; nearer objects are hardly in the image
    const double depth = std::max((X_CW * p_W).z(), kBefore);
    nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  };
  for (const double side : {-0.5, 0.5}) {
    for (const double up : {-0.5, 0.5}) {
      const Eigen::Vector3d ray(side * camera_.width_px / camera_.focal_px.x(),
                                up * camera_.height_px / camera_.focal_px.y(), 1.0);
      const Eigen::Vector3d along = camera_.X_WC.linear() * ray;
      if (along.z() < 0.0) {
        add(camera_.X_WC.translation() + (scene.wall_z_m - camera_.X_WC.translation().z()) / along.z() * along);
      }
    }
  }
  // For boxes, the middle of the part in front of the camera: a table may reach under it.
  for (const StaticBox& box : scene.boxes) add(box.center_W + Eigen::Vector3d(0.0, 0.0, box.half_m.z()));
  if (scene.board) {
    for (const Eigen::Vector3d& corner : outline_of(*scene.board)) add(corner);
  }
  if (scene.plumb) add({scene.plumb->x_m, scene.plumb->top_y_m, scene.plumb->z_m});
  const double disc = std::max(disc_radius_px(*focus_, camera_, nearest), disc_radius_px(*focus_, camera_, farthest));
  return static_cast<int>(std::ceil(std::min(disc + 3.0 * core_sigma_px(*focus_, camera_), 500.0)));
}

void StaticPainter::show(const StaticScene& scene) {
  if (scene.boxes.size() > kMostBoxes) throw std::logic_error("too many boxes for the shader");
  canvas_.use(0);
  canvas_.set(
      "light",
      Eigen::Vector3f(
          Eigen::Vector3d(scene.light_middle_m.x(), scene.light_middle_m.y(), scene.light_falloff).cast<float>()));
  canvas_.set("gradient", Eigen::Vector2f(scene.light_gradient_per_m.cast<float>()));
  canvas_.set("wall", Eigen::Vector2f(Eigen::Vector2d(scene.wall_z_m, scene.wall_albedo).cast<float>()));
  canvas_.set("has_board", scene.board ? 1 : 0);
  if (scene.board) {
    const Chessboard& board = *scene.board;
    // A ray d (camera frame) meets the board's plane at t d = R (X, Y) + o: t^-1 (X, Y, 1) = [r1 r2 o]^-1 d.
    const Eigen::Isometry3d X_CP = camera_.X_WC.inverse() * board.X_WP;
    Eigen::Matrix3d plane;
    plane << X_CP.linear().col(0) * board.square_m, X_CP.linear().col(1) * board.square_m, X_CP.translation();
    Eigen::Matrix3d to_board = plane.inverse();
    to_board /= to_board.row(2).norm();
    canvas_.set("to_board", Eigen::Matrix3f(to_board.cast<float>()));
    canvas_.set("board_normal", Eigen::Vector3f(Eigen::Vector3d(board.X_WP.linear().col(2)).cast<float>()));
    canvas_.set("board_origin", Eigen::Vector3f(Eigen::Vector3d(board.X_WP.translation()).cast<float>()));
    if (focus_) {
      canvas_.set("board_x", Eigen::Vector3f((board.X_WP.linear().col(0) / board.square_m).cast<float>()));
      canvas_.set("board_y", Eigen::Vector3f((board.X_WP.linear().col(1) / board.square_m).cast<float>()));
    }
    canvas_.set("board_size",
                Eigen::Vector3f(static_cast<float>(board.inner_columns), static_cast<float>(board.inner_rows),
                                static_cast<float>(board.border_squares)));
    canvas_.set("board_albedo", Eigen::Vector2f(Eigen::Vector2d(board.white_albedo, board.black_albedo).cast<float>()));
  }
  if (scene.plumb) {
    const PlumbLine& plumb = *scene.plumb;
    canvas_.set("thread",
                Eigen::Vector4f(Eigen::Vector4d(plumb.x_m, plumb.z_m, plumb.top_y_m, plumb.bottom_y_m).cast<float>()));
    canvas_.set("bob",
                Eigen::Vector3f(
                    Eigen::Vector3d(0.5 * plumb.diameter_m, 0.5 * plumb.bob_diameter_m, plumb.albedo).cast<float>()));
  } else {
    canvas_.set("bob", Eigen::Vector3f(Eigen::Vector3f::Zero()));
  }
  std::vector<Eigen::Vector4f> caster_centers, caster_halves;
  Eigen::AlignedBox3d casters;
  for (const StaticBox& box : scene.boxes) {
    if (!box.casts_shadow) continue;
    caster_centers.push_back(center_of(box));
    caster_halves.push_back(half_of(box));
    const double c = std::abs(std::cos(box.turn_rad)), s = std::abs(std::sin(box.turn_rad));
    const Eigen::Vector3d half = box.half_m;
    // Plus a millimetre for single precision.
    const Eigen::Vector3d reach =
        Eigen::Vector3d(c * half.x() + s * half.y(), s * half.x() + c * half.y(), half.z()).array() + 1e-3;
    casters.extend(box.center_W - reach).extend(box.center_W + reach);
  }
  if (!casters.isEmpty()) {
    canvas_.set("casters_low", Eigen::Vector3f(casters.min().cast<float>()));
    canvas_.set("casters_high", Eigen::Vector3f(casters.max().cast<float>()));
  }
  canvas_.set("casters", static_cast<int>(caster_centers.size()));
  canvas_.set_array("caster_center", std::span<const Eigen::Vector4f>(caster_centers));
  canvas_.set_array("caster_half", std::span<const Eigen::Vector4f>(caster_halves));
}

void StaticPainter::draw_tiles(const StaticScene& scene, const PixelRect& within,
                               const std::function<bool(const PixelRect&)>& is_wanted) {
  std::vector<PixelRect> rects;
  for (const StaticBox& box : scene.boxes) rects.push_back(pixels_of(camera_, box));
  constexpr int kTile = 64;
  for (int y = within.y; y < within.y + within.height; y += kTile) {
    for (int x = within.x; x < within.x + within.width; x += kTile) {
      const PixelRect tile = intersection({x, y, kTile, kTile}, within);
      if (!is_wanted(tile)) continue;
      std::vector<Eigen::Vector4f> centers, halves;
      std::vector<Eigen::Vector2f> looks;
      for (std::size_t i = 0; i < scene.boxes.size(); ++i) {
        if (intersection(tile, rects[i]).empty()) continue;
        const StaticBox& box = scene.boxes[i];
        centers.push_back(center_of(box));
        halves.push_back(half_of(box));
        looks.emplace_back(static_cast<float>(box.albedo), static_cast<float>(box.surface));
      }
      canvas_.set("boxes", static_cast<int>(centers.size()));
      canvas_.set_array("box_center", std::span<const Eigen::Vector4f>(centers));
      canvas_.set_array("box_half", std::span<const Eigen::Vector4f>(halves));
      canvas_.set_array("box_look", std::span<const Eigen::Vector2f>(looks));
      canvas_.draw(tile);
    }
  }
}

FloatImage StaticPainter::cast_rays(const StaticScene& scene, const PixelRect& within, int reach_px) {
  std::vector<float> values(static_cast<std::size_t>(within.width) * within.height * 2);
  canvas_.set("first_pass", 1);
  draw_tiles(scene, within, [](const PixelRect&) { return true; });
  canvas_.read(within, values);
  FloatImage image(within.width, within.height);
  FloatImage spread(within.width, within.height);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    image.values[i] = values[2 * i];
    spread.values[i] = values[2 * i + 1];
  }
  FloatImage wanted = wanted_rays(image, spread);
  if (focus_) {
    // Everything that a blurred edge may reach.
    cv::Mat rays(within.height, within.width, CV_32F, wanted.values.data());
    cv::dilate(rays, rays, cv::Mat::ones(2 * reach_px + 1, 2 * reach_px + 1, CV_8U));
    for (float& count : wanted.values) count = count > 0.0f ? static_cast<float>(kFocusRays) : 0.0f;
  }
  FloatImage of_all(camera_.width_px, camera_.height_px);
  for (int y = 0; y < within.height; ++y) {
    std::ranges::copy(wanted.row(y, 0, within.width), of_all.row(within.y + y, within.x, within.width).begin());
  }
  canvas_.update_texture(wanted_unit_, of_all.width, of_all.height, 1, of_all.values);
  canvas_.set("first_pass", 0);
  draw_tiles(scene, within, [&](const PixelRect& tile) {
    for (int y = tile.y; y < tile.y + tile.height; ++y) {
      if (std::ranges::max(of_all.row(y, tile.x, tile.width)) > 0.0f) return true;
    }
    return false;
  });
  canvas_.read(within, values);
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    if (wanted.values[i] > 0.5f) image.values[i] = values[2 * i];
  }
  for (int y = 0; y < (gain_.empty() ? 0 : within.height); ++y) {
    const std::span<float> row = image.row(y, 0, within.width);
    const float* gain = gain_.data() + static_cast<std::size_t>(within.y + y) * camera_.width_px + within.x;
    for (std::size_t x = 0; x < row.size(); ++x) row[x] *= gain[x];
  }
  return image;
}

FloatImage StaticPainter::paint(const StaticScene& scene) {
  show(scene);
  return cast_rays(scene, {0, 0, camera_.width_px, camera_.height_px}, focus_ ? blur_reach_px(scene) : 0);
}

FloatImage StaticPainter::paint_before(const FloatImage& empty, const StaticScene& scene, double white) {
  show(scene);
  const int reach_px = focus_ ? blur_reach_px(scene) : 0;
  const PixelRect changed = pixels_before(camera_, scene, reach_px);
  if (changed.empty()) return empty;
  // The number of rays of a pixel depends on the surrounding pixels.
  const int around = reach_px + 2;
  const PixelRect drawn =
      intersection({0, 0, camera_.width_px, camera_.height_px},
                   {changed.x - around, changed.y - around, changed.width + 2 * around, changed.height + 2 * around});
  const FloatImage part = cast_rays(scene, drawn, reach_px);
  FloatImage image = empty;
  for (int y = changed.y; y < changed.y + changed.height; ++y) {
    std::ranges::transform(part.row(y - drawn.y, changed.x - drawn.x, changed.width),
                           image.row(y, changed.x, changed.width).begin(),
                           [white](float value) { return static_cast<float>(static_cast<double>(value) * white); });
  }
  return image;
}

}  // namespace glidelab::render
