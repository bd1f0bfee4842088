#include "report/print/print_sheet.h"

#include <opencv2/core.hpp>

#include <cmath>
#include <regex>

#include "base/errors.h"
#include "core/experiment/experiment_template.h"
#include "core/pictures/board/chessboard.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

constexpr double kPixelsPerM = 200.0 / 0.0254;  // 200 dpi

cv::Mat as_mat(const report::SheetImage& image) {
  return cv::Mat(image.height, image.width, CV_8U, const_cast<std::uint8_t*>(image.grey.data())).clone();
}

/// Pixels darker than mid-grey along a row from `from` on, until the first brighter one.
int dark_run(const cv::Mat& image, int row, int from) {
  int at = from;
  while (at < image.cols && image.at<std::uint8_t>(row, at) < 128) ++at;
  return at - from;
}

}  // namespace

TEST_CASE("the printed board's corners are found in the contract's order and stand a square apart") {
  for (const char* name : {"a4", "a3", "letter"}) {
    report::BoardSheet sheet{report::paper_of(name), 9, 6, 0.0};
    sheet.square_m = report::largest_square_m(sheet.paper, sheet.columns, sheet.rows);
    INFO(name << " " << sheet.square_m);
    const cv::Mat image = as_mat(report::board_image(sheet, kPixelsPerM));
    const auto found = core::find_board(image, cv::Size(9, 6));
    REQUIRE(found);
    const core::BoardCorners board = core::refine_board(image, *found);
    CHECK(board.unrefined == 0);
    // Cairo's edges are box-filtered and 8 bits deep, which is the model of refine_board: 1/255 of a pixel's step moves
    // an edge by 1/255 px, and the corner's fit blurs by a fraction of a pixel; 0.05 px holds both.
    const double side = sheet.square_m * kPixelsPerM;
    const cv::Point2d origin = board.at(0, 0);
    for (int j = 0; j < 6; ++j) {
      for (int i = 0; i < 9; ++i) {
        const cv::Point2d expected =
            origin + cv::Point2d(i * side, j * side);  // X to the right, Y down: black side left
        CHECK(cv::norm(board.at(i, j) - expected) < 0.05);
      }
    }
    // In the middle of the paper's width.
    CHECK(std::abs(origin.x + 4.0 * side + 0.5 - 0.5 * sheet.paper.width_m * kPixelsPerM) < 1.0);
  }
}

TEST_CASE("the line to check the print is as long as it says") {
  const report::BoardSheet sheet{report::paper_of("a4"), 9, 6, 0.025};
  const cv::Mat image = as_mat(report::board_image(sheet, kPixelsPerM));
  const int left = static_cast<int>(std::lround(0.010 * kPixelsPerM));
  int longest = 0;
  for (int row = image.rows * 9 / 10; row < image.rows; ++row) {
    longest = std::max(longest, dark_run(image, row, left));
  }
  // Either end is dark to within a pixel.
  CHECK(std::abs(longest - 0.100 * kPixelsPerM) <= 2.0);
}

TEST_CASE("markers have their diameters, white on black and black on white") {
  const report::MarkerSheet sheet{report::paper_of("a4"), {0.010, 0.030}};
  const cv::Mat image = as_mat(report::marker_image(sheet, kPixelsPerM));
  // The disc's area in the first square (white on black) and in the second (black on white) of each row.
  double top_m = 0.010;
  for (const double diameter_m : sheet.diameters_m) {
    for (int k = 0; k < 2; ++k) {
      const double left_m = 0.010 + 0.018 + k * (2.0 * diameter_m + 0.004);
      // Inside the cutting line.
      const double inset_m = 0.4 * diameter_m;
      const cv::Rect inside(
          cv::Point(static_cast<int>((left_m + inset_m) * kPixelsPerM),
                    static_cast<int>((top_m + inset_m) * kPixelsPerM)),
          cv::Size(static_cast<int>(1.2 * diameter_m * kPixelsPerM), static_cast<int>(1.2 * diameter_m * kPixelsPerM)));
      const double white = cv::sum(image(inside))[0] / 255.0;
      const double disc_px = k == 0 ? white : inside.area() - white;
      // Coverage is rendered in 1/255 steps along an outline of pi d pixels, and a circle is drawn by splines to 0.1
      // px.
      const double diameter_px = 2.0 * std::sqrt(disc_px / 3.14159265);
      INFO(diameter_m << " " << k);
      CHECK(std::abs(diameter_px - diameter_m * kPixelsPerM) < 0.2);
    }
    top_m += 2.0 * diameter_m + 0.004;
  }
}

TEST_CASE("a board whose ends look alike, or that does not fit its paper, is refused") {
  const report::Paper& a4 = report::paper_of("a4");
  using report::BoardSheet;
  CHECK_NOTHROW(report::validate(BoardSheet{a4, 9, 6, 0.025}));
  CHECK_THROWS_AS(report::validate(BoardSheet{a4, 8, 6, 0.025}), base::InputError);
  CHECK_THROWS_AS(report::validate(BoardSheet{a4, 9, 7, 0.020}), base::InputError);
  CHECK_THROWS_AS(report::validate(BoardSheet{a4, 6, 9, 0.010}), base::InputError);
  CHECK_THROWS_AS(report::validate(BoardSheet{a4, 9, 6, 0.0251}), base::InputError);
  CHECK_THROWS_AS(report::validate(BoardSheet{a4, 9, 6, 0.0}), base::InputError);
  CHECK_NOTHROW(report::validate(BoardSheet{report::paper_of("letter"), 9, 6, 0.0254}));  // one inch
  CHECK_THROWS_AS(report::validate(report::MarkerSheet{a4, {}}), base::InputError);
  CHECK_THROWS_AS(report::validate(report::MarkerSheet{a4, {0.080}}), base::InputError);
  CHECK_THROWS_AS(report::validate(report::MarkerSheet{a4, {0.030, 0.030, 0.030}}), base::InputError);
  // What printers do not draw sharply: a millimetre is 12 dots at 300 an inch.
  CHECK_NOTHROW(report::validate(BoardSheet{a4, 9, 6, 0.001}));
  CHECK_THROWS_AS(report::validate(BoardSheet{a4, 9, 6, 0.0009}), base::InputError);
  CHECK_NOTHROW(report::validate(report::MarkerSheet{a4, {0.001}}));
  CHECK_THROWS_AS(report::validate(report::MarkerSheet{a4, {0.008, 0.0009}}), base::InputError);
  CHECK_THROWS_AS(report::paper_of("a9"), base::InputError);
}

TEST_CASE("the files say their size in the paper's own lengths") {
  const report::BoardSheet sheet{report::paper_of("a4"), 9, 6, 0.025};
  const std::string svg = report::board_page(sheet, report::SheetFormat::svg);
  CHECK(std::regex_search(svg, std::regex(R"re(<svg [^>]*width="297mm" height="210mm" viewBox="0 0 297 210")re")));
  const std::string pdf = report::board_page(sheet, report::SheetFormat::pdf);
  std::smatch box;
  REQUIRE(std::regex_search(pdf, box, std::regex(R"(/MediaBox \[ *0 0 ([0-9.]+) ([0-9.]+) *\])")));
  // PDF counts in points, which Cairo writes with at least four digits.
  CHECK(std::abs(std::stod(box[1]) - 297.0 / 25.4 * 72.0) < 0.1);
  CHECK(std::abs(std::stod(box[2]) - 210.0 / 25.4 * 72.0) < 0.1);
}

TEST_CASE("the sheet and a new experiment's file have as many squares measured") {
  // Nine of the ten: in a row of squares the board's edge shows at its black ends, and a row has one.
  const report::BoardSheet sheet{report::paper_of("a4"), 9, 6, 0.025};
  CHECK(report::measure_text(sheet).find("Measure 9 squares") != std::string::npos);
  const std::string toml = core::experiment_template("x");
  CHECK(toml.find("inner_corners = [9, 6]") != std::string::npos);
  CHECK(toml.find("measure 9 in a row") != std::string::npos);
}
