/// How an image's pixels respond to an edge beyond the model of a fit: as a colour mosaic, and by a curved tone.
///
/// A colour camera interpolates the colours that a pixel lacks from its neighbours, so that each of the four places of
/// the 2 x 2 mosaic blurs the image in its own way; a tone curve makes a pixel on an edge brighter or darker than the
/// light that it received. Both are sampled after the lens, so that what they do to a sharp edge depends on where it
/// lies among the pixels, and no filter takes it out again: a small marker's centre is off by 0.02 px, a chessboard's
/// corner by 0.04 px, in a pattern that repeats with the pixels and that a motion, or the rows of a board, turn into
/// slow waves. With I the model's image before all that (its edges sharper), and for place q of the mosaic
///
///     light = I + s_q D_side I + u_q D_upright I + c_q D_corner I + C E (1 - E) (t + w (2 E - 1))
///
/// D_side I is the mean of the left and right neighbours minus the pixel, and so on: any symmetric mask of 3 x 3
/// pixels. C is the contrast and E how much of the pixel the bright side covers, after the mosaic where the window was
/// fitted with a response. `light` is the code, or its light by the sRGB curve (t and w absorb
/// its difference from that of ITU-R BT.709). The fourteen terms are the same in all windows and follow from them by
/// least squares, together with the windows' own parameters. Nothing is assumed of the camera: not which mosaic or
/// interpolation, nor that there is one.
///
/// A window is fitted without what a known response adds (added_by()) to a model of its own, or by a model that has the
/// response in it: FittedWindow says which.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/pictures/image/pixel_signal.h"

namespace glidelab::core {

struct EdgeResponse {
  static constexpr int kMaskTerms = 3, kPlaces = 4;
  static constexpr int kCurvature = kMaskTerms * kPlaces, kTwist = kCurvature + 1, kTerms = kTwist + 1;
  using Terms = Eigen::Matrix<double, kTerms, 1>;

  Terms terms = Terms::Zero();
  double narrower_px2 = 0.0;           ///< reduction of the squared blur of the edges, in I relative to the model
  ToneCurve tone = ToneCurve::linear;  ///< the fits are to the light by this tone

  double curvature() const { return terms[kCurvature]; }  ///< t
  double twist() const { return terms[kTwist]; }          ///< w
};

/// What a model gives a pixel.
struct ModelPixel {
  double light = 0.0;
  double bright = 0.0;  ///< E
};

/// A window of an image that was fitted.
struct FittedWindow {
  std::vector<cv::Point> pixels;  ///< in the image
  Eigen::VectorXd weight;
  Eigen::VectorXd light;     ///< as observed
  Eigen::VectorXd model;     ///< as fitted
  Eigen::MatrixXd jacobian;  ///< of the model by the fit's own parameters, one row a pixel; empty if not needed
  double contrast = 0.0;     ///< C
  double full = 255.0;       ///< the largest code, or its light
  bool inverse = false;      ///< `light` and `model` are `full` less what the image has
  /// E after the mosaic, if the model includes the known response (and its blur is that of I); otherwise empty.
  std::vector<double> bright;
  /// The model at a pixel of the image, with the squared blur of its edges reduced by this (px²).
  std::function<ModelPixel(cv::Point pixel, double narrower_px2)> at;
};

/// What the response adds to the fit's model, pixel by pixel: to be subtracted from the light before the next fit.
Eigen::VectorXd added_by(const EdgeResponse& response, const FittedWindow& window);

/// Fits a window (numbered from 0) to the light by a tone: as it is (null), or minus what a known response adds. Empty
/// if it cannot be fitted.
using FitWindow = std::function<std::optional<FittedWindow>(std::size_t window, ToneCurve tone, const EdgeResponse*)>;

/// The response that the windows show, in three rounds, each with the windows fitted without what the last response
/// adds. The light by the sRGB curve is used if it leaves smaller residuals, as codes and beyond their scatter from
/// window to window, or far less curvature than the codes do. Empty if too few pixels are fitted, if the response of
/// some windows does not foretell the residuals of others beyond chance, or if the rounds settle on none.
std::optional<EdgeResponse> edge_response_of(std::size_t windows, bool may_be_curved, const FitWindow& fit);

/// The light of a part of an image's codes (8 or 16 bits), as 16 bits; linear: the codes themselves.
cv::Mat light_of(const cv::Mat& codes, ToneCurve tone);

}  // namespace glidelab::core
