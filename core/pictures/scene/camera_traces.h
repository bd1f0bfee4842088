/// Traces of the camera in a clip's pixels: noise against brightness, the blocks of a codec.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <vector>

#include "core/result/image_record.h"

namespace glidelab::core {

/// The changes of one pixel.
struct PixelChange {
  double level_code = 0.0;
  double squares = 0.0;  ///< sum of its changes' squares
  double changes = 0.0;  ///< their number
};
using PixelChanges = std::vector<PixelChange>;

/// A pixel's noise against its brightness: for a sensor without a tone curve the variance grows in proportion to the
/// level (the light's own noise) from that of the darkest.
///
/// Pixels are put into groups of equal ranges of level. A pixel's variance is half the mean square of its changes from
/// one frame to the next. How well a group's is known allows for what pixels blurred by 1 px have in common with their
/// neighbours (squares correlate by exp(-d²/2) at d px: 2 pi count as one) and successive changes (1/4 each: 1.5), and
/// for 2 % by which fitting a patch's light and place takes more from some pixels than from others.
///
/// Of the (blurred) pixels; a group whose relative standard deviation exceeds a tenth is left out.
std::vector<NoiseAtLevel> noise_by_level(const PixelChanges& pixels);

/// The steps between neighbouring pixels of a row, averaged over rows and frames for each column of the image, then
/// over the middle half of the columns that are equal modulo 8, so that a few upright edges in the scene do not matter.
/// A step's column is that of its right pixel.
class BlockStepSums {
 public:
  /// Some rows of every fourth image, all of one size.
  void add(const cv::Mat& grey);
  BlockSteps finish() const;

 private:
  std::vector<double> sums_;  ///< of each column of the image
  double rows_ = 0.0;
  std::size_t images_ = 0;
};

struct BlockEdges {
  double relative = 0.0;  ///< mean step at the blocks' edges over that of the other columns, less 1
  double z = 0.0;
};

/// Does a clip show a codec of 8 x 8 blocks? Steps, sorted by their column modulo 8, are larger where blocks meet than
/// inside them.
///
/// z is the excess of column 0 over the largest of the other seven, over their scatter: a codec's profile is symmetric
/// about the middle of a block, so the scatter is the difference of columns k and 8 - k, and at least 2 % of the mean
/// step, as in real scenes.
BlockEdges block_edges(const BlockSteps& steps);

/// BlockEdges::relative where the blocks are beyond doubt (z above 10), else 0.
double sure_block_steps(const BlockSteps& steps);

/// The file says so, or its images show blocks beyond doubt.
bool through_lossy_codec(const ImageRecord& record);

}  // namespace glidelab::core
