/// The model of marker_fit.h for the pixels of a window: residuals, derivatives and their normal equations.
///
/// Pixels are processed in batches, each step for a whole batch, so that the compiler can use vector instructions;
/// these are wider if the processor has AVX2. With either instruction set, sums are taken in four strands by the
/// position of a pixel in its batch, so the results agree to the last bit.
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

/// The pixels of a window, each with its weight in the fit.
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
  /// Must be called after the last add().
  void complete();

  std::size_t size() const { return size_; }
  const std::vector<double>& u() const { return u_; }
  const std::vector<double>& v() const { return v_; }
  const std::vector<double>& value() const { return value_; }
  const std::vector<double>& weight() const { return weight_; }
  void set_value(std::size_t pixel, double value) { value_[pixel] = value; }

 private:
  std::size_t size_ = 0;
  /// Longer than size_ until complete(); then whole batches, filled up with pixels of weight 0.
  std::vector<double> u_, v_, value_, weight_;
};

using Vectors = base::Simd;  ///< the portable choice is the baseline here

/// The residuals of the model and their derivatives in one batch of pixels.
template <int N>
struct MarkerSlopes;

/// The normal equations of a window. The derivatives are kept for a second sum.
template <int N>
class MarkerModel {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;

  /// The pixels must be complete() and must outlive the model.
  explicit MarkerModel(const MarkerPixels& pixels, Vectors vectors = Vectors::best);
  MarkerModel(const MarkerModel&) = delete;
  MarkerModel& operator=(const MarkerModel&) = delete;
  ~MarkerModel();

  /// The normal equations at p, not yet complete(). Empty if the parameters cannot be those of a marker.
  std::optional<NormalEquations<N>> equations(const Vector& p);

  /// The variance of the gradient, sum (w r)^2 J J^T, which is the middle of the sandwich covariance. J is taken at p,
  /// from the last call of equations() if that was at p; r is taken at p + step, to first order. std::logic_error if p
  /// cannot be a marker's.
  Eigen::Matrix<double, N, N> gradient_variance(const Vector& p, const Vector& step);

  /// The derivatives of the model at p, one row for each pixel, and its values. std::logic_error if p cannot be a
  /// marker's.
  Eigen::MatrixXd jacobian(const Vector& p);
  Eigen::VectorXd image(const Vector& p);

  /// Must be called after the values of pixels have changed.
  void forget() { known_.reset(); }

 private:
  const MarkerPixels& pixels_;
  Vectors vectors_;
  std::unique_ptr<MarkerSlopes<N>[]> slopes_;  ///< of each batch
  std::optional<Vector> known_;                ///< the parameters at which they were taken
};

/// The model at one pixel with another blur of the edge, and without the remainder of a slope beyond the edge. `p` has
/// N parameters of one of the surfaces.
ModelPixel marker_at(const Eigen::VectorXd& p, double blur_px, cv::Point2d pixel);

extern template class MarkerModel<kUniformParameters>;
extern template class MarkerModel<kShadedParameters>;

}  // namespace glidelab::core
