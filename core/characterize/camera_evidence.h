/// Reads the frames of a flat-field folder and takes the decisions behind the numbers: which pixels are outliers, which
/// cells are saturated, which levels lie in the linear range, and what the quantisation hides.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <optional>
#include <vector>

#include "base/long_work.h"
#include "core/characterize/flat_field_folder.h"
#include "core/characterize/photon_numbers.h"

namespace glidelab::core {

struct CameraEvidence {
  Evidence evidence;
  TileGrid grid{cv::Size(kSmallestFlatFieldPx, kSmallestFlatFieldPx)};
  std::size_t frames = 0;
  bool mosaic = false;
  bool dark_clipped = false;  ///< dark frames contain code 0, so that their mean and noise are clipped
  std::size_t hot_pixels = 0;
  std::size_t dead_pixels = 0;
  std::size_t outlying_pixels = 0;
  std::optional<std::size_t> middle_level;  ///< the one used nearest to 50 % of saturation
};

CameraEvidence gather_evidence(const FlatFieldFolder& folder, const base::Progress& progress);

}  // namespace glidelab::core
