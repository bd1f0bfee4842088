#include "core/pictures/camera/calibrate.h"

#include <fmt/format.h>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>

#include "base/errors.h"
#include "base/math/dense.h"
#include "base/text/number_text.h"
#include "core/pictures/camera/pose_elimination.h"

namespace glidelab::core {
namespace {

constexpr double kSignificantOne = 9.0;        // chi^2 of one degree of freedom at 0.27 %: three standard deviations
constexpr double kSignificantPair = 11.829;    // the same of two: -2 log(0.0027)
constexpr double kMostRelativeFocalSd = 0.02;  // of the focal length: a standard deviation that is worth a note

struct OpenCvCalibration {
  cv::Mat matrix;
  cv::Mat distortion;
  cv::Mat sd;          // fx fy cx cy k1 k2 p1 p2 k3 …
  cv::Mat view_error;  // rms of the distances
  std::vector<cv::Mat> turns;
  std::vector<cv::Mat> shifts;
  double rms_px = 0.0;
};

/// In single precision, as OpenCV takes them.
std::vector<cv::Point3f> points_for_opencv(cv::Size grid, double square_m) {
  const std::vector<cv::Point3d> points = pattern_points(grid, square_m);
  return {points.begin(), points.end()};
}

OpenCvCalibration run_opencv(const std::vector<const BoardView*>& views, cv::Size size, double square_m, int flags) {
  std::vector<std::vector<cv::Point3f>> objects;
  std::vector<std::vector<cv::Point2f>> images;
  for (const BoardView* view : views) {
    objects.push_back(points_for_opencv(view->corners.grid, square_m));
    images.emplace_back(view->corners.points.begin(), view->corners.points.end());
  }
  OpenCvCalibration found;
  const cv::TermCriteria thorough(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-12);
  try {
    found.rms_px = cv::calibrateCamera(objects, images, size, found.matrix, found.distortion, found.turns, found.shifts,
                                       found.sd, cv::noArray(), found.view_error, flags, thorough);
  } catch (const cv::Exception& exception) {
    throw base::InputError(base::Issue{views.front()->file.parent_path().string(), 0, "",
                                       fmt::format("views that give no camera ({})", exception.err),
                                       "views of the pattern from different sides"});
  }
  return found;
}

struct Uncertainty {
  Eigen::Matrix<double, 9, 9> covariance;
  CornerNoise noise;
  std::vector<CornerRest> rests;
};

Uncertainty uncertainty_of(const OpenCvCalibration& found, const std::vector<const BoardView*>& views,
                           double square_m) {
  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, 15, Eigen::RowMajor>;
  std::vector<int> free;
  for (int k = 0; k < 9; ++k) {
    if (found.sd.at<double>(k) > 0.0) free.push_back(k);  // OpenCV says 0 of a fixed term
  }
  Uncertainty uncertainty;
  std::vector<ViewDerivatives> derivatives;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const BoardCorners& corners = views[i]->corners;
    std::vector<cv::Point3d> points;
    for (const cv::Point3f& point : points_for_opencv(corners.grid, square_m)) points.emplace_back(point);
    std::vector<cv::Point2d> projected;
    cv::Mat derivative;  // rows u, v of each point; columns turn, shift, f, c, k1, k2, p1, p2, k3
    cv::projectPoints(points, found.turns[i], found.shifts[i], found.matrix, found.distortion, projected, derivative);
    const Eigen::Map<const Jacobian, 0, Eigen::OuterStride<>> jacobian(
        derivative.ptr<double>(), derivative.rows, 15,
        Eigen::OuterStride<>(static_cast<Eigen::Index>(derivative.step1())));
    ViewResiduals view{corners.grid, Eigen::VectorXd(derivative.rows), jacobian.leftCols<6>()};
    for (std::size_t k = 0; k < points.size(); ++k) {
      view.residual[static_cast<Eigen::Index>(2 * k)] = corners.points[k].x - projected[k].x;
      view.residual[static_cast<Eigen::Index>(2 * k + 1)] = corners.points[k].y - projected[k].y;
    }
    add_rests(corners.points, view.residual, uncertainty.rests);
    derivatives.push_back({std::move(view), jacobian.rightCols<9>()(Eigen::all, free)});
  }
  const TermUncertainty terms = uncertainty_of_terms(derivatives);
  uncertainty.noise = terms.noise;
  uncertainty.covariance.setZero();
  uncertainty.covariance(free, free) = terms.covariance;
  return uncertainty;
}

/// A term of the distortion, or a pair, that the views may not support.
struct Term {
  const char* name;
  std::vector<Eigen::Index> places;  // of fx fy cx cy k1 k2 p1 p2 k3
  int fixing;                        // OpenCV's flag
  int power;                         // of r², of a radial term
  double usual;                      // by which part lenses move an image's corner with it: a standard deviation
};

/// The part of a radial term's size that is left where lenses' sizes are N(0, usual²) at the corner: usual² /
/// (usual² + sd²).
double believed(const Term& term, double variance, const OpenCvCalibration& found, cv::Size size) {
  const double u = 0.5 * size.width / found.matrix.at<double>(0, 0);
  const double v = 0.5 * size.height / found.matrix.at<double>(1, 1);
  const double at_corner = std::pow(u * u + v * v, term.power);
  const double usual = term.usual * term.usual;
  return usual / (usual + variance * at_corner * at_corner);
}

struct SupportedFit {
  OpenCvCalibration found;
  Uncertainty uncertainty;  // with what terms that were left out may still do
  std::string model;
};

/// The terms that the views determine, from all five backwards (see the header).
SupportedFit fit_supported_terms(const std::vector<const BoardView*>& views, cv::Size size, double square_m) {
  const std::vector<Term> terms = {{"k3", {8}, cv::CALIB_FIX_K3, 3, 0.1},
                                   {"p1, p2", {6, 7}, cv::CALIB_ZERO_TANGENT_DIST, 0, 0.0},
                                   {"k2", {5}, cv::CALIB_FIX_K2, 2, 0.2},
                                   {"k1", {4}, cv::CALIB_FIX_K1, 1, 0.3}};
  int flags = 0;
  SupportedFit fit;
  fit.found = run_opencv(views, size, square_m, flags);
  fit.uncertainty = uncertainty_of(fit.found, views, square_m);
  Eigen::Matrix<double, 9, 9> left_out = Eigen::Matrix<double, 9, 9>::Zero();
  std::vector<std::string> tests;
  bool radial = true;  // the next radial term may be tested
  for (const Term& term : terms) {
    const bool is_radial = term.places.size() == 1;
    if (is_radial && !radial) continue;
    const auto count = static_cast<Eigen::Index>(term.places.size());
    Eigen::VectorXd value(count);
    for (Eigen::Index i = 0; i < count; ++i) {  // OpenCV keeps k1 k2 p1 p2 k3 apart from the matrix
      value[i] = fit.found.distortion.at<double>(static_cast<int>(term.places[static_cast<std::size_t>(i)]) - 4);
    }
    const Eigen::MatrixXd own = fit.uncertainty.covariance(term.places, term.places);
    const Eigen::MatrixXd with_others = fit.uncertainty.covariance(Eigen::all, term.places);
    const Eigen::VectorXd weighted = base::solve_positive(own, value);
    const double part = is_radial ? believed(term, own(0, 0), fit.found, size) : 1.0;
    const double statistic = part * value.dot(weighted);
    const double limit = count == 1 ? kSignificantOne : kSignificantPair;
    tests.push_back(
        fmt::format("{}: {} of {}", term.name, base::number_text(statistic, 3), base::number_text(limit, 3)));
    if (statistic > limit) {
      if (is_radial) radial = false;
      continue;
    }
    const Eigen::VectorXd moved = part * base::product(with_others, weighted);
    const double real = std::max(0.0, 1.0 - static_cast<double>(count) / std::max(statistic, 1e-300));
    left_out += part * base::product(with_others, base::solve_positive(own, with_others.transpose())) +
                real * base::product(moved, moved.transpose());
    flags |= term.fixing;
    fit.found = run_opencv(views, size, square_m, flags);
    fit.uncertainty = uncertainty_of(fit.found, views, square_m);
  }
  fit.uncertainty.covariance += left_out;
  std::vector<std::string> kept;
  for (const Term& term : terms) {
    if ((flags & term.fixing) == 0) kept.insert(kept.begin(), term.name);
  }
  fit.model = fmt::format("distortion: {} (χ² of each term tested, and the threshold to keep it: {})",
                          kept.empty() ? "none" : fmt::format("{}", fmt::join(kept, ", ")), fmt::join(tests, "; "));
  return fit;
}

}  // namespace

bool follows_badly(const CornerNoise& noise) {
  return noise.correlated_px > std::max(2.0 * kLeastCorrelatedPx, 0.5 * noise.white_px);
}

std::vector<std::string> notes_on_views(const BoardViews& boards, const std::vector<const BoardView*>& used,
                                        const Calibration& calibration) {
  std::vector<std::string> notes;
  if (!boards.without.empty()) {
    notes.push_back("no pattern in sight in " + names_of(boards.without));
  }
  std::size_t unrefined = 0;
  for (const BoardView* view : used) unrefined += view->corners.unrefined;
  if (unrefined > 0) {
    notes.push_back(unrefined == 1
                        ? "one corner could not be refined and keeps the detector's position"
                        : fmt::format("{} corners could not be refined and keep the detector's position", unrefined));
  }
  if (follows_badly(calibration.noise)) {
    notes.push_back(fmt::format(
        "neighbouring corners share an error of {:.2g} px (each has {:.2g} px of its own): the pattern is bent, or "
        "the model does not describe the lens; the uncertainties allow for it",
        calibration.noise.correlated_px, calibration.noise.white_px));
  }
  const double sd_fx = std::sqrt(calibration.covariance(0, 0));
  if (sd_fx > kMostRelativeFocalSd * calibration.camera.fx) {
    notes.push_back(
        fmt::format("the views hardly determine the focal length ({:.5g} px, sd {:.3g} px): tilt the pattern more",
                    calibration.camera.fx, sd_fx));
  }
  return notes;
}

Calibration calibrate_camera(const BoardViews& boards, double square_m) {
  Calibration calibration;
  std::vector<const BoardView*> used = checked_views(boards);
  SupportedFit fit = fit_supported_terms(used, boards.image_size, square_m);
  const std::vector<double> errors(fit.found.view_error.begin<double>(), fit.found.view_error.end<double>());
  KeptViews kept = without_outliers(used, errors);
  calibration.notes = std::move(kept.notes);
  if (kept.views.size() < used.size()) {
    used = std::move(kept.views);
    fit = fit_supported_terms(used, boards.image_size, square_m);
  }
  const OpenCvCalibration& found = fit.found;

  CameraModel& camera = calibration.camera;
  camera.size = boards.image_size;
  camera.fx = found.matrix.at<double>(0, 0);
  camera.fy = found.matrix.at<double>(1, 1);
  camera.cx = found.matrix.at<double>(0, 2);
  camera.cy = found.matrix.at<double>(1, 2);
  for (int i = 0; i < 5; ++i) camera.distortion[static_cast<std::size_t>(i)] = found.distortion.at<double>(i);
  calibration.covariance = fit.uncertainty.covariance;
  calibration.noise = fit.uncertainty.noise;
  calibration.rests = corner_map(boards.image_size, fit.uncertainty.rests);
  calibration.model = fit.model;
  calibration.rms_px = found.rms_px;
  calibration.views_used = used.size();
  for (std::string& note : notes_on_views(boards, used, calibration)) calibration.notes.push_back(std::move(note));
  return calibration;
}

}  // namespace glidelab::core
