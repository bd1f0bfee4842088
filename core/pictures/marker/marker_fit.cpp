#include "core/pictures/marker/marker_fit.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "base/math/dense.h"
#include "core/math/least_squares.h"
#include "core/math/quantile.h"
#include "core/pictures/image/pixel_signal.h"
#include "core/pictures/marker/marker_model.h"

namespace glidelab::core {
namespace {

constexpr double kLargestResidual = 1.0 / 3.0;  // relative to the amplitude; a disc leaves only noise
constexpr double kMomentReach = 1.1,
                 kMomentMargin_px = 1.5;  // of the radius, with a margin for a smear of 3 px and more
constexpr double kSharpEdge_px = 0.29;  // standard deviation of a pixel's extent, 1/sqrt(12): a sharper edge is clipped
constexpr int kMaxIterations = 14;      // a marker takes 3 to 8
constexpr int kIterationsBeforeHopeless = 4;  // after these, the residuals of a disc are nearly final
constexpr double kHopelessResidual = 2.0 * kLargestResidual;
constexpr int kMoreIterations = 16;  // for a disc whose edge is sharper than a pixel, because the sensor clips it

/// sin x for |x| <= pi/2, to 6e-8.
double sine(double x) {
  const double x2 = x * x;
  return x * (1.0 - x2 / 6.0 * (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0 * (1.0 - x2 / 72.0 * (1.0 - x2 / 110.0)))));
}

/// All pixels within `radius`. Their weights are tapered towards the rim, so that one pixel more or less there does not
/// move the centre.
std::optional<MarkerPixels> cut_window(const Signal& signal, cv::Point2d centre, double radius) {
  const int left = static_cast<int>(std::ceil(centre.x - radius));
  const int right = static_cast<int>(std::floor(centre.x + radius));
  const int top = static_cast<int>(std::ceil(centre.y - radius));
  const int bottom = static_cast<int>(std::floor(centre.y + radius));
  if (left < 0 || top < 0 || right >= signal.values.cols || bottom >= signal.values.rows) return std::nullopt;
  signal.see({left, top, right - left + 1, bottom - top + 1});
  MarkerPixels window;
  window.reserve(static_cast<std::size_t>(right - left + 1) * static_cast<std::size_t>(bottom - top + 1));
  const double taper_from = radius - std::min(2.0, 0.25 * radius);
  for (int v = top; v <= bottom; ++v) {
    for (int u = left; u <= right; ++u) {
      const double du = u - centre.x, dv = v - centre.y, square = du * du + dv * dv;
      if (square >= radius * radius) continue;
      double weight = 1.0;
      if (square > taper_from * taper_from) {
        const double into_taper = (std::sqrt(square) - taper_from) / (radius - taper_from);
        weight = 0.5 + 0.5 * sine(std::numbers::pi * (0.5 - into_taper));
      }
      window.add(u, v, signal.at(u, v), weight);
    }
  }
  window.complete();
  return window;
}

/// Weak priors. They keep the size and the blur of a small marker apart, and the blur of a sharp image, which has no
/// visible effect, from drifting to 0. Each counts like a residual of so much of the amplitude in one pixel.
struct Prior {
  double radius_px;
  double blur_px;
  double amplitude;
};
constexpr double kSizeStrength = 0.1;  // per unit of ln(radius)
constexpr double kBlurStrength = 0.3;  // per unit of ln(blur)
constexpr double kShadeStrength = 0.05;

/// The normal equations of the pixels and the priors.
template <int N>
std::optional<NormalEquations<N>> evaluate(MarkerModel<N>& pixels, const Prior& prior,
                                           const Eigen::Matrix<double, N, 1>& p) {
  std::optional<NormalEquations<N>> equations = pixels.equations(p);
  if (!equations) return std::nullopt;
  const double a = p[kMuu], b = p[kMuv], c = p[kMvv];
  const double determinant = a * c - b * b;
  Eigen::Matrix<double, N, 1> jacobian;
  const double sharp = kBlurStrength * prior.amplitude;
  jacobian.setZero();
  jacobian[kLogBlur] = sharp;
  equations->add(jacobian, sharp * (p[kLogBlur] - std::log(prior.blur_px)), 1.0);
  // ln(radius / expected) = -ln(determinant) / 2 - ln(expected).
  const double along = kSizeStrength * prior.amplitude;
  jacobian.setZero();
  jacobian[kMuu] = -0.5 * along * c / determinant;
  jacobian[kMvv] = -0.5 * along * a / determinant;
  jacobian[kMuv] = along * b / determinant;
  equations->add(jacobian, along * (-0.5 * std::log(determinant) - std::log(prior.radius_px)), 1.0);
  if constexpr (N == kShadedParameters) {
    jacobian.setZero();
    jacobian[kShadeR] = kShadeStrength;
    equations->add(jacobian, kShadeStrength * p[kShadeR], 1.0);
  }
  return equations;
}

/// The levels of the pixels well inside and outside the guess.
struct Contrast {
  double level;      ///< of the background
  double amplitude;  ///< of the marker above it, > 0
};

std::optional<Contrast> contrast_of(const MarkerPixels& window, const MarkerGuess& guess) {
  std::vector<double> inside, around;
  inside.reserve(window.size());
  around.reserve(window.size());
  const double well_inside_px = 0.7 * guess.radius_px;
  for (std::size_t i = 0; i < window.size(); ++i) {
    const double du = window.u()[i] - guess.centre.x, dv = window.v()[i] - guess.centre.y;
    const double square = du * du + dv * dv;
    if (square < well_inside_px * well_inside_px) inside.push_back(window.value()[i]);
    if (square > guess.radius_px * guess.radius_px) around.push_back(window.value()[i]);
  }
  if (inside.empty() || around.empty()) return std::nullopt;
  const double level = median_of(std::move(around));
  const double amplitude = median_of(std::move(inside)) - level;
  if (!(amplitude > 0.0)) return std::nullopt;
  return Contrast{level, amplitude};
}

template <int N>
Eigen::Matrix<double, N, 1> start_of(const MarkerGuess& guess, const Contrast& contrast) {
  Eigen::Matrix<double, N, 1> start = Eigen::Matrix<double, N, 1>::Zero();
  start[kU] = guess.centre.x;
  start[kV] = guess.centre.y;
  start[kMuu] = guess.shape ? (*guess.shape)[0] : 1.0 / guess.radius_px;
  start[kMuv] = guess.shape ? (*guess.shape)[1] : 0.0;
  start[kMvv] = guess.shape ? (*guess.shape)[2] : 1.0 / guess.radius_px;
  start[kLogBlur] = std::log(guess.blur_px);
  start[kBright] = contrast.level + contrast.amplitude;
  start[kLevel] = contrast.level;
  return start;
}

/// Steps of the parameters that are too small to matter.
template <int N>
Eigen::Matrix<double, N, 1> steps_of(const MarkerGuess& guess, double amplitude) {
  Eigen::Matrix<double, N, 1> step = Eigen::Matrix<double, N, 1>::Constant(3e-3 * amplitude);
  step[kU] = step[kV] = 1e-3;
  step[kMuu] = step[kMuv] = step[kMvv] = 3e-3 / guess.radius_px;
  step[kLogBlur] = 2e-2;
  return step;
}

template <int N>
LeastSquaresFit<N> solve(MarkerModel<N>& pixels, const MarkerGuess& guess, const Contrast& contrast,
                         const Eigen::Matrix<double, N, 1>& start) {
  const double amplitude = contrast.amplitude;
  const Prior prior{guess.radius_px, guess.blur_px, amplitude};
  const auto model = [&](const Eigen::Matrix<double, N, 1>& p) { return evaluate<N>(pixels, prior, p); };
  const auto is_hopeless = [&](const LeastSquaresFit<N>& so_far, const NormalEquations<N>& here) {
    if (so_far.iterations < kIterationsBeforeHopeless) return false;
    const double bright = std::max(amplitude, so_far.parameters[kBright] - so_far.parameters[kLevel]);
    return here.cost > here.weight * kHopelessResidual * kHopelessResidual * bright * bright;
  };
  const Eigen::Matrix<double, N, 1> step = steps_of<N>(guess, amplitude);
  LeastSquaresFit<N> found = fit_least_squares<N>(model, start, step, kMaxIterations, is_hopeless);
  const bool unsettled = found.stop == base::FitStop::iterations || found.stop == base::FitStop::no_descent;
  if (unsettled && found.parameters[kLogBlur] < std::log(kSharpEdge_px) && found.rms < kLargestResidual * amplitude) {
    found = fit_least_squares<N>(model, found.parameters, step, kMoreIterations);
  }
  return found;
}

/// Standard deviation of one coordinate of the centre. The pixels of a bright marker are noisier than those of the
/// background, and the taper counts, so the covariance is the sandwich A^-1 B A^-1 with A = J^T W J and B = sum (w r)^2
/// J J^T. The N parameters are taken from the degrees of freedom of the residuals.
template <int N>
double centre_sd(MarkerModel<N>& pixels, const LeastSquaresFit<N>& found, double total_weight) {
  const Eigen::Matrix<double, N, N> noise =
      pixels.gradient_variance(found.evaluated_at, found.parameters - found.evaluated_at);
  const Eigen::Matrix<double, 2, N> inverse = found.covariance.template topRows<2>() / (found.rms * found.rms);
  const Eigen::Matrix2d covariance = inverse * noise * inverse.transpose();
  const double freedom = total_weight / (total_weight - N);
  return std::sqrt(0.5 * freedom * covariance.trace());
}

struct Moments {
  cv::Point2d first;
  cv::Vec3d second;
};

/// The moments of what exceeds the fitted background.
Moments moments_of(const MarkerPixels& window, const MarkerFit& marker, double expected_radius_px) {
  cv::Vec3d moments(0.0, 0.0, 0.0);
  cv::Point2d first;
  double above = 0.0;
  const double reach =
      kMomentReach * expected_radius_px + kMomentMargin_px;  // short of other things that move with the marker
  for (std::size_t i = 0; i < window.size(); ++i) {
    const double du = window.u()[i] - marker.centre.x, dv = window.v()[i] - marker.centre.y;
    if (du * du + dv * dv > reach * reach) continue;
    const double value = window.value()[i] - marker.background - marker.slope_u * du - marker.slope_v * dv;
    above += value;
    first += value * cv::Point2d(du, dv);
    moments += value * cv::Vec3d(du * du, du * dv, dv * dv);
  }
  return {first / above, moments * (1.0 / above)};
}

template <int N>
MarkerFit marker_of(const MarkerPixels& window, const MarkerGuess& guess, MarkerModel<N>& pixels,
                    const LeastSquaresFit<N>& found, double total_weight) {
  const auto& p = found.parameters;
  MarkerFit marker;
  marker.centre = {p[kU], p[kV]};
  marker.sd_px = centre_sd<N>(pixels, found, total_weight);
  const double determinant = p[kMuu] * p[kMvv] - p[kMuv] * p[kMuv];
  marker.radius_px = 1.0 / std::sqrt(determinant);
  marker.shape = {p[kMuu], p[kMuv], p[kMvv]};
  const double mean = 0.5 * (p[kMuu] + p[kMvv]);
  const double spread = std::hypot(0.5 * (p[kMuu] - p[kMvv]), p[kMuv]);
  marker.elongation = (mean + spread) / std::max(mean - spread, 1e-9);
  marker.amplitude = p[kBright] - p[kLevel];
  marker.background = p[kLevel];
  marker.slope_u = p[kSlopeU];
  marker.slope_v = p[kSlopeV];
  const Moments moments = moments_of(window, marker, guess.radius_px);
  marker.moments = moments.second;
  marker.light_px = moments.first;
  marker.blur_px = std::exp(p[kLogBlur]);
  marker.rms = found.rms;
  if constexpr (N == kShadedParameters)
    marker.shade = cv::Vec3d(p[kShadeU], p[kShadeV], p[kShadeR]) * (1.0 / marker.amplitude);
  marker.bic = total_weight * std::log(std::max(found.rms * found.rms * (total_weight - N) / total_weight, 1e-12)) +
               N * std::log(total_weight);
  return marker;
}

bool is_plausible(const MarkerFit& marker, const MarkerGuess& guess) {
  const double moved = cv::norm(marker.centre - guess.centre);
  return moved < std::max(guess.radius_px, 1.5) && has_expected_size(marker, guess) && marker.amplitude > 0.0 &&
         marker.rms < kLargestResidual * marker.amplitude;
}

template <int N>
std::optional<LeastSquaresFit<N>> settled_fit(const MarkerPixels& window, MarkerModel<N>& pixels,
                                              const MarkerGuess& guess) {
  if (window.size() < 2 * static_cast<std::size_t>(N)) return std::nullopt;
  const std::optional<Contrast> contrast = contrast_of(window, guess);
  if (!contrast) return std::nullopt;
  const LeastSquaresFit<N> found = solve<N>(pixels, guess, *contrast, start_of<N>(guess, *contrast));
  if (!base::is_settled(found.stop)) return std::nullopt;
  return found;
}

template <int N>
std::optional<MarkerFit> plausible_marker(const MarkerPixels& window, const MarkerGuess& guess, MarkerModel<N>& pixels,
                                          const LeastSquaresFit<N>& found) {
  double total_weight = 0.0;
  for (const double w : window.weight()) total_weight += w;
  if (!(total_weight > N) || !(found.rms > 0.0)) return std::nullopt;
  MarkerFit marker = marker_of<N>(window, guess, pixels, found, total_weight);
  if (!is_plausible(marker, guess)) return std::nullopt;
  return marker;
}

std::optional<MarkerPixels> cut_around(const Signal& signal, const MarkerGuess& guess) {
  return cut_window(signal, guess.centre, 1.25 * guess.radius_px + 2.5);
}

template <int N>
std::optional<MarkerFit> fit(const Signal& signal, const MarkerGuess& guess) {
  const std::optional<MarkerPixels> window = cut_around(signal, guess);
  if (!window) return std::nullopt;
  MarkerModel<N> pixels(*window);
  const std::optional<LeastSquaresFit<N>> found = settled_fit<N>(*window, pixels, guess);
  if (!found) return std::nullopt;
  return plausible_marker<N>(*window, guess, pixels, *found);
}

/// The same signal with the light of the codes in their place.
Signal in_light(const Signal& signal, ToneCurve tone) {
  if (!signal.inverse || tone == ToneCurve::linear) return {light_of(signal.values, tone), {}, signal.inverse};
  cv::Mat codes, light;
  cv::bitwise_not(signal.values, codes);
  cv::bitwise_not(light_of(codes, tone), light);
  return {light, {}, true};
}

/// A window that is fitted to the light of its codes under a tone curve, repeatedly, each time without what a response
/// adds.
template <int N>
class Refit {
 public:
  Refit(const MarkerWindow& of, ToneCurve tone)
      : of_(of), window_(*cut_around(in_light(of.signal, tone), of.guess)), pixels_(window_) {
    seen_.light = Eigen::Map<const Eigen::VectorXd>(window_.value().data(), size());
    seen_.weight = Eigen::Map<const Eigen::VectorXd>(window_.weight().data(), size());
    seen_.inverse = of.signal.inverse;
    seen_.full = of.signal.values.depth() == CV_8U && tone == ToneCurve::linear ? 255.0 : 65535.0;
    for (std::size_t i = 0; i < window_.size(); ++i) {
      seen_.pixels.push_back(of.corner + cv::Point(static_cast<int>(window_.u()[i]), static_cast<int>(window_.v()[i])));
    }
  }

  /// Whether the fit settles. A null `response` adds nothing.
  bool settles(const EdgeResponse* response) {
    constexpr int kRefits = 2;  // the response changes by a tenth of the change that it makes to the fit
    found_ = settled_fit<N>(window_, pixels_, of_.guess);
    const std::optional<Contrast> contrast = contrast_of(window_, of_.guess);
    for (int refit = 0; found_ && response != nullptr && refit < kRefits; ++refit) {
      look();
      const Eigen::VectorXd added = added_by(*response, seen_);
      for (Eigen::Index i = 0; i < size(); ++i)
        window_.set_value(static_cast<std::size_t>(i), seen_.light[i] - added[i]);
      pixels_.forget();
      found_ = solve<N>(pixels_, of_.guess, *contrast, found_->parameters);
      if (!base::is_settled(found_->stop)) found_ = solve<N>(pixels_, of_.guess, *contrast, found_->parameters);
      if (!base::is_settled(found_->stop)) found_.reset();
    }
    return found_.has_value();
  }
  FittedWindow fitted() {
    look();
    seen_.jacobian = pixels_.jacobian(found_->parameters);
    return seen_;
  }
  std::optional<MarkerFit> marker() { return plausible_marker<N>(window_, of_.guess, pixels_, *found_); }

 private:
  Eigen::Index size() const { return static_cast<Eigen::Index>(window_.size()); }
  void look() {
    const Eigen::VectorXd p = found_->parameters;
    seen_.model = pixels_.image(p);
    seen_.contrast = p[kBright] - p[kLevel];
    const double blur = std::exp(p[kLogBlur]);
    constexpr double kSharpest_px = 0.05;  // below, nothing changes at the width of a pixel
    seen_.at = [p, blur, corner = of_.corner](cv::Point pixel, double narrower_px2) {
      const double sharp = std::sqrt(std::max(blur * blur - narrower_px2, kSharpest_px * kSharpest_px));
      return marker_at(p, sharp, cv::Point2d(pixel - corner));
    };
  }

  const MarkerWindow& of_;
  MarkerPixels window_;
  MarkerModel<N> pixels_;
  std::optional<LeastSquaresFit<N>> found_;
  FittedWindow seen_;
};

template <int N>
std::optional<EdgeResponse> response_of(const std::vector<MarkerWindow>& windows, bool may_be_curved) {
  return edge_response_of(windows.size(), may_be_curved,
                          [&](std::size_t i, ToneCurve tone, const EdgeResponse* known) -> std::optional<FittedWindow> {
                            if (!cut_around(windows[i].signal, windows[i].guess)) return std::nullopt;
                            Refit<N> refit(windows[i], tone);
                            if (!refit.settles(known)) return std::nullopt;
                            return refit.fitted();
                          });
}

template <int N>
std::optional<MarkerFit> fit_again(const MarkerWindow& window, const EdgeResponse& response) {
  if (!cut_around(window.signal, window.guess)) return std::nullopt;
  Refit<N> refit(window, response.tone);
  if (!refit.settles(&response)) return std::nullopt;
  return refit.marker();
}

}  // namespace

std::optional<MarkerFit> fit_marker(const Signal& signal, const MarkerGuess& guess, Surface surface) {
  return surface == Surface::uniform ? fit<kUniformParameters>(signal, guess) : fit<kShadedParameters>(signal, guess);
}

std::optional<EdgeResponse> marker_response(const std::vector<MarkerWindow>& windows, Surface surface,
                                            bool may_be_curved) {
  return surface == Surface::uniform ? response_of<kUniformParameters>(windows, may_be_curved)
                                     : response_of<kShadedParameters>(windows, may_be_curved);
}

std::optional<MarkerFit> fit_marker(const MarkerWindow& window, Surface surface, const EdgeResponse& response) {
  return surface == Surface::uniform ? fit_again<kUniformParameters>(window, response)
                                     : fit_again<kShadedParameters>(window, response);
}

namespace {

enum Parameter {
  kDiscU,
  kDiscV,
  kDiscRadius,
  kDiscBlur,
  kDiscBright,
  kDiscLevel,
  kDiscSlopeU,
  kDiscSlopeV,
  kDiscParameters
};
using Vector = Eigen::Matrix<double, kDiscParameters, 1>;

double pixel_of(const Vector& p, double u, double v) {
  const double du = u - p[kDiscU], dv = v - p[kDiscV];
  const double distance = std::max(std::hypot(du, dv), 1e-9);
  const double edge = pixel_edge(p[kDiscRadius] - distance, du / distance, dv / distance, p[kDiscBlur]).value;
  const double behind = p[kDiscLevel] + p[kDiscSlopeU] * du + p[kDiscSlopeV] * dv;
  return behind + (p[kDiscBright] - behind) * edge;
}

}  // namespace

double least_centre_sd_px(const DiscImage& disc, double reach_px) {
  Vector p;
  p << disc.u, disc.v, disc.radius_px, disc.blur_px, disc.amplitude, 0.0, 0.0, 0.0;
  Eigen::Matrix<double, kDiscParameters, kDiscParameters> information;
  information.setZero();
  // Step of the central differences, in pixels and grey values: the third derivative adds 1e-6 of the first.
  constexpr double kStep = 1e-3;
  for (int v = static_cast<int>(std::ceil(disc.v - reach_px)); v <= disc.v + reach_px; ++v) {
    for (int u = static_cast<int>(std::ceil(disc.u - reach_px)); u <= disc.u + reach_px; ++u) {
      if (std::hypot(u - disc.u, v - disc.v) > reach_px) continue;
      Vector slope;
      for (int k = 0; k < kDiscParameters; ++k) {
        Vector up = p, down = p;
        up[k] += kStep;
        down[k] -= kStep;
        slope[k] = (pixel_of(up, u, v) - pixel_of(down, u, v)) / (2.0 * kStep);
      }
      information += slope * slope.transpose() / (disc.noise_sd * disc.noise_sd);
    }
  }
  const Eigen::MatrixXd bound = base::inverse_positive(information);
  return std::sqrt(0.5 * (bound(kDiscU, kDiscU) + bound(kDiscV, kDiscV)));
}

}  // namespace glidelab::core
