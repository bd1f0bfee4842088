#include "core/check/check_pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <set>

#include "base/errors.h"
#include "core/pictures/camera/calibrate_fisheye.h"
#include "core/pictures/camera/plane_fit.h"

namespace glidelab::core {
namespace {

constexpr int kAcross = 8, kDown = 6;  // parts of the image

double share_covered(const PatternCheck& pattern) {
  std::set<int> parts;
  for (const PatternView& view : pattern.views) {
    for (const PixelPlace& corner : view.corners) {
      const int across = static_cast<int>((corner.u_px + 0.5) / pattern.width_px * kAcross);
      const int down = static_cast<int>((corner.v_px + 0.5) / pattern.height_px * kDown);
      parts.insert(std::clamp(down, 0, kDown - 1) * kAcross + std::clamp(across, 0, kAcross - 1));
    }
  }
  return static_cast<double>(parts.size()) / (kAcross * kDown);
}

/// The images of the planes of motion.
std::set<std::filesystem::path> all_planes(const Experiment& experiment) {
  std::set<std::filesystem::path> planes(experiment.calibration->planes.begin(), experiment.calibration->planes.end());
  for (const GroupSetup& group : experiment.groups) planes.insert(group.planes.begin(), group.planes.end());
  return planes;
}

}  // namespace

CheckedPattern check_pattern(const Experiment& experiment, int jobs) {
  CheckedPattern checked;
  PatternCheck& pattern = checked.check;
  std::optional<SeenPattern>& seen = checked.seen;
  const double square_m = experiment.calibration->square_m;
  const std::set<std::filesystem::path> planes = all_planes(experiment);
  const BoardSize grid = experiment.calibration->inner_corners;
  BoardViews boards;
  try {
    boards = find_board_views(pattern_files(experiment), cv::Size(grid.columns, grid.rows), jobs);
    seen = SeenPattern{boards, calibrate_any_lens(boards, square_m)};
  } catch (const base::InputError& error) {
    pattern.failure = error.what();
  }
  pattern.width_px = boards.image_size.width;
  pattern.height_px = boards.image_size.height;
  for (const std::filesystem::path& file : boards.without) pattern.without.push_back(file.filename().string());
  for (const BoardView& board : boards.views) {
    PatternView view;
    view.file = board.file.filename().string();
    view.plane = planes.contains(board.file);
    for (const cv::Point2d& corner : board.corners.points) view.corners.push_back({corner.x, corner.y});
    if (seen) {
      const Calibration& camera = seen->calibration;
      const PlaneFit fit = fit_plane(camera.camera, {board.corners}, square_m, camera.noise.correlated_px);
      view.rms_px = fit.rms_px;
      view.tilt_deg = std::acos(std::min(1.0, std::abs(fit.pose.rotation(2, 2)))) * 180.0 / std::numbers::pi;
    }
    pattern.views.push_back(std::move(view));
  }
  if (!pattern.views.empty()) pattern.covered = share_covered(pattern);
  return checked;
}

std::optional<double> share_inside(const PatternCheck& pattern, const std::vector<PixelPlace>& path) {
  std::vector<cv::Point2f> corners, outline;
  for (const PatternView& view : pattern.views) {
    for (const PixelPlace& corner : view.corners) {
      corners.emplace_back(static_cast<float>(corner.u_px), static_cast<float>(corner.v_px));
    }
  }
  if (corners.size() < 3 || path.empty()) return std::nullopt;
  cv::convexHull(corners, outline);
  const auto inside = std::count_if(path.begin(), path.end(), [&](const PixelPlace& place) {
    const cv::Point2f here(static_cast<float>(place.u_px), static_cast<float>(place.v_px));
    return cv::pointPolygonTest(outline, here, false) >= 0.0;
  });
  return static_cast<double>(inside) / static_cast<double>(path.size());
}

}  // namespace glidelab::core
