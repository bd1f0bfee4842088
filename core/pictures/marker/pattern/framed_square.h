/// Finds square markers with a dark frame and a pattern inside (AprilTag, ArUco and the like), which no search for
/// discs finds: a disc fits now this part of the pattern and now that one.
///
/// Pixels that are darker than the mean of their surroundings form regions. A region counts if its outline is nearly a
/// square of about the stated size (its side, its diagonal or the side of the paper around it), if it has holes, and if
/// its rim is darker than what lies around it. Its place is the centroid of the outline, to about a tenth of a pixel;
/// the marker's look in all frames (template_look.h) gives it to a hundredth.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <vector>

#include "core/pictures/marker/marker_path.h"
#include "core/pictures/marker/marker_windows.h"
#include "core/pictures/marker/pattern/moving_pattern.h"

namespace glidelab::core {

/// The centres of the framed squares in an image, for a marker of an expected radius (half of its stated size).
std::vector<cv::Point2d> framed_squares(const cv::Mat& grey, double radius_px);

/// Whether a framed square of about the stated size moves, from a look at every fifth frame.
class SquareWatch {
 public:
  void add(const cv::Mat& grey, std::size_t frame, const RadiusAt& radius_at);
  bool any_moves() const;

 private:
  std::vector<std::vector<cv::Point2d>> places_;  ///< of each frame looked at
  double radius_px_ = 0.0;
};

/// The framed squares that move by more than least_travel(), with their places; of those, the one that is seen in most
/// frames comes first.
std::vector<MovingPattern> moving_squares(const ClipAgain& clip, const RadiusAt& radius_at);

}  // namespace glidelab::core
