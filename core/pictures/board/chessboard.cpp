#include "core/pictures/board/chessboard.h"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "core/pictures/image/edge_response.h"

namespace glidelab::core {
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

constexpr std::size_t kFewestResponseCorners = 9;  // from which the pixels' response is found,
constexpr double kResponsePixels = 5000.0;         // with about this many pixels

/// A corner of an image, to be fitted.
struct CornerAt {
  const BoardImage* image = nullptr;
  cv::Point2d start;
  CornerSurroundings around;
};

/// Some of an image's corners, all over the board.
void sample_corners(const BoardImage& image, std::vector<CornerAt>& sampled) {
  const BoardCorners& board = image.board;
  std::vector<CornerAt> corners;
  double pixels = 0.0;
  for (int j = 0; j < board.grid.height; ++j) {
    for (int i = 0; i < board.grid.width; ++i) {
      corners.push_back({&image, board.at(i, j), surroundings_of(board, i, j)});
      pixels += std::numbers::pi * std::pow(corners.back().around.window_px, 2);
    }
  }
  const auto wanted = static_cast<std::size_t>(kResponsePixels / pixels * static_cast<double>(corners.size()));
  const std::size_t taken = std::min(corners.size(), std::max(kFewestResponseCorners, wanted));
  for (std::size_t k = 0; k < taken; ++k) sampled.push_back(corners[k * corners.size() / taken]);
}

}  // namespace

BoardImage cut_board(const cv::Mat& grey, BoardCorners board) {
  constexpr double kAroundPx = kLargestWindowPx + 4.0;  // a fit moves by 3 px at most
  cv::Point2d low(1e9, 1e9), high(-1e9, -1e9);
  for (const cv::Point2d& point : board.points) {
    low = {std::min(low.x, point.x), std::min(low.y, point.y)};
    high = {std::max(high.x, point.x), std::max(high.y, point.y)};
  }
  const auto even_below = [](double at) { return 2 * static_cast<int>(std::floor(0.5 * (at - kAroundPx))); };
  const cv::Point first(even_below(low.x), even_below(low.y));
  const cv::Rect wanted(first, cv::Point(cvCeil(high.x + kAroundPx) + 1, cvCeil(high.y + kAroundPx) + 1));
  const cv::Rect part = wanted & cv::Rect({}, grey.size());  // 0 is even
  for (cv::Point2d& point : board.points) point -= cv::Point2d(part.tl());
  return {grey(part).clone(), part.tl(), std::move(board)};
}

std::optional<EdgeResponse> board_response(const std::vector<BoardImage>& images) {
  std::vector<CornerAt> corners;
  std::map<const BoardImage*, cv::Mat> light;
  for (const BoardImage& image : images) {
    sample_corners(image, corners);
    light[&image] = light_of(image.part, ToneCurve::srgb);
  }
  const auto fit = [&](std::size_t k, ToneCurve tone, const EdgeResponse* known) {
    const CornerAt& corner = corners[k];
    const cv::Mat& seen = tone == ToneCurve::linear ? corner.image->part : light.at(corner.image);
    return corner_window(seen, corner.start, corner.around, known);
  };
  return edge_response_of(corners.size(), true, fit);
}

namespace {

struct RefinedBoard {
  BoardCorners board;
  double left = 0.0;  // of the residuals' squares without the response, on average
};

RefinedBoard refined(const BoardImage& image, const std::optional<EdgeResponse>& response) {
  RefinedBoard refined{image.board};
  const cv::Mat light = response ? light_of(image.part, response->tone) : image.part;
  refined.board.unrefined = 0;
  for (int j = 0; j < image.board.grid.height; ++j) {
    for (int i = 0; i < image.board.grid.width; ++i) {
      const CornerSurroundings around = surroundings_of(image.board, i, j);
      std::optional<FittedCorner> corner;
      if (response) corner = fit_corner(light, image.board.at(i, j), around, &*response);
      // Where the response lets a fit not settle, the corner as the image is errs far less than the detector.
      if (!corner) corner = fit_corner(image.part, image.board.at(i, j), around);
      const auto index = static_cast<std::size_t>(j * image.board.grid.width + i);
      cv::Point2d& point = refined.board.points[index];
      if (corner) {
        point = corner->point;
        refined.board.sd_px[index] = corner->sd_px;
        refined.left += corner->left / static_cast<double>(image.board.points.size());
      } else {
        ++refined.board.unrefined;
      }
      point += cv::Point2d(image.first);
    }
  }
  return refined;
}

}  // namespace

BoardCorners refine_board(const BoardImage& image, const std::optional<EdgeResponse>& response) {
  RefinedBoard with = refined(image, response);
  if (response && with.left > 1.0) with = refined(image, board_response({image}));
  return std::move(with.board);
}

BoardCorners refine_board(const cv::Mat& grey, const BoardCorners& board) {
  const BoardImage image = cut_board(grey, board);
  return refined(image, board_response({image})).board;
}

std::optional<BoardCorners> find_board(const cv::Mat& grey, cv::Size inner_corners, BoardDetector detector,
                                       const std::function<void()>& between) {
  const std::vector<cv::Point2f> corners = search_board(grey, inner_corners, detector, between);
  if (corners.empty()) return std::nullopt;
  return refine_board(grey, orient_board(grey, inner_corners, corners));
}

}  // namespace glidelab::core
