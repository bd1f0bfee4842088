/// One corner of a chessboard in an image: two crossing edges, fitted to the pixels around it to a hundredth of a
/// pixel.
#pragma once

#include <opencv2/core.hpp>

#include <optional>

#include "core/pictures/image/edge_response.h"

namespace glidelab::core {

/// What is known about a corner before the fit.
struct CornerSurroundings {
  double window_px = 0.0;  ///< radius of the pixels used, short of the nearest edge of another corner
  double angle_x = 0.0;    ///< directions of its two edges, radians from u towards v
  double angle_y = 0.0;
};

struct FittedCorner {
  cv::Point2d point;
  double sd_px = 0.0;  ///< of one coordinate, from the fit's residuals
  double left = 1.0;   ///< of the residuals' squares without a response, by the fit with it
};

/// One corner of a chessboard, by a least-squares fit of two crossing edges to the pixels around it.
///
///     I(p) = (1 + h . d) (b + a (2 E1 - 1) (2 E2 - 1)),   d = p - c,   Ei = pixel_edge(ni . d, ni, s)
///
/// with the corner c, the edges' normals n1, n2, the lens's blur s, and the light's slope h. The pixel's square is
/// averaged over exactly for each edge alone (core/pictures/image/pixel_signal.h), so that a sharp image does not pull
/// the corner towards certain phases of the pixels; where both edges cross one pixel it is exact to second order for
/// right angles. A blur of another shape keeps the image point-symmetric about c and so does not move it.
///
/// With a `response` (edge_response.h) the fit's model is the response to I and the surrounding pixels; `image` is then
/// the light by its tone (light_of()).
///
/// `image` has 8 or 16 bits. Nothing if the window is smaller than 2.5 px, or the fit does not converge, moves by half
/// the window or 3 px, or leaves residuals of a quarter of the contrast.
std::optional<FittedCorner> fit_corner(const cv::Mat& image, cv::Point2d start, const CornerSurroundings& around,
                                       const EdgeResponse* response = nullptr);

/// The same fit as a window from which a response is learnt.
std::optional<FittedWindow> corner_window(const cv::Mat& image, cv::Point2d start, const CornerSurroundings& around,
                                          const EdgeResponse* response);

}  // namespace glidelab::core
