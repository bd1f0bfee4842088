/// The centre of one marker's image, to a hundredth of a pixel, by a least-squares fit to the pixels around it, and the
/// least uncertainty that it can have.
///
/// The model is an opaque shape with a blurred edge before a sloping background:
///
///     I(p) = (b + g . d) (1 - E) + (B + a . d / r + q (1 - rho^2)) E,   E = Phi(s / sigma),   d = p - c
///
/// c centre, b and g the background and its slope, B the marker's brightness, Phi the normal distribution, sigma the
/// edge's blur (which holds the pixel's own extent), rho = |M d| with a symmetric M (1/px) whose unit level is the
/// outline (an ellipse: a sphere off the axis, a streak of motion), s = rho (1 - rho) / |M^2 d| the distance inside it
/// (exact for a circle, to first order near any outline). a and q describe a surface that is lit from one side; they
/// are used where the clip shows that they are needed. A plain centroid above a threshold follows the background's
/// slope; this does not. Pixels; the centre of the first pixel is (0, 0).
#pragma once

#include <opencv2/core.hpp>

#include <optional>
#include <vector>

#include "core/pictures/frames/frame_source.h"
#include "core/pictures/image/edge_response.h"

namespace glidelab::core {

/// One channel in which the marker is brighter than what surrounds it: the grey image, its inverse, or the likeness
/// to the marker's colour. 8 or 16 bits.
struct Signal {
  cv::Mat values;
  DrawPixels draw = {};  ///< where the pixels are made as they are looked at: before at() and values, see()

  /// The rectangle, which lies within the image, is about to be looked at.
  void see(const cv::Rect& part) const {
    if (draw) draw(part);
  }
  double at(int u, int v) const {
    return values.depth() == CV_8U ? static_cast<double>(values.at<unsigned char>(v, u))
                                   : static_cast<double>(values.at<unsigned short>(v, u));
  }
};

struct MarkerFit {
  cv::Point2d centre;
  double sd_px = 0.0;       ///< of one coordinate, from the residuals and the fit's covariance
  double radius_px = 0.0;   ///< of the circle with the outline's area
  double elongation = 1.0;  ///< long over short axis
  cv::Vec3d shape;          ///< the elements uu, uv, vv of M (1/px)
  double amplitude = 0.0;   ///< B - b, in units of the signal
  double background = 0.0;
  /// Second moments uu, uv, vv (px²) about the centre of what stands above the background in a disc a little larger
  /// than the marker: of the pixels, whatever the model makes of them.
  cv::Vec3d moments;
  /// The centroid of what stands out there, less the centre (px): where light from one side, or a background that is
  /// not even, draws a centroid.
  cv::Point2d light_px;
  double slope_u = 0.0, slope_v = 0.0;  ///< g, of the background, 1/px
  double blur_px = 0.0;                 ///< sigma
  double rms = 0.0;                     ///< of the residuals, in units of the signal
  double bic = 0.0;                     ///< Bayesian information criterion, to compare surfaces on the same window
};

enum class Surface { uniform, shaded };

/// What is known before the fit.
struct MarkerGuess {
  cv::Point2d centre;
  double radius_px = 0.0;
  double blur_px = 0.5;
  std::optional<cv::Vec3d> shape;  ///< M of the last frame's fit: a start, not a constraint
};

inline constexpr double kLargestRatio = 2.0;  ///< of the fitted radius and the expected one, or its inverse

inline bool has_expected_size(const MarkerFit& marker, const MarkerGuess& guess) {
  const double ratio = marker.radius_px / guess.radius_px;
  return ratio <= kLargestRatio && ratio >= 1.0 / kLargestRatio;
}

/// Fits the model in a window of 1.25 radii plus 2.5 px. Nothing where the window leaves the image, the fit does not
/// converge, moves by more than a radius, or ends with a shape that is not the marker's (size off by more than a factor
/// of 2, darker than its surroundings, residuals above a third of the amplitude).
std::optional<MarkerFit> fit_marker(const Signal& signal, const MarkerGuess& guess, Surface surface);

/// A window of an image around the marker, kept to be fitted again.
struct MarkerWindow {
  Signal signal;      ///< of the window
  cv::Point corner;   ///< its first pixel in the image
  MarkerGuess guess;  ///< in the window
};

/// What the pixels of these windows of one clip add to the model (core/pictures/image/edge_response.h).
std::optional<EdgeResponse> marker_response(const std::vector<MarkerWindow>& windows, Surface surface,
                                            bool may_be_curved);

/// The fit of a window to the light of its codes, without what the response adds; amplitudes in units of that light.
std::optional<MarkerFit> fit_marker(const MarkerWindow& window, Surface surface, const EdgeResponse& response);

struct DiscImage {
  double u = 0.0, v = 0.0;  ///< centre; only the part below a pixel matters
  double radius_px = 0.0;
  double blur_px = 0.0;
  double amplitude = 0.0;  ///< brightness above the background, in the unit of the noise
  double noise_sd = 0.0;
};

/// The least uncertainty with which a disc's centre can be measured, the Cramér-Rao bound: the standard deviation of
/// one coordinate (root mean square of u and v), in pixels, from the pixels within `reach_px` of the centre.
///
/// For independent Gaussian noise of standard deviation s in every pixel the covariance of any unbiased estimate is at
/// least the inverse of Fisher's information F_ab = (1/s^2) sum over pixels of (dI/da)(dI/db). The disc is that of the
/// fit: radius, blurred edge (a square pixel's exact response), brightness, and a background with a slope; all eight
/// parameters are unknown. By the symmetry of the disc only the background's slope costs the centre anything.
double least_centre_sd_px(const DiscImage& disc, double reach_px);

}  // namespace glidelab::core
