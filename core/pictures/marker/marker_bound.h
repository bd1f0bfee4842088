/// The least uncertainty with which a disc's centre can be measured: the Cramér-Rao bound.
///
/// For independent Gaussian noise of standard deviation s in every pixel the covariance of any unbiased estimate is at
/// least the inverse of Fisher's information F_ab = (1/s^2) sum over pixels of (dI/da)(dI/db). The disc is that of
/// marker.h: radius, blurred edge (a square pixel's exact response), brightness, and a background with a slope;
/// all eight parameters are unknown. By the symmetry of the disc only the background's slope costs the centre anything.
#pragma once

namespace glidelab::core {

struct DiscImage {
  double u = 0.0, v = 0.0;  ///< centre; only the part below a pixel matters
  double radius_px = 0.0;
  double blur_px = 0.0;
  double amplitude = 0.0;  ///< brightness above the background, in the unit of the noise
  double noise_sd = 0.0;
};

/// Least standard deviation of one coordinate (root mean square of u and v), in pixels, from the pixels within
/// `reach_px` of the centre.
double least_centre_sd_px(const DiscImage& disc, double reach_px);

}  // namespace glidelab::core
