#include "core/pictures/marker/marker_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "core/pictures/image/pixel_signal.h"

namespace glidelab::core {
namespace {

constexpr int kStrands = 4;
constexpr int kBatch = 16;  // pixels

using Batch = std::array<double, kBatch>;

}  // namespace

/// The Jacobian of a batch, column by column, and the residuals.
template <int N>
struct MarkerSlopes {
  alignas(64) std::array<Batch, N> jacobian;
  alignas(64) Batch residual;
};

namespace {

const NormalNodes kNodes = make_normal_nodes();

/// The quantities that are common to all pixels.
template <int N>
struct Marker {
  Eigen::Matrix<double, N, 1> p;
  double blur;
  double per_radius;
  double variance;  // of the blur and the pixel together
};

/// The geometry of a batch of pixels: d, M d, rho, and the normal of the outline and the distance inside it.
struct Geometry {
  alignas(64) Batch du, dv, mu, mv, rho, per_steep, normal_u, normal_v, s;
};

/// Sums over all batches, in strands: the lower half of J' W J by columns with J' W r, then r' W r and the sum of W.
template <int N>
struct Sums {
  static constexpr int kProducts = N * (N + 1) / 2 + N + 2;
  alignas(64) std::array<std::array<double, kStrands>, kProducts> strands{};
};

[[gnu::always_inline]] inline void place(const double* u, const double* v, const double* p, double blur,
                                         Geometry& out) {
  const double a = p[kMuu], b = p[kMuv], c = p[kMvv];
  const double inside = (kFarFromEdge + 1.0) * blur + 1.0;  // for a pixel exactly at the centre, which has no normal
  for (int i = 0; i < kBatch; ++i) {
    const double du = u[i] - p[kU], dv = v[i] - p[kV];
    const double mu = a * du + b * dv, mv = b * du + c * dv;  // M d
    const double nu = a * mu + b * mv, nv = b * mu + c * mv;  // M^2 d
    const double rho = std::sqrt(mu * mu + mv * mv);
    const double steep = std::sqrt(nu * nu + nv * nv);
    const bool centre = !(rho > 1e-9);
    const double per_steep = 1.0 / (centre ? 1.0 : steep);
    out.du[i] = du;
    out.dv[i] = dv;
    out.mu[i] = mu;
    out.mv[i] = mv;
    out.rho[i] = rho;
    out.per_steep[i] = per_steep;
    out.normal_u[i] = centre ? 1.0 : nu * per_steep;
    out.normal_v[i] = centre ? 0.0 : nv * per_steep;
    out.s[i] = centre ? inside : rho * (1.0 - rho) * per_steep;
  }
}

/// E and its derivatives, in a loop of its own, since a compiler does not vectorise a longer one.
[[gnu::always_inline]] inline void see_edge(const Geometry& g, double blur, Batch& value, Batch& slope, Batch& bend) {
  for (int i = 0; i < kBatch; ++i) {
    const EdgeBoxes boxes = edge_boxes(g.normal_u[i], g.normal_v[i], blur);
    const PixelEdge edge = edge_of(boxes, edge_corners(kNodes, g.s[i], boxes));
    value[i] = edge.value;
    slope[i] = edge.slope;
    bend[i] = edge.bend;
  }
}

template <int N>
[[gnu::always_inline]] inline void derive(const Marker<N>& marker, const Geometry& g, const double* datum,
                                          MarkerSlopes<N>& out) {
  alignas(64) Batch value, slope, bend;
  see_edge(g, marker.blur, value, slope, bend);
  const auto& p = marker.p;
  auto& jacobian = out.jacobian;
  const double blur2 = marker.blur * marker.blur, bright = p[kBright], level = p[kLevel];
  const double slope_u = p[kSlopeU], slope_v = p[kSlopeV];
  double shade_u = 0.0, shade_v = 0.0, shade_r = 0.0;
  if constexpr (N == kShadedParameters) {
    shade_u = p[kShadeU];
    shade_v = p[kShadeV];
    shade_r = p[kShadeR];
  }
  for (int i = 0; i < kBatch; ++i) {
    const double du = g.du[i], dv = g.dv[i], edge = value[i], rest = 1.0 - edge;
    double surface = bright;
    if constexpr (N == kShadedParameters) {
      surface += (shade_u * du + shade_v * dv) * marker.per_radius + shade_r * (1.0 - g.rho[i] * g.rho[i]);
    }
    const double behind = level + slope_u * du + slope_v * dv;
    // A slope that ends at an edge leaves, once blurred, a remainder beyond the edge.
    const double blurred = marker.variance * slope[i];
    const double remain_u = blurred * g.normal_u[i], remain_v = blurred * g.normal_v[i];
    const double model = behind * rest + surface * edge + slope_u * remain_u + slope_v * remain_v;
    const double to_s = (surface - behind) * slope[i];
    // At fixed steepness ds = -rho d(rho) / |M^2 d| with d(rho) = ((M d) . dM d) / rho. A shift of the centre changes d
    // by the opposite.
    const double to_m = -to_s * g.per_steep[i];
    double to_u = to_s * g.normal_u[i] - rest * slope_u;
    double to_v = to_s * g.normal_v[i] - rest * slope_v;
    if constexpr (N == kShadedParameters) {
      const double nu = g.normal_u[i] / g.per_steep[i], nv = g.normal_v[i] / g.per_steep[i];
      to_u -= edge * (shade_u * marker.per_radius - 2.0 * shade_r * nu);
      to_v -= edge * (shade_v * marker.per_radius - 2.0 * shade_r * nv);
      jacobian[kShadeU][i] = edge * du * marker.per_radius;
      jacobian[kShadeV][i] = edge * dv * marker.per_radius;
      jacobian[kShadeR][i] = edge * (1.0 - g.rho[i] * g.rho[i]);
    }
    jacobian[kU][i] = to_u;
    jacobian[kV][i] = to_v;
    jacobian[kMuu][i] = to_m * g.mu[i] * du;
    jacobian[kMuv][i] = to_m * (g.mu[i] * dv + g.mv[i] * du);
    jacobian[kMvv][i] = to_m * g.mv[i] * dv;
    jacobian[kLogBlur][i] = (surface - behind) * blur2 * bend[i];
    jacobian[kBright][i] = edge;
    jacobian[kLevel][i] = rest;
    jacobian[kSlopeU][i] = rest * du + remain_u;
    jacobian[kSlopeV][i] = rest * dv + remain_v;
    out.residual[i] = model - datum[i];
  }
}

[[gnu::always_inline]] inline void add_product(const Batch& a, const Batch& b, std::array<double, kStrands>& sum) {
  std::array<double, kStrands> strands = sum;
  for (int i = 0; i < kBatch; i += kStrands) {
    for (int k = 0; k < kStrands; ++k) strands[k] += a[i + k] * b[i + k];
  }
  sum = strands;
}

template <int N>
[[gnu::always_inline]] inline void sum_up(const MarkerSlopes<N>& of, const Batch& weight, Sums<N>& sums) {
  alignas(64) Batch weighted;
  auto* sum = sums.strands.data();
  for (int column = 0; column < N; ++column) {
    for (int i = 0; i < kBatch; ++i) weighted[i] = weight[i] * of.jacobian[column][i];
    for (int row = column; row < N; ++row) add_product(weighted, of.jacobian[row], *sum++);
    add_product(weighted, of.residual, *sum++);
  }
  for (int i = 0; i < kBatch; ++i) weighted[i] = weight[i] * of.residual[i];
  add_product(weighted, of.residual, *sum++);
  for (int i = 0; i < kBatch; i += kStrands) {
    for (int k = 0; k < kStrands; ++k) (*sum)[k] += weight[i + k];
  }
}

template <int N>
[[gnu::always_inline]] inline void sum_pixels(const MarkerPixels& pixels, const Marker<N>& marker,
                                              MarkerSlopes<N>* slopes, Sums<N>& sums) {
  Geometry geometry;
  alignas(64) Batch weights;
  for (std::size_t first = 0; first < pixels.u().size(); first += kBatch, ++slopes) {
    place(pixels.u().data() + first, pixels.v().data() + first, marker.p.data(), marker.blur, geometry);
    derive(marker, geometry, pixels.value().data() + first, *slopes);
    const double* const taper = pixels.weight().data() + first;
    for (int i = 0; i < kBatch; ++i) weights[i] = taper[i];
    sum_up(*slopes, weights, sums);
  }
}

/// Sums weighted by (w r)^2, a pixel's share in the variance of the gradient, with r a step away from where it was
/// taken.
template <int N>
[[gnu::always_inline]] inline void sum_variance(const MarkerPixels& pixels, const MarkerSlopes<N>* slopes,
                                                const double* step, Sums<N>& sums) {
  alignas(64) Batch weights;
  for (std::size_t first = 0; first < pixels.u().size(); first += kBatch, ++slopes) {
    const double* const taper = pixels.weight().data() + first;
    alignas(64) Batch residual = slopes->residual;
    for (int k = 0; k < N; ++k) {
      for (int i = 0; i < kBatch; ++i) residual[i] += slopes->jacobian[k][i] * step[k];
    }
    for (int i = 0; i < kBatch; ++i) {
      const double share = taper[i] * residual[i];
      weights[i] = share * share;
    }
    sum_up(*slopes, weights, sums);
  }
}

template <int N>
void sum_pixels_baseline(const MarkerPixels& pixels, const Marker<N>& marker, MarkerSlopes<N>* slopes, Sums<N>& sums) {
  sum_pixels(pixels, marker, slopes, sums);
}
template <int N>
void sum_variance_baseline(const MarkerPixels& pixels, const MarkerSlopes<N>* slopes, const double* step,
                           Sums<N>& sums) {
  sum_variance(pixels, slopes, step, sums);
}

#if defined(__x86_64__)
// AVX2 without FMA: the same operations in more lanes.
template <int N>
[[gnu::target("avx2")]] void sum_pixels_avx2(const MarkerPixels& pixels, const Marker<N>& marker,
                                             MarkerSlopes<N>* slopes, Sums<N>& sums) {
  sum_pixels(pixels, marker, slopes, sums);
}
template <int N>
[[gnu::target("avx2")]] void sum_variance_avx2(const MarkerPixels& pixels, const MarkerSlopes<N>* slopes,
                                               const double* step, Sums<N>& sums) {
  sum_variance(pixels, slopes, step, sums);
}
#endif

template <int N>
NormalEquations<N> equations_of(const Sums<N>& sums) {
  NormalEquations<N> equations;
  const auto* next = sums.strands.data();
  const auto total = [&] {
    const std::array<double, kStrands>& strand = *next++;
    return (strand[0] + strand[1]) + (strand[2] + strand[3]);
  };
  for (int column = 0; column < N; ++column) {
    for (int row = column; row < N; ++row) equations.jtj(row, column) = total();
    equations.jtr[column] = total();
  }
  equations.cost = total();
  equations.weight = total();
  return equations;
}

}  // namespace

void MarkerPixels::reserve(std::size_t pixels) {
  for (std::vector<double>* values : {&u_, &v_, &value_, &weight_}) values->resize(pixels + kBatch);
}

void MarkerPixels::complete() {
  const std::size_t whole = (size_ + kBatch - 1) / kBatch * kBatch;
  for (std::vector<double>* values : {&u_, &v_, &value_, &weight_}) {
    values->resize(size_);
    values->resize(whole, values != &weight_ && size_ > 0 ? values->back() : 0.0);
  }
}

template <int N>
MarkerModel<N>::MarkerModel(const MarkerPixels& pixels, Vectors vectors)
    : pixels_(pixels),
      vectors_(vectors),
      slopes_(std::make_unique_for_overwrite<MarkerSlopes<N>[]>(pixels.u().size() / kBatch)) {}

template <int N>
MarkerModel<N>::~MarkerModel() = default;

template <int N>
std::optional<NormalEquations<N>> MarkerModel<N>::equations(const Vector& p) {
  const double determinant = p[kMuu] * p[kMvv] - p[kMuv] * p[kMuv];
  const double blur = std::exp(p[kLogBlur]);
  if (!(blur > 0.01) || blur > 20.0 || !(determinant > 1e-6) || !(p[kMuu] > 0.0)) return std::nullopt;
  const Marker<N> marker{p, blur, std::sqrt(determinant), blur * blur + 1.0 / 12.0};
  known_ = p;
  Sums<N> sums;
#if defined(__x86_64__)
  if (base::uses_avx2(vectors_)) {
    sum_pixels_avx2(pixels_, marker, slopes_.get(), sums);
    return equations_of(sums);
  }
#endif
  sum_pixels_baseline(pixels_, marker, slopes_.get(), sums);
  return equations_of(sums);
}

template <int N>
Eigen::Matrix<double, N, N> MarkerModel<N>::gradient_variance(const Vector& p, const Vector& step) {
  if (!(known_ && *known_ == p) && !equations(p)) throw std::logic_error("the slopes of no marker");
  Sums<N> sums;
#if defined(__x86_64__)
  if (base::uses_avx2(vectors_)) {
    sum_variance_avx2(pixels_, slopes_.get(), step.data(), sums);
  } else {
    sum_variance_baseline(pixels_, slopes_.get(), step.data(), sums);
  }
#else
  sum_variance_baseline(pixels_, slopes_.get(), step.data(), sums);
#endif
  NormalEquations<N> equations = equations_of(sums);
  equations.complete();
  return equations.jtj;
}

template <int N>
Eigen::MatrixXd MarkerModel<N>::jacobian(const Vector& p) {
  if (!(known_ && *known_ == p) && !equations(p)) throw std::logic_error("the slopes of no marker");
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(pixels_.size()), N);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    for (int k = 0; k < N; ++k) rows(i, k) = slopes_[at / kBatch].jacobian[static_cast<std::size_t>(k)][at % kBatch];
  }
  return rows;
}

template <int N>
Eigen::VectorXd MarkerModel<N>::image(const Vector& p) {
  if (!(known_ && *known_ == p) && !equations(p)) throw std::logic_error("the image of no marker");
  Eigen::VectorXd values(static_cast<Eigen::Index>(pixels_.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    values[i] = slopes_[at / kBatch].residual[at % kBatch] + pixels_.value()[at];
  }
  return values;
}

ModelPixel marker_at(const Eigen::VectorXd& p, double blur_px, cv::Point2d pixel) {
  const double a = p[kMuu], b = p[kMuv], c = p[kMvv];
  const double du = pixel.x - p[kU], dv = pixel.y - p[kV];
  const double mu = a * du + b * dv, mv = b * du + c * dv;
  const double nu = a * mu + b * mv, nv = b * mu + c * mv;
  const double rho = std::hypot(mu, mv), steep = std::hypot(nu, nv);
  double covered = 1.0;
  if (rho > 1e-9) covered = pixel_edge(rho * (1.0 - rho) / steep, nu / steep, nv / steep, blur_px).value;
  double surface = p[kBright];
  if (p.size() == kShadedParameters) {
    surface += (p[kShadeU] * du + p[kShadeV] * dv) * std::sqrt(a * c - b * b) + p[kShadeR] * (1.0 - rho * rho);
  }
  const double behind = p[kLevel] + p[kSlopeU] * du + p[kSlopeV] * dv;
  return {behind + (surface - behind) * covered, covered};
}

template class MarkerModel<kUniformParameters>;
template class MarkerModel<kShadedParameters>;

}  // namespace glidelab::core
