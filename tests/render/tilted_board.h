/// A chessboard that is tilted about all three axes, for tests of what is drawn of it.
#pragma once

#include <Eigen/Geometry>

#include "render/scenario/scene.h"

namespace glidelab::tests {

inline render::Chessboard tilted_board() {
  render::Chessboard board;
  board.inner_columns = 5;
  board.inner_rows = 4;
  board.square_m = 0.11;
  board.X_WP.linear() =
      (Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(-0.3, Eigen::Vector3d::UnitX()) *
       Eigen::AngleAxisd(3.14159265358979 + 0.05, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  board.X_WP.translation() = Eigen::Vector3d(-0.2, 0.17, 0.3);
  return board;
}

}  // namespace glidelab::tests
