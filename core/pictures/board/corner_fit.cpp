#include "core/pictures/board/corner_fit.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/math/least_squares.h"
#include "core/pictures/image/pixel_signal.h"

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

/// Prior of the blur, because an edge along a pixel's border shows no width.
constexpr double kUsualBlurPx = 0.4;
constexpr double kBlurStrength = 0.05;  // weight of a unit of ln(blur), as a fraction of the contrast in one pixel

/// Pixels beyond the reach of both edges, of which half of a window may consist: there the model is
/// (1 + h . d) (b ± a), so that their part of the normal equations follows from a few sums.
struct Plateau {
  double weight = 0.0, u = 0.0, v = 0.0, uu = 0.0, uv = 0.0, vv = 0.0;  // sums of w, w du, …, w dv²
  double y = 0.0, uy = 0.0, vy = 0.0, yy = 0.0;                         // of w y, w du y, w dv y, w y²

  void add(double du, double dv, double value, double w) {
    const double wu = w * du, wv = w * dv, wy = w * value;
    weight += w;
    u += wu;
    v += wv;
    uu += wu * du;
    uv += wu * dv;
    vv += wv * dv;
    y += wy;
    uy += wy * du;
    vy += wy * dv;
    yy += wy * value;
  }

  /// The Jacobian of a pixel is M (1, du, dv), its model light . (1, du, dv) times the pattern.
  void add_to(NormalEquations<kParameters>& equations, const Vector& p, double sign) const {
    const double pattern = p[kMean] + sign * p[kAmplitude];
    const Eigen::Vector3d light(1.0, p[kSlopeU], p[kSlopeV]), data(y, uy, vy);
    Eigen::Matrix3d sums;
    sums << weight, u, v, u, uu, uv, v, uv, vv;
    Eigen::Matrix<double, kParameters, 3> m = Eigen::Matrix<double, kParameters, 3>::Zero();
    m(kU, 0) = -p[kSlopeU] * pattern;
    m(kV, 0) = -p[kSlopeV] * pattern;
    m.row(kMean) = light.transpose();
    m.row(kAmplitude) = sign * light.transpose();
    m(kSlopeU, 1) = m(kSlopeV, 2) = pattern;
    const Eigen::Vector3d model = pattern * (sums * light);
    equations.jtj += m * sums * m.transpose();
    equations.jtr += m * (model - data);
    equations.cost += pattern * light.dot(model - 2.0 * data) + yy;
    equations.weight += weight;
  }
};

/// The edges of a corner for given parameters.
struct Edges {
  double cx, sx, cy, sy;  // directions
  double far;             // pixels that an edge leaves all dark or all bright: Phi(-5) = 3e-7
  EdgeBoxes first_boxes, second_boxes;

  Edges(const Vector& p, double blur)
      : cx(std::cos(p[kAngleX])),
        sx(std::sin(p[kAngleX])),
        cy(std::cos(p[kAngleY])),
        sy(std::sin(p[kAngleY])),
        far(5.0 * blur + 0.71),
        first_boxes(edge_boxes(-sx, cx, blur)),
        second_boxes(edge_boxes(-sy, cy, blur)) {}

  // Signed distances from the edge along x (its normal is (-sx, cx)) and from the edge along y.
  double from_first(double du, double dv) const { return -sx * du + cx * dv; }
  double from_second(double du, double dv) const { return -sy * du + cy * dv; }
  PixelEdge first(double d) const { return response(d, first_boxes); }
  PixelEdge second(double d) const { return response(d, second_boxes); }

 private:
  PixelEdge response(double d, const EdgeBoxes& boxes) const {
    static const NormalNodes nodes = make_normal_nodes();
    return std::abs(d) > far ? PixelEdge{d > 0.0 ? 1.0 : 0.0, 0.0, 0.0} : edge_of(boxes, edge_corners(nodes, d, boxes));
  }
};

/// The model at a pixel, and its derivatives.
double corner_pixel(const Edges& edges, double blur, const Vector& p, double du, double dv, Vector& jacobian) {
  const PixelEdge first = edges.first(edges.from_first(du, dv)), second = edges.second(edges.from_second(du, dv));
  const double e1 = 2.0 * first.value - 1.0, e2 = 2.0 * second.value - 1.0;
  const double light = 1.0 + p[kSlopeU] * du + p[kSlopeV] * dv;
  const double pattern = p[kMean] + p[kAmplitude] * e1 * e2;
  const double to_d1 = light * p[kAmplitude] * 2.0 * first.slope * e2;
  const double to_d2 = light * p[kAmplitude] * e1 * 2.0 * second.slope;
  jacobian[kU] = to_d1 * edges.sx + to_d2 * edges.sy - p[kSlopeU] * pattern;
  jacobian[kV] = -to_d1 * edges.cx - to_d2 * edges.cy - p[kSlopeV] * pattern;
  jacobian[kAngleX] = to_d1 * (-edges.cx * du - edges.sx * dv);
  jacobian[kAngleY] = to_d2 * (-edges.cy * du - edges.sy * dv);
  jacobian[kLogBlur] = light * p[kAmplitude] * 2.0 * blur * blur * (first.bend * e2 + e1 * second.bend);
  jacobian[kMean] = light;
  jacobian[kAmplitude] = light * e1 * e2;
  jacobian[kSlopeU] = pattern * du;
  jacobian[kSlopeV] = pattern * dv;
  return light * pattern;
}

/// The image before the response around a corner, each pixel once.
class PixelsAround {
 public:
  explicit PixelsAround(const Window& window) {
    cv::Point last(-1, -1);
    first_ = {1 << 30, 1 << 30};
    for (const cv::Point2d& at : window.at) {
      first_ = {std::min(first_.x, cvRound(at.x)), std::min(first_.y, cvRound(at.y))};
      last = {std::max(last.x, cvRound(at.x)), std::max(last.y, cvRound(at.y))};
    }
    first_ -= cv::Point(1, 1);
    size_ = {last.x + 2 - first_.x, last.y + 2 - first_.y};
    cells_.resize(static_cast<std::size_t>(size_.area()));
  }

  void set(const Vector& p) {
    p_ = p;
    blur_ = std::exp(p[kLogBlur]);
    edges_.emplace(p, blur_);
    for (Cell& cell : cells_) cell.known = false;
  }
  /// Of the pixel that was seen last: how much of its light, before the tone, is the bright side's.
  double share() const { return share_; }

  /// What the pixel gives with the response, and its derivatives.
  double seen(cv::Point pixel, const EdgeResponse& response, Vector& jacobian) {
    const int place = 2 * (pixel.y & 1) + (pixel.x & 1);
    const auto mask = response.terms.segment<EdgeResponse::kMaskTerms>(EdgeResponse::kMaskTerms * place);
    const Cell& middle = at(pixel);
    double light = (1.0 - mask.sum()) * middle.light;
    jacobian = (1.0 - mask.sum()) * middle.jacobian;
    const auto add = [&](int u, int v, double share) {
      const Cell& cell = at(pixel + cv::Point(u, v));
      light += share * cell.light;
      jacobian += share * cell.jacobian;
    };
    for (const int side : {-1, 1}) {
      add(side, 0, 0.5 * mask[0]);
      add(0, side, 0.5 * mask[1]);
      add(side, -1, 0.25 * mask[2]);
      add(side, 1, 0.25 * mask[2]);
    }
    // C E (1 - E) (t + w (2 E - 1)) with C = 2 |a|.
    const double half = std::abs(p_[kAmplitude]), shade = middle.jacobian[kMean];
    const double bright = 0.5 + 0.5 * (light / shade - p_[kMean]) / half, t = response.curvature(),
                 w = response.twist();
    const double rises = t * (1.0 - 2.0 * bright) + w * (6.0 * bright * (1.0 - bright) - 1.0);
    const double bent = 2.0 * bright * (1.0 - bright) * (t + w * (2.0 * bright - 1.0));
    light += half * bent;
    share_ = bright;
    jacobian.head<kMean>() *= 1.0 + rises / shade;
    jacobian[kAmplitude] += p_[kAmplitude] > 0.0 ? bent : -bent;
    return light;
  }

 private:
  struct Cell {
    bool known = false;
    double light = 0.0;
    Vector jacobian;
  };
  const Cell& at(cv::Point pixel) {
    Cell& cell = cells_[static_cast<std::size_t>((pixel.y - first_.y) * size_.width + pixel.x - first_.x)];
    if (!cell.known) {
      cell.light = corner_pixel(*edges_, blur_, p_, pixel.x - p_[kU], pixel.y - p_[kV], cell.jacobian);
      cell.known = true;
    }
    return cell;
  }

  cv::Point first_;
  cv::Size size_;
  std::vector<Cell> cells_;
  Vector p_;
  double blur_ = 0.0, share_ = 0.0;
  std::optional<Edges> edges_;
};

/// The model of a window's pixels, with a response or (null) without.
class CornerModel {
 public:
  CornerModel(const Window& window, const EdgeResponse* response) : window_(window), response_(response) {
    if (response_ != nullptr) around_.emplace(window);
  }

  std::optional<NormalEquations<kParameters>> evaluate(double contrast, const Vector& p) {
    const double blur = std::exp(p[kLogBlur]);
    if (!(blur > 0.01) || blur > 10.0) return std::nullopt;
    NormalEquations<kParameters> equations;
    const Edges edges(p, blur);
    if (around_) around_->set(p);
    const double reach = edges.far + (around_ ? std::numbers::sqrt2 : 0.0);  // the response's neighbours too
    std::array<Plateau, 2> plateaus;  // where both edges are on one side, where not
    Vector jacobian;
    for (std::size_t i = 0; i < window_.at.size(); ++i) {
      const double du = window_.at[i].x - p[kU];
      const double dv = window_.at[i].y - p[kV];
      const double d1 = edges.from_first(du, dv), d2 = edges.from_second(du, dv);
      if (std::abs(d1) > reach && std::abs(d2) > reach) {
        plateaus[(d1 > 0.0) == (d2 > 0.0) ? 0 : 1].add(du, dv, window_.value[i], window_.weight[i]);
        continue;
      }
      const double model =
          around_ ? around_->seen({cvRound(window_.at[i].x), cvRound(window_.at[i].y)}, *response_, jacobian)
                  : corner_pixel(edges, blur, p, du, dv, jacobian);
      equations.add(jacobian, model - window_.value[i], window_.weight[i]);
    }
    plateaus[0].add_to(equations, p, 1.0);
    plateaus[1].add_to(equations, p, -1.0);
    jacobian.setZero();
    const double strength = kBlurStrength * contrast;
    jacobian[kLogBlur] = strength;
    equations.add(jacobian, strength * (p[kLogBlur] - std::log(kUsualBlurPx)), 1.0);
    return equations;
  }

  /// As it is fitted, with its derivatives.
  FittedWindow fitted(const Vector& p) {
    const double blur = std::exp(p[kLogBlur]);
    const Edges edges(p, blur);
    const auto count = static_cast<Eigen::Index>(window_.at.size());
    FittedWindow fitted;
    fitted.weight = Eigen::Map<const Eigen::VectorXd>(window_.weight.data(), count);
    fitted.light = Eigen::Map<const Eigen::VectorXd>(window_.value.data(), count);
    fitted.model.resize(count);
    fitted.jacobian.resize(count, kParameters);
    if (around_) around_->set(p);
    Vector slopes;
    for (Eigen::Index i = 0; i < count; ++i) {
      const cv::Point2d at = window_.at[static_cast<std::size_t>(i)];
      const cv::Point pixel(cvRound(at.x), cvRound(at.y));
      fitted.pixels.push_back(pixel);
      fitted.model[i] = around_ ? around_->seen(pixel, *response_, slopes)
                                : corner_pixel(edges, blur, p, at.x - p[kU], at.y - p[kV], slopes);
      fitted.jacobian.row(i) = slopes.transpose();
      if (around_) fitted.bright.push_back(around_->share());
    }
    fitted.contrast = 2.0 * std::abs(p[kAmplitude]);
    fitted.at = [p, blur](cv::Point pixel, double narrower_px2) {
      constexpr double kSharpest_px = 0.05;  // nothing changes below, at a pixel's width
      const double sharp = std::sqrt(std::max(blur * blur - narrower_px2, kSharpest_px * kSharpest_px));
      Vector unused;
      const double du = pixel.x - p[kU], dv = pixel.y - p[kV];
      const double light = corner_pixel(Edges(p, sharp), sharp, p, du, dv, unused);
      const double pattern = light / (1.0 + p[kSlopeU] * du + p[kSlopeV] * dv);
      return ModelPixel{light, 0.5 + 0.5 * (pattern - p[kMean]) / std::abs(p[kAmplitude])};
    };
    return fitted;
  }

 private:
  const Window& window_;
  const EdgeResponse* response_;
  std::optional<PixelsAround> around_;
};

Window window_around(const cv::Mat& grey, cv::Point2d centre, double radius) {
  return grey.depth() == CV_8U ? cut_window<std::uint8_t>(grey, centre, radius)
                               : cut_window<std::uint16_t>(grey, centre, radius);
}

Vector start_of(const Window& window, cv::Point2d start, const CornerSurroundings& around) {
  const auto [low, high] = std::minmax_element(window.value.begin(), window.value.end());
  Vector parameters;
  parameters << start.x, start.y, around.angle_x, around.angle_y, std::log(0.6), 0.5 * (*low + *high),
      0.5 * (*high - *low), 0.0, 0.0;
  double agreement = 0.0;  // the sign of the amplitude: which two of the four squares are bright
  const auto at_start = CornerModel(window, nullptr).evaluate(0.0, parameters);
  if (at_start) {
    agreement = -at_start->jtr[kAmplitude] + parameters[kAmplitude] * at_start->jtj(kAmplitude, kAmplitude);
  }
  if (agreement < 0.0) parameters[kAmplitude] = -parameters[kAmplitude];
  return parameters;
}

LeastSquaresFit<kParameters> solve(CornerModel& model, const Vector& start) {
  Vector step;
  const double level = 1e-4 * std::abs(start[kAmplitude]) + 1e-9;
  step << 1e-4, 1e-4, 1e-4, 1e-4, 1e-2, level, level, 1e-5, 1e-5;
  const double contrast = std::abs(start[kAmplitude]);
  return fit_least_squares<kParameters>([&](const Vector& p) { return model.evaluate(contrast, p); }, start, step, 50);
}

/// A corner that is fitted, with its last window.
class CornerFit {
 public:
  CornerFit(const cv::Mat& image, cv::Point2d start, const CornerSurroundings& around)
      : image_(image), start_(start), around_(around) {}

  /// Whether it converges on something that is a corner; `response` null: the image as it is.
  bool settles(const EdgeResponse* response) {
    response_ = response;
    if (around_.window_px < kSmallestWindowPx) return false;
    cv::Point2d centre = start_;
    // Twice: the second time the window is centred on the first result.
    for (int pass = 0; pass < 2; ++pass) {
      window_ = window_around(image_, centre, around_.window_px);
      if (window_.at.size() < 2 * kParameters) return false;
      CornerModel model(window_, pass == 0 ? nullptr : response);
      fit_ = solve(model, pass == 0 ? start_of(window_, start_, around_) : fit_.parameters);
      if (!is_corner()) return false;
      if (pass == 0) plain_rms_ = fit_.rms;
      centre = point();
    }
    return true;
  }

  FittedCorner corner() const {
    const double left = response_ != nullptr ? std::pow(fit_.rms / plain_rms_, 2) : 1.0;
    return {point(), std::sqrt(0.5 * (fit_.covariance(kU, kU) + fit_.covariance(kV, kV))), left};
  }
  FittedWindow fitted() const {
    FittedWindow fitted = CornerModel(window_, response_).fitted(fit_.parameters);
    fitted.full = image_.depth() == CV_8U ? 255.0 : 65535.0;
    return fitted;
  }

 private:
  cv::Point2d point() const { return {fit_.parameters[kU], fit_.parameters[kV]}; }
  bool is_corner() const {
    if (!base::is_settled(fit_.stop)) return false;
    const bool stayed = cv::norm(point() - start_) < std::min(0.5 * around_.window_px, 3.0);
    // A crossing of two edges leaves a small residual; a quarter of the contrast is something else.
    return stayed && fit_.rms <= 0.25 * std::abs(fit_.parameters[kAmplitude]);
  }

  const cv::Mat& image_;
  cv::Point2d start_;
  CornerSurroundings around_;
  const EdgeResponse* response_ = nullptr;
  Window window_;
  double plain_rms_ = 0.0;  ///< without a response
  LeastSquaresFit<kParameters> fit_;
};

}  // namespace

std::optional<FittedCorner> fit_corner(const cv::Mat& image, cv::Point2d start, const CornerSurroundings& around,
                                       const EdgeResponse* response) {
  CornerFit fit(image, start, around);
  if (!fit.settles(response)) return std::nullopt;
  return fit.corner();
}

std::optional<FittedWindow> corner_window(const cv::Mat& image, cv::Point2d start, const CornerSurroundings& around,
                                          const EdgeResponse* response) {
  CornerFit fit(image, start, around);
  if (!fit.settles(response)) return std::nullopt;
  return fit.fitted();
}

}  // namespace glidelab::core
