/// A measured camera, the result of photon transfer, as plain data. report/ writes it as a file with the keys of a
/// scenario's [sensor], as JSON, table and page.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/characterize/camera_note.h"
#include "core/characterize/flat_field_folder.h"
#include "core/characterize/measured.h"

namespace glidelab::core {

/// One level of light in the photon-transfer diagram.
struct TransferPoint {
  std::string set;
  std::optional<double> exposure_s;
  double mean_dn = 0.0;       ///< above the dark frames; for a level in the fit over the cells that count, otherwise
                              ///< over all
  double image_dn = 0.0;      ///< above the dark frames, over the whole image
  double variance_dn2 = 0.0;  ///< quantisation (1/12) subtracted
  double sd_dn2 = 0.0;        ///< of the variance
  double at_largest = 0.0;    ///< fraction of the samples at the largest code
  bool used = false;          ///< in the fit of the line
};

struct CameraMeasurement {
  FlatFieldFolder folder;
  int width_px = 0, height_px = 0;  ///< of a frame
  std::size_t frames = 0;
  bool mosaic = false;  ///< raw codes of a colour sensor

  Measured gain_dn_per_e;
  Measured read_noise_e;
  Measured offset_dn;              ///< of the dark frames; extrapolated to zero exposure if there are several exposures
  Measured full_well_e;            ///< electrons at which the output stops rising, in the pixel or in the converter
  Measured saturation_capacity_e;  ///< EMVA 1288: where the variance is largest
  Measured dark_signal_e_s;
  Measured prnu;  ///< relative, 0.01 is 1 %
  Measured dsnu_e;
  Measured linearity_error;  ///< mean of the relative deviations from a line, 0.01 is 1 %

  std::size_t hot_pixels = 0;   ///< far above their neighbourhood in the dark
  std::size_t dead_pixels = 0;  ///< respond to light less than half as much as their neighbourhood
  std::size_t outlying_pixels =
      0;  ///< all outliers of the pattern, including hot and dead pixels; excluded from the numbers

  std::vector<TransferPoint> curve;     ///< by rising mean
  std::optional<double> intercept_dn2;  ///< of the line, at the dark level
  double saturation_dn = 0.0;           ///< above dark; the 70 % refer to it
  std::vector<CameraNote> notes;        ///< what a reader should know
};

}  // namespace glidelab::core
