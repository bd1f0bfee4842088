/// The arithmetic of photon transfer: from the statistics of the frames and the decisions about them to the numbers and
/// their errors. The jackknife repeats it without one tile at a time.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "core/characterize/flat_field_stack.h"
#include "core/characterize/pixel_response.h"

namespace glidelab::core {

inline double square(double value) {
  return value * value;
}

/// Variance of rounding to integer codes.
inline constexpr double kQuantisation = 1.0 / 12.0;

/// Dark noise up to this cannot be distinguished from rounding: EMVA standard 1288 requires a variance of 0.24 DN²,
/// including the 1/12.
inline constexpr double kHiddenNoise_dn = 0.40;

/// The effect of rounding on a variance beyond adding 1/12: the amplitude of the first harmonic in the position of the
/// mean between two codes, (4 s² + 1/pi²) exp(-2 pi² spread²), for normal noise of variance s², averaged over pixels
/// whose means scatter such that all samples together have the variance spread² (both without the 1/12).
double rounding_of_variance(double variance_dn2, double spread_dn2);

/// Standard deviation of the rounding error of a mean for unknown phase: from 0.289 DN without noise down to zero.
double rounding_of_mean(double spread_dn2);

/// Everything that the numbers depend on. Choices are frozen here, so that the jackknife does not change them.
struct Evidence {
  std::vector<FlatFieldStack> darks;              ///< the first one belongs to the flat fields
  std::vector<std::optional<double>> exposure_s;  ///< of the darks
  std::vector<FlatFieldStack> flats;

  std::vector<std::vector<char>> counts;  ///< [level][cell]: not clipped, and within the linear range
  std::vector<double> weight;             ///< of each level in the line, 1/DN⁴; 0: not used
  double dark_weight = 0.0;

  bool read_noise_from_dark = false;  ///< otherwise from the line's intercept

  Saturation saturation;

  std::vector<CellPattern> dark_pattern;
  bool dark_pattern_shown = false;                     ///< above the quantisation
  std::vector<std::size_t> pattern_levels;             ///< one for EMVA's formula, several for a regression
  std::vector<std::vector<CellPattern>> flat_pattern;  ///< of those levels
  std::vector<double> pattern_weight;
};

/// NaN: not determined by this evidence.
struct PhotonNumbers {
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  double gain = kNone;
  double intercept_dn2 = kNone;
  double offset_dn = kNone;
  double dark_slope_dn_s = kNone;
  double dark_signal_e_s = kNone;
  double read_variance_e2 = kNone;
  double full_well_e = kNone;
  double saturation_capacity_e = kNone;
  double prnu_squared = kNone;
  double dsnu_squared_e2 = kNone;
};

/// One level as a point of the diagram, over the cells that count, without the tile that is left out.
struct LevelPoint {
  double pixels = 0.0;
  double mean_dn = 0.0;
  double variance_dn2 = 0.0;
  double sampling_dn4 = 0.0;  ///< variance of the variance, for normal noise
};
LevelPoint level_point(const Evidence& evidence, std::size_t level, std::optional<std::size_t> without_tile);

/// Derivatives of the line's parameters by each point, for errors common to a level.
struct LineSensitivity {
  std::vector<double> gain;  ///< one for each level, then the dark point
  std::vector<double> intercept;
};
LineSensitivity line_sensitivity(const Evidence& evidence);

PhotonNumbers photon_numbers(const Evidence& evidence, std::optional<std::size_t> without_tile = std::nullopt);

/// Standard deviations of the numbers: sqrt((T - 1) / T sum (number without tile t - mean)²).
PhotonNumbers jackknife_sd(const Evidence& evidence, std::size_t tiles);

/// Errors common to all tiles of the images, which the jackknife over tiles cannot see: the drift of the dark level
/// from frame to frame and from set to set, and what rounding to integer codes hides.
struct SharedErrors {
  double offset_dn = 0.0;  ///< standard deviations
  double dark_slope_dn_s = 0.0;
  double gain_variance = 0.0;
  double intercept_variance = 0.0;
};
SharedErrors shared_errors(const Evidence& evidence, const PhotonNumbers& numbers);

/// Variance over the pixels and frames of a cell, without that of rounding.
inline double spread_dn2(const FlatFieldStack& stack) {
  return stack.all.total_dn2 - kQuantisation;
}

}  // namespace glidelab::core
