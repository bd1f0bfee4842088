/// How an experiment was filmed, as far as its folder and calibration show, written as sections of a scenario.
///
/// The calibration gives the camera and the pose of the plane's pattern in front of it (p_C = R p_P + s). The marker's
/// pixels, restituted onto the plane Z = -height of the pattern's frame P, give the line of motion p_P = through + x
/// along. With the fitted inclination, that line is the track's direction in the world, which gives the camera's
/// position. With a scale alone, the camera is taken to look straight at the line of motion from a distance of f /
/// (px_per_m). SI units, radians, pixels.
#pragma once

#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/pictures/camera/camera_model.h"
#include "core/result/image_record.h"
#include "core/result/results.h"

namespace glidelab::diagnose {

/// The noise of resting pixels against their brightness, compared with shot noise and a linear sensor:
///
///     variance = dark + gain level      (codes²; level in codes above the black)
///
/// Shot noise grows as the square root of the level. `gain` is the number of codes of one electron, and `dark` contains
/// read noise and rounding (1/12). The fit is weighted least squares over the levels that were seen, with neither below
/// 0. Deviations from that line are due to a tone curve, a codec or the camera's own smoothing.
struct NoiseLaw {
  double gain_code = 0.0, gain_sd = 0.0;
  double dark_code2 = 0.0;
  double at(double level_code) const { return dark_code2 + gain_code * level_code; }  ///< codes²
};

/// Empty for fewer than three levels, or if all levels are the same.
std::optional<NoiseLaw> noise_law(const std::vector<core::NoiseAtLevel>& levels);

/// The first folder that has clips made of images, and its first such clip.
struct Filming {
  core::CameraSettings settings;
  int width_px = 0, height_px = 0;
  std::optional<core::CameraModel> lens;                      ///< as calibrated
  Eigen::Isometry3d X_CP = Eigen::Isometry3d::Identity();     ///< with a lens: the pattern's plane
  Eigen::Vector3d through_P = Eigen::Vector3d::Zero();        ///< with a lens: the marker at x = 0,
  Eigen::Vector3d along_P = Eigen::Vector3d::UnitX();         ///< and its displacement per unit x
  Eigen::Vector2d through_px = Eigen::Vector2d::Zero();       ///< by a scale: its pixel at x = 0,
  Eigen::Vector2d along_px_m = Eigen::Vector2d(1000.0, 0.0);  ///< and its displacement in pixels a metre
  int inner_columns = 0, inner_rows = 0;
  double square_m = 0.0;
  double marker_m = 0.0, marker_height_m = 0.0;
  std::string codec;  ///< four letters, as in the container
  std::optional<bool> lossy;
  double full_code = 255.0;
  double noise_code = 0.0;        ///< of a resting pixel; 0: not measured
  std::optional<NoiseLaw> noise;  ///< noise of its pixels as a function of level, if it was seen
  bool others = false;            ///< further clips were filmed by another camera
};

/// Empty if no clip was filmed, or too little of one was seen. The folders are those of the results, in order; the
/// pattern's images are read once more, `jobs` at a time (InputError as in the analysis).
std::optional<Filming> filming_of(const core::AnalysisResults& results, const std::vector<core::Experiment>& folders,
                                  int jobs);

/// The camera in front of the plane of motion, in a scenario's world, whose origin is where the marker is at x =
/// reference.
struct TwinView {
  int downhill = 1;  ///< +1: x points to the right in the world
  Eigen::Vector3d position_m = {0.0, 0.1, 2.4};
  Eigen::Vector3d target_m = {0.0, 0.0, 0.0};
  double roll_rad = 0.0;
  std::array<double, 2> focal_px = {1200.0, 1200.0};
  double distance_m() const { return (position_m - target_m).norm(); }
  struct Pattern {
    double square_m = 0.0, x_m = 0.0, y_m = 0.0, rotation_rad = 0.0;
  };
  std::optional<Pattern> pattern;    ///< if it is known and wholly in the image
  std::vector<std::string> assumed;  ///< unknown quantities, which take a scenario's defaults
};

/// Without a filming: a scenario's default camera, far enough away to see `range_m` of the track.
TwinView view_of(const std::optional<Filming>& filming, double reference_m, double range_m, double incline_rad);

/// Keys of [camera] except the frame rate and the exposure, then [track], [marker], [calibration], [sensor] as far as
/// they are known; each ends with a newline.
std::string camera_keys(const std::optional<Filming>& filming, const TwinView& view);
std::string scene_sections(const std::optional<Filming>& filming, const TwinView& view);

}  // namespace glidelab::diagnose
