/// From the images of the pattern to the camera and, for each group, the mapping from pixels to its plane of motion.
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
  std::optional<cv::Size> size;  ///< of the images; nothing with a scale alone
  std::optional<CalibrationResult> calibration;
  std::map<std::string, Restitution> restitutions;  ///< of the groups that have filmed clips
};

/// The table of a group, or null if the file has none.
const GroupSetup* group_of(const Experiment& experiment, const std::string& name);

/// The images of the plane of motion, of a group or else of [calibration].
std::vector<std::filesystem::path> planes_of(const Experiment& experiment, const std::string& group);

/// All images of the pattern: views, then planes, then those of groups that have filmed clips. Some may occur twice.
std::vector<std::filesystem::path> pattern_files(const Experiment& experiment);

/// For an experiment with filmed clips. `seen`: the pattern, if it was found before; null: its images are read, `jobs`
/// at a time. InputError for images that cannot be used.
CameraAndPlanes camera_and_planes_of(const Experiment& experiment, int jobs, const SeenPattern* seen = nullptr);

}  // namespace glidelab::core
