#include "report/analysis/camera_plots.h"

#include <regex>
#include <string>

#include "tests/catch.h"

using namespace glidelab;

TEST_CASE("the numbers along the calibration's image leave room between them, whatever its width") {
  for (const int width_px : {320, 640, 800, 1280, 1440, 1456, 1920, 3840}) {
    core::CornerMap rests;
    rests.width_px = width_px;
    rests.height_px = width_px * 3 / 4;
    rests.cells = {core::CornerCell{.u_px = 10.0, .v_px = 10.0, .du_px = 0.1, .dv_px = 0.1}};
    const std::vector<report::Plot> plots = report::calibration_plots(rests, "");
    REQUIRE(plots.size() == 1);
    std::smatch u, v;
    const std::string& script = plots.front().drawing.script;
    REQUIRE(std::regex_search(script, u, std::regex("set xtics ([0-9]+)\n")));
    REQUIRE(std::regex_search(script, v, std::regex("set ytics ([0-9]+)\n")));
    INFO(width_px << ": " << u[1]);
    const int step = std::stoi(u[1]);
    CHECK(v[1] == u[1]);
    // 0 and at most seven more, of four figures each in the 400 points that a plot is wide, and three at least.
    CHECK(width_px / step <= 7);
    CHECK(width_px / step >= 2);
    const std::string figures = std::to_string(step);
    CHECK(std::regex_match(figures, std::regex("[125]0*")));
  }
}
