#include "diagnose/pictures/twin_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/pictures/camera/restitution.h"
#include "core/result/image_record.h"

namespace glidelab::diagnose {

std::optional<NoiseLaw> noise_law(const std::vector<core::NoiseAtLevel>& levels) {
  if (levels.size() < 3) return std::nullopt;
  double w = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (const core::NoiseAtLevel& one : levels) {
    const double sd = 2.0 * one.sd_code * one.known_to;  // of the variance
    if (!(sd > 0.0)) return std::nullopt;
    const double weight = 1.0 / (sd * sd), level = one.level_code, variance = one.sd_code * one.sd_code;
    w += weight;
    x += weight * level;
    y += weight * variance;
    xx += weight * level * level;
    xy += weight * level * variance;
  }
  const double determinant = w * xx - x * x;
  if (!(determinant > 1e-9 * w * xx)) return std::nullopt;
  NoiseLaw law{(w * xy - x * y) / determinant, std::sqrt(w / determinant), (xx * y - x * xy) / determinant};
  if (law.gain_code < 0.0) {
    law.gain_code = 0.0;
    law.dark_code2 = y / w;
  } else if (law.dark_code2 < 0.0) {
    law.dark_code2 = 0.0;
    law.gain_code = xy / xx;
  }
  return law;
}

namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kField = 1.6;            // m that a scenario's own camera sees from 2.4 m
constexpr std::size_t kFewestPlaces = 8;  // from which a line is fitted
/// Code of a scenario's wall, the largest part of the resting scene: from its albedo, white level and offset.
constexpr double kLastCode = 255.0, kBlackCode = 2.0, kRange = kLastCode - kBlackCode;  // of a scenario's 8 bits
constexpr double kWallCode = 0.38 * 0.75 * kRange;
constexpr double kWellKnown = 5.0;                 // standard deviations
constexpr double kFocalOfWidth = 1.5;              // of a usual lens, if nothing is known: that of a scenario's default
                                                   // camera
constexpr double kMostRotation = 10.0 / kDegrees;  // that a scenario allows a pattern

/// y = through + x along, by least squares.
template <int n>
std::pair<Eigen::Matrix<double, n, 1>, Eigen::Matrix<double, n, 1>> line_of(
    const std::vector<double>& x, const std::vector<Eigen::Matrix<double, n, 1>>& y) {
  using Vector = Eigen::Matrix<double, n, 1>;
  double mean = 0.0, square = 0.0;
  Vector middle = Vector::Zero(), mixed = Vector::Zero();
  for (std::size_t i = 0; i < x.size(); ++i) {
    mean += x[i] / static_cast<double>(x.size());
    middle += y[i] / static_cast<double>(x.size());
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    mixed += (x[i] - mean) * (y[i] - middle);
    square += (x[i] - mean) * (x[i] - mean);
  }
  const Vector along = mixed / square;
  return {middle - mean * along, along};
}

core::CameraModel lens_of(const core::CalibrationResult& calibration, const cv::Size& size) {
  core::CameraModel camera;
  camera.fx = calibration.camera_matrix[0];
  camera.cx = calibration.camera_matrix[2];
  camera.fy = calibration.camera_matrix[4];
  camera.cy = calibration.camera_matrix[5];
  camera.size = size;
  if (calibration.distortion.size() == 4) camera.lens = core::LensKind::fisheye;
  std::copy(calibration.distortion.begin(), calibration.distortion.end(), camera.distortion.begin());
  return camera;
}

/// Lens, plane and line of motion of a clip's group; false if too little of the clip was seen.
bool lay_plane(const core::CameraAndPlanes& setting, const std::string& group, const core::ClipResult& clip,
               Filming& filming) {
  const core::PlanePose& pose = setting.restitutions.at(group).plane()->pose;
  for (int i = 0; i < 9; ++i) filming.X_CP.linear()(i / 3, i % 3) = pose.rotation.val[i];
  filming.X_CP.translation() = Eigen::Vector3d(pose.shift[0], pose.shift[1], pose.shift[2]);
  filming.lens = lens_of(*setting.calibration, *setting.size);
  const Eigen::Isometry3d X_PC = filming.X_CP.inverse();
  std::vector<double> x_m;
  std::vector<Eigen::Vector3d> places;
  for (const core::MarkerSighting& sighting : clip.sightings) {
    if (sighting.frame >= clip.motion.size() || !clip.motion[sighting.frame].measured_m) continue;
    const auto seen = filming.lens->to_normalised({sighting.u_px, sighting.v_px});
    if (!seen) continue;
    const Eigen::Vector3d eye = X_PC.translation(), ray = X_PC.linear() * Eigen::Vector3d(seen->x, seen->y, 1.0);
    x_m.push_back(*clip.motion[sighting.frame].measured_m);
    places.emplace_back(eye + (-filming.marker_height_m - eye.z()) / ray.z() * ray);
  }
  if (x_m.size() < kFewestPlaces) return false;
  std::tie(filming.through_P, filming.along_P) = line_of<3>(x_m, places);
  return true;
}

/// X_WP for a marker that moves along `along_P` towards `downhill` on a track that falls by the inclination.
Eigen::Isometry3d plane_in_world(const Filming& filming, int downhill, double reference_m, double incline_rad) {
  const Eigen::Vector3d along = Eigen::Vector3d(filming.along_P.x(), filming.along_P.y(), 0.0).normalized();
  const Eigen::Vector3d track(downhill * std::cos(incline_rad), -std::sin(incline_rad), 0.0);
  Eigen::Matrix3d in_plane, in_world;
  in_plane << along, Eigen::Vector3d::UnitZ(), along.cross(Eigen::Vector3d::UnitZ());
  in_world << track, -Eigen::Vector3d::UnitZ(), track.cross(-Eigen::Vector3d::UnitZ());
  Eigen::Isometry3d X_WP = Eigen::Isometry3d::Identity();
  X_WP.linear() = in_world * in_plane.transpose();
  const Eigen::Vector3d origin = filming.through_P + reference_m * filming.along_P;
  X_WP.translation() = X_WP.linear() * -Eigen::Vector3d(origin.x(), origin.y(), 0.0);
  return X_WP;
}

/// Whether the pattern with a border of one square is in the image.
bool wholly_seen(const Filming& filming) {
  for (const double x : {-2.0, filming.inner_columns + 1.0}) {
    for (const double y : {-2.0, filming.inner_rows + 1.0}) {
      const Eigen::Vector3d p = filming.X_CP * Eigen::Vector3d(x * filming.square_m, y * filming.square_m, 0.0);
      if (!(p.z() > 0.0)) return false;
      const cv::Point2d pixel = filming.lens->to_pixel({p.x() / p.z(), p.y() / p.z()});
      if (pixel.x < 0.0 || pixel.y < 0.0 || pixel.x > filming.width_px - 1 || pixel.y > filming.height_px - 1)
        return false;
    }
  }
  return true;
}

void place_pattern(const Filming& filming, const Eigen::Isometry3d& X_WP, double incline_rad, TwinView& view) {
  const Eigen::Vector3d middle = X_WP * Eigen::Vector3d(0.5 * (filming.inner_columns - 1) * filming.square_m,
                                                        0.5 * (filming.inner_rows - 1) * filming.square_m, 0.0);
  const double turn = -view.downhill * incline_rad;
  const Eigen::Vector3d right(std::cos(turn), std::sin(turn), 0.0), up(-std::sin(turn), std::cos(turn), 0.0);
  const Eigen::Vector3d X = X_WP.linear().col(0);
  const double rotation = std::atan2(X.dot(up), X.dot(right));
  if (std::abs(rotation) > kMostRotation || !wholly_seen(filming) || filming.inner_columns < filming.inner_rows) return;
  view.pattern = TwinView::Pattern{filming.square_m, view.downhill * middle.dot(right), middle.dot(up), rotation};
}

void look_through_lens(const Filming& filming, double reference_m, double incline_rad, TwinView& view) {
  for (const int downhill : {1, -1}) {
    const Eigen::Isometry3d X_WP = plane_in_world(filming, downhill, reference_m, incline_rad);
    const Eigen::Isometry3d X_WC = X_WP * filming.X_CP.inverse();
    // Both are the same image, one of them upside down: a camera stands upright.
    if (downhill == 1 && X_WC.linear()(1, 1) > 0.0) continue;
    view.downhill = downhill;
    view.position_m = X_WC.translation();
    const Eigen::Vector3d forward = X_WC.linear().col(2);
    view.target_m = view.position_m - view.position_m.z() / forward.z() * forward;
    const Eigen::Vector3d level = forward.cross(Eigen::Vector3d::UnitY()).normalized();
    const Eigen::Vector3d down = forward.cross(level), right = X_WC.linear().col(0);
    view.roll_rad = std::atan2(right.dot(down), right.dot(level));
    place_pattern(filming, X_WP, incline_rad, view);
    break;
  }
  view.focal_px = {filming.lens->fx, filming.lens->fy};
}

/// Straight at the line of motion, as far as one scale needs it.
void look_by_scale(const Filming& filming, double reference_m, double incline_rad, TwinView& view) {
  const double focal = kFocalOfWidth * filming.width_px;
  view.focal_px = {focal, focal};
  view.downhill = filming.along_px_m.x() < 0.0 ? -1 : 1;
  const double away = focal / filming.along_px_m.norm() + filming.marker_height_m;
  // The image's right is the world's, turned by what the track's slope there differs from the inclination.
  const Eigen::Vector2d seen = filming.along_px_m * view.downhill;
  view.roll_rad = view.downhill * incline_rad - std::atan2(seen.y(), seen.x());
  const Eigen::Vector2d middle(0.5 * (filming.width_px - 1), 0.5 * (filming.height_px - 1));
  const Eigen::Vector2d off =
      (middle - filming.through_px - reference_m * filming.along_px_m) / filming.along_px_m.norm();
  const Eigen::Vector2d turned = Eigen::Rotation2Dd(view.roll_rad) * off;
  view.target_m = {turned.x(), -turned.y(), 0.0};
  view.position_m = view.target_m + Eigen::Vector3d(0.0, 0.0, away);
  view.assumed.emplace_back("the focal length, and with it the distance");
}

/// Shot noise and the sensor's own noise from the noise as a function of level. If that cannot separate them, shot
/// noise alone, for a wall as bright as a scenario's. Rounding to whole codes contributes 1/12 to the variance.
std::string sensor_section(const Filming& filming) {
  if (filming.full_code != kLastCode || filming.lossy.value_or(false)) return "";
  const double variance = filming.noise_code * filming.noise_code - 1.0 / 12.0;
  const bool told_apart = filming.noise && filming.noise->gain_code > kWellKnown * filming.noise->gain_sd;
  const double gain = told_apart ? filming.noise->gain_code : variance / kWallCode;
  const double well_e = kRange / gain;
  if (!(gain > 0.0) || !(well_e > 10.0 && well_e < 1e7)) return "";
  const double read_code2 = told_apart ? filming.noise->at(kBlackCode) - 1.0 / 12.0 : 0.0;
  return fmt::format(
      "\n[sensor]  # a resting pixel's noise is {:.3g} codes\nfull_well_e = {:.6g}\nread_noise_e = {:.6g}\n",
      filming.noise_code, well_e, std::sqrt(std::max(0.0, read_code2)) / gain);
}

}  // namespace

std::optional<Filming> filming_of(const core::AnalysisResults& results, const std::vector<core::Experiment>& folders,
                                  int jobs) {
  std::optional<Filming> filming;
  const core::Experiment* of = nullptr;
  std::size_t i = 0;
  for (const core::Experiment& folder : folders) {
    for (const core::ClipSetup& setup : folder.clips) {
      const core::ClipResult& clip = results.clips.at(i++);
      if (!clip.images || !folder.camera || !folder.marker || clip.sightings.size() < kFewestPlaces) continue;
      if (filming) {
        filming->others = filming->others || &folder != of;
        continue;
      }
      Filming found;
      found.settings = *folder.camera;
      found.width_px = clip.images->width_px;
      found.height_px = clip.images->height_px;
      found.marker_m = folder.marker->diameter_m;
      found.marker_height_m = folder.marker->height_m;
      found.codec = clip.images->codec;
      found.lossy = clip.images->lossy;
      found.full_code = clip.images->full_code;
      found.noise_code = clip.images->noise_code;
      found.noise = noise_law(clip.images->noise_levels);
      if (folder.calibration) {
        found.inner_columns =
            std::max(folder.calibration->inner_corners.columns, folder.calibration->inner_corners.rows);
        found.inner_rows = std::min(folder.calibration->inner_corners.columns, folder.calibration->inner_corners.rows);
        found.square_m = folder.calibration->square_m;
      }
      if (folder.calibration) {
        if (!lay_plane(core::camera_and_planes_of(folder, jobs), setup.group, clip, found)) continue;
      } else {
        std::vector<double> x_m;
        std::vector<Eigen::Vector2d> pixels;
        for (const core::MarkerSighting& sighting : clip.sightings) {
          if (sighting.frame >= clip.motion.size() || !clip.motion[sighting.frame].measured_m) continue;
          x_m.push_back(*clip.motion[sighting.frame].measured_m);
          pixels.emplace_back(sighting.u_px, sighting.v_px);
        }
        if (x_m.size() < kFewestPlaces) continue;
        std::tie(found.through_px, found.along_px_m) = line_of<2>(x_m, pixels);
      }
      filming = std::move(found);
      of = &folder;
    }
  }
  return filming;
}

TwinView view_of(const std::optional<Filming>& filming, double reference_m, double range_m, double incline_rad) {
  TwinView view;
  if (!filming) {
    view.position_m.z() *= std::max(1.0, 1.2 * range_m / kField);
    view.assumed = {"the camera, except for its frame rate, because these are tracks"};
    return view;
  }
  if (filming->lens) {
    look_through_lens(*filming, reference_m, incline_rad, view);
  } else {
    look_by_scale(*filming, reference_m, incline_rad, view);
  }
  if (!view.pattern) view.assumed.emplace_back("the pattern and its place");
  if (!filming->settings.exposure_s) view.assumed.emplace_back("the exposure");
  view.assumed.emplace_back("the scene, its light and its brightness");
  if (filming->others) view.assumed.emplace_back("one camera, the first folder's, for all clips");
  return view;
}

std::string camera_keys(const std::optional<Filming>& filming, const TwinView& view) {
  std::string keys;
  if (filming) {
    keys += fmt::format("width_px = {}\nheight_px = {}\nfocal_px = [{:.9g}, {:.9g}]\n", filming->width_px,
                        filming->height_px, view.focal_px[0], view.focal_px[1]);
  }
  const auto three = [](const Eigen::Vector3d& p) { return fmt::format("[{:.9g}, {:.9g}, {:.9g}]", p[0], p[1], p[2]); };
  keys += fmt::format("position_m = {}\ntarget_m = {}\n", three(view.position_m), three(view.target_m));
  if (view.roll_rad != 0.0) keys += fmt::format("roll_deg = {:.9g}\n", view.roll_rad * kDegrees);
  if (!filming || !filming->lens) return keys;
  const core::CameraModel& lens = *filming->lens;
  const std::array<double, 5>& k = lens.distortion;
  keys += fmt::format("center_px = [{:.9g}, {:.9g}]\n", lens.cx, lens.cy);
  keys +=
      lens.lens == core::LensKind::fisheye
          ? fmt::format("lens = \"fisheye\"\ndistortion = {{ k1 = {:.9g}, k2 = {:.9g}, k3 = {:.9g}, k4 = {:.9g} }}\n",
                        k[0], k[1], k[2], k[3])
          : fmt::format("distortion = {{ k1 = {:.9g}, k2 = {:.9g}, p1 = {:.9g}, p2 = {:.9g}, k3 = {:.9g} }}\n", k[0],
                        k[1], k[2], k[3], k[4]);
  return keys;
}

std::string scene_sections(const std::optional<Filming>& filming, const TwinView& view) {
  if (!filming) return "";
  std::string text = fmt::format("\n[track]\ndownhill = \"{}\"\n", view.downhill > 0 ? "+X" : "-X");
  text +=
      fmt::format("\n[marker]\ndiameter_m = {:.9g}\nheight_m = {:.9g}\n", filming->marker_m, filming->marker_height_m);
  if (view.pattern) {
    text += fmt::format(
        "\n[calibration]\ninner_corners = [{}, {}]\nsquare_m = {:.9g}\nplane_x_m = [{:.9g}]\nplane_y_m = {:.9g}\n"
        "plane_rotation_deg = {:.9g}\n",
        filming->inner_columns, filming->inner_rows, view.pattern->square_m, view.pattern->x_m, view.pattern->y_m,
        view.pattern->rotation_rad * kDegrees);
  }
  return text + sensor_section(*filming);
}

}  // namespace glidelab::diagnose
