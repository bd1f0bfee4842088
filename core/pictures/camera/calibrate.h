/// The camera from views of the calibration pattern, by least squares over all corners, with either of two lenses and
/// with the uncertainty of its terms.
#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

#include "core/pictures/board/board_views.h"
#include "core/pictures/board/corner_errors.h"
#include "core/pictures/camera/camera_model.h"
#include "core/result/analysis_note.h"

namespace glidelab::core {

/// One view: its residuals, and their derivatives with respect to its pose and to the camera's free terms.
struct ViewDerivatives {
  ViewResiduals view;
  Eigen::MatrixXd by_terms;
};

struct TermUncertainty {
  Eigen::MatrixXd covariance;  ///< of the free terms
  CornerNoise noise;
};

/// The uncertainty of a camera's terms that were fitted together with the poses of its views.
///
/// With the poses eliminated, M = J - P (P'P)^-1 P'J of every view, an error e of the corners changes the camera's
/// terms by S^-1 sum of M'e, S = sum of M'M; so their covariance is S^-1 [sum of M'V M] S^-1, V that of
/// corner_errors.h.
///
/// At least one view; all with derivatives by the same terms.
TermUncertainty uncertainty_of_terms(const std::vector<ViewDerivatives>& views);

struct Calibration {
  CameraModel camera;
  /// Of fx, fy, cx, cy, k1, k2, p1, p2, k3 (the views' poses are fitted with them); rows of terms that were left out
  /// hold only what these might be.
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();
  CornerNoise noise;  ///< of the corners, as the covariance assumes
  CornerMap rests;    ///< residuals of the fit over the image
  LensTerms lens;
  double rms_px = 0.0;  ///< per corner (distance), over the views used
  std::size_t views_used = 0;
  std::vector<Note> notes;
};

/// Whether neighbouring corners share larger errors than their own noise explains: a bent pattern, or a lens that the
/// model does not describe.
bool follows_badly(const CornerNoise& noise);

/// What a reader should know about the views used and how well they fit.
std::vector<Note> notes_on_views(const BoardViews& boards, const std::vector<const BoardView*>& used,
                                 const Calibration& calibration);

/// The camera with a pinhole lens and its distortion (camera_model.h), by least squares over all corners (Zhang 2000;
/// cv::calibrateCamera).
///
/// Parameters: fx, fy, cx, cy always; of the distortion only the terms that the views support. Starting from all five
/// (k1, k2, p1, p2, k3), k3, then the pair p1, p2, then k2, then k1 are tested: v' C^-1 v of the term with its
/// covariance C (of correlated corner errors, uncertainty_of_terms()) against 9 for one term and 11.8 for the pair
/// (three standard deviations, 0.27 %; with white errors that is the F-test of the nested models). A term below it is
/// fixed to zero and the rest fitted again; k2 is tested only without k3, k1 only without k2. So a lens without
/// distortion gets none, and no undetermined term is amplified outside the region in which the pattern was seen.
///
/// Lenses move the image's corner by a part of N(0, 0.3²) with k1, N(0, 0.2²) with k2, N(0, 0.1²) with k3. That is an
/// assumption, two to four times the largest of the three measured calibrations in scenarios/cameras (a C920: 0.07,
/// -0.10, 0.02), because wider lenses are in use. A radial term counts as far as that leaves it: with the sd s of its
/// part at the corner, v' C^-1 v and the term's value times usual² / (usual² + s²). What the views know ten times
/// better loses 1 %; noise that would bend the image's sides by half is no term.
///
/// What a term that was left out may still do is added to the covariance, so that leaving terms out makes no result
/// look more certain (left_out_terms.h, which says for which lenses this does not hold). k2 of a lens of extent
/// e is N(0, (2 e)²) at the corner and k3 N(0, e²); in the three measured calibrations k2 has 0.6 to 2 times the part
/// of k1.
///
/// Needs at least three views with a visible board; otherwise InputError, naming the images without one. A view whose
/// error is above 0.2 px and five times the median is left out (with a note).
Calibration calibrate_camera(const BoardViews& boards, double square_m);

/// The camera with a fisheye lens (camera_model.h): cv::fisheye::calibrate, with uncertainties as in
/// calibrate_camera(). Parameters: fx, fy, cx, cy always; k1 to k4 only if they are determined: from k4 down, a term
/// is tested as the radial ones there, and fixed to zero and the rest fitted again, until the first that is
/// significant; what is left out counts in the covariance as it does there, but without the lens's extent. Fisheyes
/// move the image's corner by a part of N(0, 0.15²) with k1, N(0, 0.3²), N(0, 0.5²), N(0, 0.5²) with the next: an
/// assumption, about twice the larger of two profiles for k2 to k4 (docs/reference/camera-sources.md, S23). The rows of
/// the covariance are fx, fy, cx, cy, k1, k2, k3, k4, and one of zeros. Nothing if OpenCV finds no such camera.
std::optional<Calibration> calibrate_fisheye(const BoardViews& boards, double square_m);

/// Twice the logarithm of the likelihood ratio above which a lens is modelled as a fisheye.
inline constexpr double kLeastDecisiveGain = 100.0;

/// Brown-Conrady, or a fisheye, which is tried if the image's corner is more than 0.8 focal lengths off the axis, or if
/// neighbouring corners show that Brown-Conrady does not describe the lens. With the gain g = n log(rms² / rms²) of the
/// fisheye over n coordinates (twice the logarithm of the likelihood ratio), it is taken in either of two cases:
///
/// - It explains the corners decisively better, g > kLeastDecisiveGain. So much is asked because some ten neighbouring
///   corners share their errors; how many terms either model has does not count.
/// - It explains them as well with at least two fewer terms of the distortion, and the image's corner is more than 0.8
///   focal lengths off the axis: a polynomial that mimics a fisheye where the pattern was seen goes wrong beyond. As
///   well: g > -9 for each term saved, for a term that gains less than 9 would not be kept (calibrate_camera()). One
///   term fewer does not count: whether a term near that threshold is kept is chance.
Calibration calibrate_any_lens(const BoardViews& boards, double square_m);

}  // namespace glidelab::core
