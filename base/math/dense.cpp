#include "base/math/dense.h"

#include <fmt/format.h>

#include <Eigen/Dense>

#include <stdexcept>

#include "base/errors.h"

namespace glidelab::base {

namespace {

void require_fit(bool fits, const char* verb, const MatrixView& a, const MatrixView& b) {
  if (!fits)
    throw std::invalid_argument(fmt::format("{}: {} x {} with {} x {}", verb, a.rows(), a.cols(), b.rows(), b.cols()));
}

void require_square(const char* verb, const MatrixView& a) {
  require_fit(a.rows() == a.cols(), verb, a, a);
}

}  // namespace

Eigen::MatrixXd product(const MatrixView& a, const MatrixView& b) {
  require_fit(a.cols() == b.rows(), "product", a, b);
  return a * b;
}

Eigen::MatrixXd transposed_product(const MatrixView& a, const MatrixView& b) {
  require_fit(a.rows() == b.rows(), "transposed_product", a, b);
  return a.transpose() * b;
}

Eigen::MatrixXd solve_positive(const MatrixView& a, const MatrixView& b) {
  require_square("solve_positive", a);
  require_fit(a.rows() == b.rows(), "solve_positive", a, b);
  return a.ldlt().solve(b);
}

Eigen::MatrixXd inverse_positive(const MatrixView& a) {
  return solve_positive(a, Eigen::MatrixXd::Identity(a.rows(), a.cols()));
}

Eigen::MatrixXd cholesky_lower(const MatrixView& a) {
  require_square("cholesky_lower", a);
  const Eigen::LLT<Eigen::MatrixXd> factor(a);
  if (factor.info() != Eigen::Success)
    throw NumericalError(fmt::format("a {} x {} covariance is not positive definite", a.rows(), a.cols()));
  return factor.matrixL();
}

Eigen::MatrixXd solve_lower(const MatrixView& lower, const MatrixView& b) {
  require_square("solve_lower", lower);
  require_fit(lower.rows() == b.rows(), "solve_lower", lower, b);
  return lower.triangularView<Eigen::Lower>().solve(b);
}

Eigen::MatrixXd least_squares(const MatrixView& a, const MatrixView& b) {
  require_fit(a.rows() == b.rows(), "least_squares", a, b);
  return a.colPivHouseholderQr().solve(b);
}

Eigen::MatrixXd upper_factor(const MatrixView& a) {
  require_fit(a.rows() >= a.cols(), "upper_factor", a, a);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(a);
  const Eigen::MatrixXd upper = qr.matrixQR().topRows(a.cols()).triangularView<Eigen::Upper>();
  const Eigen::VectorXd sign = upper.diagonal().array().sign();
  return sign.asDiagonal() * upper;
}

Eigen::MatrixXd orthonormal_columns(const MatrixView& a, double alike) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factor(a);
  factor.setThreshold(alike);
  return factor.householderQ() * Eigen::MatrixXd::Identity(a.rows(), factor.rank());
}

SymmetricEigen symmetric_eigen(const MatrixView& a) {
  require_square("symmetric_eigen", a);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(a);
  if (eigen.info() != Eigen::Success)
    throw NumericalError(fmt::format("the eigenvalues of a {} x {} matrix were not found", a.rows(), a.cols()));
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

}  // namespace glidelab::base
