#include "core/pictures/board/chessboard.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "core/math/least_squares.h"
#include "core/pictures/image/edge_response.h"
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

/// What is known of the blur beforehand, for an edge that runs along a pixel's border has no width to be seen.
constexpr double kUsualBlurPx = 0.4;
constexpr double kBlurStrength = 0.05;  // worth so much of the contrast in one pixel, a unit of ln(blur)

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

std::optional<NormalEquations<kParameters>> evaluate(const Window& window, double contrast, const Vector& p) {
  const double blur = std::exp(p[kLogBlur]);
  if (!(blur > 0.01) || blur > 10.0) return std::nullopt;
  NormalEquations<kParameters> equations;
  const Edges edges(p, blur);
  std::array<Plateau, 2> plateaus;  // where both edges are on one side, where not
  for (std::size_t i = 0; i < window.at.size(); ++i) {
    const double du = window.at[i].x - p[kU];
    const double dv = window.at[i].y - p[kV];
    const double d1 = edges.from_first(du, dv), d2 = edges.from_second(du, dv);
    if (std::abs(d1) > edges.far && std::abs(d2) > edges.far) {
      plateaus[(d1 > 0.0) == (d2 > 0.0) ? 0 : 1].add(du, dv, window.value[i], window.weight[i]);
      continue;
    }
    Vector jacobian;
    const double model = corner_pixel(edges, blur, p, du, dv, jacobian);
    equations.add(jacobian, model - window.value[i], window.weight[i]);
  }
  plateaus[0].add_to(equations, p, 1.0);
  plateaus[1].add_to(equations, p, -1.0);
  Vector jacobian = Vector::Zero();
  const double strength = kBlurStrength * contrast;
  jacobian[kLogBlur] = strength;
  equations.add(jacobian, strength * (p[kLogBlur] - std::log(kUsualBlurPx)), 1.0);
  return equations;
}

}  // namespace

namespace {

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
  const auto at_start = evaluate(window, 0.0, parameters);
  if (at_start) {
    agreement = -at_start->jtr[kAmplitude] + parameters[kAmplitude] * at_start->jtj(kAmplitude, kAmplitude);
  }
  if (agreement < 0.0) parameters[kAmplitude] = -parameters[kAmplitude];
  return parameters;
}

LeastSquaresFit<kParameters> solve(const Window& window, const Vector& start) {
  Vector step;
  const double level = 1e-4 * std::abs(start[kAmplitude]) + 1e-9;
  step << 1e-4, 1e-4, 1e-4, 1e-4, 1e-2, level, level, 1e-5, 1e-5;
  const double contrast = std::abs(start[kAmplitude]);
  const auto model = [&](const Vector& p) { return evaluate(window, contrast, p); };
  return fit_least_squares<kParameters>(model, start, step, 50);
}

/// A corner that is fitted, with its last window.
class CornerFit {
 public:
  CornerFit(const cv::Mat& grey, cv::Point2d start, const CornerSurroundings& around)
      : grey_(grey), start_(start), around_(around) {}

  /// Whether it settles, on what is a corner; `response` null: as the image is.
  bool settles(const EdgeResponse* response) {
    if (around_.window_px < kSmallestWindowPx) return false;
    cv::Point2d centre = start_;
    // Twice: the second time the window is centred on the first result.
    for (int pass = 0; pass < 2; ++pass) {
      window_ = window_around(grey_, centre, around_.window_px);
      if (window_.at.size() < 2 * kParameters) return false;
      fit_ = solve(window_, pass == 0 ? start_of(window_, start_, around_) : fit_.parameters);
      if (!is_corner()) return false;
      centre = point();
    }
    light_ = window_.value;
    constexpr int kRefits = 2;  // what is taken off changes by a tenth of what it changes the fit
    for (int refit = 0; response != nullptr && refit < kRefits; ++refit) {
      const Eigen::VectorXd added = added_by(*response, fitted());
      for (std::size_t i = 0; i < light_.size(); ++i)
        window_.value[i] = light_[i] - added[static_cast<Eigen::Index>(i)];
      fit_ = solve(window_, fit_.parameters);
      if (!is_corner()) return false;
    }
    return true;
  }

  FittedCorner corner() const {
    return {point(), std::sqrt(0.5 * (fit_.covariance(kU, kU) + fit_.covariance(kV, kV)))};
  }

  FittedWindow fitted() const {
    const Vector& p = fit_.parameters;
    const double blur = std::exp(p[kLogBlur]);
    const Edges edges(p, blur);
    const auto count = static_cast<Eigen::Index>(window_.at.size());
    FittedWindow fitted;
    fitted.weight = Eigen::Map<const Eigen::VectorXd>(window_.weight.data(), count);
    fitted.light = Eigen::Map<const Eigen::VectorXd>(light_.data(), count);
    fitted.model.resize(count);
    fitted.jacobian.resize(count, kParameters);
    Vector slopes;
    for (Eigen::Index i = 0; i < count; ++i) {
      const cv::Point2d at = window_.at[static_cast<std::size_t>(i)];
      fitted.pixels.emplace_back(cvRound(at.x), cvRound(at.y));
      fitted.model[i] = corner_pixel(edges, blur, p, at.x - p[kU], at.y - p[kV], slopes);
      fitted.jacobian.row(i) = slopes.transpose();
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
  cv::Point2d point() const { return {fit_.parameters[kU], fit_.parameters[kV]}; }
  bool is_corner() const {
    if (!base::is_settled(fit_.stop)) return false;
    const bool stayed = cv::norm(point() - start_) < std::min(0.5 * around_.window_px, 3.0);
    // A crossing of two edges leaves a small residual; a quarter of the contrast is something else.
    return stayed && fit_.rms <= 0.25 * std::abs(fit_.parameters[kAmplitude]);
  }

  const cv::Mat& grey_;
  cv::Point2d start_;
  CornerSurroundings around_;
  Window window_;
  std::vector<double> light_;  // of the window as it is seen
  LeastSquaresFit<kParameters> fit_;
};

}  // namespace

std::optional<FittedCorner> fit_corner(const cv::Mat& grey, cv::Point2d start, const CornerSurroundings& around) {
  CornerFit fit(grey, start, around);
  if (!fit.settles(nullptr)) return std::nullopt;
  return fit.corner();
}

namespace {

constexpr double kWindowShare = 0.7;  // of the distance to the next edge
constexpr double kLargestWindowPx = 14.0;

template <class Pixel>
double mean_around(const cv::Mat& grey, cv::Point2d centre, double radius) {
  double sum = 0.0;
  int count = 0;
  for (int v = static_cast<int>(std::ceil(centre.y - radius)); v <= centre.y + radius; ++v) {
    for (int u = static_cast<int>(std::ceil(centre.x - radius)); u <= centre.x + radius; ++u) {
      if (u < 0 || v < 0 || u >= grey.cols || v >= grey.rows) continue;
      sum += static_cast<double>(grey.at<Pixel>(v, u));
      ++count;
    }
  }
  return count == 0 ? 0.0 : sum / count;
}

double mean_around(const cv::Mat& grey, cv::Point2d centre, double radius) {
  return grey.depth() == CV_8U ? mean_around<std::uint8_t>(grey, centre, radius)
                               : mean_around<std::uint16_t>(grey, centre, radius);
}

/// How much brighter the squares (i + j even) between inner corners are than the others; each square is compared with
/// its neighbours, so that uneven light does not matter.
double even_minus_odd(const cv::Mat& grey, const BoardCorners& board) {
  const auto square = [&](int i, int j) {
    const cv::Point2d a = board.at(i, j);
    const cv::Point2d b = board.at(i + 1, j + 1);
    const cv::Point2d c = board.at(i + 1, j);
    const cv::Point2d d = board.at(i, j + 1);
    const double side = std::min({cv::norm(c - a), cv::norm(d - a), cv::norm(b - c), cv::norm(b - d)});
    return mean_around(grey, 0.25 * (a + b + c + d), std::max(0.51, 0.2 * side));
  };
  double sum = 0.0;
  for (int j = 0; j + 1 < board.grid.height; ++j) {
    for (int i = 0; i + 1 < board.grid.width; ++i) {
      const double sign = (i + j) % 2 == 0 ? 1.0 : -1.0;
      const double here = square(i, j);
      if (i + 2 < board.grid.width) sum += sign * (here - square(i + 1, j));
      if (j + 2 < board.grid.height) sum += sign * (here - square(i, j + 1));
    }
  }
  return sum;
}

BoardCorners transposed(const BoardCorners& board) {
  BoardCorners other;
  other.grid = cv::Size(board.grid.height, board.grid.width);
  for (int j = 0; j < other.grid.height; ++j) {
    for (int i = 0; i < other.grid.width; ++i) other.points.push_back(board.at(j, i));
  }
  return other;
}

BoardCorners flipped(const BoardCorners& board, bool in_x, bool in_y) {
  BoardCorners other;
  other.grid = board.grid;
  for (int j = 0; j < board.grid.height; ++j) {
    for (int i = 0; i < board.grid.width; ++i) {
      other.points.push_back(board.at(in_x ? board.grid.width - 1 - i : i, in_y ? board.grid.height - 1 - j : j));
    }
  }
  return other;
}

/// From the first to the last corner of the rows (the columns), on average.
cv::Point2d along_x(const BoardCorners& board) {
  cv::Point2d sum;
  for (int j = 0; j < board.grid.height; ++j) sum += board.at(board.grid.width - 1, j) - board.at(0, j);
  return sum;
}
cv::Point2d along_y(const BoardCorners& board) {
  cv::Point2d sum;
  for (int i = 0; i < board.grid.width; ++i) sum += board.at(i, board.grid.height - 1) - board.at(i, 0);
  return sum;
}

/// The window reaches most of the way to the nearest edge that is not the corner's own.
CornerSurroundings surroundings_of(const BoardCorners& board, int i, int j) {
  const cv::Point2d here = board.at(i, j);
  const int left = std::max(i - 1, 0);
  const int right = std::min(i + 1, board.grid.width - 1);
  const int up = std::max(j - 1, 0);
  const int down = std::min(j + 1, board.grid.height - 1);
  const cv::Point2d x = board.at(right, j) - board.at(left, j);
  const cv::Point2d y = board.at(i, down) - board.at(i, up);
  // Perpendicular distance of a neighbour from the edge through this corner.
  const auto distance = [&](cv::Point2d neighbour, cv::Point2d edge) {
    return std::abs((neighbour - here).cross(edge)) / cv::norm(edge);
  };
  double nearest = std::numeric_limits<double>::infinity();
  for (const int n : {left, right}) {
    if (n != i) nearest = std::min(nearest, distance(board.at(n, j), y));
  }
  for (const int n : {up, down}) {
    if (n != j) nearest = std::min(nearest, distance(board.at(i, n), x));
  }
  return {std::min(kWindowShare * nearest, kLargestWindowPx), std::atan2(x.y, x.x), std::atan2(y.y, y.x)};
}

}  // namespace

BoardCorners orient_board(const cv::Mat& grey, cv::Size inner_corners, const std::vector<cv::Point2f>& corners) {
  BoardCorners board;
  board.grid = inner_corners;
  for (const cv::Point2f& corner : corners) board.points.emplace_back(corner.x, corner.y);
  const bool square = board.grid.width == board.grid.height;
  if (board.grid.width < board.grid.height || (square && std::abs(along_y(board).x) > std::abs(along_x(board).x))) {
    board = transposed(board);
  }
  // A corner square has the colour of the square between inner corners that touches it at its corner, so the squares
  // between inner corners tell. The ends differ where the board has an odd number of columns and an even one of rows.
  const bool ends_differ = board.grid.width % 2 == 1 && board.grid.height % 2 == 0;
  const cv::Point2d x = along_x(board);
  const bool turn_x = ends_differ ? even_minus_odd(grey, board) > 0.0 : x.x < 0.0 || (x.x == 0.0 && x.y < 0.0);
  if (turn_x) board = flipped(board, true, false);
  if (along_x(board).cross(along_y(board)) < 0.0) board = flipped(board, false, true);
  board.sd_px.assign(board.points.size(), 0.0);
  board.unrefined = board.points.size();
  return board;
}

namespace {

constexpr std::size_t kFewestResponseCorners = 9;  // that say how the pixels answer,
constexpr double kResponsePixels = 5000.0;         // and about so many pixels

/// What the pixels add to the corners' images, from some of them all over the board.
std::optional<EdgeResponse> response_of(const cv::Mat& grey, const cv::Mat& light, const BoardCorners& board) {
  std::vector<std::pair<cv::Point2d, CornerSurroundings>> corners;
  double pixels = 0.0;
  for (int j = 0; j < board.grid.height; ++j) {
    for (int i = 0; i < board.grid.width; ++i) {
      corners.emplace_back(board.at(i, j), surroundings_of(board, i, j));
      pixels += std::numbers::pi * std::pow(corners.back().second.window_px, 2);
    }
  }
  const auto wanted = static_cast<std::size_t>(kResponsePixels / pixels * static_cast<double>(corners.size()));
  const std::size_t taken = std::min(corners.size(), std::max(kFewestResponseCorners, wanted));
  return edge_response_of(taken, true,
                          [&](std::size_t k, ToneCurve tone, const EdgeResponse* known) -> std::optional<FittedWindow> {
                            const auto& [start, around] = corners[k * corners.size() / taken];
                            CornerFit fit(tone == ToneCurve::linear ? grey : light, start, around);
                            if (!fit.settles(known)) return std::nullopt;
                            return fit.fitted();
                          });
}

}  // namespace

BoardCorners refine_board(const cv::Mat& grey, BoardCorners board) {
  const BoardCorners start = board;
  const cv::Mat light = light_of(grey, ToneCurve::srgb);
  const std::optional<EdgeResponse> response = response_of(grey, light, board);
  const cv::Mat& fitted = response && response->tone == ToneCurve::srgb ? light : grey;
  board.unrefined = 0;
  for (int j = 0; j < board.grid.height; ++j) {
    for (int i = 0; i < board.grid.width; ++i) {
      const auto index = static_cast<std::size_t>(j * board.grid.width + i);
      const CornerSurroundings around = surroundings_of(start, i, j);
      CornerFit with_response(fitted, start.points[index], around);
      // Where what the response adds lets a fit not settle, the corner as the image is errs far less than the detector.
      const std::optional<FittedCorner> corner = response && with_response.settles(&*response)
                                                     ? std::optional(with_response.corner())
                                                     : fit_corner(grey, start.points[index], around);
      if (!corner) {
        ++board.unrefined;
        continue;
      }
      board.points[index] = corner->point;
      board.sd_px[index] = corner->sd_px;
    }
  }
  return board;
}

std::optional<BoardCorners> find_board(const cv::Mat& grey, cv::Size inner_corners, BoardDetector detector,
                                       const std::function<void()>& between) {
  const std::vector<cv::Point2f> corners = search_board(grey, inner_corners, detector, between);
  if (corners.empty()) return std::nullopt;
  return refine_board(grey, orient_board(grey, inner_corners, corners));
}

}  // namespace glidelab::core
