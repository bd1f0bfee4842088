/// What the pictures of the pattern say: the camera, and for each group the way from pixels to its plane of motion.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/pictures/camera/calibrate.h"
#include "core/pictures/camera/restitution.h"
#include "core/result/results.h"

namespace glidelab::core {

/// The pattern's corners, as found in pattern_files(), and the camera that they make.
struct SeenPattern {
  BoardViews boards;
  Calibration calibration;
};

struct CameraAndPlanes {
  std::optional<cv::Size> size;  ///< of the pictures; nothing by a scale alone
  std::optional<CalibrationResult> calibration;
  std::map<std::string, Restitution> restitutions;  ///< of the groups that have clips made of pictures
};

/// The table of a group, or null where the file has none.
const GroupSetup* group_of(const Experiment& experiment, const std::string& name);

/// The pictures of the plane of motion, of a group or else of [calibration].
std::vector<std::filesystem::path> planes_of(const Experiment& experiment, const std::string& group);

/// All pictures of the pattern: views, then planes, those of groups that have clips made of pictures. Some may stand
/// twice.
std::vector<std::filesystem::path> pattern_files(const Experiment& experiment);

/// For an experiment with clips made of pictures. `seen`: what is known of the pattern already; null: its pictures are
/// read, `jobs` at a time. InputError for pictures that cannot be used.
CameraAndPlanes camera_and_planes_of(const Experiment& experiment, int jobs, const SeenPattern* seen = nullptr);

}  // namespace glidelab::core
