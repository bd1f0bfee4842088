#include "render/scenario/scene.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "render/sensor/readout.h"

namespace glidelab::render {

double shade_of(const Eigen::Vector3d& normal_W) {
  return (kAmbient + (1.0 - kAmbient) * std::max(0.0, normal_W.dot(kToLight))) /
         (kAmbient + (1.0 - kAmbient) * kToLight.z());
}

std::vector<Eigen::Vector3d> outline_of(const Chessboard& board) {
  const double low = -(1.0 + board.border_squares) * board.square_m;
  const double right = (board.inner_columns + board.border_squares) * board.square_m;
  const double bottom = (board.inner_rows + board.border_squares) * board.square_m;
  return {board.X_WP * Eigen::Vector3d(low, low, 0), board.X_WP * Eigen::Vector3d(right, low, 0),
          board.X_WP * Eigen::Vector3d(right, bottom, 0), board.X_WP * Eigen::Vector3d(low, bottom, 0)};
}

namespace {

// The glider, as shown in figure 5 of the paper: a body of 13 cm with magnets at its ends and weights on top. Metres
// and kilograms.
constexpr double kGliderLength = 0.130;
constexpr double kGliderTop = 0.018;      // above the marker's centre
constexpr double kGliderBottom = -0.034;  // below it: the skirt hides the upper edge of the track
constexpr double kGliderDepth = 0.060;
constexpr double kWeightMass = 0.100;
constexpr double kWeightHeight = 0.009;
constexpr int kMostWeights = 8;  // visible on top of each other; heavier gliders look the same
constexpr double kTrackTop = -0.027;
constexpr double kTrackHeight = 0.048;
constexpr double kTableBelow = 0.20;  // under the reference point

struct TrackFrame {
  Eigen::Vector3d right;  // along the track, to the right in the world
  Eigen::Vector3d up;     // perpendicular to it, in the plane of motion
  double turn_rad;
};

TrackFrame track_frame(const TrackSetup& track, double incline_rad) {
  const double turn = -track.downhill * incline_rad;
  return {{std::cos(turn), std::sin(turn), 0.0}, {-std::sin(turn), std::cos(turn), 0.0}, turn};
}

double glider_front_z(const MarkerSetup& marker) {
  return marker.height_m - 0.5 * marker.diameter_m;
}

}  // namespace

Eigen::Vector3d track_direction_W(const TrackSetup& track, double incline_rad) {
  return {track.downhill * std::cos(incline_rad), -std::sin(incline_rad), 0.0};
}

Eigen::Vector3d marker_position_W(const Scenario& scenario, double incline_rad, double x_m) {
  return x_m * track_direction_W(scenario.track, incline_rad) + Eigen::Vector3d(0.0, 0.0, scenario.marker.height_m);
}

StaticScene empty_track(const Scenario& scenario, double incline_rad) {
  StaticScene scene;
  scene.wall_z_m = -scenario.scene.wall_distance_m;
  scene.wall_albedo = scenario.scene.wall_albedo;
  scene.light_falloff = scenario.scene.light_falloff;
  scene.light_gradient_per_m = scenario.light.gradient_per_m;
  const TrackFrame frame = track_frame(scenario.track, incline_rad);
  const double half_length = 0.5 * scenario.track.length_m;
  // The board of a plane view stands at z = 0 in front of the track; the glider's front overhangs it.
  const double front_z = std::min(glider_front_z(scenario.marker) - 0.006, -0.004);
  const double back_z = front_z - 0.050;
  const double middle_z = 0.5 * (front_z + back_z);
  const auto on_track = [&](double x, double y, double z) {
    return Eigen::Vector3d(x * frame.right + y * frame.up + Eigen::Vector3d(0.0, 0.0, z));
  };
  const auto add = [&](const Eigen::Vector3d& center, double turn, const Eigen::Vector3d& size, double albedo,
                       Surface surface = Surface::matt, bool casts_shadow = true) {
    scene.boxes.push_back({center, turn, 0.5 * size, albedo, surface, casts_shadow});
  };
  // The bar, a scale along its lower part, end stops with rubber.
  add(on_track(0.0, kTrackTop - 0.5 * kTrackHeight, middle_z), frame.turn_rad,
      {2.0 * half_length, kTrackHeight, front_z - back_z}, scenario.scene.track_albedo, Surface::aluminium);
  add(on_track(0.0, kTrackTop - 0.66 * kTrackHeight, front_z), frame.turn_rad,
      {2.0 * half_length - 0.02, 0.009, 0.0008}, 0.55, Surface::scale_tape, false);
  for (const double side : {-1.0, 1.0}) {
    add(on_track(side * (half_length - 0.012), kTrackTop + 0.014, middle_z), frame.turn_rad, {0.024, 0.034, 0.04},
        0.12);
    add(on_track(side * (half_length - 0.028), kTrackTop + 0.018, middle_z), frame.turn_rad, {0.010, 0.016, 0.016},
        0.06, Surface::matt, false);
  }
  // Feet from the bar down to the table.
  const double table_y = -kTableBelow;
  for (const double side : {-1.0, 1.0}) {
    const Eigen::Vector3d under = on_track(side * 0.55 * half_length, kTrackTop - kTrackHeight + 0.004, middle_z);
    const double height = std::max(0.005, under.y() - table_y);
    add({under.x(), table_y + 0.5 * height, middle_z}, 0.0, {0.022, height, 0.022}, 0.30);
    add(on_track(side * 0.55 * half_length, kTrackTop - kTrackHeight - 0.004, middle_z), frame.turn_rad,
        {0.07, 0.010, 0.060}, 0.16);
    add({under.x(), table_y + 0.006, middle_z}, 0.0, {0.11, 0.012, 0.09}, 0.14);
  }
  // The table, from the wall to a hand's breadth in front of the track.
  const double table_front = 0.22;
  add({0.0, table_y - 0.015, 0.5 * (scene.wall_z_m + table_front)}, 0.0, {6.0, 0.030, table_front - scene.wall_z_m},
      0.30, Surface::wood);
  return scene;
}

MovingBody glider(const Scenario& scenario, const StaticScene& scene, const sim::Body& body, double x_m) {
  const TrackFrame frame = track_frame(scenario.track, body.incline_rad);
  const double front_z = glider_front_z(scenario.marker);
  MovingBody moving;
  moving.direction_W = track_direction_W(scenario.track, body.incline_rad);
  const double light = light_at(scene, marker_position_W(scenario, body.incline_rad, x_m));
  Eigen::Matrix3d axes;
  axes << frame.right, frame.up, Eigen::Vector3d::UnitZ();
  const auto place = [&](double x, double y, double z) {
    return Eigen::Vector3d(x * frame.right + y * frame.up + Eigen::Vector3d(0.0, 0.0, z));
  };
  const auto box = [&](const Eigen::Vector3d& low, const Eigen::Vector3d& high, double albedo) {
    MovingBox made;
    const Eigen::Vector3d middle = 0.5 * (low + high);
    made.center_W = place(middle.x(), middle.y(), middle.z());
    made.axes_W = axes;
    made.half_m = 0.5 * (high - low);
    for (int face = 0; face < 6; ++face) {
      Eigen::Vector3d normal = axes.col(face / 2) * (face % 2 == 0 ? -1.0 : 1.0);
      made.radiance[face] = albedo * light * shade_of(normal);
    }
    return made;
  };
  const auto patch = [&](double left, double right, double bottom, double top, double albedo) {
    return Patch{{place(left, bottom, front_z), place(right, bottom, front_z), place(right, top, front_z),
                  place(left, top, front_z)},
                 albedo * light};
  };
  const double half = 0.5 * kGliderLength;
  const double albedo = scenario.scene.glider_albedo;
  MovingBox carriage = box({-half, kGliderBottom, front_z - kGliderDepth}, {half, kGliderTop, front_z}, albedo);
  carriage.patches = {
      patch(-half, half, kGliderTop - 0.0035, kGliderTop, 1.5 * albedo),       // a chamfer that catches the light
      patch(-half, half, kGliderBottom, kGliderBottom + 0.006, 0.6 * albedo),  // the skirt's lower edge
      patch(-half + 0.006, -half + 0.026, -0.024, -0.012, 0.55),               // magnets
      patch(half - 0.026, half - 0.006, -0.024, -0.012, 0.55),
      patch(-half + 0.014, -half + 0.018, -0.024, -0.012, 0.10),
      patch(half - 0.018, half - 0.014, -0.024, -0.012, 0.10),
  };
  moving.boxes.push_back(carriage);
  const long weights = std::clamp(std::lround((body.mass_kg - scenario.scene.glider_mass_kg) / kWeightMass), 0L,
                                  static_cast<long>(kMostWeights));
  for (long i = 0; i < weights; ++i) {
    const double bottom = kGliderTop + static_cast<double>(i) * kWeightHeight;
    MovingBox weight = box({0.010, bottom, front_z - 0.050}, {0.055, bottom + kWeightHeight, front_z - 0.010}, 0.42);
    const auto shine = [&](double from, double to, double value) {
      Patch seen = patch(0.010, 0.055, bottom + from, bottom + to, value);
      for (Eigen::Vector3d& corner : seen.corners_W) corner.z() = front_z - 0.010;
      return seen;
    };
    weight.patches = {shine(0.0, 0.0012, 0.12), shine(0.0065, 0.0080, 0.65)};
    moving.boxes.push_back(weight);
  }
  moving.marker = MarkerSphere{place(0.0, 0.0, scenario.marker.height_m), 0.5 * scenario.marker.diameter_m,
                               scenario.marker.reflectance * light};
  if (scenario.light.ring_light > 0.0) {
    // A lamp at the lens: its illumination falls with the square of the distance.
    const Eigen::Vector3d eye = scenario.camera.X_WC.translation();
    const double near2 = eye.squaredNorm();
    const double far2 = (eye - marker_position_W(scenario, body.incline_rad, x_m)).squaredNorm();
    moving.marker->radiance += scenario.light.ring_light * near2 / far2;
  }
  return moving;
}

Chessboard plane_board(const Scenario& scenario, std::size_t view) {
  const PatternSetup& pattern = scenario.pattern;
  const double incline = scenario.motion.configurations.front().body.incline_rad;
  const TrackFrame frame = track_frame(scenario.track, incline);
  const double turn = frame.turn_rad + pattern.plane_rotation_rad;
  Chessboard board;
  board.inner_columns = pattern.inner_columns;
  board.inner_rows = pattern.inner_rows;
  board.square_m = pattern.square_m;
  // X to the right along the track, Y downward, Z away from the camera.
  board.X_WP.linear().col(0) = Eigen::Vector3d(std::cos(turn), std::sin(turn), 0.0);
  board.X_WP.linear().col(1) = Eigen::Vector3d(std::sin(turn), -std::cos(turn), 0.0);
  board.X_WP.linear().col(2) = Eigen::Vector3d(0.0, 0.0, -1.0);
  const Eigen::Vector3d middle_P(0.5 * (pattern.inner_columns - 1) * pattern.square_m,
                                 0.5 * (pattern.inner_rows - 1) * pattern.square_m, 0.0);
  const Eigen::Vector3d middle_W =
      scenario.track.downhill * pattern.plane_x_m.at(view) * frame.right + pattern.plane_y_m * frame.up;
  board.X_WP.translation() = middle_W - board.X_WP.linear() * middle_P;
  return board;
}

PlumbLine plumb_line(const PlumbSetup& setup, const Camera& camera) {
  PlumbLine line;
  line.x_m = setup.x_m;
  line.z_m = setup.z_m;
  line.diameter_m = setup.diameter_m;
  // From above the image down to a bob that hangs slightly above the table.
  const double reach = camera.height_px / camera.focal_px.y() * (camera.X_WC.translation().z() - setup.z_m);
  line.top_y_m = camera.X_WC.translation().y() + 2.0 * reach;
  line.bottom_y_m = -kTableBelow + 0.035;
  return line;
}

std::optional<PixelRect> plumb_region(const Scenario& scenario) {
  if (!scenario.plumb) return std::nullopt;
  const Camera& camera = scenario.camera;
  const PlumbLine line = plumb_line(*scenario.plumb, camera);
  const TrackFrame frame = track_frame(scenario.track, scenario.motion.configurations.front().body.incline_rad);
  constexpr double kClearOfTrack = 0.05;  // m
  const double low_y = line.x_m * std::tan(frame.turn_rad) + kClearOfTrack;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9);
  Eigen::Vector2d high = Eigen::Vector2d::Constant(-1e9);
  constexpr int kSteps = 2000;
  for (int i = 0; i <= kSteps; ++i) {
    const double y = low_y + (line.top_y_m - low_y) * i / kSteps;
    const auto pixel = project(camera, {line.x_m, y, line.z_m});
    if (!pixel || !in_image(camera, *pixel)) continue;
    low = low.cwiseMin(*pixel);
    high = high.cwiseMax(*pixel);
  }
  if (!(high.y() - low.y() >= 40.0)) return std::nullopt;
  constexpr double kMargin = 25.0;  // px beside the line
  const int left = static_cast<int>(low.x() - kMargin);
  const int top = static_cast<int>(low.y());
  return intersection({left, top, static_cast<int>(high.x() + kMargin) - left, static_cast<int>(high.y()) - top},
                      {0, 0, camera.width_px, camera.height_px});
}

Scenario as_in_clips(const Scenario& scenario) {
  Scenario changed = scenario;
  changed.camera.focal_px *= 1.0 + scenario.mount.focal_change;
  return changed;
}

double electrons_of_white(const Scenario& scenario) {
  const Sensor& sensor = scenario.sensor;
  const Exposure& exposure = scenario.exposure;
  if (exposure.white_photons_s) {
    return scenario.light.level * *exposure.white_photons_s * exposure.quantum_efficiency *
           scenario.recording.exposure_s;
  }
  return scenario.light.level *
         (converter_code(sensor, exposure.white_level * sensor.largest_code()) - sensor.offset_dn) /
         sensor.gain_dn_per_e;
}

}  // namespace glidelab::render
