/// glidelab pattern.
#include <nlohmann/json.hpp>

#include "base/files/file_io.h"
#include "core/pictures/board/chessboard.h"
#include "core/pictures/frames/read_image.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
namespace fs = std::filesystem;

TEST_CASE("pattern writes a board and markers, as PDF and SVG") {
  const tests::TempDir temp;
  const tests::ProcessResult made =
      tests::glidelab({"pattern", "--json", "-o", "sheets", "--paper", "a3"}, temp.path());
  INFO(made.err);
  REQUIRE(made.status == 0);
  const nlohmann::json result = nlohmann::json::parse(made.out);
  CHECK(result.at("inner_corners") == nlohmann::json({9, 6}));
  // (297 - 10 - 25) mm for 7 squares are 37.4 mm.
  CHECK(result.at("square_m").get<double>() == 0.037);
  for (const char* name : {"chessboard.pdf", "markers.pdf"}) {
    CHECK(base::read_file(temp / "sheets" / name).starts_with("%PDF-"));
  }
  for (const char* name : {"chessboard.svg", "markers.svg"}) {
    CHECK(base::read_file(temp / "sheets" / name).starts_with("<?xml"));
  }
}

TEST_CASE("pattern names the option that is wrong, and writes nothing") {
  const tests::TempDir temp;
  const auto refuses = [&](std::vector<std::string> arguments, const std::string& named) {
    arguments.insert(arguments.begin(), "pattern");
    const tests::ProcessResult result = tests::glidelab(arguments, temp.path());
    INFO(result.err);
    CHECK(result.status == 2);
    CHECK(result.err.find(named) != std::string::npos);
  };
  refuses({"--corners", "8x6"}, "--corners: found 8x6");
  refuses({"--corners", "9"}, "--corners: found 9");
  refuses({"--corners", "9x6x2"}, "--corners: found 9x6x2");
  refuses({"--square-mm", "30"},
          "--square-mm: found 30, expected at least 1, which a printer draws sharply, and at most 25");
  refuses({"--marker-mm", "200"}, "--marker-mm: found 200");
  refuses({"--square-mm", "0.1"}, "--square-mm: found 0.1, expected at least 1");
  refuses({"--marker-mm", "0.01"}, "--marker-mm: found 0.01, expected at least 1");
  CHECK(tests::glidelab({"pattern", "--paper", "a9"}, temp.path()).status == 2);
  CHECK(tests::glidelab({"pattern", "--square-mm", "0"}, temp.path()).status == 2);
  CHECK_FALSE(fs::exists(temp / "glidelab-out"));
}

TEST_CASE("on the PDF as another program prints it, the squares have the stated size") {
  const tests::TempDir temp;
  REQUIRE(tests::glidelab({"pattern", "-q", "-o", "s", "--corners", "7x4", "--square-mm", "30"}, temp.path()).status ==
          0);
  const std::string pdf = (temp / "s/chessboard.pdf").string();
  const tests::ProcessResult printed =
      tests::run({"pdftoppm", "-r", "300", "-gray", "-singlefile", pdf, (temp / "printed").string()});
  if (printed.status != 0) {
    WARN("skipped: no pdftoppm program");
    return;
  }
  const cv::Mat image = core::read_grey_image(temp / "printed.pgm");
  const auto found = core::find_board(image, cv::Size(7, 4));
  REQUIRE(found);
  const core::BoardCorners board = core::refine_board(image, *found);
  const double side_px = 0.030 / 0.0254 * 300.0;
  // Poppler puts the edges of filled rectangles on whole pixels: half a pixel at either end, 0.05 px for the corners.
  CHECK(std::abs(cv::norm(board.at(6, 0) - board.at(0, 0)) - 6.0 * side_px) < 1.05);
  CHECK(std::abs(cv::norm(board.at(0, 3) - board.at(0, 0)) - 3.0 * side_px) < 1.05);
}
