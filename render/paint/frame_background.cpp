#include "render/paint/frame_background.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "base/errors.h"
#include "render/paint/static_painter.h"
#include "render/scenario/scene.h"

namespace glidelab::render {
namespace {

/// Depth (z in the camera's frame) of the surface that the ray meets.
double depth_along(const Camera& camera, const StaticScene& scene, const Eigen::Vector2d& undistorted) {
  const Eigen::Vector3d eye = camera.X_WC.translation();
  const Eigen::Vector3d along = camera.X_WC.linear() * undistorted.homogeneous();
  double nearest = (scene.wall_z_m - eye.z()) / along.z();
  for (const StaticBox& box : scene.boxes) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(-box.turn_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Vector3d o = turn * (eye - box.center_W);
    const Eigen::Vector3d d = turn * along;
    double enter = 0.0;
    double leave = nearest;
    for (int axis = 0; axis < 3; ++axis) {
      const double a = (-box.half_m[axis] - o[axis]) / d[axis];
      const double b = (box.half_m[axis] - o[axis]) / d[axis];
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter > 0.0 && enter < leave) nearest = enter;
  }
  return nearest;
}

bool moves_sideways(const Mount& mount) {
  return std::any_of(mount.motions.begin(), mount.motions.end(), [](const MountMotion& motion) {
    return motion.axis == MountAxis::x || motion.axis == MountAxis::y || motion.axis == MountAxis::z;
  });
}

FloatImage box_means(const FloatImage& fine) {
  const int width = fine.width - kFine + 1;
  const int height = fine.height - kFine + 1;
  FloatImage across(width, fine.height);
  for (int y = 0; y < fine.height; ++y) {
    for (int x = 0; x < width; ++x) {
      float sum = 0.0f;
      for (int k = 0; k < kFine; ++k) sum += fine.at(x + k, y);
      across.at(x, y) = sum / static_cast<float>(kFine);
    }
  }
  FloatImage means(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float sum = 0.0f;
      for (int k = 0; k < kFine; ++k) sum += across.at(x, y + k);
      means.at(x, y) = sum / static_cast<float>(kFine);
    }
  }
  return means;
}

/// The same lens with pixels that are kFine times smaller.
std::optional<Focus> as_fine(std::optional<Focus> focus) {
  if (focus) {
    focus->pixel_pitch_m /= kFine;
    focus->core_px *= kFine;
  }
  return focus;
}

/// The pixel position of the still camera that shows what the moved one shows at a pixel.
Eigen::Vector2d source_of(const FineImage& fine, const Eigen::Isometry3d& moved, int u, int v) {
  const std::size_t at = static_cast<std::size_t>(v) * fine.rays.width + u;
  const Eigen::Vector3d ray(static_cast<double>(fine.rays.x_y_dxdu_dxdv[4 * at]),
                            static_cast<double>(fine.rays.x_y_dxdu_dxdv[4 * at + 1]), 1.0);
  const Eigen::Vector3d turned = moved.linear() * ray;
  auto source = pixel_of(fine.camera, turned.hnormalized(), fine.rays.fold_radius);
  if (!fine.depth_m.values.empty()) {
    for (int i = 0; i < 3 && source; ++i) {
      const int x = static_cast<int>(std::lround(source->x())) + fine.margin_px;
      const int y = static_cast<int>(std::lround(source->y())) + fine.margin_px;
      if (x < 0 || y < 0 || x >= fine.depth_m.width || y >= fine.depth_m.height) break;
      // The point is scale * turned + translation, at the depth that the still camera sees.
      const double scale = (static_cast<double>(fine.depth_m.at(x, y)) - moved.translation().z()) / turned.z();
      source = pixel_of(fine.camera, (turned + moved.translation() / scale).hnormalized(), fine.rays.fold_radius);
    }
  }
  if (!source) throw std::logic_error("shaken image: a ray leads beyond the lens");
  return *source;
}

}  // namespace

double largest_shift_px(const Camera& camera, const Mount& mount, double duration_s, double nearest_m) {
  double largest = 0.0;
  constexpr int kInstants = 2000;
  for (int i = 0; i <= kInstants; ++i) {
    const Eigen::Isometry3d moved = mount_at(mount, duration_s * i / kInstants);
    for (const double u : {-0.5, camera.width_px - 0.5}) {
      for (const double v : {-0.5, camera.height_px - 0.5}) {
        const auto ray = undistorted_at(camera, {u, v});
        if (!ray) continue;
        const Eigen::Vector3d there = moved.linear() * ray->homogeneous() + moved.translation() / nearest_m;
        const auto pixel = pixel_of(camera, there.hnormalized());
        largest = std::max(largest, pixel ? (*pixel - Eigen::Vector2d(u, v)).cwiseAbs().maxCoeff() : 1e9);
      }
    }
  }
  return largest;
}

FineImage fine_image(const Camera& camera, const Mount& mount, const std::optional<Focus>& focus,
                     const StaticScene& scene, double duration_s) {
  FineImage fine;
  fine.camera = camera;
  fine.rays = make_ray_table(camera);
  constexpr double kNearest = 0.5;  // m
  // For the sines between the sampled instants, and a pixel for the means.
  const double shift = 1.1 * largest_shift_px(camera, mount, duration_s, kNearest) + 2.0;
  constexpr double kMost = 400.0;
  if (!(shift <= kMost)) {
    throw base::NumericalError(
        fmt::format("mount: the image moves by {:.0f} px; up to {:.0f} px can be drawn", shift, kMost));
  }
  fine.margin_px = static_cast<int>(std::ceil(shift));
  const int columns = (camera.width_px + 2 * fine.margin_px) * kFine;
  const int rows = (camera.height_px + 2 * fine.margin_px) * kFine;
  FloatImage cast(columns, rows);
  // In strips, to save memory. A strip includes the reach of blurred edges beyond it.
  constexpr int kStrip = 512;
  const int overlap = focus ? 128 : 8;
  for (int top = 0; top < rows; top += kStrip) {
    const int first = std::max(0, top - overlap);
    const int last = std::min(rows, top + kStrip + overlap);
    Camera strip = camera;
    strip.width_px = columns;
    strip.height_px = last - first;
    strip.focal_px = kFine * camera.focal_px;
    const Eigen::Vector2d half = Eigen::Vector2d::Constant(0.5);
    strip.center_px = kFine * (camera.center_px + half + Eigen::Vector2d::Constant(fine.margin_px)) - half;
    strip.center_px.y() -= first;
    const FloatImage seen = StaticPainter(strip, make_ray_table(strip), as_fine(focus)).paint(scene);
    for (int y = top; y < std::min(rows, top + kStrip); ++y) {
      const std::span<const float> from = seen.row(y - first, 0, columns);
      std::copy(from.begin(), from.end(), cast.row(y, 0, columns).begin());
    }
  }
  fine.means = box_means(cast);
  if (moves_sideways(mount)) {
    fine.depth_m = FloatImage(camera.width_px + 2 * fine.margin_px, camera.height_px + 2 * fine.margin_px);
    for (int y = 0; y < fine.depth_m.height; ++y) {
      for (int x = 0; x < fine.depth_m.width; ++x) {
        const auto ray = undistort(
            camera.lens,
            (Eigen::Vector2d(x - fine.margin_px, y - fine.margin_px) - camera.center_px).cwiseQuotient(camera.focal_px),
            fine.rays.fold_radius);
        if (!ray) throw base::NumericalError("mount: the lens has no rays beyond the image's edge");
        fine.depth_m.at(x, y) = static_cast<float>(depth_along(camera, scene, *ray));
      }
    }
  }
  return fine;
}

void add_row(const FineImage& fine, const Eigen::Isometry3d& moved, int y, int x, float weight,
             std::span<float> values) {
  constexpr int kStep = 16;
  const int step = fine.depth_m.values.empty() ? kStep : 1;
  const double offset = fine.margin_px * kFine;  // a pixel's window advances by kFine places per pixel
  const auto sample = [&](double u, double v) {
    const double fx = u * kFine + offset;
    const double fy = v * kFine + offset;
    const int left = static_cast<int>(std::floor(fx));
    const int top = static_cast<int>(std::floor(fy));
    if (left < 0 || top < 0 || left + 1 >= fine.means.width || top + 1 >= fine.means.height) {
      throw std::logic_error(fmt::format("shaken image: ({}, {}) lies beyond the margin", u, v));
    }
    const auto a = static_cast<float>(fx - left);
    const auto b = static_cast<float>(fy - top);
    const float* const upper = fine.means.values.data() + static_cast<std::size_t>(top) * fine.means.width + left;
    const float* const lower = upper + fine.means.width;
    const float above = upper[0] + a * (upper[1] - upper[0]);
    const float below = lower[0] + a * (lower[1] - lower[0]);
    return above + b * (below - above);
  };
  // Nodes at multiples of the step, so that a pixel is the same for any requested part of the row.
  const int end = x + static_cast<int>(values.size());
  for (int node = x / step * step; node < end; node += step) {
    const Eigen::Vector2d from = source_of(fine, moved, node, y);
    const int last = std::min(node + step, fine.camera.width_px - 1);
    const Eigen::Vector2d to = last > node ? source_of(fine, moved, last, y) : from;
    const Eigen::Vector2d per_px =
        last > node ? Eigen::Vector2d((to - from) / (last - node)) : Eigen::Vector2d::Zero().eval();
    for (int u = std::max(node, x); u < std::min({node + step, end}); ++u) {
      const Eigen::Vector2d at = from + (u - node) * per_px;
      values[static_cast<std::size_t>(u - x)] += weight * sample(at.x(), at.y());
    }
  }
}

namespace {

/// The normal distribution's integral over each of `count` pixels from `first` on.
std::vector<double> pixel_shares(double center, double sigma, int first, int count) {
  std::vector<double> shares;
  const auto below = [&](double at) { return 0.5 * std::erfc((center - at) / (sigma * std::numbers::sqrt2)); };
  double before = below(first - 0.5);
  for (int i = 0; i < count; ++i) {
    const double after = below(first + i + 0.5);
    shares.push_back(after - before);
    before = after;
  }
  return shares;
}

}  // namespace

PixelRect add_reflection(const Scenario& scenario, const RayTable& rays, const sim::Body& body,
                         const Reflection& reflection, const FrameMotion& frame, double white_e,
                         const PixelRect& within, FloatImage& image) {
  const Recording& recording = scenario.recording;
  const Eigen::Vector3d along_W = track_direction_W(scenario.track, body.incline_rad);
  const auto place_W = [&](double t_s) -> Eigen::Vector3d {
    double x_m = frame.middle.x_m;
    if (reflection.follow != 0.0) {
      const double middle_s = frame.start_s + 0.5 * (recording.exposure_s + recording.shutter.readout_s());
      x_m = frame.path.empty() ? frame.middle.x_m + (t_s - middle_s) * frame.middle.v_m_s : frame.path.x_m(t_s);
    }
    return reflection.position_W + t_s * reflection.velocity_m_s + reflection.follow * x_m * along_W;
  };
  const auto camera_at = [&](double t_s) {
    Camera moved = scenario.camera;
    if (scenario.mount.moves()) moved.X_WC = moved.X_WC * mount_at(scenario.mount, t_s);
    return moved;
  };
  // The row of the spot's middle, found from the middle row's time.
  double row = 0.5 * (scenario.camera.height_px - 1);
  for (int i = 0; i < 3; ++i) {
    const double t_s = mid_exposure_s(recording, frame, row);
    if (const auto pixel = project(camera_at(t_s), place_W(t_s))) row = pixel->y();
  }
  const double start_s = frame.start_s + recording.shutter.delay_s(row);
  constexpr std::size_t kInstants = 16;
  PixelRect touched;
  for (std::size_t k = 0; k < kInstants; ++k) {
    const double t_s = start_s + exposure_instant(k, kInstants) * recording.exposure_s;
    const Camera camera = camera_at(t_s);
    const Eigen::Vector3d p_W = place_W(t_s);
    const auto pixel = project(camera, p_W);
    if (!pixel) continue;
    const double depth = (camera.X_WC.inverse() * p_W).z();
    const double sigma_u = reflection.radius_m * camera.focal_px.x() / depth;
    const double sigma_v = reflection.radius_m * camera.focal_px.y() / depth;
    constexpr double kReach = 6.0;
    const int left = static_cast<int>(std::floor(std::clamp(pixel->x() - kReach * sigma_u, -1e6, 1e6)));
    const int top = static_cast<int>(std::floor(std::clamp(pixel->y() - kReach * sigma_v, -1e6, 1e6)));
    const PixelRect rect = intersection(within, {left, top, static_cast<int>(2.0 * kReach * sigma_u) + 2,
                                                 static_cast<int>(2.0 * kReach * sigma_v) + 2});
    if (rect.empty()) continue;
    const std::vector<double> across = pixel_shares(pixel->x(), sigma_u, rect.x, rect.width);
    const std::vector<double> down = pixel_shares(pixel->y(), sigma_v, rect.y, rect.height);
    const double light_e = white_e * reflection.radiance * 2.0 * std::numbers::pi * sigma_u * sigma_v / kInstants;
    for (int y = 0; y < rect.height; ++y) {
      const std::span<float> values = image.row(rect.y + y, rect.x, rect.width);
      const std::size_t at = static_cast<std::size_t>(rect.y + y) * rays.width + rect.x;
      for (int x = 0; x < rect.width; ++x) {
        const double gain = rays.gain.empty() ? 1.0 : static_cast<double>(rays.gain[at + x]);
        values[static_cast<std::size_t>(x)] += static_cast<float>(gain * light_e * across[static_cast<std::size_t>(x)] *
                                                                  down[static_cast<std::size_t>(y)]);
      }
    }
    touched = united(touched, rect);
  }
  return touched;
}

}  // namespace glidelab::render
