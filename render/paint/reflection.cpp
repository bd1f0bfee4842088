#include "render/paint/reflection.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "render/scenario/scene.h"

namespace glidelab::render {
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
                         const PixelRect& within, FloatPicture& picture) {
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
  // The row of its middle, found from the middle row's time.
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
      const std::span<float> values = picture.row(rect.y + y, rect.x, rect.width);
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
