#include "report/simulation/simulation_report.h"

#include "tests/catch.h"

using namespace glidelab;
using sim::Mode;

TEST_CASE("the table of a simulation says in words when each glider stops, turns and starts") {
  sim::Trajectory trajectory;
  trajectory.states = {{0.0, 0.1, -0.5, 1.0, Mode::slide_up}, {1.0, 0.2, 0.25, 0.0, Mode::slide_down}};
  trajectory.changes = {{0.25, -0.02, Mode::slide_up, Mode::slide_down},
                        {0.5, 0.1, Mode::slide_down, Mode::stick},
                        {0.75, 0.1, Mode::stick, Mode::slide_up}};
  const std::string text = report::simulation_text({{"m1-up", "m1", "trajectory-m1-up.csv", trajectory}});
  CHECK(text.find("stops and turns at (s)") != std::string::npos);
  CHECK(text.find("0.2500 turns downhill, 0.5000 stops, 0.7500 starts uphill") != std::string::npos);
}
