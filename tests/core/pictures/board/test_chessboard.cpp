#include "core/pictures/board/chessboard.h"

#include <cmath>
#include <numbers>

#include "tests/catch.h"
#include "tests/core/mosaic.h"
#include "tests/core/painter.h"

using namespace glidelab;
using tests::board_light;
using tests::paint;

namespace {

/// From board coordinates (squares) to pixels: the board's centre at `centre`, `side` pixels a square, turned by
/// `angle` in the image, tilted (the far side shrinks by `tilt` a square).
cv::Matx33d board_pose(int columns, int rows, cv::Point2d centre, double side, double angle, double tilt = 0.0) {
  const cv::Matx33d to_centre(1, 0, -0.5 * (columns - 1), 0, 1, -0.5 * (rows - 1), 0, 0, 1);
  const cv::Matx33d perspective(1, 0, 0, 0, 1, 0, tilt, 0.6 * tilt, 1);
  const double c = side * std::cos(angle), s = side * std::sin(angle);
  return cv::Matx33d(c, -s, centre.x, s, c, centre.y, 0, 0, 1) * perspective * to_centre;
}

cv::Mat paint_board(cv::Size size, const cv::Matx33d& pose, int columns, int rows, bool black_first, int samples,
                    double blur_px) {
  const cv::Matx33d back = pose.inv();
  return paint(
      size,
      [&](double u, double v) {
        const cv::Point2d p = tests::map(back, u, v);
        return board_light(p.x, p.y, columns, rows, black_first);
      },
      samples, blur_px);
}

double distance(cv::Point2d a, cv::Point2d b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

}  // namespace

TEST_CASE("a 9 x 6 board's axes are the contract's in every pose, whichever function finds the corners") {
  // The painter's (x right, y down at angle 0) frame is right-handed with the direction away from the camera, and its
  // x = -1 side has black corner squares, so the painter's axes are the contract's; 0.5 px tells corners apart.
  for (const core::BoardDetector detector : {core::BoardDetector::classic, core::BoardDetector::sector_based}) {
    for (int degrees = 0; degrees < 360; degrees += 10) {
      const double tilt = (degrees / 10) % 3 == 0 ? 0.0 : ((degrees / 10) % 3 == 1 ? 0.03 : -0.03);
      const cv::Matx33d pose = board_pose(9, 6, {180.0, 170.0}, 24.0, degrees * std::numbers::pi / 180.0, tilt);
      const cv::Mat grey = tests::expose(paint_board({360, 340}, pose, 9, 6, true, 3, 0.0), 1.0, 7);
      INFO("detector " << static_cast<int>(detector) << ", " << degrees << " degrees, tilt " << tilt);
      const auto board = core::find_board(grey, {9, 6}, detector);
      REQUIRE(board);
      CHECK(board->grid == cv::Size(9, 6));
      CHECK(distance(board->at(0, 0), tests::map(pose, 0, 0)) < 0.5);
      CHECK(distance(board->at(8, 0), tests::map(pose, 8, 0)) < 0.5);
      CHECK(distance(board->at(0, 5), tests::map(pose, 0, 5)) < 0.5);
      CHECK(distance(board->at(4, 3), tests::map(pose, 4, 3)) < 0.5);
    }
  }
}

TEST_CASE("a board's axes do not depend on how a detector numbers its corners") {
  const cv::Matx33d pose = board_pose(9, 6, {180.0, 170.0}, 24.0, 0.4, 0.02);
  const cv::Mat grey = tests::expose(paint_board({360, 340}, pose, 9, 6, true, 3, 0.0), 0.0, 7);
  for (int numbering = 0; numbering < 8; ++numbering) {
    const bool swap = (numbering & 4) != 0;  // row by row, or column by column
    std::vector<cv::Point2f> corners;
    for (int b = 0; b < (swap ? 9 : 6); ++b) {
      for (int a = 0; a < (swap ? 6 : 9); ++a) {
        int i = swap ? b : a, j = swap ? a : b;
        if ((numbering & 1) != 0) i = 8 - i;
        if ((numbering & 2) != 0) j = 5 - j;
        const cv::Point2d p = tests::map(pose, i, j);
        corners.emplace_back(static_cast<float>(p.x), static_cast<float>(p.y));
      }
    }
    const auto board = core::orient_board(grey, swap ? cv::Size(6, 9) : cv::Size(9, 6), corners);
    CHECK(board.grid == cv::Size(9, 6));
    CHECK(distance(board.at(0, 0), tests::map(pose, 0, 0)) < 1e-3);
    CHECK(distance(board.at(8, 5), tests::map(pose, 8, 5)) < 1e-3);
    CHECK(distance(board.at(8, 0), tests::map(pose, 8, 0)) < 1e-3);
  }
}

TEST_CASE("a board whose ends look alike has X to the right in the image") {
  struct Alike {
    int columns, rows;
  };
  for (const Alike alike : {Alike{8, 6}, Alike{9, 5}, Alike{7, 7}}) {
    for (const double degrees : {20.0, 200.0, 340.0, 160.0}) {
      const cv::Matx33d pose =
          board_pose(alike.columns, alike.rows, {180.0, 170.0}, 24.0, degrees * std::numbers::pi / 180.0);
      const cv::Mat grey =
          tests::expose(paint_board({360, 340}, pose, alike.columns, alike.rows, true, 3, 0.0), 1.0, 7);
      const auto board = core::find_board(grey, {alike.columns, alike.rows});
      INFO(alike.columns << " x " << alike.rows << " at " << degrees);
      REQUIRE(board);
      const cv::Point2d x = board->at(board->grid.width - 1, 0) - board->at(0, 0);
      const cv::Point2d y = board->at(0, board->grid.height - 1) - board->at(0, 0);
      CHECK(x.x > 0.0);
      CHECK(std::abs(x.x) > std::abs(x.y));
      CHECK(x.x * y.y - x.y * y.x > 0.0);  // X, Y, away from the camera: right-handed where v points down
    }
  }
}

TEST_CASE("inner corners counted the other way round give the same board") {
  const cv::Matx33d pose = board_pose(9, 6, {180.0, 170.0}, 24.0, 0.3);
  const cv::Mat grey = tests::expose(paint_board({360, 340}, pose, 9, 6, true, 3, 0.0), 1.0, 7);
  const auto board = core::find_board(grey, {6, 9});
  REQUIRE(board);
  CHECK(board->grid == cv::Size(9, 6));
  CHECK(distance(board->at(8, 0), tests::map(pose, 8, 0)) < 0.5);
}

TEST_CASE("corners are found to 0.015 px in noisy images at any sub-pixel place, blur and tilt") {
  // Noise 2 of a contrast of 175: the fit's own sd is about 0.01 px at 24 px a square (checked below against the
  // scatter), painting at 8 x 8 samples adds 1/8/sqrt(12)/sqrt(number of edge pixels) ~ 0.007 px.
  double sum = 0.0, predicted = 0.0, worst = 0.0;
  std::size_t count = 0;
  int turn = 0;
  for (const double blur_px : {0.0, 0.4, 1.0}) {
    for (const double tilt : {0.0, 0.02, -0.03}) {
      const cv::Matx33d pose =
          board_pose(9, 6, {160.3 + 0.17 * turn, 130.7 - 0.31 * turn}, 24.0, 0.1 + 0.37 * turn, tilt);
      ++turn;
      const cv::Mat grey = tests::expose(paint_board({320, 290}, pose, 9, 6, true, 8, blur_px), 2.0, 100 + turn);
      const auto board = core::find_board(grey, {9, 6});
      REQUIRE(board);
      CHECK(board->unrefined == 0);
      for (int j = 0; j < 6; ++j) {
        for (int i = 0; i < 9; ++i) {
          const double error = distance(board->at(i, j), tests::map(pose, i, j));
          sum += error * error;
          worst = std::max(worst, error);
          predicted += 2.0 * std::pow(board->sd_px[static_cast<std::size_t>(j * 9 + i)], 2);
          ++count;
        }
      }
    }
  }
  const double rms = std::sqrt(0.5 * sum / static_cast<double>(count));  // of one coordinate
  const double stated = std::sqrt(0.5 * predicted / static_cast<double>(count));
  INFO("rms " << rms << " px, stated " << stated << " px, worst " << worst << " px");
  CHECK(rms < 0.015);
  CHECK(rms < 1.5 * stated + 0.004);  // 486 corners: the rms scatters by 3 %; the rest is the painter's
  CHECK(stated < 1.5 * rms + 0.004);
}

TEST_CASE("light that falls off across the board does not move its corners") {
  const cv::Matx33d pose = board_pose(9, 6, {160.3, 130.7}, 24.0, 0.2);
  const cv::Matx33d back = pose.inv();
  const cv::Mat image = paint(
      {320, 290},
      [&](double u, double v) {
        const cv::Point2d p = tests::map(back, u, v);
        // 60 % across the image: about 5 % across one corner's window.
        return board_light(p.x, p.y, 9, 6) * (0.4 + 0.6 * u / 320.0) * (1.0 - 0.3 * v / 290.0);
      },
      8, 0.6);
  const auto board = core::find_board(tests::expose(image, 0.0, 1, CV_8U), {9, 6});
  REQUIRE(board);
  double sum = 0.0;
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 9; ++i) sum += std::pow(distance(board->at(i, j), tests::map(pose, i, j)), 2);
  }
  // Rounding to 8 bits (0.29) at a contrast of down to 70 and the painter's samples: 0.006 px.
  CHECK(std::sqrt(0.5 * sum / 54.0) < 0.008);
}

TEST_CASE("a 16-bit image with 12 bits used gives the same corners as an 8-bit one") {
  const cv::Matx33d pose = board_pose(9, 6, {160.3, 130.7}, 24.0, 0.2);
  const cv::Mat image = paint_board({320, 290}, pose, 9, 6, true, 8, 0.5);
  const auto eight = core::find_board(tests::expose(image, 0.0, 1, CV_8U), {9, 6});
  const auto sixteen = core::find_board(tests::expose(16.0 * image, 0.0, 1, CV_16U), {9, 6});
  REQUIRE(eight);
  REQUIRE(sixteen);
  // Rounding to 8 bits alone separates them: 0.29 of 175.
  for (std::size_t i = 0; i < 54; ++i) CHECK(distance(eight->points[i], sixteen->points[i]) < 0.01);
}

TEST_CASE("an image of any size without the board gives nothing") {
  for (const cv::Size size :
       {cv::Size(1, 1), cv::Size(65535, 1), cv::Size(1, 65535), cv::Size(5, 9), cv::Size(20000, 9)}) {
    for (const core::BoardDetector detector : {core::BoardDetector::classic, core::BoardDetector::sector_based}) {
      INFO(size);
      CHECK_FALSE(core::find_board(cv::Mat(size, CV_8U, cv::Scalar(90)), {9, 6}, detector));
    }
  }
}

TEST_CASE("an image without the board gives nothing") {
  const cv::Mat grey = tests::expose(cv::Mat(240, 320, CV_64F, cv::Scalar(100.0)), 3.0, 5);
  CHECK_FALSE(core::find_board(grey, {9, 6}));
}

TEST_CASE("a board is found in noise of a third of its contrast, and none in noise alone") {
  // The detectors alone take minutes for the specks of such an image.
  const cv::Matx33d pose = board_pose(9, 6, {320.0, 240.0}, 42.0, 0.2, 0.01);
  const cv::Mat noisy = tests::expose(paint_board({640, 480}, pose, 9, 6, true, 2, 0.5), 40.0, 5);
  const auto board = core::find_board(noisy, {9, 6});
  REQUIRE(board);
  for (int j = 0; j < 6; ++j) {
    for (int i = 0; i < 9; ++i) CHECK(distance(board->at(i, j), tests::map(pose, i, j)) < 5.0);  // a wrong one: 42 px
  }
  const cv::Mat grey = tests::expose(cv::Mat_<double>(480, 640, 0.5), 40.0, 6);
  CHECK_FALSE(core::find_board(grey, {9, 6}));
}

TEST_CASE("a colour mosaic and a tone curve do not move a board's corners") {
  // Rows that lie nearly along those of the pixels, where the errors of neighbours add up. Without the pixels' answer
  // taken off, corners are off by 0.047 and 0.050 px (rms).
  for (const int interpolation : {cv::COLOR_BayerRG2BGR, cv::COLOR_BayerRG2BGR_EA}) {
    const cv::Matx33d pose = board_pose(9, 6, {100.3, 80.2}, 14.9, 0.05);
    cv::Mat light = paint_board({200, 160}, pose, 9, 6, true, 12, 0.0);
    const cv::Mat grey = tests::through_mosaic(light, interpolation, true, 1.0, 9);
    const auto board = core::find_board(grey, {9, 6});
    REQUIRE(board);
    double squares = 0.0;
    for (int j = 0; j < 6; ++j) {
      for (int i = 0; i < 9; ++i) squares += std::pow(distance(board->at(i, j), tests::map(pose, i, j)), 2);
    }
    INFO("interpolation " << interpolation);
    CHECK(std::sqrt(squares / (2.0 * 54.0)) < 0.02);
  }
}

TEST_CASE("the boards of one camera say together how its pixels answer, and one along the rows is not bent by it") {
  // Squares of an odd number of pixels: neighbours alternate in the mosaic, and the corners of the board along the rows
  // meet the pixels alike, so that its own image does not tell an answer from a displacement. 1 of 255 of noise leaves
  // 0.003 px.
  std::vector<cv::Matx33d> poses{board_pose(9, 6, {100.3, 80.2}, 15.05, 0.004)};
  for (int k = 1; k < 6; ++k)
    poses.push_back(board_pose(9, 6, {100.0 + 0.37 * k, 80.6}, 13.0 + 0.4 * k, 0.13 * k, 0.01));
  std::vector<core::BoardImage> images;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const cv::Mat light = paint_board({200, 160}, poses[k], 9, 6, true, 12, 0.0);
    const cv::Mat grey = tests::through_mosaic(light, cv::COLOR_BayerRG2BGR, false, 1.0, static_cast<unsigned>(k));
    const auto corners = core::search_board(grey, {9, 6}, core::BoardDetector::any);
    REQUIRE_FALSE(corners.empty());
    images.push_back(core::cut_board(grey, core::orient_board(grey, {9, 6}, corners)));
  }
  const auto response = core::board_response(images);
  REQUIRE(response);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const core::BoardCorners board = core::refine_board(images[k], response);
    double squares = 0.0, bend = 0.0;
    for (int j = 0; j < 6; ++j) {
      for (int i = 0; i < 9; ++i) {
        const cv::Point2d off = board.at(i, j) - tests::map(poses[k], i, j);
        squares += off.dot(off);
        bend += off.x * (std::pow(i - 4.0, 2) - 20.0 / 3.0) / 54.0;
      }
    }
    INFO("board " << k << ": rms " << std::sqrt(squares / 108.0) << " px, bend " << bend);
    CHECK(std::sqrt(squares / 108.0) < 0.006);
  }
}
