/// The experiments of blind cases: who launches what from where, what is stated of it, and what is true.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "validate/blind/case/blind_motion.h"
#include "validate/blind/case/blind_random.h"

namespace glidelab::validate {

struct BlindGroup {
  std::string name;
  double stated_rad = 0.0;
  double true_rad = 0.0;
  std::optional<double> stated_sd_rad;
};

struct BlindMass {
  double stated_kg = 0.0;
  double true_kg = 0.0;
  double sd_kg = 0.0;  ///< 0: stated exactly
};

struct BlindClip {
  std::string name;
  std::size_t group = 0, mass = 0;
  double x0_m = 0.0, v0_m_s = 0.0;
  double rate_hz = 0.0;
  std::size_t frames = 0;
};

/// What a calibration leaves open of the place that a position at x is given, x + a x + b x² + c x³: their standard
/// deviations, and the values that it has (0: none, as in tracks).
struct BlindCalibration {
  double scale_sd = 0.0, bend_sd_1_m = 0.0, cubic_sd_1_m2 = 0.0;
  double scale = 0.0, bend_1_m = 0.0, cubic_1_m2 = 0.0;
};

struct BlindDesign {
  std::vector<BlindGroup> groups;
  std::vector<BlindMass> masses;
  std::vector<BlindClip> clips;
  double k_n_s_m = 0.0;
  double mu = 0.0;
  double noise_sd_m = 0.0;
  BlindCalibration calibration;
  double gravity_m_s2 = 9.80665;
};

/// 2 to 12 clips of 0.8 to 2 s at 60 to 240 Hz, 1 to 3 masses, a level track, an inclined one or both; noise of 5 to
/// 300 µm.
BlindDesign draw_design(BlindRandom& random);

/// What one clip goes through: effects alter it before it is moved.
struct BlindFilm {
  BlindLaw law;
  std::vector<double> true_t_s;                                     ///< of each frame; stated is k / rate
  std::vector<std::function<double(double x_m, double t_s)>> seen;  ///< what camera and restitution do, in this order
  std::vector<double> off_m;                                        ///< added to each position besides the noise
};

/// Nominal: linear drag and dry friction, frames at even times, seen as it is.
BlindFilm nominal_film(const BlindDesign& design, const BlindClip& clip);

/// Positions as the camera has them, without noise; NaN where the glider has come to rest.
std::vector<double> seen_positions(const BlindClip& clip, const BlindFilm& film);

}  // namespace glidelab::validate
