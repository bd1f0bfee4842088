/// Dense linear algebra of run-time size, compiled once.
///
/// Eigen instantiates its kernels in every file that multiplies or decomposes a dynamic matrix, which costs a compiler
/// a minute a file. These functions do the same work behind one object file; small fixed-size geometry stays in Eigen.
/// Shapes that do not match are a programmer's mistake: std::invalid_argument with both shapes.
#pragma once

#include <Eigen/Core>

namespace glidelab::base {

using MatrixView = Eigen::Ref<const Eigen::MatrixXd>;

/// A B.
Eigen::MatrixXd product(const MatrixView& a, const MatrixView& b);

/// A' B.
Eigen::MatrixXd transposed_product(const MatrixView& a, const MatrixView& b);

/// X in A X = B for a symmetric positive definite A, by Cholesky's LDL'. Only the lower triangle of A is read.
Eigen::MatrixXd solve_positive(const MatrixView& a, const MatrixView& b);

/// Inverse of a symmetric positive definite matrix; only its lower triangle is read.
Eigen::MatrixXd inverse_positive(const MatrixView& a);

/// L of A = L L' for a symmetric positive definite A; NumericalError if a pivot is not positive.
Eigen::MatrixXd cholesky_lower(const MatrixView& a);

/// X in L X = B for a lower triangle L (entries above its diagonal are not read).
Eigen::MatrixXd solve_lower(const MatrixView& lower, const MatrixView& b);

/// X that minimises |A X - B|, by Householder's QR with column pivoting.
Eigen::MatrixXd least_squares(const MatrixView& a, const MatrixView& b);

/// The upper triangle R of A = Q R, with a positive diagonal; A has at least as many rows as columns.
Eigen::MatrixXd upper_factor(const MatrixView& a);

/// An orthonormal basis of the span of A's columns, by the same QR; a column whose remainder is below `alike` times the
/// longest adds nothing. As many rows as A, and as many columns as its rank.
Eigen::MatrixXd orthonormal_columns(const MatrixView& a, double alike);

/// A = V diag(values) V' of a symmetric A (its lower triangle), values ascending, vectors in columns.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen symmetric_eigen(const MatrixView& a);

}  // namespace glidelab::base
