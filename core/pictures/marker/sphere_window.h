/// The pixels around a marker that lit_sphere.h fits, each with what lies behind it: the still background of other
/// frames, or, for a marker in front of the glider, a plane through the light around it. Directions from the centre in
/// which the pixels outside the outline do not look like that (a stick, the glider's edge, a shadow) are left out.
#pragma once

#include <opencv2/core.hpp>

#include <vector>

#include "core/pictures/marker/lit_sphere.h"
#include "core/pictures/marker/still_background.h"

namespace glidelab::core {

enum class Behind {
  still,  ///< what other frames show at that place
  moving  ///< something even that moves with the marker
};

struct KnownBackground {
  cv::Rect region;  ///< of the image
  StillBackground::Part part;
  double full_code = 255.0;

  double noise() const { return part.noise / full_code; }
};

struct SphereWindow {
  std::vector<SpherePixel> pixels;
  double usable = 0.0;  ///< share of the directions
};

/// `codes` (CV_32F) is what the frame shows in the rectangle `window`. No pixels where they do not reach around the
/// marker.
SphereWindow cut_sphere_window(const cv::Mat& codes, const cv::Rect& window, const KnownBackground& background,
                               const SphereGuess& guess, Behind behind);

double radius_of(const cv::Vec3d& shape);  ///< of the circle of the same area: M as its elements uu, uv, vv

}  // namespace glidelab::core
