#include "core/pictures/camera/camera_and_planes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/errors.h"
#include "core/pictures/camera/calibrate_fisheye.h"

namespace glidelab::core {
namespace fs = std::filesystem;

const GroupSetup* group_of(const Experiment& experiment, const std::string& name) {
  for (const GroupSetup& group : experiment.groups) {
    if (group.name == name) return &group;
  }
  return nullptr;
}

std::vector<fs::path> planes_of(const Experiment& experiment, const std::string& group) {
  const GroupSetup* setup = group_of(experiment, group);
  return setup != nullptr && !setup->planes.empty() ? setup->planes : experiment.calibration->planes;
}

namespace {

std::set<std::string> filmed_groups(const Experiment& experiment) {
  std::set<std::string> names;
  for (const ClipSetup& clip : experiment.clips) {
    if (!clip.file.empty()) names.insert(clip.group);
  }
  return names;
}

}  // namespace

std::vector<fs::path> pattern_files(const Experiment& experiment) {
  const CalibrationSetup& setup = *experiment.calibration;
  std::vector<fs::path> files = setup.views;
  files.insert(files.end(), setup.planes.begin(), setup.planes.end());
  for (const std::string& name : filmed_groups(experiment)) {
    const std::vector<fs::path> planes = planes_of(experiment, name);
    files.insert(files.end(), planes.begin(), planes.end());
  }
  return files;
}

namespace {

CameraAndPlanes calibrated(const Experiment& experiment, int jobs, const SeenPattern* seen) {
  const CalibrationSetup& setup = *experiment.calibration;
  const BoardViews boards =
      seen != nullptr ? seen->boards
                      : find_board_views(pattern_files(experiment),
                                         cv::Size(setup.inner_corners.columns, setup.inner_corners.rows), jobs);
  const auto corners_in = [&](const fs::path& file) -> const BoardCorners& {
    for (const BoardView& view : boards.views) {
      if (view.file == file) return view.corners;
    }
    throw base::InputError(base::Issue{
        file.string(), 0, "calibration.plane", "no pattern in sight",
        fmt::format("all {} x {} inner corners in sight", setup.inner_corners.columns, setup.inner_corners.rows)});
  };

  CameraAndPlanes setting;
  std::vector<std::pair<std::string, std::vector<BoardCorners>>> planes;
  for (const std::string& name : filmed_groups(experiment)) {
    planes.emplace_back(name, std::vector<BoardCorners>{});
    for (const fs::path& file : planes_of(experiment, name)) planes.back().second.push_back(corners_in(file));
  }
  const Calibration calibration = seen != nullptr ? seen->calibration : calibrate_any_lens(boards, setup.square_m);
  setting.size = calibration.camera.size;
  CalibrationResult result;
  result.experiment = experiment.name;
  result.rms_px = calibration.rms_px;
  const CameraModel& camera = calibration.camera;
  result.camera_matrix = {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
  result.distortion.assign(camera.distortion.begin(), camera.distortion.end());
  if (camera.lens == LensKind::fisheye) result.distortion.resize(4);
  for (Eigen::Index k = 0; k < calibration.covariance.rows(); ++k) {
    result.sd.push_back(std::sqrt(calibration.covariance(k, k)));
  }
  result.model = calibration.model;
  result.views_used = calibration.views_used;
  result.rests = calibration.rests;
  result.notes = calibration.notes;
  double sum = 0.0, count = 0.0;
  for (const auto& [name, corners] : planes) {
    const auto [place, is_new] = setting.restitutions.emplace(
        name, Restitution::from_pattern(calibration, corners, setup.square_m, experiment.marker->height_m,
                                        experiment.marker->diameter_m));
    const PlaneFit& fit = *place->second.plane();
    const auto views = static_cast<double>(corners.size());
    sum += views * fit.rms_m * fit.rms_m;
    count += views;
    result.plane_rms_px = std::max(result.plane_rms_px, fit.rms_px);
    result.plane_expected_px = std::hypot(calibration.noise.white_px, calibration.noise.correlated_px);
    const auto warning = disagreement(fit, corners.size(), calibration.noise, name);
    if (warning) result.notes.push_back(*warning);
  }
  result.restitution_rms_m = std::sqrt(sum / count);
  setting.calibration = std::move(result);
  return setting;
}

}  // namespace

CameraAndPlanes camera_and_planes_of(const Experiment& experiment, int jobs, const SeenPattern* seen) {
  if (experiment.calibration) return calibrated(experiment, jobs, seen);
  CameraAndPlanes setting;
  for (const std::string& name : filmed_groups(experiment)) {
    setting.restitutions.emplace(name, Restitution::from_scale(*experiment.scale, experiment.marker->diameter_m));
  }
  return setting;
}

}  // namespace glidelab::core
