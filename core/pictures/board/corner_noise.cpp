#include "core/pictures/board/corner_noise.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>

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
      const Eigen::MatrixXd smooth = across * field * down;
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

/// Moments of the residuals, and what white noise and K of variance 1 would make of them.
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
  const Matrix6 g = (p.transpose() * p).inverse();
  const Matrix6 pkp = p.transpose() * kp, pwp = p.transpose() * wp;
  const auto coordinates = static_cast<double>(view.residual.size());
  const double pairs = 2.0 * ((view.grid.width - 1.0) * view.grid.height + (view.grid.height - 1.0) * view.grid.width);
  moments.squares += view.residual.squaredNorm();
  moments.products += view.residual.dot(times_w(view.grid, view.residual).col(0));
  moments.white_squares += coordinates - 6.0;
  moments.white_products -= (g * pwp).trace();
  moments.correlated_squares += coordinates - (g * pkp).trace();
  moments.correlated_products += pairs * std::exp(-0.5 / (kCorrelationLength * kCorrelationLength)) -
                                 2.0 * (g * (kp.transpose() * wp)).trace() + (g * pkp * g * pwp).trace();
  moments.products_variance +=
      2.0 * (0.5 * pairs - 2.0 * (g * (wp.transpose() * wp)).trace() + (g * pwp * g * pwp).trace());
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

}  // namespace glidelab::core
