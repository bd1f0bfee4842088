#include "core/pictures/board/board_search.h"

#include <cmath>
#include <ctime>

#include "core/pictures/board/chessboard.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

/// Dark squares of `side` pixels, as far from each other, on white.
cv::Mat squares(cv::Size size, int side) {
  cv::Mat image(size, CV_8U, cv::Scalar(230));
  for (int y = side; y + side < size.height; y += 2 * side) {
    for (int x = side; x + side < size.width; x += 2 * side) image(cv::Rect(x, y, side, side)).setTo(30);
  }
  return image;
}

/// A board of 10 x 7 squares with its first inner corner at (x, y) + side - 0.5, upright, on white.
void put_board(cv::Mat& image, int x, int y, int side) {
  image(cv::Rect(x - side, y - side, 12 * side, 9 * side)).setTo(230);
  for (int j = 0; j < 7; ++j) {
    for (int i = j % 2; i < 10; i += 2) image(cv::Rect(x + i * side, y + j * side, side, side)).setTo(30);
  }
}

double processor_seconds(const cv::Mat& image) {
  const std::clock_t start = std::clock();
  CHECK_FALSE(core::find_board(image, {9, 6}));
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

}  // namespace

TEST_CASE("dark squares on white are counted one by one, also at the rim") {
  cv::Mat white = squares({200, 100}, 10) > 128;
  CHECK(core::count_quads(white) == 9 * 4);
  white(cv::Rect(0, 42, 8, 6)).setTo(0);
  CHECK(core::count_quads(white) == 9 * 4 + 1);
}

TEST_CASE("noise and thousands of squares are searched in bounded work") {
  // Unbounded, each of these takes minutes to hours. Bounded, each takes some seconds, five times as long in a build
  // that checks addresses.
  constexpr double kMostSeconds = 60.0;
  CHECK(processor_seconds(squares({2000, 2000}, 5)) < kMostSeconds);
  CHECK(processor_seconds(squares({900, 900}, 8)) < kMostSeconds);
  cv::Mat noise(1500, 2000, CV_8U);
  cv::randu(noise, 0, 256);
  CHECK(processor_seconds(noise) < kMostSeconds);
}

TEST_CASE("a board among thousands of squares is found where it is") {
  cv::Mat image = squares({1300, 1000}, 6);
  constexpr int kSide = 40, kX = 420, kY = 300;
  put_board(image, kX, kY, kSide);
  const auto board = core::find_board(image, {9, 6});
  REQUIRE(board);
  CHECK(board->unrefined == 0);
  for (const cv::Point2d& corner : board->points) {
    // The edges lie between pixels, half a pixel before the centre of the next one. A sharp corner is fitted to a
    // hundredth of a pixel.
    const double i = (corner.x + 0.5 - kX) / kSide, j = (corner.y + 0.5 - kY) / kSide;
    CHECK(std::abs(i - std::round(i)) * kSide < 0.02);
    CHECK(std::abs(j - std::round(j)) * kSide < 0.02);
    CHECK((std::round(i) >= 1.0 && std::round(i) <= 9.0 && std::round(j) >= 1.0 && std::round(j) <= 6.0));
  }
}

TEST_CASE("a board of large squares is found in one coarse look, small ones in more, and all to the same corners") {
  // A side of 60 px is 15 px in the first look, one of 20 px is 5 px and is looked for again.
  for (const int side : {60, 20}) {
    cv::Mat image(1500, 2000, CV_8U, cv::Scalar(120));
    put_board(image, 431, 307, side);
    int steps = 0;  // two a look: the outlines are counted, then looked through
    CHECK(core::search_board(image, {9, 6}, core::BoardDetector::any, [&] { ++steps; }).size() == 54);
    CHECK((steps == 2) == (side == 60));
    const auto board = core::find_board(image, {9, 6});
    REQUIRE(board);
    CHECK(board->unrefined == 0);
    for (int j = 0; j < 6; ++j) {
      for (int i = 0; i < 9; ++i) {
        const cv::Point2d off = board->at(i, j) - cv::Point2d(431 - 0.5 + (i + 1) * side, 307 - 0.5 + (j + 1) * side);
        CHECK(cv::norm(off) < 0.02);  // a sharp corner is fitted to a hundredth of a pixel
      }
    }
  }
}

TEST_CASE("a search can be ended between its steps") {
  struct Stop {};
  const cv::Mat image = squares({900, 900}, 8);
  int steps = 0;
  CHECK_THROWS_AS(core::find_board(image, {9, 6}, core::BoardDetector::any,
                                   [&] {
                                     if (++steps == 3) throw Stop();
                                   }),
                  Stop);
  CHECK(steps == 3);
}
