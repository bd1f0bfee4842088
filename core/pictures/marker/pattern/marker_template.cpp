#include "core/pictures/marker/pattern/marker_template.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "base/math/dense.h"
#include "core/math/least_squares.h"
#include "core/math/quantile.h"
#include "core/pictures/marker/sphere/sphere_window.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kFewestWindows = 8;
constexpr int kSharpenings = 4;           // after these, a hundredth of the look is left
constexpr int kFewestNodesPerRadius = 3;  // of the grid
constexpr int kMostNodesPerRadius = 48;   // the grid of a larger marker has steps of a few pixels
constexpr double kNodesPerPixel = 2.0;  // edges are narrower than a pixel: on a grid of whole ones they err by 0.04 px
constexpr std::size_t kFewestForFineGrid = 32;  // windows; fewer do not fill the grid
constexpr int kNodesBeyond = 3;                 // margin that the interpolation needs
constexpr double kLeastOfNode = 0.5;            // weight of pixels, below which a node has no value
constexpr double kRobustTimes = 2.5;            // times the usual residual, beyond which a pixel counts less (Huber)
constexpr double kLeastResidual = 0.29;         // codes, 1 / sqrt(12)
constexpr double kSettled_px = 2e-4;
constexpr double kNearlySettled_px = 0.02;  // a longer step back is no jump of a weight
constexpr double kNormalOfMedian = 1.4826;  // standard deviation of a normal residual over the median of its size
constexpr std::size_t kFewestPixels = 12;   // three for each parameter of the fit
constexpr int kMostSteps = 25;
constexpr int kStepsWithUsual = 2;  // steps before the usual residual is one
constexpr double kLeastLightGain = 0.3, kMostLightGain = 3.0;
constexpr double kLeastPixels = 0.6;     // relative to the number in a whole window
constexpr double kTurnedReach = 1.15;    // radii around its centre in which a look is compared with itself turned
constexpr double kFarthestCentre = 0.2;  // radii from the mean of the guesses
constexpr double kSettledCentre = 1e-5;  // radii
constexpr double kMostTurnedDifference = 0.15;  // of the contrast, root mean square

/// The Gauss-Newton method, in which weights depend on the place, so that costs cannot be compared: every step is
/// taken. `step(from)` makes a base::FitTrial. Empty if it does not settle.
template <class Point, class Step>
std::optional<Point> gauss_newton(Point at, const Step& step) {
  base::FitOptions options;
  options.most_iterations = kMostSteps;
  options.take_every_step = true;
  const auto undamped = [&](const Point& from, double) {
    base::FitTrial<Point> trial = step(from);
    trial.cost = 0.0;
    return trial;
  };
  if (!base::is_settled(base::levenberg_marquardt(at, 0.0, options, undamped).stop)) return std::nullopt;
  return at;
}

/// Weights of four values at -1, 0, 1, 2 in the Catmull-Rom cubic between 0 and 1, and in its derivative.
std::array<double, 4> cubic_weights(double t) {
  const double t2 = t * t, t3 = t2 * t;
  return {-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1.0, -1.5 * t3 + 2.0 * t2 + 0.5 * t, 0.5 * t3 - 0.5 * t2};
}

std::array<double, 4> cubic_slopes(double t) {
  const double t2 = t * t;
  return {-1.5 * t2 + 2.0 * t - 0.5, 4.5 * t2 - 5.0 * t, -4.5 * t2 + 4.0 * t + 0.5, 1.5 * t2 - t};
}

/// The pixels of a window around the ellipse |M d| = reach: the rest is many times as large.
cv::Rect box_around(const TemplateWindow& window, cv::Point2d centre) {
  const cv::Vec3d& m = window.shape;
  const double determinant = m[0] * m[2] - m[1] * m[1];
  const double half_u = MarkerTemplate::kReach * std::hypot(m[2], m[1]) / determinant,
               half_v = MarkerTemplate::kReach * std::hypot(m[0], m[1]) / determinant;
  const cv::Point2d at = centre - cv::Point2d(window.corner);
  const cv::Point first(static_cast<int>(std::floor(at.x - half_u)), static_cast<int>(std::floor(at.y - half_v)));
  const cv::Point last(static_cast<int>(std::ceil(at.x + half_u)), static_cast<int>(std::ceil(at.y + half_v)));
  return cv::Rect(first, last + cv::Point(1, 1)) & cv::Rect({}, window.codes.size());
}

/// Calls `each` with q and the code for the pixels of a window within the reach.
template <class Each>
void for_pixels(const TemplateWindow& window, cv::Point2d centre, const Each& each) {
  const cv::Rect box = box_around(window, centre);
  for (int v = box.y; v < box.br().y; ++v) {
    const auto* const row = window.codes.ptr<float>(v);
    for (int u = box.x; u < box.br().x; ++u) {
      const double du = u + window.corner.x - centre.x, dv = v + window.corner.y - centre.y;
      const double x = window.shape[0] * du + window.shape[1] * dv, y = window.shape[1] * du + window.shape[2] * dv;
      if (x * x + y * y < MarkerTemplate::kReach * MarkerTemplate::kReach) each(x, y, static_cast<double>(row[u]));
    }
  }
}

/// Means of values on a grid, each value shared among the four nodes around it.
class Splat {
 public:
  Splat(int side, double per_node, double origin)
      : sums_(cv::Mat::zeros(side, side, CV_64F)),
        weights_(cv::Mat::zeros(side, side, CV_64F)),
        per_node_(per_node),
        origin_(origin) {}
  void add(double x, double y, double value, double weight) {
    const double gx = x * per_node_ + origin_, gy = y * per_node_ + origin_;
    const int i = static_cast<int>(std::floor(gx)), j = static_cast<int>(std::floor(gy));
    const double fx = gx - i, fy = gy - j;
    for (int dj = 0; dj < 2; ++dj) {
      auto* const sums = sums_.ptr<double>(j + dj) + i;
      auto* const weights = weights_.ptr<double>(j + dj) + i;
      const double of_row = weight * (dj == 0 ? 1.0 - fy : fy), left = of_row * (1.0 - fx), right = of_row * fx;
      sums[0] += left * value;
      sums[1] += right * value;
      weights[0] += left;
      weights[1] += right;
    }
  }
  const cv::Mat& weights() const { return weights_; }
  /// 0 if there are no values.
  double mean(int j, int i) const {
    const double weight = weights_.at<double>(j, i);
    return weight > kLeastOfNode ? sums_.at<double>(j, i) / weight : 0.0;
  }

 private:
  cv::Mat sums_, weights_;
  double per_node_, origin_;
};

/// Gives nodes without pixels the mean of their neighbours with some: where the marker moves along rows, its pixels
/// always lie alike between the rows of the grid, and may miss every other one.
void fill_from_neighbours(cv::Mat& look, const Splat& splat) {
  const auto is_known = [&](int j, int i) { return splat.weights().at<double>(j, i) > kLeastOfNode; };
  for (int j = 1; j + 1 < look.rows; ++j) {
    for (int i = 1; i + 1 < look.cols; ++i) {
      if (is_known(j, i)) continue;
      double sum = 0.0, known = 0.0;
      for (const cv::Point beside : {cv::Point(0, -1), cv::Point(0, 1), cv::Point(-1, 0), cv::Point(1, 0)}) {
        if (!is_known(j + beside.y, i + beside.x)) continue;
        sum += look.at<double>(j + beside.y, i + beside.x);
        known += 1.0;
      }
      if (known >= 2.0) look.at<double>(j, i) = sum / known;
    }
  }
}

}  // namespace

MarkerTemplate::Value MarkerTemplate::at(double x, double y) const {
  const double middle = 0.5 * (look_.cols - 1);
  const double gx = x * nodes_per_radius_ + middle, gy = y * nodes_per_radius_ + middle;
  const int i = static_cast<int>(std::floor(gx)), j = static_cast<int>(std::floor(gy));
  const std::array<double, 4> weight_x = cubic_weights(gx - i), weight_y = cubic_weights(gy - j),
                              slope_x = cubic_slopes(gx - i), slope_y = cubic_slopes(gy - j);
  Value sum{0.0, 0.0, 0.0};
  for (int dj = 0; dj < 4; ++dj) {
    const auto* const row = look_.ptr<double>(j - 1 + dj) + (i - 1);
    double value = 0.0, slope = 0.0;
    for (std::size_t di = 0; di < 4; ++di) {
      value += weight_x[di] * row[di];
      slope += slope_x[di] * row[di];
    }
    const auto k = static_cast<std::size_t>(dj);
    sum.value += weight_y[k] * value;
    sum.x += weight_y[k] * slope * nodes_per_radius_;
    sum.y += slope_y[k] * value * nodes_per_radius_;
  }
  return sum;
}

double MarkerTemplate::value_at(double x, double y) const {
  const double middle = 0.5 * (look_.cols - 1);
  const double gx = x * nodes_per_radius_ + middle, gy = y * nodes_per_radius_ + middle;
  const int i = static_cast<int>(std::floor(gx)), j = static_cast<int>(std::floor(gy));
  const std::array<double, 4> weight_x = cubic_weights(gx - i), weight_y = cubic_weights(gy - j);
  double sum = 0.0;
  for (int dj = 0; dj < 4; ++dj) {
    const auto* const row = look_.ptr<double>(j - 1 + dj) + (i - 1);
    sum += weight_y[static_cast<std::size_t>(dj)] *
           (weight_x[0] * row[0] + weight_x[1] * row[1] + weight_x[2] * row[2] + weight_x[3] * row[3]);
  }
  return sum;
}

double MarkerTemplate::weight_at(double x, double y) const {
  const double middle = 0.5 * (look_.cols - 1);
  return weight_.at<double>(static_cast<int>(std::lround(y * nodes_per_radius_ + middle)),
                            static_cast<int>(std::lround(x * nodes_per_radius_ + middle)));
}

double MarkerTemplate::share_at_outline() const {
  constexpr double kInner = 0.8, kOuter = 1.2;
  const int steps = static_cast<int>(std::floor(kReach * nodes_per_radius_)) - 1;
  double all = 0.0, at_outline = 0.0;
  for (int j = -steps; j <= steps; ++j) {
    for (int i = -steps; i <= steps; ++i) {
      const double x = i * step(), y = j * step(), r = std::hypot(x, y);
      if (r > kReach - 2.0 * step()) continue;
      const Value look = at(x, y);
      const double square = weight_at(x, y) * (look.x * look.x + look.y * look.y);
      all += square;
      if (r > kInner && r < kOuter) at_outline += square;
    }
  }
  return all > 0.0 ? at_outline / all : 0.0;
}

std::optional<MarkerTemplate> MarkerTemplate::of(const std::vector<TemplateWindow>& windows,
                                                 const std::vector<std::optional<TemplateFit>>& fits) {
  std::vector<double> radii;
  for (std::size_t k = 0; k < windows.size(); ++k) {
    if (fits[k]) radii.push_back(radius_of(windows[k].shape));
  }
  if (radii.size() < kFewestWindows) return std::nullopt;
  MarkerTemplate made;
  const double per_pixel = radii.size() < kFewestForFineGrid ? 1.0 : kNodesPerPixel;
  made.nodes_per_radius_ = std::clamp(static_cast<int>(std::lround(per_pixel * median_of(radii))),
                                      kFewestNodesPerRadius, kMostNodesPerRadius);
  const int half = static_cast<int>(std::ceil(kReach * made.nodes_per_radius_)) + kNodesBeyond, side = 2 * half + 1;
  made.look_ = cv::Mat::zeros(side, side, CV_64F);
  made.weight_ = cv::Mat::zeros(side, side, CV_64F);
  const auto of_all = [&](const auto& value) {
    Splat splat(side, made.nodes_per_radius_, half);
    for (std::size_t k = 0; k < windows.size(); ++k) {
      if (!fits[k]) continue;
      for_pixels(windows[k], fits[k]->centre, [&](double x, double y, double code) {
        splat.add(x, y, value(x, y, (code - fits[k]->level) / fits[k]->gain), 1.0);
      });
    }
    return splat;
  };
  for (int round = 0; round <= kSharpenings; ++round) {
    const bool is_first = round == 0;  // nothing to subtract yet
    const Splat left =
        of_all([&](double x, double y, double code) { return is_first ? code : code - made.value_at(x, y); });
    for (int j = 0; j < side; ++j) {
      for (int i = 0; i < side; ++i) made.look_.at<double>(j, i) += left.mean(j, i);
    }
    fill_from_neighbours(made.look_, left);
  }
  const Splat squares = of_all([&](double x, double y, double code) {
    const double off = code - made.value_at(x, y);
    return off * off;
  });
  std::vector<double> variances, values;
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      if (squares.weights().at<double>(j, i) <= kLeastOfNode) continue;
      variances.push_back(squares.mean(j, i));
      values.push_back(made.look_.at<double>(j, i));
    }
  }
  if (variances.empty()) return std::nullopt;
  const double usual = std::max(quantile(variances, 0.25), kLeastResidual * kLeastResidual);
  double mean = 0.0, square = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  for (const double value : values) square += (value - mean) * (value - mean) / static_cast<double>(values.size());
  made.contrast_ = std::sqrt(square);
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      if (squares.weights().at<double>(j, i) <= kLeastOfNode) continue;
      made.weight_.at<double>(j, i) = usual / std::max(squares.mean(j, i), usual);
    }
  }
  return made;
}

std::optional<cv::Point2d> MarkerTemplate::centre_of_symmetry() const {
  const int steps = static_cast<int>(std::floor(kTurnedReach * nodes_per_radius_));
  struct Point {
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    double difference = 0.0;  // root mean square, before the last step
  };
  const auto found = gauss_newton(Point{}, [&](const Point& from) {
    NormalEquations<2> equations;
    for (int j = -steps; j <= steps; ++j) {
      for (int i = -steps; i <= steps; ++i) {
        const double x = i * step(), y = j * step();
        if (x * x + y * y > kTurnedReach * kTurnedReach) continue;
        const double weight = std::min(weight_at(from.centre[0] + x, from.centre[1] + y),
                                       weight_at(from.centre[0] - x, from.centre[1] - y));
        if (weight <= 0.0) continue;
        const Value here = at(from.centre[0] + x, from.centre[1] + y),
                    turned = at(from.centre[0] - x, from.centre[1] - y);
        equations.add({here.x - turned.x, here.y - turned.y}, here.value - turned.value, weight);
      }
    }
    equations.complete();
    base::FitTrial<Point> trial;
    const Eigen::Vector2d change = -base::solve_positive(equations.jtj, equations.jtr);
    if (!change.allFinite()) return trial;
    trial.why_none = base::FitStop::out_of_range;
    if ((from.centre + change).norm() > kFarthestCentre) return trial;
    trial.point = Point{from.centre + change, std::sqrt(equations.cost / equations.weight)};
    trial.is_small = change.norm() <= kSettledCentre;
    return trial;
  });
  // Half of the difference is what is not the same after half a turn.
  if (!found || 0.5 * found->difference > kMostTurnedDifference * contrast_) return std::nullopt;
  return cv::Point2d(found->centre[0], found->centre[1]);
}

std::optional<TemplateFit> MarkerTemplate::fit(const TemplateWindow& window) const {
  struct Point {
    TemplateFit fit;
    double usual = 0.0;  // the usual residual; 0: not known yet
    int steps = 0;
    cv::Point2d moved = {};  // by the last step
    double damping = 1.0;
  };
  const double radius = radius_of(window.shape);
  const cv::Vec3d& m = window.shape;
  const double whole = std::numbers::pi * kReach * kReach * radius * radius;
  Point start;
  start.fit.centre = window.start;
  const auto found = gauss_newton(start, [&](const Point& from) {
    const TemplateFit& fit = from.fit;
    NormalEquations<4> equations;
    std::vector<double> residuals;
    residuals.reserve(static_cast<std::size_t>(1.3 * whole));
    double pixels = 0.0;
    for_pixels(window, fit.centre, [&](double x, double y, double code) {
      pixels += 1.0;
      double weight = weight_at(x, y);
      if (weight <= 0.0) return;
      const Value look = at(x, y);
      const double off = fit.level + fit.gain * look.value - code;
      const double scaled = std::abs(off) * std::sqrt(weight);
      residuals.push_back(scaled);
      if (from.usual > 0.0 && scaled > kRobustTimes * from.usual) weight *= kRobustTimes * from.usual / scaled;
      // q = M (p - c): a shift of the centre changes q by -M times the shift.
      equations.add(
          {-fit.gain * (look.x * m[0] + look.y * m[1]), -fit.gain * (look.x * m[1] + look.y * m[2]), 1.0, look.value},
          off, weight);
    });
    equations.complete();
    base::FitTrial<Point> trial;
    trial.why_none = base::FitStop::out_of_range;
    if (pixels < kLeastPixels * whole || residuals.size() < kFewestPixels) return trial;
    trial.why_none = base::FitStop::singular;
    const Eigen::Vector4d change = -base::solve_positive(equations.jtj, equations.jtr);
    const std::optional<Eigen::MatrixXd> inverse = inverse_of_equations(equations.jtj);
    if (!change.allFinite() || !inverse) return trial;
    // Weights jump from node to node, and a fit may go to and fro across a jump: halving steps back ends that.
    const cv::Point2d step(change[0], change[1]);
    const bool back = from.moved.dot(step) < 0.0 && cv::norm(step) < kNearlySettled_px;
    const double damping = back ? 0.5 * from.damping : from.damping;
    const double length = damping * cv::norm(step), allowed = 0.3 * radius;
    const cv::Point2d moved = step * (length > allowed ? damping * allowed / length : damping);
    const double rms = std::sqrt(equations.cost / std::max(equations.weight, 1.0));
    const TemplateFit to{fit.centre + moved, rms * std::sqrt(0.5 * ((*inverse)(0, 0) + (*inverse)(1, 1))),
                         fit.level + change[2], fit.gain + change[3], rms};
    trial.why_none = base::FitStop::out_of_range;
    if (to.gain < kLeastLightGain || to.gain > kMostLightGain || cv::norm(to.centre - window.start) > radius)
      return trial;
    trial.point =
        Point{to, std::max(kNormalOfMedian * median_of(residuals), kLeastResidual), from.steps + 1, moved, damping};
    trial.is_small = cv::norm(moved) <= kSettled_px && from.steps >= kStepsWithUsual;
    return trial;
  });
  if (!found) return std::nullopt;
  return found->fit;
}

}  // namespace glidelab::core
