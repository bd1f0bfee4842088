#include "diagnose/tracks/whitening.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/math/dense.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kStretch = 240;  // points that are whitened together

}  // namespace

Eigen::MatrixXd covariance_of(const SeenFrames& frames, const NoiseShape& shape, double white_px) {
  const auto n = static_cast<Eigen::Index>(frames.along_px.size());
  Eigen::MatrixXd covariance(n, n);
  const double a = shape.pixels * shape.pixels, b = shape.phase * shape.phase, c = shape.lasting * shape.lasting;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto p = static_cast<std::size_t>(i);
    for (Eigen::Index j = 0; j <= i; ++j) {
      const auto q = static_cast<std::size_t>(j);
      const double d = std::abs(frames.along_px[p] - frames.along_px[q]),
                   lag = std::abs(frames.frame[p] - frames.frame[q]);
      double of = 0.0;
      if (a > 0.0) of += a * std::exp(-0.5 * std::pow(d / shape.pixels_px, 2));
      if (b > 0.0) of += b * std::cos(2.0 * std::numbers::pi * d) * std::exp(-d / shape.phase_px);
      if (c > 0.0) of += c * std::exp(-lag / shape.lasting_frames);
      covariance(i, j) = covariance(j, i) = of;
    }
    covariance(i, i) += 1.0 + std::pow(shape.jitter_s * frames.v_px_s[p] / white_px, 2);
  }
  return covariance;
}

double unit_m(const TrackedMotion& motion) {
  return motion.m_per_px > 0.0 ? motion.m_per_px : 1.0;
}

SeenFrames seen_frames(const TrackedMotion& motion, double rate_hz) {
  SeenFrames frames;
  frames.along_px = motion.m_per_px > 0.0 ? motion.along_px : motion.x_m;
  if (frames.along_px.empty()) return frames;
  for (std::size_t p = 0; p < motion.t_s.size(); ++p) {
    frames.frame.push_back(motion.t_s[p] * rate_hz);
    const std::size_t a = p - std::min<std::size_t>(p, 2), b = std::min(p + 2, motion.t_s.size() - 1);
    frames.v_px_s.push_back((frames.along_px[b] - frames.along_px[a]) / (motion.t_s[b] - motion.t_s[a]));
  }
  return frames;
}

void whiten(TrackedMotion& motion, const NoiseShape& shape, double rate_hz) {
  motion.wider.clear();
  motion.coarser.clear();
  motion.whitening.clear();
  const SeenFrames all = seen_frames(motion, rate_hz);
  if (all.along_px.empty()) return;
  const std::size_t points = motion.t_s.size(), stretches = (points + kStretch - 1) / kStretch;
  for (std::size_t s = 0; s < stretches; ++s) {
    const auto from = static_cast<std::ptrdiff_t>(points * s / stretches),
               to = static_cast<std::ptrdiff_t>(points * (s + 1) / stretches);
    const auto part = [&](const std::vector<double>& of) {
      return std::vector<double>(of.begin() + from, of.begin() + to);
    };
    Eigen::MatrixXd covariance =
        covariance_of({part(all.along_px), part(all.frame), part(all.v_px_s)}, shape, motion.sd_m / unit_m(motion));
    const Eigen::VectorXd sd = covariance.diagonal().cwiseSqrt();
    for (Eigen::Index i = 0; i < sd.size(); ++i) {
      motion.wider.push_back(sd[i]);
      if (motion.outlier[static_cast<std::size_t>(from + i)] == 0) continue;
      covariance.row(i).setZero();
      covariance.col(i).setZero();
      covariance(i, i) = sd[i] * sd[i];
    }
    const Eigen::VectorXd over = sd.cwiseInverse();
    const Eigen::MatrixXd lower =
        base::cholesky_lower(Eigen::MatrixXd(over.asDiagonal() * covariance * over.asDiagonal()));
    motion.whitening.push_back(base::solve_lower(lower, Eigen::MatrixXd::Identity(sd.size(), sd.size())));
  }
}

Eigen::MatrixXd whitened(const TrackedMotion& motion, Eigen::MatrixXd over_sd) {
  Eigen::Index from = 0;
  for (const Eigen::MatrixXd& by : motion.whitening) {
    over_sd.middleRows(from, by.rows()) = base::product(by, over_sd.middleRows(from, by.rows()));
    from += by.rows();
  }
  if (motion.remainder.shrink.size() > 0) {
    const Eigen::MatrixXd along = base::transposed_product(motion.remainder.span, over_sd);
    over_sd -= base::product(motion.remainder.span, Eigen::MatrixXd(motion.remainder.shrink.asDiagonal() * along));
  }
  return over_sd;
}

namespace {

/// The inverse of the remainder's part of whitening, a symmetric matrix.
Eigen::MatrixXd with_remainder(const Remainder& remainder, Eigen::MatrixXd white) {
  if (remainder.shrink.size() == 0) return white;
  const Eigen::VectorXd grow = remainder.shrink.array() / (1.0 - remainder.shrink.array());
  const Eigen::MatrixXd along = base::transposed_product(remainder.span, white);
  white += base::product(remainder.span, Eigen::MatrixXd(grow.asDiagonal() * along));
  return white;
}

}  // namespace

Eigen::MatrixXd without_remainder(const TrackedMotion& motion, Eigen::MatrixXd white) {
  return with_remainder(motion.remainder, std::move(white));
}

Eigen::VectorXd coloured(const TrackedMotion& motion, Eigen::VectorXd white) {
  white = with_remainder(motion.remainder, std::move(white));
  Eigen::Index from = 0;
  for (const Eigen::MatrixXd& by : motion.whitening) {
    white.segment(from, by.rows()) = base::solve_lower(by, white.segment(from, by.rows()));
    from += by.rows();
  }
  return white;
}

Eigen::MatrixXd weights_of_white(const TrackedMotion& motion, Eigen::MatrixXd weights) {
  Eigen::Index from = 0;
  for (const Eigen::MatrixXd& by : motion.whitening) {
    // (by^-1)' w: an upper triangle, which is a lower one in reverse order.
    const Eigen::MatrixXd turned = by.transpose().reverse();
    const Eigen::MatrixXd reversed = weights.middleRows(from, by.rows()).colwise().reverse();
    weights.middleRows(from, by.rows()) = base::solve_lower(turned, reversed).colwise().reverse();
    from += by.rows();
  }
  return with_remainder(motion.remainder, std::move(weights));
}

}  // namespace glidelab::diagnose
