#include "base/math/dense.h"

#include <cmath>
#include <stdexcept>

#include "base/errors.h"
#include "tests/catch.h"

using namespace glidelab::base;

namespace {

// Small integers: products are exact; a decomposition of a matrix with condition number below 100 keeps 1e-13.
constexpr double kRounding = 1e-13;

double largest(const Eigen::MatrixXd& m) {
  return m.cwiseAbs().maxCoeff();
}

Eigen::MatrixXd positive() {
  Eigen::MatrixXd a(3, 3);
  a << 4, 2, 0, 2, 5, 1, 0, 1, 3;
  return a;
}

}  // namespace

TEST_CASE("products of whole numbers are exact, entry by entry") {
  Eigen::MatrixXd a(2, 3);
  a << 1, 2, 3, 4, 5, 6;
  Eigen::MatrixXd b(3, 2);
  b << 7, 8, 9, 10, 11, 12;
  Eigen::MatrixXd by_hand(2, 2);
  by_hand << 58, 64, 139, 154;
  CHECK(largest(product(a, b) - by_hand) == 0.0);
  CHECK(largest(transposed_product(a.transpose(), b) - by_hand) == 0.0);
}

TEST_CASE("a positive definite system is solved, also when the upper triangle holds something else") {
  const Eigen::MatrixXd a = positive();
  Eigen::MatrixXd x(3, 1);
  x << 1, -2, 3;
  Eigen::MatrixXd lower = a;
  lower(0, 1) = lower(0, 2) = lower(1, 2) = 99;
  CHECK(largest(solve_positive(lower, product(a, x)) - x) < kRounding);
  CHECK(largest(product(a, inverse_positive(lower)) - Eigen::MatrixXd::Identity(3, 3)) < kRounding);
  const Eigen::MatrixXd l = cholesky_lower(lower);
  CHECK(largest(product(l, l.transpose()) - a) < kRounding);
}

TEST_CASE("a triangular system is solved from its lower triangle alone") {
  Eigen::MatrixXd lower(3, 3), x(3, 2), b(3, 2);
  lower << 2, 99, 99, -1, 4, 99, 3, 5, -2;
  x << 1, -3, 2, 5, -4, 0.5;
  b << 2, -6, 7, 23, 21, 15;  // by hand
  CHECK(largest(solve_lower(lower, b) - x) < kRounding);
  CHECK_THROWS_AS(solve_lower(lower, b.topRows(2)), std::invalid_argument);
}

TEST_CASE("a matrix that is not positive definite has no Cholesky factor") {
  Eigen::MatrixXd a = positive();
  a(1, 1) = -5;
  CHECK_THROWS_AS(cholesky_lower(a), NumericalError);
}

TEST_CASE("a straight line through points off it has the closed form's slope and intercept") {
  // x = -1, 0, 1; y = 0, 2, 1: slope (1 - 0)/2, intercept the mean.
  Eigen::MatrixXd a(3, 2);
  a << 1, -1, 1, 0, 1, 1;
  Eigen::MatrixXd y(3, 1);
  y << 0, 2, 1;
  const Eigen::MatrixXd fit = least_squares(a, y);
  CHECK(std::abs(fit(0) - 1.0) < kRounding);
  CHECK(std::abs(fit(1) - 0.5) < kRounding);
}

TEST_CASE("an upper factor is Cholesky's of A'A: triangular, of a positive diagonal, and it keeps lengths") {
  Eigen::MatrixXd a(4, 3);
  a << 1.0, -2.0, 0.5, 3.0, 0.25, -1.0, -0.5, 4.0, 2.0, 2.0, 1.0, 7.0;
  const Eigen::MatrixXd r = upper_factor(a);
  REQUIRE(r.rows() == 3);
  CHECK((r - Eigen::MatrixXd(r.triangularView<Eigen::Upper>())).norm() == 0.0);
  CHECK((r.diagonal().array() > 0.0).all());
  CHECK((r.transpose() * r - a.transpose() * a).norm() < 1e-13 * a.squaredNorm());
  CHECK_THROWS_AS(upper_factor(a.transpose()), std::invalid_argument);
}

TEST_CASE("eigenvalues come in ascending order with their vectors") {
  Eigen::MatrixXd a(2, 2);
  a << 2, 1, 1, 2;  // 1 and 3
  const SymmetricEigen eigen = symmetric_eigen(a);
  CHECK(std::abs(eigen.values(0) - 1.0) < kRounding);
  CHECK(std::abs(eigen.values(1) - 3.0) < kRounding);
  CHECK(largest(product(a, eigen.vectors) - eigen.vectors * eigen.values.asDiagonal()) < kRounding);
}

TEST_CASE("columns that share what they span count once, and their basis is orthonormal") {
  // (1, 1, 0), (0, 1, 1), their sum but for a billionth, and nothing: a plane, whose normal is (1, -1, 1).
  Eigen::MatrixXd a(3, 4);
  a << 1, 0, 1, 0,  //
      1, 1, 2, 0,   //
      0, 1, 1.000000001, 0;
  const Eigen::MatrixXd basis = orthonormal_columns(a, 1e-6);
  REQUIRE(basis.cols() == 2);
  CHECK(largest(transposed_product(basis, basis) - Eigen::MatrixXd::Identity(2, 2)) < kRounding);
  Eigen::MatrixXd normal(3, 1);
  normal << 1, -1, 1;
  CHECK(largest(transposed_product(basis, normal)) < 1e-8);  // the third column is a billionth off the plane
  CHECK(orthonormal_columns(a, 1e-12).cols() == 3);
  CHECK(orthonormal_columns(Eigen::MatrixXd::Zero(3, 2), 1e-6).cols() == 0);
}

TEST_CASE("shapes that do not fit are named") {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2, 3);
  CHECK_THROWS_AS(product(a, a), std::invalid_argument);
  CHECK_THROWS_WITH(solve_positive(a, a), Catch::Contains("2 x 3"));
}
