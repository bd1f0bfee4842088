/// The pixels around a marker that lit_sphere.h fits, each with its background: the still one of other frames or, for a
/// marker in front of the glider, a plane through the light around it. Directions from the centre in which the pixels
/// outside the outline do not match the background (a stick, the edge of the glider, a shadow) are left out.
#pragma once

#include <opencv2/core.hpp>

#include <vector>

#include "core/pictures/marker/sphere/lit_sphere.h"
#include "core/pictures/marker/sphere/still_background.h"

namespace glidelab::core {

enum class Behind {
  still,  ///< what other frames show there
  moving  ///< an even surface that moves with the marker
};

struct KnownBackground {
  cv::Rect region;  ///< of the image
  StillBackground::Part part;
  double full_code = 255.0;

  double noise() const { return part.noise / full_code; }
};

struct SphereWindow {
  std::vector<SpherePixel> pixels;
  double usable = 0.0;  ///< part of the directions that match
};

/// `codes` (CV_32F) are the frame's codes in the rectangle `window`. No pixels if the window does not contain the whole
/// surroundings of the marker, or if no plane fits them.
SphereWindow cut_sphere_window(const cv::Mat& codes, const cv::Rect& window, const KnownBackground& background,
                               const SphereGuess& guess, Behind behind);

double radius_of(const cv::Vec3d& shape);  ///< of the circle of the same area; `shape` has the elements uu, uv, vv of M

}  // namespace glidelab::core
