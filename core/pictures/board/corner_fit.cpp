#include "core/pictures/board/corner_fit.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/math/least_squares.h"
#include "core/pictures/image/pixel_edge.h"

namespace glidelab::core {
namespace {

constexpr double kSmallestWindowPx = 2.5;

enum Parameter { kU, kV, kAngleX, kAngleY, kLogBlur, kMean, kAmplitude, kSlopeU, kSlopeV, kParameters };
using Vector = Eigen::Matrix<double, kParameters, 1>;

/// The pixels around a corner, tapered towards the rim so that a pixel more or less there does not matter.
struct Window {
  std::vector<cv::Point2d> at;
  std::vector<double> value;
  std::vector<double> weight;
};

template <class Pixel>
Window cut_window(const cv::Mat& grey, cv::Point2d centre, double radius) {
  Window window;
  for (int v = static_cast<int>(std::ceil(centre.y - radius)); v <= centre.y + radius; ++v) {
    for (int u = static_cast<int>(std::ceil(centre.x - radius)); u <= centre.x + radius; ++u) {
      if (u < 0 || v < 0 || u >= grey.cols || v >= grey.rows) continue;
      const double share = std::hypot(u - centre.x, v - centre.y) / radius;
      if (share >= 1.0) continue;
      window.at.emplace_back(u, v);
      window.value.push_back(static_cast<double>(grey.at<Pixel>(v, u)));
      window.weight.push_back(share < 0.75 ? 1.0 : 0.5 * (1.0 + std::cos(std::numbers::pi * (share - 0.75) / 0.25)));
    }
  }
  return window;
}

/// What is known of the blur beforehand, for an edge that runs along a pixel's border has no width to be seen.
constexpr double kUsualBlurPx = 0.4;
constexpr double kBlurStrength = 0.05;  // worth so much of the contrast in one pixel, a unit of ln(blur)

std::optional<NormalEquations<kParameters>> evaluate(const Window& window, double contrast, const Vector& p) {
  const double blur = std::exp(p[kLogBlur]);
  if (!(blur > 0.01) || blur > 10.0) return std::nullopt;
  NormalEquations<kParameters> equations;
  const double cx = std::cos(p[kAngleX]), sx = std::sin(p[kAngleX]);
  const double cy = std::cos(p[kAngleY]), sy = std::sin(p[kAngleY]);
  const double far = 5.0 * blur + 0.71;  // pixels that an edge leaves all dark or all bright: Phi(-5) = 3e-7
  const auto response = [&](double d, double nu, double nv) {
    return std::abs(d) > far ? PixelEdge{d > 0.0 ? 1.0 : 0.0, 0.0, 0.0} : pixel_edge(d, nu, nv, blur);
  };
  for (std::size_t i = 0; i < window.at.size(); ++i) {
    const double du = window.at[i].x - p[kU];
    const double dv = window.at[i].y - p[kV];
    // Signed distances from the edge along x (its normal is (-sx, cx)) and from the edge along y.
    const PixelEdge first = response(-sx * du + cx * dv, -sx, cx);
    const PixelEdge second = response(-sy * du + cy * dv, -sy, cy);
    const double e1 = 2.0 * first.value - 1.0, e2 = 2.0 * second.value - 1.0;
    const double light = 1.0 + p[kSlopeU] * du + p[kSlopeV] * dv;
    const double pattern = p[kMean] + p[kAmplitude] * e1 * e2;
    const double to_d1 = light * p[kAmplitude] * 2.0 * first.slope * e2;
    const double to_d2 = light * p[kAmplitude] * e1 * 2.0 * second.slope;
    Vector jacobian;
    jacobian[kU] = to_d1 * sx + to_d2 * sy - p[kSlopeU] * pattern;
    jacobian[kV] = -to_d1 * cx - to_d2 * cy - p[kSlopeV] * pattern;
    jacobian[kAngleX] = to_d1 * (-cx * du - sx * dv);
    jacobian[kAngleY] = to_d2 * (-cy * du - sy * dv);
    jacobian[kLogBlur] = light * p[kAmplitude] * 2.0 * blur * blur * (first.bend * e2 + e1 * second.bend);
    jacobian[kMean] = light;
    jacobian[kAmplitude] = light * e1 * e2;
    jacobian[kSlopeU] = pattern * du;
    jacobian[kSlopeV] = pattern * dv;
    equations.add(jacobian, light * pattern - window.value[i], window.weight[i]);
  }
  Vector jacobian = Vector::Zero();
  const double strength = kBlurStrength * contrast;
  jacobian[kLogBlur] = strength;
  equations.add(jacobian, strength * (p[kLogBlur] - std::log(kUsualBlurPx)), 1.0);
  return equations;
}

}  // namespace

std::optional<FittedCorner> fit_corner(const cv::Mat& grey, cv::Point2d start, const CornerSurroundings& around) {
  if (around.window_px < kSmallestWindowPx) return std::nullopt;
  FittedCorner refined{start, 0.0};
  Vector parameters = Vector::Zero();
  // Twice: the second time the window is centred on the first result.
  for (int pass = 0; pass < 2; ++pass) {
    const Window window = grey.depth() == CV_8U ? cut_window<std::uint8_t>(grey, refined.point, around.window_px)
                                                : cut_window<std::uint16_t>(grey, refined.point, around.window_px);
    if (window.at.size() < 2 * kParameters) return std::nullopt;
    if (pass == 0) {
      const auto [low, high] = std::minmax_element(window.value.begin(), window.value.end());
      parameters << start.x, start.y, around.angle_x, around.angle_y, std::log(0.6), 0.5 * (*low + *high),
          0.5 * (*high - *low), 0.0, 0.0;
      double agreement = 0.0;  // the sign of the amplitude: which two of the four squares are bright
      const auto at_start = evaluate(window, 0.0, parameters);
      if (at_start) {
        agreement = -at_start->jtr[kAmplitude] + parameters[kAmplitude] * at_start->jtj(kAmplitude, kAmplitude);
      }
      if (agreement < 0.0) parameters[kAmplitude] = -parameters[kAmplitude];
    }
    Vector step;
    const double level = 1e-4 * std::abs(parameters[kAmplitude]) + 1e-9;
    step << 1e-4, 1e-4, 1e-4, 1e-4, 1e-2, level, level, 1e-5, 1e-5;
    const double contrast = std::abs(parameters[kAmplitude]);
    const auto model = [&](const Vector& p) { return evaluate(window, contrast, p); };
    const auto fit = fit_least_squares<kParameters>(model, parameters, step, 50);
    if (!base::is_settled(fit.stop)) return std::nullopt;
    const cv::Point2d point(fit.parameters[kU], fit.parameters[kV]);
    const bool stayed = cv::norm(point - start) < std::min(0.5 * around.window_px, 3.0);
    // A crossing of two edges leaves a small residual; a quarter of the contrast is something else.
    if (!stayed || fit.rms > 0.25 * std::abs(fit.parameters[kAmplitude])) return std::nullopt;
    parameters = fit.parameters;
    refined.point = point;
    refined.sd_px = std::sqrt(0.5 * (fit.covariance(kU, kU) + fit.covariance(kV, kV)));
  }
  return refined;
}

}  // namespace glidelab::core
