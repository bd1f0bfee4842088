/// The data to which the generalised line (gls_line.h) is fitted: free stretches up to the estimated times at which
/// they turn or come to rest, their nodes, and what is known about their noise.
#pragma once

#include <Eigen/SparseCholesky>

#include <cstddef>
#include <span>
#include <vector>

#include "core/motion/free/free_motion.h"
#include "core/motion/free/motion.h"
#include "core/motion/free/motion_events.h"
#include "core/motion/smoothing/local_polynomial.h"

namespace glidelab::core {

/// Points first … first + count - 1 of the motion: free, in one direction, up to the events at their ends.
struct FreePiece {
  std::size_t first = 0;
  std::size_t count = 0;
  int direction = 0;
};

/// The stretches up to their estimated ends. If a stretch turns into the reversed one or comes to rest, the event's
/// time is estimated from three bandwidths on both sides (motion_events.h), and the stretch reaches up to two standard
/// deviations from it. If that fails, and at other borders (a hand, a bumper), a bandwidth is left out. At the ends of
/// the data nothing is left out.
std::vector<FreePiece> free_pieces(const Motion& motion, const FreeMotion& free, double bandwidth_s,
                                   const std::vector<double>& autocovariance);

struct GlsInput {
  double bandwidth_s = 0.0;
  std::vector<double> autocovariance;
  std::vector<double> noise_factor = {};  ///< of every point of the motion (stretch_noise.h); empty: 1
  double k_start_1_s = 0.0;               ///< start value of the search for k
  double scale_sd_relative = 0.0;
  double mass_kg = 0.0;  ///< with a known force only
  double mass_sd_kg = 0.0;
  std::vector<double> law_m_s2;               ///< with a known force only: f(v(t)) at every point (rule_lines.h)
  std::vector<std::vector<double>> shared_m;  ///< as in TrackData
};

/// C = L L', banded; L is kept in the order of time.
using BandedCholesky = Eigen::SimplicialLLT<Eigen::SparseMatrix<double>, Eigen::Lower, Eigen::NaturalOrdering<int>>;

/// rho = y - a0 p at the nodes of one piece, for one k.
struct NodeResidual {
  Eigen::VectorXd y, p;
};

/// The nodes of one piece for the generalised line: smoothed points about a bandwidth apart with the parts of their
/// covariance, and their prediction under the line's own law.
class LineNodes {
 public:
  /// `count` nodes from the first to the last point of the piece; fewer if there are fewer points.
  LineNodes(const Motion& motion, const FreePiece& piece, const GlsInput& input, std::size_t count);

  int count() const { return static_cast<int>(v_.size()); }
  double span_s() const { return t_.back() - t_.front(); }
  const FreePiece& piece() const { return piece_; }
  const Eigen::VectorXd& v() const { return v_; }
  const Eigen::VectorXd& a() const { return a_; }

  /// Lower triangles of C(k) and of dC/dk.
  Eigen::SparseMatrix<double> covariance(double k) const { return aa_ + 2.0 * k * av_ + k * k * vv_; }
  Eigen::SparseMatrix<double> covariance_slope(double k) const { return 2.0 * av_ + 2.0 * k * vv_; }
  /// Whether every pivot of C(k) is above 1e-9 of its diagonal; below that, nodes carry the same information.
  bool well_conditioned(double k) const;

  NodeResidual residual(double k) const;

  /// Change of a + k v due to a displacement of all the motion's points.
  Eigen::VectorXd change(const std::vector<double>& displacement, double k) const;
  /// With a known force: change of a due to a unit relative change of the mass, and the kernel's bias of a under a law.
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
