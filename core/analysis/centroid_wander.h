/// How far the centroid of a marker's light or colour wanders with the place in the image.
///
/// A centroid is shifted by light from one side and by what shines through at the marker's rim. A constant shift does
/// not matter; one that changes along the path (vignetting, another background, a codec that drops faint colours) is an
/// error of position that is smooth in x. It is not seen in the scatter from frame to frame. A second centroid of the
/// same pixels, with weights that are nearly equal over the marker, is shifted by another part of the same light
/// (MarkerFit::light_px is the difference). Where the two agree up to a constant, nothing wanders; how far they
/// disagree is the size of the wander of either, to within a factor of about two:
///
///     e(x) = sum over k = 1 .. 4 of c_k s cos(k pi (x - x_0) / L),    c_k of unit variance,
///
/// from x_0 over the length L of all paths. Lengths are in metres.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace glidelab::core {

struct CentroidShift {
  double x_m = 0.0;
  double shift_m = 0.0;  ///< of one centroid from the other, along x
};

inline constexpr std::size_t kWanderModes = 4;

struct CentroidWander {
  double from_m = 0.0, length_m = 0.0;
  double sd_m = 0.0;  ///< s

  /// One standard deviation of a mode, from 0.
  double at(std::size_t mode, double x_m) const;
};

/// Empty where the difference of the centroids does not change along the path by more than its scatter explains, at a
/// level of a hundredth.
std::optional<CentroidWander> centroid_wander(const std::vector<CentroidShift>& shifts);

}  // namespace glidelab::core
