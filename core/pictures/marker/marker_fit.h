/// The centre of a marker's image, to a hundredth of a pixel, by a least-squares fit to the pixels around it, and the
/// lowest uncertainty that it can have.
///
/// The model is an opaque shape with a blurred edge in front of a sloping background:
///
///     I(p) = (b + g . d) (1 - E) + (B + a . d / r + q (1 - rho^2)) E,   E = Phi(s / sigma),   d = p - c
///
/// Here c is the centre, b and g are the background and its slope, B is the brightness of the marker and Phi the normal
/// distribution. sigma is the blur of the edge; E is averaged over the square pixel
/// (core/pictures/image/pixel_signal.h). rho = |M d| with a symmetric M (1/px), and rho = 1 is the outline: an ellipse,
/// since the marker may be a sphere off the axis or a streak of motion. s = rho (1 - rho) / |M^2 d| is the distance
/// inside the outline (exact for a circle, to first order near any outline). a and q describe a surface that is lit
/// from one side; they are fitted if the clip shows that they are needed. A centroid above a threshold follows the
/// slope of the background; this fit does not. Lengths are in pixels, and the centre of the first pixel is (0, 0).
#pragma once

#include <opencv2/core.hpp>

#include <optional>
#include <vector>

#include "core/pictures/frames/frame_source.h"
#include "core/pictures/image/edge_response.h"

namespace glidelab::core {

/// One channel, of 8 or 16 bits, in which the marker is brighter than its surroundings: the grey image, its inverse, or
/// the likeness to the marker's colour.
struct Signal {
  cv::Mat values;
  DrawPixels draw = {};  ///< for pixels that are made on demand: call see() before at() or `values`
  bool inverse = false;  ///< the values are the largest code less the image's

  /// Makes the pixels of a rectangle within the image.
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
  double radius_px = 0.0;   ///< of the circle with the area of the outline
  double elongation = 1.0;  ///< ratio of the long axis to the short one
  cv::Vec3d shape;          ///< the elements uu, uv, vv of M (1/px)
  double amplitude = 0.0;   ///< B - b, in units of the signal
  double background = 0.0;
  /// Second moments uu, uv, vv (px²) about the centre, weighted by the signal above the background, in a disc a little
  /// larger than the marker. They are those of the pixels, not of the model.
  cv::Vec3d moments;
  /// The centroid of that signal, less the centre (px): how far light from one side or an uneven background shifts a
  /// centroid. Where the centre is a centroid: less the one with nearly equal weights over the marker.
  cv::Point2d light_px;
  double slope_u = 0.0, slope_v = 0.0;  ///< g, in units of the signal per px
  double blur_px = 0.0;                 ///< sigma
  double rms = 0.0;                     ///< root mean square of the residuals, in units of the signal
  cv::Vec3d shade;                      ///< a and q over the amplitude; 0 for a uniform surface
  double bic = 0.0;                     ///< Bayesian information criterion, to compare surfaces on the same window
};

enum class Surface { uniform, shaded };

/// What is known before a fit.
struct MarkerGuess {
  cv::Point2d centre;
  double radius_px = 0.0;
  double blur_px = 0.5;
  std::optional<cv::Vec3d> shape;  ///< M of the last frame's fit: a starting point, not a constraint
};

inline constexpr double kLargestRatio = 2.0;  ///< of the fitted radius to the expected one, or the inverse

inline bool has_expected_size(const MarkerFit& marker, const MarkerGuess& guess) {
  const double ratio = marker.radius_px / guess.radius_px;
  return ratio <= kLargestRatio && ratio >= 1.0 / kLargestRatio;
}

/// Fits the model in a window with a radius of 1.25 marker radii plus 2.5 px. Empty if the window leaves the image, if
/// the fit does not converge or moves by more than a radius (at least 1.5 px), or if the result is no marker: a radius
/// off by more than a factor of 2, darker than its surroundings, or residuals above a third of the amplitude.
std::optional<MarkerFit> fit_marker(const Signal& signal, const MarkerGuess& guess, Surface surface);

/// A window of an image around the marker, kept for a second fit.
struct MarkerWindow {
  Signal signal;      ///< the pixels of the window
  cv::Point corner;   ///< its first pixel in the image
  MarkerGuess guess;  ///< in pixels of the window
};

/// What the pixels of these windows of one clip add to the model (core/pictures/image/edge_response.h). Empty if the
/// windows show no such response.
std::optional<EdgeResponse> marker_response(const std::vector<MarkerWindow>& windows, Surface surface,
                                            bool may_be_curved);

/// The fit of a window to the light of its codes, without what the response adds. Amplitudes are in units of that
/// light.
std::optional<MarkerFit> fit_marker(const MarkerWindow& window, Surface surface, const EdgeResponse& response);

struct DiscImage {
  double u = 0.0, v = 0.0;  ///< centre; only the part below a pixel matters
  double radius_px = 0.0;
  double blur_px = 0.0;
  double amplitude = 0.0;  ///< brightness above the background, in the unit of the noise
  double noise_sd = 0.0;
};

/// The Cramér-Rao bound on the centre of a disc: the lowest standard deviation of one coordinate (root mean square of u
/// and v), in pixels, from the pixels within `reach_px` of the centre.
///
/// For independent Gaussian noise of standard deviation s in every pixel, the covariance of any unbiased estimate is at
/// least the inverse of the Fisher information F_ab = (1/s^2) sum over pixels of (dI/da)(dI/db). The disc is that of
/// the fit: centre, radius, blurred edge (with the exact response of a square pixel), brightness, and a background with
/// a slope. All eight parameters are unknown; by the symmetry of the disc, only the slope of the background adds to the
/// uncertainty of the centre.
double least_centre_sd_px(const DiscImage& disc, double reach_px);

}  // namespace glidelab::core
