/// The contents of a scenario: the true motions, the changing light, and everything in front of the camera and in it.
///
/// SI units and radians; pixels where the name says so. scenario.h reads it, scenario_sections.h names its sections.
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "render/camera/camera.h"
#include "render/camera/frame_clock.h"
#include "render/camera/optics.h"
#include "render/sensor/sensor.h"
#include "render/video/video_writer.h"
#include "sim/motion/motion_scenario.h"

namespace glidelab::render {

/// A round spot of light with a Gaussian profile, added to the scene; it moves with its own velocity plus the glider's
/// motion times `follow`.
struct Reflection {
  Eigen::Vector3d position_W =
      Eigen::Vector3d::Zero();  ///< at the clip's start; with `follow`, when the glider is at x = 0
  double radius_m = 0.02;       ///< standard deviation of its profile
  double radiance = 1.0;        ///< in its middle, relative to white
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  double follow = 0.0;    ///< of the glider's displacement along the track
  bool in_front = false;  ///< of the glider; otherwise the glider hides the spot
};

/// The light of a scene, which varies from image to image and with position.
///
/// Flicker: all light is multiplied by 1 + depth cos(2 pi f t + phase), t measured from the clip's first exposure; a
/// row gets the mean over its exposure [a, a + T], 1 + depth sinc(pi f T) cos(2 pi f (a + T/2) + phase). Still images
/// do not flicker.
struct Light {
  double level = 1.0;                                        ///< of all light
  Eigen::Vector2d gradient_per_m = Eigen::Vector2d::Zero();  ///< light is multiplied by exp(gradient · (x, y)) in the
                                                             ///< world
  double flicker_depth = 0.0;                                ///< 0 to 1
  double flicker_hz = 100.0;
  double flicker_phase_rad = 0.0;
  double ring_light = 0.0;  ///< radiance that a lamp next to the lens adds to the marker at the track's reference point
  std::vector<Reflection> reflections;

  bool flickers() const { return flicker_depth > 0.0; }
};

/// At an instant.
inline double flicker_at(const Light& light, double t_s) {
  return 1.0 +
         light.flicker_depth * std::cos(2.0 * std::numbers::pi * light.flicker_hz * t_s + light.flicker_phase_rad);
}

/// The mean over [start_s, start_s + exposure_s].
inline double mean_flicker(const Light& light, double start_s, double exposure_s) {
  const double half_turn = std::numbers::pi * light.flicker_hz * exposure_s;
  const double sinc = half_turn < 1e-8 ? 1.0 : std::sin(half_turn) / half_turn;
  return 1.0 + sinc * (flicker_at(light, start_s + 0.5 * exposure_s) - 1.0);
}

/// How the images are taken: every row is exposed once every 1/rate.
struct Recording {
  double frame_rate_hz = 200.0;
  double exposure_s = 0.001;
  Shutter shutter = {};
  ClockSetup clock = {};
};

/// How bright things are in the image: a white surface in the middle of the light.
struct Exposure {
  double white_level = 0.75;              ///< its code, as a fraction of the largest code; not used if there is
  std::optional<double> white_photons_s;  ///< photons from it per pixel and second
  double quantum_efficiency = 1.0;        ///< electrons per photon
};

struct PatternSetup {
  int inner_columns = 9;
  int inner_rows = 6;
  double square_m = 0.04;
  int views = 12;
  std::vector<double> plane_x_m = {0.0};  ///< the middle of the pattern, along the track, in each view of the plane
  double plane_y_m = 0.0;                 ///< and across it, upward
  double plane_rotation_rad = 0.0;        ///< rotation relative to the track, anticlockwise as seen by the camera
};

struct MarkerSetup {
  double diameter_m = 0.02;
  double height_m = 0.0;     ///< of its centre above the pattern's plane, towards the camera
  double reflectance = 1.1;  ///< radiance relative to a white wall's; retro-reflective ones exceed white
};

struct TrackSetup {
  int downhill = 1;       ///< +1: x points to the right in the world, -1: to the left
  double length_m = 2.0;  ///< of the aluminium bar
};

struct SceneSetup {
  double wall_albedo = 0.38;
  double wall_distance_m = 0.6;  ///< behind the plane of motion
  double track_albedo = 0.5;
  double glider_albedo = 0.22;
  double glider_mass_kg = 0.335;  ///< without weights; every additional 0.1 kg is a weight visible on it
  double light_falloff = 0.12;    ///< relative darkening at 1 m from the middle of the light
};

struct PlumbSetup {
  double x_m = 0.45;
  double z_m = 0.0;
  double diameter_m = 0.003;
};

struct Scenario {
  std::filesystem::path file;
  std::uint64_t seed = 1;  ///< used if the command line gives none
  sim::MotionScenario motion;
  std::string camera_name;  ///< of the camera file; empty without one
  Camera camera;
  Vignetting vignetting;
  std::optional<Focus> focus;  ///< without it everything is sharp
  Recording recording;
  Light light;
  Mount mount;
  Sensor sensor;
  Exposure exposure;
  Codec codec = Codec::magicyuv;
  Compression compression;
  PatternSetup pattern;
  MarkerSetup marker;
  TrackSetup track;
  SceneSetup scene;
  std::optional<PlumbSetup> plumb;
};

}  // namespace glidelab::render
