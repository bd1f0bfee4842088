#include "core/pictures/camera/calibrate.h"

#include <fmt/format.h>
#include <Eigen/Dense>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/errors.h"
#include "base/math/dense.h"
#include "base/text/number_text.h"
#include "core/pictures/camera/left_out_terms.h"

namespace glidelab::core {

TermUncertainty uncertainty_of_terms(const std::vector<ViewDerivatives>& views) {
  const Eigen::Index size = views.front().by_terms.cols();
  std::vector<ViewResiduals> residuals;
  std::vector<Eigen::MatrixXd> left;  // M
  for (const ViewDerivatives& one : views) {
    const Eigen::MatrixXd of_pose = base::transposed_product(one.view.by_pose, one.view.by_pose);
    const Eigen::MatrixXd taken_up =
        base::solve_positive(of_pose, base::transposed_product(one.view.by_pose, one.by_terms));
    left.push_back(one.by_terms - base::product(one.view.by_pose, taken_up));
    residuals.push_back(one.view);
  }
  TermUncertainty uncertainty;
  uncertainty.noise = estimate_corner_noise(residuals, static_cast<std::size_t>(size));
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(size, size), scatter = information;
  for (std::size_t i = 0; i < views.size(); ++i) {
    information += base::transposed_product(left[i], left[i]);
    scatter += base::transposed_product(left[i], times_covariance(uncertainty.noise, residuals[i].grid, left[i]));
  }
  const Eigen::MatrixXd inverse = base::inverse_positive(information);
  uncertainty.covariance = base::product(base::product(inverse, scatter), inverse);
  return uncertainty;
}

namespace {

constexpr double kSignificantOne = 9.0;      // chi^2 of one degree of freedom at 0.27 %: three standard deviations
constexpr double kSignificantPair = 11.829;  // the same of two: -2 log(0.0027)
constexpr const char* kTangential = "p1, p2";
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

/// In single precision, as OpenCV requires.
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
                                       fmt::format("views that do not determine a camera ({})", exception.err),
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
  double usual;                      // standard deviation of the relative displacement of an image's corner by this
                                     // term, over all lenses,
  double of_extent;                  // and over lenses of one extent, relative to it
};

/// The relative displacement of an image's corner by a radial term of 1.
double at_corner(const Term& term, const OpenCvCalibration& found, cv::Size size) {
  const double u = 0.5 * size.width / found.matrix.at<double>(0, 0);
  const double v = 0.5 * size.height / found.matrix.at<double>(1, 1);
  return std::pow(u * u + v * v, term.power);
}

struct SupportedFit {
  OpenCvCalibration found;
  Uncertainty uncertainty;  // includes the possible effect of terms that were left out
  LensTerms lens;
};

/// The terms that the views determine, from all five backwards (see the header).
SupportedFit fit_supported_terms(const std::vector<const BoardView*>& views, cv::Size size, double square_m) {
  const std::vector<Term> terms = {{"k3", {8}, cv::CALIB_FIX_K3, 3, 0.1, 1.0},
                                   {kTangential, {6, 7}, cv::CALIB_ZERO_TANGENT_DIST, 0, 0.0, 0.0},
                                   {"k2", {5}, cv::CALIB_FIX_K2, 2, 0.2, 2.0},
                                   {"k1", {4}, cv::CALIB_FIX_K1, 1, 0.3, 0.0}};
  int flags = 0;
  SupportedFit fit;
  fit.found = run_opencv(views, size, square_m, flags);
  fit.uncertainty = uncertainty_of(fit.found, views, square_m);
  std::vector<LeftOutTerm> left_out;
  double kept_at_corner = 0.0;
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
    const double part = is_radial ? believed(term.usual, at_corner(term, fit.found, size) * std::sqrt(own(0, 0))) : 1.0;
    const double statistic = part * value.dot(base::solve_positive(own, value).col(0));
    const double limit = count == 1 ? kSignificantOne : kSignificantPair;
    fit.lens.tests.push_back({term.name, statistic, limit});
    if (statistic > limit) {
      if (is_radial) radial = false;
      continue;
    }
    left_out.push_back({term.power, term.usual, term.of_extent, at_corner(term, fit.found, size), value, own,
                        fit.uncertainty.covariance(Eigen::all, term.places)});
    flags |= term.fixing;
    fit.found = run_opencv(views, size, square_m, flags);
    fit.uncertainty = uncertainty_of(fit.found, views, square_m);
  }
  for (const Term& term : terms) {
    if ((flags & term.fixing) != 0) continue;
    fit.lens.kept.insert(fit.lens.kept.begin(), term.name);
    if (term.power == 0) continue;
    const double value = fit.found.distortion.at<double>(static_cast<int>(term.places.front()) - 4);
    kept_at_corner += at_corner(term, fit.found, size) * std::abs(value);
  }
  fit.uncertainty.covariance += effect_of(left_out, kept_at_corner);
  return fit;
}

}  // namespace

bool follows_badly(const CornerNoise& noise) {
  return noise.correlated_px > std::max(2.0 * kLeastCorrelatedPx, 0.5 * noise.white_px);
}

std::vector<Note> notes_on_views(const BoardViews& boards, const std::vector<const BoardView*>& used,
                                 const Calibration& calibration) {
  std::vector<Note> notes;
  if (!boards.without.empty()) {
    NoPatternInSight none;
    for (const std::filesystem::path& file : boards.without) none.files.push_back(file.filename().string());
    notes.emplace_back(std::move(none));
  }
  std::size_t unrefined = 0;
  for (const BoardView* view : used) unrefined += view->corners.unrefined;
  if (unrefined > 0) notes.emplace_back(UnrefinedCorners{unrefined});
  if (follows_badly(calibration.noise)) {
    notes.emplace_back(CornersErrTogether{calibration.noise.correlated_px, calibration.noise.white_px});
  }
  const double sd_fx = std::sqrt(calibration.covariance(0, 0));
  if (sd_fx > kMostRelativeFocalSd * calibration.camera.fx) {
    notes.emplace_back(UncertainFocalLength{calibration.camera.fx, sd_fx});
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
  calibration.lens = fit.lens;
  calibration.rms_px = found.rms_px;
  calibration.views_used = used.size();
  for (Note& note : notes_on_views(boards, used, calibration)) calibration.notes.push_back(std::move(note));
  return calibration;
}

namespace {

constexpr int kTerms = 8;  // fx fy cx cy k1 k2 k3 k4
/// Standard deviations of the relative displacement of an image's corner by k1 to k4, over all fisheyes. The two
/// profiles of docs/reference/camera-sources.md (S23) displace it by 0.05, 0.15, -0.25, 0.15 and 0.23, -0.07, -0.25,
/// 0.33. k1, which any board determines, is the only one that a profile exceeds.
constexpr std::array<double, 4> kUsualFisheye{0.15, 0.3, 0.5, 0.5};

struct Fit {
  CameraModel camera;
  std::vector<cv::Vec3d> turns;
  std::vector<cv::Vec3d> shifts;
  double rms_px = 0.0;
};

/// Empty if it finds no camera. `guess`: a camera to begin with; empty: OpenCV's own guess.
std::optional<Fit> run_opencv(const std::vector<const BoardView*>& views, cv::Size size, double square_m,
                              int fixed_terms, const CameraModel* guess) {
  std::vector<std::vector<cv::Point3d>> objects;
  std::vector<std::vector<cv::Point2d>> images;
  for (const BoardView* view : views) {
    objects.push_back(pattern_points(view->corners.grid, square_m));
    images.emplace_back(view->corners.points.begin(), view->corners.points.end());
  }
  constexpr std::array<int, 4> kFixing{cv::fisheye::CALIB_FIX_K4, cv::fisheye::CALIB_FIX_K3, cv::fisheye::CALIB_FIX_K2,
                                       cv::fisheye::CALIB_FIX_K1};
  int flags = cv::fisheye::CALIB_RECOMPUTE_EXTRINSIC | cv::fisheye::CALIB_FIX_SKEW;
  for (int i = 0; i < fixed_terms; ++i) flags |= kFixing[static_cast<std::size_t>(i)];
  Fit fit;
  cv::Matx33d matrix = cv::Matx33d::eye();
  cv::Vec4d distortion;
  if (guess != nullptr) {
    flags |= cv::fisheye::CALIB_USE_INTRINSIC_GUESS;
    matrix = {guess->fx, 0.0, guess->cx, 0.0, guess->fy, guess->cy, 0.0, 0.0, 1.0};
    for (int i = 0; i < 4 - fixed_terms; ++i) distortion[i] = guess->distortion[static_cast<std::size_t>(i)];
  }
  try {
    fit.rms_px = cv::fisheye::calibrate(objects, images, size, matrix, distortion, fit.turns, fit.shifts, flags,
                                        cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 200, 1e-12));
  } catch (const cv::Exception&) {  // OpenCV's sign that it found none
    return std::nullopt;
  }
  fit.camera.lens = LensKind::fisheye;
  fit.camera.size = size;
  fit.camera.fx = matrix(0, 0);
  fit.camera.fy = matrix(1, 1);
  fit.camera.cx = matrix(0, 2);
  fit.camera.cy = matrix(1, 2);
  for (int i = 0; i < 4; ++i) fit.camera.distortion[static_cast<std::size_t>(i)] = distortion[i];
  return fit;
}

/// As believed(), of the fisheye's k1 (1) to k4.
double believed_fisheye(int term, double variance, const CameraModel& camera) {
  const double angle = std::hypot(0.5 * camera.size.width / camera.fx, 0.5 * camera.size.height / camera.fy);
  return believed(kUsualFisheye[static_cast<std::size_t>(term - 1)], std::pow(angle, 2 * term) * std::sqrt(variance));
}

/// Pixels of the pattern's corners, u and v of each.
Eigen::VectorXd projected(const CameraModel& camera, const cv::Vec3d& turn, const cv::Vec3d& shift, cv::Size grid,
                          double square_m) {
  cv::Matx33d rotation;
  cv::Rodrigues(turn, rotation);
  Eigen::VectorXd pixels(2 * grid.area());
  Eigen::Index row = 0;
  for (const cv::Point3d& point : pattern_points(grid, square_m)) {
    const cv::Vec3d p = rotation * cv::Vec3d(point) + shift;
    const cv::Point2d pixel = camera.to_pixel({p[0] / p[2], p[1] / p[2]});
    pixels[row++] = pixel.x;
    pixels[row++] = pixel.y;
  }
  return pixels;
}

/// Central differences: a step of 1e-6 radians, metres or of the distortion, and 1e-4 px of the matrix, is far above
/// rounding (1e-13 px) and its third order far below what matters.
ViewDerivatives derivatives_of(const Fit& fit, std::size_t view, const BoardCorners& corners, double square_m,
                               int free_terms) {
  const auto pixels_with = [&](int parameter, double step) {
    CameraModel camera = fit.camera;
    cv::Vec3d turn = fit.turns[view];
    cv::Vec3d shift = fit.shifts[view];
    if (parameter < 3) {
      turn[parameter] += step;
    } else if (parameter < 6) {
      shift[parameter - 3] += step;
    } else {
      Eigen::Matrix<double, 9, 1> change = Eigen::Matrix<double, 9, 1>::Zero();
      change[parameter - 6] = step;
      camera = camera.moved(change);
    }
    return projected(camera, turn, shift, corners.grid, square_m);
  };
  ViewDerivatives derivatives;
  derivatives.view.grid = corners.grid;
  derivatives.view.residual = -pixels_with(0, 0.0);
  for (std::size_t k = 0; k < corners.points.size(); ++k) {
    derivatives.view.residual[static_cast<Eigen::Index>(2 * k)] += corners.points[k].x;
    derivatives.view.residual[static_cast<Eigen::Index>(2 * k + 1)] += corners.points[k].y;
  }
  const Eigen::Index rows = derivatives.view.residual.size();
  derivatives.view.by_pose.resize(rows, 6);
  derivatives.by_terms.resize(rows, free_terms);
  for (int parameter = 0; parameter < 6 + free_terms; ++parameter) {
    const double step = parameter >= 6 && parameter < 10 ? 1e-4 : 1e-6;
    const Eigen::VectorXd column = (pixels_with(parameter, step) - pixels_with(parameter, -step)) / (2.0 * step);
    if (parameter < 6) {
      derivatives.view.by_pose.col(parameter) = column;
    } else {
      derivatives.by_terms.col(parameter - 6) = column;
    }
  }
  return derivatives;
}

/// Root mean square distance of each view's corners.
std::vector<double> view_errors_px(const Fit& fit, const std::vector<const BoardView*>& views, double square_m) {
  std::vector<double> errors_px;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const ViewDerivatives one = derivatives_of(fit, i, views[i]->corners, square_m, 0);
    errors_px.push_back(
        std::sqrt(2.0 * one.view.residual.squaredNorm() / static_cast<double>(one.view.residual.size())));
  }
  return errors_px;
}

}  // namespace

std::optional<Calibration> calibrate_fisheye(const BoardViews& boards, double square_m) {
  std::vector<const BoardView*> views = checked_views(boards);
  const auto fit_of = [&](const std::vector<const BoardView*>& some, const CameraModel* guess) {
    return run_opencv(some, boards.image_size, square_m, 0, guess);
  };
  // From OpenCV's own guess, a tilted board near the image's edge may end in a false pose; the camera fitted to the
  // others corrects it.
  const std::optional<Fit> first = fit_of(views, nullptr);
  if (!first) return std::nullopt;
  const std::optional<Fit> most =
      fit_of(without_outliers(views, view_errors_px(*first, views, square_m)).views, nullptr);
  if (!most) return std::nullopt;
  const CameraModel& guess = most->camera;
  const std::optional<Fit> all = fit_of(views, &guess);
  if (!all) return std::nullopt;
  KeptViews kept = without_outliers(views, view_errors_px(*all, views, square_m));
  views = std::move(kept.views);
  Eigen::Matrix<double, 9, 9> left_out = Eigen::Matrix<double, 9, 9>::Zero();
  for (int fixed = 0;; ++fixed) {
    const std::optional<Fit> found = run_opencv(views, boards.image_size, square_m, fixed, &guess);
    if (!found) return std::nullopt;
    const Fit& fit = *found;
    const int free_terms = kTerms - fixed;
    std::vector<ViewDerivatives> derivatives;
    std::vector<CornerRest> rests;
    for (std::size_t i = 0; i < views.size(); ++i) {
      derivatives.push_back(derivatives_of(fit, i, views[i]->corners, square_m, free_terms));
      add_rests(views[i]->corners.points, derivatives.back().view.residual, rests);
    }
    const TermUncertainty uncertainty = uncertainty_of_terms(derivatives);
    const int last = free_terms - 1;
    if (last >= 4) {
      const double value = fit.camera.distortion[static_cast<std::size_t>(last - 4)];
      const double variance = uncertainty.covariance(last, last);
      const double part = believed_fisheye(last - 3, variance, fit.camera), statistic = part * value * value / variance;
      if (statistic < kSignificantOne) {
        const Eigen::VectorXd moved = part * value / variance * uncertainty.covariance.col(last);
        const double real = std::max(0.0, 1.0 - 1.0 / std::max(statistic, 1e-300));
        left_out.topLeftCorner(free_terms, free_terms) +=
            part / variance * uncertainty.covariance.col(last) * uncertainty.covariance.col(last).transpose() +
            real * moved * moved.transpose();
        continue;
      }
    }
    Calibration calibration;
    calibration.camera = fit.camera;
    calibration.rms_px = fit.rms_px;
    calibration.noise = uncertainty.noise;
    calibration.rests = corner_map(boards.image_size, rests);
    calibration.covariance = left_out;
    calibration.covariance.topLeftCorner(free_terms, free_terms) += uncertainty.covariance;
    calibration.views_used = views.size();
    calibration.notes = std::move(kept.notes);
    for (Note& note : notes_on_views(boards, views, calibration)) calibration.notes.push_back(std::move(note));
    calibration.lens.fisheye = true;
    for (int k = 1; k <= 4 - fixed; ++k) calibration.lens.kept.push_back(fmt::format("k{}", k));
    return calibration;
  }
}

namespace {

int distortion_terms(const Calibration& calibration) {
  int terms = 0;
  for (const std::string& kept : calibration.lens.kept) terms += kept == kTangential ? 2 : 1;
  return terms;
}

}  // namespace

Calibration calibrate_any_lens(const BoardViews& boards, double square_m) {
  Calibration found = calibrate_camera(boards, square_m);
  const CameraModel& camera = found.camera;
  constexpr double kLeastWideCorner = 0.8;  // focal lengths
  constexpr int kFewerTerms = 2;            // of the distortion
  const bool wide =
      std::hypot(0.5 * camera.size.width / camera.fx, 0.5 * camera.size.height / camera.fy) > kLeastWideCorner;
  if (!wide && !follows_badly(found.noise)) return found;
  std::optional<Calibration> fisheye = calibrate_fisheye(boards, square_m);
  if (!fisheye || fisheye->views_used < found.views_used) return found;
  const double coordinates = 2.0 * static_cast<double>(found.views_used * boards.views.front().corners.points.size());
  const double gain = coordinates * 2.0 * std::log(found.rms_px / fisheye->rms_px);
  const int fewer = distortion_terms(found) - distortion_terms(*fisheye);
  const bool simpler = wide && fewer >= kFewerTerms && gain > -kSignificantOne * fewer;
  if (gain < kLeastDecisiveGain && !simpler) return found;
  fisheye->notes.emplace_back(FisheyePreferred{fisheye->rms_px, found.rms_px, gain < kLeastDecisiveGain ? fewer : 0});
  return std::move(*fisheye);
}

}  // namespace glidelab::core
