/// The light of a scene as it changes from image to image and from place to place.
///
/// Flicker: all light is multiplied by 1 + depth cos(2 pi f t + phase), t counted from the clip's first exposure; a row
/// gets its mean over the row's exposure [a, a + T], 1 + depth sinc(pi f T) cos(2 pi f (a + T/2) + phase). Still
/// images do not flicker. A reflection is a round spot of light with a Gaussian profile, added to what stands there;
/// it follows its own velocity, and the glider's motion times `follow`.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace glidelab::render {

struct Reflection {
  Eigen::Vector3d position_W =
      Eigen::Vector3d::Zero();  ///< at the clip's start; with `follow`, when the glider is at x = 0
  double radius_m = 0.02;       ///< standard deviation of its profile
  double radiance = 1.0;        ///< in its middle, of white
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  double follow = 0.0;    ///< of the glider's displacement along the track
  bool in_front = false;  ///< of the glider; else it hides the spot
};

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

}  // namespace glidelab::render
