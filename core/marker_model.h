/// The model of core/marker.h for the pixels of a window: its residuals and their derivatives, summed up.
///
/// The pixels are taken in batches, each step for a whole batch, so that a compiler turns the steps into vector
/// instructions; where the processor has AVX2 these are wider. Sums are taken in four strands by a pixel's place in its
/// batch, with either set of instructions: the results are the same to the last bit.
#pragma once

#include <opencv2/core.hpp>

#include <optional>
#include <vector>

#include "base/simd.h"
#include "core/least_squares.h"

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
  void add(int u, int v, double value, double weight);
  /// To be called after the last pixel.
  void complete();

  std::size_t size() const { return size_; }
  const std::vector<double>& u() const { return u_; }
  const std::vector<double>& v() const { return v_; }
  const std::vector<double>& value() const { return value_; }
  const std::vector<double>& weight() const { return weight_; }

 private:
  std::size_t size_ = 0;
  std::vector<double> u_, v_, value_, weight_;  ///< once complete whole batches, filled up with pixels of no weight
};

enum class PixelWeight {
  taper,    ///< a pixel's weight in the fit
  gradient  ///< its share in the variance of the gradient, (w r)^2: the middle of the sandwich covariance
};

using Vectors = base::Simd;  ///< there is no portable one here: it is the baseline

/// The sums over the window (not complete() yet); nothing where the parameters are no marker's.
template <int N>
std::optional<NormalEquations<N>> marker_equations(const MarkerPixels& pixels, const Eigen::Matrix<double, N, 1>& p,
                                                   PixelWeight weight, Vectors vectors = Vectors::best);

extern template std::optional<NormalEquations<kUniformParameters>> marker_equations<kUniformParameters>(
    const MarkerPixels&, const Eigen::Matrix<double, kUniformParameters, 1>&, PixelWeight, Vectors);
extern template std::optional<NormalEquations<kShadedParameters>> marker_equations<kShadedParameters>(
    const MarkerPixels&, const Eigen::Matrix<double, kShadedParameters, 1>&, PixelWeight, Vectors);

}  // namespace glidelab::core
