/// The nodes of one piece for the generalised line (gls_line.h): smoothed points about a bandwidth apart with the parts
/// of their covariance, and what the line's own law makes of them.
#pragma once

#include <Eigen/SparseCholesky>

#include <cstddef>
#include <span>
#include <vector>

#include "core/motion/lines/free_pieces.h"
#include "core/motion/smoothing/local_polynomial.h"

namespace glidelab::core {

/// C = L L', banded; L is kept in the order of time.
using BandedCholesky = Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>>;

/// rho = y - a0 p at the nodes of one piece, for one k.
struct NodeResidual {
  Eigen::VectorXd y, p;
};

class LineNodes {
 public:
  /// `count` nodes from the first to the last point of the piece; fewer where points are fewer.
  LineNodes(const Motion& motion, const FreePiece& piece, const GlsInput& input, std::size_t count);

  int count() const { return static_cast<int>(v_.size()); }
  double span_s() const { return t_.back() - t_.front(); }
  const FreePiece& piece() const { return piece_; }
  const Eigen::VectorXd& v() const { return v_; }
  const Eigen::VectorXd& a() const { return a_; }

  /// Lower triangles of C(k) and of dC/dk.
  Eigen::SparseMatrix<double> covariance(double k) const { return aa_ + 2.0 * k * av_ + k * k * vv_; }
  Eigen::SparseMatrix<double> covariance_slope(double k) const { return 2.0 * av_ + 2.0 * k * vv_; }
  /// Every pivot of C(k) is above 1e-9 of its diagonal; below that nodes say the same.
  bool well_conditioned(double k) const;

  NodeResidual residual(double k) const;

  /// Change of a + k v by a displacement of all the motion's points.
  Eigen::VectorXd change(const std::vector<double>& displacement, double k) const;
  /// With a known force: change of a by one relative change of the mass, and the kernel's bias of a under a law.
  Eigen::VectorXd force_part() const;
  Eigen::VectorXd law_bias(const std::vector<double>& law_m_s2) const;

 private:
  FreePiece piece_;
  std::span<const double> t_;
  bool forced_ = false;
  std::vector<KernelRow> rows_;  // over the points of the piece
  std::vector<std::size_t> point_;
  std::vector<double> force_part_;
  Eigen::VectorXd v_, a_;
  Eigen::SparseMatrix<double> aa_, av_, vv_;
};

}  // namespace glidelab::core
