/// Does a codec of 8 x 8 blocks show in a clip? Steps between neighbouring pixels of a row, by the column of the right
/// one modulo 8: where blocks meet they are larger than inside.
///
/// Of each column of the picture the mean over rows and frames; of the columns that are alike modulo 8 the mean of the
/// middle half, which a few upright edges in the scene do not move. z is how far column 0 stands out above the largest
/// of the other seven, over their scatter: a codec's profile is symmetric about a block's middle, so that is what
/// columns k and 8 - k differ by; and never below 2 % of the mean step, as columns of real scenes do.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <vector>

#include "core/result/picture_record.h"

namespace glidelab::core {

class BlockStepSums {
 public:
  /// Some rows of every fourth picture, all of one size.
  void add(const cv::Mat& grey);
  BlockSteps finish() const;

 private:
  std::vector<double> sums_;  ///< of each column of the picture
  double rows_ = 0.0;
  std::size_t pictures_ = 0;
};

struct BlockEdges {
  double relative = 0.0;  ///< mean step at the blocks' edges over that of the other columns, less 1
  double z = 0.0;
};

BlockEdges block_edges(const BlockSteps& steps);

/// The file says so, or its pictures have blocks beyond doubt (z above 10).
bool through_lossy_codec(const PictureRecord& record);

}  // namespace glidelab::core
