#include "core/pictures/board/corner_errors.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

#include "base/math/dense.h"

namespace glidelab::core {
namespace {

constexpr double kCorrelationLength = 2.0;  // squares

Eigen::MatrixXd gaussian(int size) {
  Eigen::MatrixXd k(size, size);
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) k(i, j) = std::exp(-0.5 * std::pow((i - j) / kCorrelationLength, 2));
  }
  return k;
}

/// K X: the Gaussian of a distance is one of the columns' times one of the rows'.
Eigen::MatrixXd times_k(cv::Size grid, const Eigen::MatrixXd& columns) {
  const Eigen::MatrixXd across = gaussian(grid.width), down = gaussian(grid.height);
  Eigen::MatrixXd product(columns.rows(), columns.cols());
  for (Eigen::Index c = 0; c < columns.cols(); ++c) {
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      Eigen::MatrixXd field(grid.width, grid.height);
      for (Eigen::Index k = 0; k < field.size(); ++k) field(k) = columns(2 * k + axis, c);
      const Eigen::MatrixXd smooth = base::product(base::product(across, field), down);
      for (Eigen::Index k = 0; k < field.size(); ++k) product(2 * k + axis, c) = smooth(k);
    }
  }
  return product;
}

/// W X with W_ij = 1/2 for neighbours, so that r' W r is the sum of their products.
Eigen::MatrixXd times_w(cv::Size grid, const Eigen::MatrixXd& columns) {
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(columns.rows(), columns.cols());
  const auto join = [&](int a, int b) {
    product.middleRows<2>(2 * a) += 0.5 * columns.middleRows<2>(2 * b);
    product.middleRows<2>(2 * b) += 0.5 * columns.middleRows<2>(2 * a);
  };
  for (int j = 0; j < grid.height; ++j) {
    for (int i = 0; i < grid.width; ++i) {
      if (i + 1 < grid.width) join(j * grid.width + i, j * grid.width + i + 1);
      if (j + 1 < grid.height) join(j * grid.width + i, (j + 1) * grid.width + i);
    }
  }
  return product;
}

/// Moments of the residuals, and their expectations for white noise and for K of variance 1.
struct Moments {
  double squares = 0.0, products = 0.0;
  double white_squares = 0.0, white_products = 0.0;
  double correlated_squares = 0.0, correlated_products = 0.0;
  double products_variance = 0.0;  // of the products by white noise of variance 1
};

/// With Q = P G P', G = (P'P)^-1 and M = 1 - Q: tr M = n - 6, tr WM = -tr G P'WP, tr MK = tr K - tr G P'KP,
/// tr WMKM = tr WK - 2 tr G P'KWP + tr G P'KP G P'WP, and 2 tr WMWM for the variance.
void add_view(const ViewResiduals& view, Moments& moments) {
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  const Eigen::MatrixXd p = view.by_pose;
  const Eigen::MatrixXd kp = times_k(view.grid, p), wp = times_w(view.grid, p);
  const Matrix6 g = base::inverse_positive(base::transposed_product(p, p));
  const Matrix6 pkp = base::transposed_product(p, kp), pwp = base::transposed_product(p, wp);
  const Matrix6 pkwp = base::transposed_product(kp, wp), pwwp = base::transposed_product(wp, wp);
  const auto coordinates = static_cast<double>(view.residual.size());
  const double pairs = 2.0 * ((view.grid.width - 1.0) * view.grid.height + (view.grid.height - 1.0) * view.grid.width);
  moments.squares += view.residual.squaredNorm();
  moments.products += view.residual.dot(times_w(view.grid, view.residual).col(0));
  moments.white_squares += coordinates - 6.0;
  moments.white_products -= (g * pwp).trace();
  moments.correlated_squares += coordinates - (g * pkp).trace();
  moments.correlated_products += pairs * std::exp(-0.5 / (kCorrelationLength * kCorrelationLength)) -
                                 2.0 * (g * pkwp).trace() + (g * pkp * g * pwp).trace();
  moments.products_variance += 2.0 * (0.5 * pairs - 2.0 * (g * pwwp).trace() + (g * pwp * g * pwp).trace());
}

}  // namespace

CornerNoise estimate_corner_noise(const std::vector<ViewResiduals>& views, std::size_t fitted) {
  Moments moments;
  for (const ViewResiduals& view : views) add_view(view, moments);
  // The parameters that the views share take their part of either moment.
  const double freedom = moments.white_squares;
  const double share = freedom / std::max(freedom - static_cast<double>(fitted), 1.0);
  const double squares = share * moments.squares, products = share * moments.products;
  const double white = squares / moments.white_squares;
  double correlated = 0.0;
  const double excess = products - white * moments.white_products;
  if (excess > 2.0 * white * std::sqrt(std::max(moments.products_variance, 0.0))) {
    const double determinant =
        moments.white_squares * moments.correlated_products - moments.white_products * moments.correlated_squares;
    correlated = (moments.white_squares * products - moments.white_products * squares) / determinant;
  }
  correlated = std::max(correlated, kLeastCorrelatedPx * kLeastCorrelatedPx);
  const double rest = (squares - correlated * moments.correlated_squares) / moments.white_squares;
  return {std::sqrt(std::max(rest, 0.0)), std::sqrt(correlated)};
}

Eigen::MatrixXd times_covariance(const CornerNoise& noise, cv::Size grid, const Eigen::MatrixXd& columns) {
  return noise.white_px * noise.white_px * columns + noise.correlated_px * noise.correlated_px * times_k(grid, columns);
}

namespace {

constexpr int kCellsAlongLongSide = 8;  // cells

struct Sums {
  cv::Point2d at, off;
  double squares = 0.0, count = 0.0;
};

}  // namespace

void add_rests(const std::vector<cv::Point2d>& corners, const Eigen::VectorXd& residual,
               std::vector<CornerRest>& rests) {
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const auto row = static_cast<Eigen::Index>(2 * k);
    rests.push_back({corners[k], {residual[row], residual[row + 1]}});
  }
}

CornerMap corner_map(cv::Size image, const std::vector<CornerRest>& rests) {
  const double side = static_cast<double>(std::max(image.width, image.height)) / kCellsAlongLongSide;
  const int columns = std::max(1, static_cast<int>(image.width / side));
  const int rows = std::max(1, static_cast<int>(image.height / side));
  std::vector<Sums> sums(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const auto cell = [](double at, int size, int cells) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(std::floor((at + 0.5) * cells / size)), 0, cells - 1));
  };
  for (const CornerRest& rest : rests) {
    Sums& of = sums[cell(rest.at.y, image.height, rows) * static_cast<std::size_t>(columns) +
                    cell(rest.at.x, image.width, columns)];
    of.at += rest.at;
    of.off += rest.off;
    of.squares += rest.off.dot(rest.off);
    of.count += 1.0;
  }
  CornerMap map;
  map.width_px = image.width;
  map.height_px = image.height;
  double scatter = 0.0, free = 0.0, means = 0.0;
  for (const Sums& of : sums) {
    if (of.count < 2.0) continue;
    scatter += of.squares - of.off.dot(of.off) / of.count;
    free += 2.0 * (of.count - 1.0);
    means += of.off.dot(of.off) / of.count;
    map.cells.push_back({of.at.x / of.count, of.at.y / of.count, of.off.x / of.count, of.off.y / of.count, 0.0,
                         static_cast<std::size_t>(of.count)});
  }
  if (map.cells.empty()) return map;
  map.scatter_px = std::sqrt(scatter / free);
  for (CornerCell& one : map.cells) one.sd_px = map.scatter_px / std::sqrt(static_cast<double>(one.corners));
  if (map.scatter_px > 0.0) {
    map.excess = std::sqrt(means / (2.0 * static_cast<double>(map.cells.size()))) / map.scatter_px;
  }
  return map;
}

}  // namespace glidelab::core
