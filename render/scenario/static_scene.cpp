#include "render/scenario/static_scene.h"

#include <algorithm>

namespace glidelab::render {

double shade_of(const Eigen::Vector3d& normal_W) {
  return (kAmbient + (1.0 - kAmbient) * std::max(0.0, normal_W.dot(kToLight))) /
         (kAmbient + (1.0 - kAmbient) * kToLight.z());
}

std::vector<Eigen::Vector3d> outline_of(const Chessboard& board) {
  const double low = -(1.0 + board.border_squares) * board.square_m;
  const double right = (board.inner_columns + board.border_squares) * board.square_m;
  const double bottom = (board.inner_rows + board.border_squares) * board.square_m;
  return {board.X_WP * Eigen::Vector3d(low, low, 0), board.X_WP * Eigen::Vector3d(right, low, 0),
          board.X_WP * Eigen::Vector3d(right, bottom, 0), board.X_WP * Eigen::Vector3d(low, bottom, 0)};
}

}  // namespace glidelab::render
