#include "core/motion/lines/gls_line.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "base/math/levenberg_marquardt.h"
#include "core/math/least_squares.h"
#include "core/motion/lines/gls_pieces.h"
#include "core/motion/lines/line_fit.h"
#include "core/result/estimate.h"

namespace glidelab::core {
namespace {

constexpr double kLeastPieceBandwidths = 4.0;  // minimum duration of a piece, in bandwidths
constexpr std::size_t kFewestPoints = 8;
constexpr std::size_t kFewestNodes = 3;
constexpr int kSteps = 60;
constexpr double kSlopeSettled = 1e-4;  // of the standard deviation of k
constexpr int kFewestNodeBlocks = 8;
constexpr std::size_t kFewestPieces = 4;

using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

/// The sums over all pieces at one k.
class Fit {
 public:
  Fit(const std::vector<LineNodes>& pieces, double k) : k_(k) {
    double pp = 0.0, py = 0.0;
    for (const LineNodes& nodes : pieces) {
      const double step = 1e-4 * (std::abs(k) + 1.0 / nodes.span_s());
      const NodeResidual at = nodes.residual(k), above = nodes.residual(k + step), below = nodes.residual(k - step);
      auto cholesky = std::make_shared<BandedCholesky>(nodes.covariance(k));
      if (cholesky->info() != Eigen::Success) return;
      Piece piece;
      piece.nodes = &nodes;
      piece.cholesky = cholesky;
      piece.y = white(*cholesky, at.y);
      piece.p = white(*cholesky, at.p);
      piece.slope_y = white(*cholesky, (above.y - below.y) / (2.0 * step));
      piece.slope_p = white(*cholesky, (above.p - below.p) / (2.0 * step));
      pp += piece.p.squaredNorm();
      py += piece.p.dot(piece.y);
      pieces_.push_back(std::move(piece));
    }
    if (!(pp > 0.0)) return;
    a0_ = py / pp;
    for (Piece& piece : pieces_) {
      piece.rho = piece.y - a0_ * piece.p;
      piece.design.resize(piece.rho.size(), 2);
      piece.design.col(0) = a0_ * piece.slope_p - piece.slope_y;
      piece.design.col(1) = piece.p;
      information_ += piece.design.transpose() * piece.design;
      chi2_ += piece.rho.squaredNorm();
      const Vector u = piece.cholesky->matrixU().solve(piece.rho);
      const Sparse slope = piece.nodes->covariance_slope(k);
      gradient_ += -2.0 * piece.design.col(0).dot(piece.rho) - u.dot(slope.selfadjointView<Eigen::Lower>() * u);
      nodes_ += static_cast<int>(piece.rho.size());
    }
    valid_ = information_.determinant() > 1e-12 * information_(0, 0) * information_(1, 1);
  }

  struct Piece {
    const LineNodes* nodes = nullptr;
    std::shared_ptr<BandedCholesky> cholesky;
    Vector y, p, slope_y, slope_p, rho;
    Eigen::MatrixX2d design;
  };

  bool valid() const { return valid_; }
  double k() const { return k_; }
  double a0() const { return a0_; }
  double chi2() const { return chi2_; }
  int nodes() const { return nodes_; }
  const Eigen::Matrix2d& information() const { return information_; }
  const std::vector<Piece>& pieces() const { return pieces_; }

  /// The Gauss-Newton step of k, and the standard deviation of k.
  double step() const { return -0.5 * gradient_ * inverse_k(); }
  double sd() const { return std::sqrt(inverse_k()); }

  /// Change of (k, a0) due to a change of a + k v at the nodes of every piece.
  template <typename Change>
  Eigen::Vector2d moved_by(const Change& change) const {
    Eigen::Vector2d score = Eigen::Vector2d::Zero();
    for (const Piece& piece : pieces_) score += piece.design.transpose() * white(*piece.cholesky, change(*piece.nodes));
    return information_.inverse() * score;
  }

 private:
  static Vector white(const BandedCholesky& cholesky, const Vector& of) { return cholesky.matrixL().solve(of); }
  double inverse_k() const { return information_.inverse()(0, 0); }

  double k_ = 0.0, a0_ = 0.0, chi2_ = 0.0, gradient_ = 0.0;
  int nodes_ = 0;
  bool valid_ = false;
  Eigen::Matrix2d information_ = Eigen::Matrix2d::Zero();
  std::vector<Piece> pieces_;
};

std::vector<LineNodes> nodes_of(int direction, const Motion& motion, const std::vector<FreePiece>& pieces,
                                const GlsInput& input) {
  std::vector<LineNodes> nodes;
  for (const FreePiece& piece : pieces) {
    if (piece.direction != direction || piece.count < kFewestPoints) continue;
    const double span_s = motion.t_s[piece.first + piece.count - 1] - motion.t_s[piece.first];
    if (span_s < kLeastPieceBandwidths * input.bandwidth_s) continue;
    auto count = static_cast<std::size_t>(std::lround(span_s / input.bandwidth_s)) + 1;
    for (count = std::min(count, piece.count); count >= kFewestNodes; count = std::min(count - 1, 7 * count / 8)) {
      LineNodes made(motion, piece, input, count);
      if (made.count() < static_cast<int>(kFewestNodes) || !made.well_conditioned(input.k_start_1_s)) continue;
      nodes.push_back(std::move(made));
      break;
    }
  }
  return nodes;
}

/// Gauss-Newton steps of k, with a0 eliminated. They are not damped and chi^2 is not compared: `step()` follows its
/// whole gradient, with the change of C(k), so that the steps end where it vanishes.
std::optional<Fit> settle(const std::vector<LineNodes>& nodes, double k) {
  const auto is_settled = [](const Fit& fit) { return std::abs(fit.step()) <= kSlopeSettled * fit.sd(); };
  Fit fit(nodes, k);
  if (!fit.valid()) return {};
  if (is_settled(fit)) return fit;
  base::FitOptions options;
  options.most_iterations = kSteps - 1;  // after the first fit
  options.take_every_step = true;
  const base::FitSummary summary = base::levenberg_marquardt(fit, fit.chi2(), options, [&](const Fit& at, double) {
    base::FitTrial<Fit> trial;
    Fit there(nodes, at.k() + at.step());
    if (!there.valid()) return trial;
    trial.cost = there.chi2();
    trial.is_small = is_settled(there);
    trial.point = std::move(there);
    return trial;
  });
  if (!base::is_settled(summary.stop)) return {};
  return fit;
}

/// The noise, and the scatter of whitened residuals beyond it.
void set_random_part(const Fit& fit, LineUncertainty& parts) {
  const Eigen::Matrix2d inverse = fit.information().inverse();
  Eigen::Matrix2d covariance = inverse;
  parts.degrees = std::numeric_limits<double>::infinity();
  const int free = fit.nodes() - 2;
  const double ratio = free > 0 ? fit.chi2() / free : 1.0;
  parts.scatter = std::sqrt(ratio);
  if (free > 0 && ratio > chi2_ratio_limit(free)) {
    const int length = std::max(1, fit.nodes() / kFewestNodeBlocks);
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    double blocks = 0.0;
    for (const Fit::Piece& piece : fit.pieces()) {
      const auto n = static_cast<int>(piece.rho.size());
      for (int from = 0; from < n; from += length) {
        const int count = std::min(length, n - from);
        const Eigen::Vector2d score = piece.design.middleRows(from, count).transpose() * piece.rho.segment(from, count);
        sum += score * score.transpose();
        blocks += 1.0;
      }
    }
    if (blocks >= 3.0) {
      const Eigen::Matrix2d wider = inverse * sum * inverse * ((1.0 - 1.0 / ratio) * blocks / (blocks - 2.0));
      const double total = covariance(1, 1) + wider(1, 1);
      parts.degrees = std::max(1.0, (blocks - 2.0) * total * total / (wider(1, 1) * wider(1, 1)));
      covariance += wider;
    }
  }
  parts.var_k = covariance(0, 0);
  parts.cov = covariance(0, 1);
  parts.var_a0 = covariance(1, 1);
}

/// The delete-one-piece jackknife, if it gives more (line_fit.h).
void compare_with_piece_jackknife(const Fit& fit, LineUncertainty& parts) {
  if (fit.pieces().size() < kFewestPieces) return;
  std::vector<Eigen::Vector2d> moved;
  for (const Fit::Piece& piece : fit.pieces()) {
    const Eigen::Matrix2d rest = fit.information() - piece.design.transpose() * piece.design;
    if (!(rest.determinant() > 1e-9 * fit.information().determinant())) return;  // one piece alone determines the line
    moved.push_back(rest.inverse() * (piece.design.transpose() * piece.rho));
  }
  widen_by_jackknife(moved, parts);
}

void set_shared_parts(const Fit& fit, const Motion& motion, const GlsInput& input, LineUncertainty& parts) {
  if (motion.forced) {
    const Eigen::Vector2d bias = fit.moved_by([&](const LineNodes& nodes) { return nodes.law_bias(input.law_m_s2); });
    parts.smoothing_k = bias[0];
    parts.smoothing_a0 = bias[1];
    const double relative = input.mass_kg > 0.0 ? input.mass_sd_kg / input.mass_kg : 0.0;
    const Eigen::Vector2d mass =
        fit.moved_by([&](const LineNodes& nodes) { return Vector(relative * nodes.force_part()); });
    parts.mass_k = mass[0];
    parts.mass_a0 = mass[1];
  }
  parts.scale_relative = input.scale_sd_relative;
  for (const std::vector<double>& mode : input.shared_m) {
    LineShift shift;
    if (!mode.empty()) {
      std::vector<double> displacement;
      for (const std::size_t point : motion.point) displacement.push_back(mode[point]);
      const Eigen::Vector2d moved =
          fit.moved_by([&](const LineNodes& nodes) { return nodes.change(displacement, fit.k()); });
      shift = {moved[0], moved[1]};
    }
    parts.calibration.push_back(shift);
  }
}

/// Squared correlation of v and a, and the range of v, over the nodes.
void describe_points(const std::vector<LineNodes>& pieces, LineFit& line) {
  PairCorrelation correlation;
  line.from_v_m_s = std::numeric_limits<double>::infinity();
  line.to_v_m_s = -line.from_v_m_s;
  for (const LineNodes& nodes : pieces) {
    line.points += nodes.piece().count;
    for (int j = 0; j < nodes.count(); ++j) {
      correlation.add(nodes.v()[j], nodes.a()[j]);
      line.from_v_m_s = std::min(line.from_v_m_s, nodes.v()[j]);
      line.to_v_m_s = std::max(line.to_v_m_s, nodes.v()[j]);
    }
  }
  line.r2 = correlation.squared();
}

}  // namespace

std::optional<LineFit> fit_line_gls(int direction, const Motion& motion, const std::vector<FreePiece>& pieces,
                                    const GlsInput& input) {
  const std::vector<LineNodes> nodes = nodes_of(direction, motion, pieces, input);
  if (nodes.empty()) return {};
  const std::optional<Fit> fit = settle(nodes, input.k_start_1_s);
  if (!fit) return {};
  LineFit line;
  line.direction = direction;
  line.k_over_m_1_s.value = fit->k();
  line.a0_m_s2.value = fit->a0();
  describe_points(nodes, line);
  set_random_part(*fit, line.parts);
  compare_with_piece_jackknife(*fit, line.parts);
  set_shared_parts(*fit, motion, input, line.parts);
  complete_line(line);
  return line;
}

}  // namespace glidelab::core
