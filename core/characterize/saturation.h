/// Where the output of a camera stops rising: in a plateau of the pixel itself, or at the converter's largest code.
///
/// A cell (flat_field_stack.h) is saturated at the brightest level if its temporal variance has all but vanished
/// compared with a darker level: nearly every electron above the full well is lost. If no plateau is seen and the codes
/// reach the largest one, the converter limits. EMVA standard 1288, release 3.1, also takes the level of largest
/// variance as the saturation capacity.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/characterize/flat_field_stack.h"

namespace glidelab::core {

/// Where the variance is largest.
struct VariancePeak {
  double mean_dn = 0.0;  ///< above dark
  double step_dn = 0.0;  ///< from the nearest light below it to the nearest above
};

struct Saturation {
  double level_dn = 0.0;                     ///< above dark; the largest code, where the output is not seen to stop
  bool converter_clips = false;              ///< codes reach the largest one
  std::optional<std::size_t> plateau_level;  ///< saturated,
  std::vector<char> plateau_cells;           ///< in these cells
  std::optional<double> top_dn;              ///< or: code at which the output is clipped
  std::optional<VariancePeak> peak;
};

/// `flats` in any order, with cells as those of `dark`.
Saturation find_saturation(const FlatFieldStack& dark, const std::vector<FlatFieldStack>& flats, int largest_code);

}  // namespace glidelab::core
