#include "core/pictures/camera/calibrate_fisheye.h"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/calib3d.hpp>

#include "core/pictures/camera/pose_elimination.h"

namespace glidelab::core {
namespace {

constexpr double kSignificant = 3.0;  // standard deviations
constexpr int kTerms = 8;             // fx fy cx cy k1 k2 k3 k4

struct Fit {
  CameraModel camera;
  std::vector<cv::Vec3d> turns;
  std::vector<cv::Vec3d> shifts;
  double rms_px = 0.0;
};

/// Nothing where it finds no camera. `guess`: a camera to begin with; nothing: OpenCV's own guess.
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
  } catch (const cv::Exception&) {  // how OpenCV says that it found none
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
  // From OpenCV's own guess a tilted board near the image's edge may end in a false pose; the camera of the others
  // puts it right.
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
    const double sd = std::sqrt(uncertainty.covariance(last, last));
    if (last >= 4 && std::abs(fit.camera.distortion[static_cast<std::size_t>(last - 4)]) < kSignificant * sd) continue;
    Calibration calibration;
    calibration.camera = fit.camera;
    calibration.rms_px = fit.rms_px;
    calibration.noise = uncertainty.noise;
    calibration.rests = corner_map(boards.image_size, rests);
    calibration.covariance.topLeftCorner(free_terms, free_terms) = uncertainty.covariance;
    calibration.views_used = views.size();
    calibration.notes = std::move(kept.notes);
    for (std::string& note : notes_on_views(boards, views, calibration)) calibration.notes.push_back(std::move(note));
    calibration.model = fmt::format("fisheye: {}", fixed == 4   ? std::string("no terms")
                                                   : fixed == 3 ? std::string("k1")
                                                                : fmt::format("k1 to k{}", 4 - fixed));
    return calibration;
  }
}

Calibration calibrate_any_lens(const BoardViews& boards, double square_m) {
  Calibration found = calibrate_camera(boards, square_m);
  const CameraModel& camera = found.camera;
  constexpr double kWide = 0.8;  // focal lengths
  const bool wide = std::hypot(0.5 * camera.size.width / camera.fx, 0.5 * camera.size.height / camera.fy) > kWide;
  if (!wide && !follows_badly(found.noise)) return found;
  std::optional<Calibration> fisheye = calibrate_fisheye(boards, square_m);
  if (!fisheye || fisheye->views_used < found.views_used) return found;
  const double coordinates = 2.0 * static_cast<double>(found.views_used * boards.views.front().corners.points.size());
  if (coordinates * 2.0 * std::log(found.rms_px / fisheye->rms_px) < kDecisive) return found;
  fisheye->notes.push_back(fmt::format(
      "the lens is modelled as a fisheye (equidistant): corners fit to {:.2g} px, to {:.2g} px with Brown-Conrady",
      fisheye->rms_px, found.rms_px));
  return std::move(*fisheye);
}

}  // namespace glidelab::core
