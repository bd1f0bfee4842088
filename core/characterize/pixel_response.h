/// The response of a sensor's pixels: where they saturate, their fixed pattern, and the outliers among them.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <optional>
#include <vector>

#include "core/characterize/flat_field_stack.h"

namespace glidelab::core {

/// The point of largest variance.
struct VariancePeak {
  double mean_dn = 0.0;  ///< above dark
  double step_dn = 0.0;  ///< from the nearest light level below it to the nearest above
};

/// Where the output of a camera stops rising: in a plateau of the pixel itself, or at the converter's largest code.
struct Saturation {
  double level_dn = 0.0;                     ///< above dark; the largest code if the output is not seen to stop rising
  bool converter_clips = false;              ///< codes reach the largest one
  std::optional<std::size_t> plateau_level;  ///< saturated,
  std::vector<char> plateau_cells;           ///< in these cells
  std::optional<double> top_dn;              ///< or: code at which the output is clipped
  std::optional<VariancePeak> peak;
};

/// `flats` in any order, with the same cells as `dark`.
///
/// A cell (flat_field_stack.h) is saturated at the brightest level if its temporal variance has all but vanished
/// compared with a darker level: nearly every electron above the full well is lost. If no plateau is seen and the codes
/// reach the largest one, the converter limits. EMVA standard 1288, release 3.1, also takes the level of largest
/// variance as the saturation capacity.
Saturation find_saturation(const FlatFieldStack& dark, const std::vector<FlatFieldStack>& flats, int largest_code);

/// For the pixels of a cell: n / (n - 1) times the sum of squares about their mean, after the filter. (The mean is the
/// remainder of curved shading.) The fixed pattern's variance is (squares - noise) / pixels.
struct CellPattern {
  double pixels = 0.0;
  double mean_dn = 0.0;      ///< of these pixels
  double squares_dn2 = 0.0;  ///< of the mean of the frames: pattern and remaining temporal noise
  double noise_dn2 = 0.0;    ///< of the contrast of the frames: remaining temporal noise
};

/// The fixed pattern of a sensor: the mean of frames without the shading.
///
/// Shading is removed by the high-pass of EMVA standard 1288, release 3.1 (a box of 7 x 7, then one of 11 x 11, then
/// the binomial 3 x 3, subtracted from the image), colour by colour if the sensor has a mosaic. White patterns keep the
/// fraction sum h² of their variance (h: kernel of the filter), which is divided out here, so that the variances are
/// those of the pattern itself. Patterns with structure wider than about 10 pixels count as shading.
///
/// Pixels closer to the edge than the filter's half width do not count, nor do masked ones (which are replaced by the
/// local median before filtering, so that they do not leak into their neighbours).
std::vector<CellPattern> spatial_pattern(const cv::Mat& mean_dn, const cv::Mat& contrast_dn, const TileGrid& grid,
                                         const cv::Mat& mask, bool mosaic);

/// Median of the 5 x 5 pixels around each one (of the same colour, in a mosaic).
cv::Mat neighbourhood_median(const cv::Mat& mean_dn, bool mosaic);

/// kSdOverMedian times the median of the absolute values: a standard deviation that is insensitive to outliers.
double robust_sd(const cv::Mat& deviations, const cv::Mat& mask);

/// Pixels that differ from their neighbourhood by more than this many robust standard deviations are outliers: 2 in
/// 10^9 for a normal pattern.
inline constexpr double kOutlierSd = 6.0;

/// Whether the four positions of the 2 x 2 mosaic see different brightness (by more than 5 %).
bool has_mosaic(const FlatFieldStack& flat, const FlatFieldStack& dark);

}  // namespace glidelab::core
