/// What a scenario holds: the true motions, and everything that stands before the camera and in it. SI units and
/// radians; pixels where the name says so. scenario.h reads it, scenario_sections.h names its sections.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "render/camera/camera.h"
#include "render/camera/focus.h"
#include "render/camera/frame_clock.h"
#include "render/camera/mount.h"
#include "render/camera/shutter.h"
#include "render/camera/vignetting.h"
#include "render/scenario/light.h"
#include "render/sensor/sensor.h"
#include "render/video/video_format.h"
#include "sim/motion/motion_scenario.h"

namespace glidelab::render {

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
