/// What a scenario holds: the true motions, the light as it changes, and everything that stands before the camera and
/// in it.
///
/// SI units and radians; pixels where the name says so. scenario.h reads it, scenario_sections.h names its sections.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "render/camera/camera.h"
#include "render/camera/exposure_times.h"
#include "render/camera/optics.h"
#include "render/sensor/sensor.h"
#include "render/video/video_writer.h"
#include "sim/motion/motion_scenario.h"

namespace glidelab::render {

/// A round spot of light with a Gaussian profile, added to what stands there; it follows its own velocity, and the
/// glider's motion times `follow`.
struct Reflection {
  Eigen::Vector3d position_W =
      Eigen::Vector3d::Zero();  ///< at the clip's start; with `follow`, when the glider is at x = 0
  double radius_m = 0.02;       ///< standard deviation of its profile
  double radiance = 1.0;        ///< in its middle, of white
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  double follow = 0.0;    ///< of the glider's displacement along the track
  bool in_front = false;  ///< of the glider; else it hides the spot
};

/// The light of a scene as it changes from image to image and from place to place.
///
/// Flicker: all light is multiplied by 1 + depth cos(2 pi f t + phase), t counted from the clip's first exposure; a row
/// gets its mean over the row's exposure [a, a + T], 1 + depth sinc(pi f T) cos(2 pi f (a + T/2) + phase). Still images
/// do not flicker.
struct Light {
  double level = 1.0;                                        ///< of all light
  Eigen::Vector2d gradient_per_m = Eigen::Vector2d::Zero();  ///< light is times exp(gradient · (x, y)) in the world
  double flicker_depth = 0.0;                                ///< 0 to 1
  double flicker_hz = 100.0;
  double flicker_phase_rad = 0.0;
  double ring_light = 0.0;  ///< radiance that a lamp beside the lens adds to the marker at the track's reference point
  std::vector<Reflection> reflections;

  bool flickers() const { return flicker_depth > 0.0; }
};

/// At an instant.
double flicker_at(const Light& light, double t_s);

/// The mean over [start_s, start_s + exposure_s].
double mean_flicker(const Light& light, double start_s, double exposure_s);

/// How the images are taken: every row is exposed once every 1/rate.
struct Recording {
  double frame_rate_hz = 200.0;
  double exposure_s = 0.001;
  Shutter shutter = {};
  ClockSetup clock = {};
};

/// How bright things are in the image: a white surface in the middle of the light.
struct Exposure {
  double white_level = 0.75;              ///< its code, as part of the largest code; not looked at where there is
  std::optional<double> white_photons_s;  ///< the photons that come from it to a pixel
  double quantum_efficiency = 1.0;        ///< electrons a photon
};

struct PatternSetup {
  int inner_columns = 9;
  int inner_rows = 6;
  double square_m = 0.04;
  int views = 12;
  std::vector<double> plane_x_m = {0.0};  ///< the middle of the pattern, along the track, in each view of the plane
  double plane_y_m = 0.0;                 ///< and across it, upward
  double plane_rotation_rad = 0.0;        ///< how far it is turned off the track, anticlockwise as the camera sees it
};

struct MarkerSetup {
  double diameter_m = 0.02;
  double height_m = 0.0;     ///< its centre off the pattern's plane, towards the camera
  double reflectance = 1.1;  ///< radiance beside a white wall's; retro-reflective ones shine more than white
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
  double glider_mass_kg = 0.335;  ///< without weights; every 0.1 kg more is a weight that is seen on it
  double light_falloff = 0.12;    ///< how much darker it is 1 m off the middle of the light
};

struct PlumbSetup {
  double x_m = 0.45;
  double z_m = 0.0;
  double diameter_m = 0.003;
};

struct Scenario {
  std::filesystem::path file;
  std::uint64_t seed = 1;  ///< used where the command line gives none
  sim::MotionScenario motion;
  std::string camera_name;  ///< of the camera file; empty without one
  Camera camera;
  Vignetting vignetting;
  std::optional<Focus> focus;  ///< without it all is sharp
  Recording recording;
  Light light;
  Mount mount;
  Sensor sensor;
  Exposure exposure;
  Codec codec = Codec::ffv1;
  Compression compression;
  PatternSetup pattern;
  MarkerSetup marker;
  TrackSetup track;
  SceneSetup scene;
  std::optional<PlumbSetup> plumb;
};

}  // namespace glidelab::render
