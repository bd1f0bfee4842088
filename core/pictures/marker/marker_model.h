/// The model of marker.h for the pixels of a window: its residuals and their derivatives, summed up.
///
/// The pixels are taken in batches, each step for a whole batch, so that a compiler turns the steps into vector
/// instructions; where the processor has AVX2 these are wider. Sums are taken in four strands by a pixel's place in its
/// batch, with either set of instructions: the results are the same to the last bit.
#pragma once

#include <opencv2/core.hpp>

#include <memory>
#include <optional>
#include <vector>

#include "base/math/simd.h"
#include "core/math/least_squares.h"
#include "core/pictures/image/edge_response.h"

namespace glidelab::core {

enum MarkerParameter {
  kU,  ///< c
  kV,
  kMuu,  ///< M
  kMuv,
  kMvv,
  kLogBlur,  ///< ln sigma
  kBright,   ///< B
  kLevel,    ///< b
  kSlopeU,   ///< g
  kSlopeV,
  kShadeU,  ///< a
  kShadeV,
  kShadeR  ///< q
};
inline constexpr int kUniformParameters = kShadeU;
inline constexpr int kShadedParameters = kShadeR + 1;

/// Pixels, each with its weight in the fit.
class MarkerPixels {
 public:
  void reserve(std::size_t pixels);
  void add(int u, int v, double value, double weight) {
    if (size_ == u_.size()) reserve(2 * size_);
    u_[size_] = u;
    v_[size_] = v;
    value_[size_] = value;
    weight_[size_++] = weight;
  }
  /// To be called after the last pixel.
  void complete();

  std::size_t size() const { return size_; }
  const std::vector<double>& u() const { return u_; }
  const std::vector<double>& v() const { return v_; }
  const std::vector<double>& value() const { return value_; }
  const std::vector<double>& weight() const { return weight_; }
  void set_value(std::size_t pixel, double value) { value_[pixel] = value; }

 private:
  std::size_t size_ = 0;
  /// With room; once complete() whole batches, filled up with pixels of no weight.
  std::vector<double> u_, v_, value_, weight_;
};

using Vectors = base::Simd;  ///< there is no portable one here: it is the baseline

/// The model's residuals and slopes in one batch of pixels.
template <int N>
struct MarkerSlopes;

/// The sums over a window, whose slopes are kept for a second sum.
template <int N>
class MarkerModel {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  /// The pixels, complete(), must outlive it.
  explicit MarkerModel(const MarkerPixels& pixels, Vectors vectors = Vectors::best);
  MarkerModel(const MarkerModel&) = delete;
  MarkerModel& operator=(const MarkerModel&) = delete;
  ~MarkerModel();

  /// The sums (not complete() yet); nothing where the parameters are no marker's.
  std::optional<NormalEquations<N>> equations(const Vector& p);

  /// The variance of the gradient, sum (w r)^2 J J^T: the middle of the sandwich covariance. J is that at p, kept where
  /// equations() was asked for it last, else taken anew; r is that at p + step, to first order. p must be a marker's.
  Eigen::Matrix<double, N, N> gradient_variance(const Vector& p, const Vector& step);

  /// The model's derivatives at p by its parameters, a row for each pixel, and what it gives each pixel. p must be a
  /// marker's.
  Eigen::MatrixXd jacobian(const Vector& p);
  Eigen::VectorXd image(const Vector& p);

  /// The pixels' values have changed.
  void forget() { known_.reset(); }

 private:
  const MarkerPixels& pixels_;
  Vectors vectors_;
  std::unique_ptr<MarkerSlopes<N>[]> slopes_;  ///< of each batch
  std::optional<Vector> known_;                ///< where they were taken
};

/// The model at one pixel, but for the remainder of a slope beyond the edge, with an edge of another blur. N
/// parameters.
ModelPixel marker_at(const Eigen::VectorXd& p, double blur_px, cv::Point2d pixel);

extern template class MarkerModel<kUniformParameters>;
extern template class MarkerModel<kShadedParameters>;

}  // namespace glidelab::core
