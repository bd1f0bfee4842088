/// What photon transfer finds of a camera, as plain data. report/ writes it as JSON, table and page.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/characterize/flat_field_folder.h"

namespace glidelab::core {

/// A number with its standard deviation, or the reason why there is none.
struct Measured {
  std::optional<double> value;
  double sd = 0.0;
  std::string how;              ///< by which way; empty where there is only one
  std::string why;              ///< empty where there is a value
  std::optional<double> limit;  ///< where there is no value: the upper or lower limit that `why` speaks of
};

/// One level of light in the photon-transfer diagram.
struct TransferPoint {
  std::string set;
  std::optional<double> exposure_s;
  double mean_dn = 0.0;       ///< above the dark frames; of a level in the fit over the cells that count, else over all
  double picture_dn = 0.0;    ///< above the dark frames, over the whole picture
  double variance_dn2 = 0.0;  ///< quantisation (1/12) subtracted
  double sd_dn2 = 0.0;        ///< of the variance
  double at_largest = 0.0;    ///< part of the samples at the largest code
  bool used = false;          ///< in the fit of the line
};

struct CameraMeasurement {
  FlatFieldFolder folder;
  cv::Size picture;
  std::size_t frames = 0;
  bool mosaic = false;  ///< raw codes of a colour sensor

  Measured gain_dn_per_e;
  Measured read_noise_e;
  Measured offset_dn;              ///< of the dark frames; at zero exposure, where several exposures are there
  Measured full_well_e;            ///< electrons at which the output stops rising, in the pixel or in the converter
  Measured saturation_capacity_e;  ///< EMVA 1288: where the variance is largest
  Measured dark_signal_e_s;
  Measured prnu;  ///< relative, 0.01 is 1 %
  Measured dsnu_e;
  Measured linearity_error;  ///< mean of the relative deviations from a line, 0.01 is 1 %

  std::size_t hot_pixels = 0;   ///< far above their neighbourhood in the dark
  std::size_t dead_pixels = 0;  ///< answer light by less than half of what their neighbourhood does
  std::size_t outlying_pixels =
      0;  ///< all that stand out of the pattern, hot and dead ones among them; not in the numbers

  std::vector<TransferPoint> curve;     ///< by rising mean
  std::optional<double> intercept_dn2;  ///< of the line, at the dark level
  double saturation_dn = 0.0;           ///< above dark, that the 70 % refer to
  std::vector<std::string> notes;       ///< what a reader should know
};

}  // namespace glidelab::core
