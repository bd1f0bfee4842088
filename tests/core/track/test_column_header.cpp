#include "core/track/column_header.h"

#include <string>
#include <vector>

#include "tests/catch.h"

using namespace glidelab;

namespace {

bool is_of_sensor(const std::string& time, const std::string& place) {
  return core::is_sensor_column(core::columns_of_header({{time, place}}, 2).at(1));
}

}  // namespace

TEST_CASE("a motion sensor is known by how its program heads the positions") {
  CHECK(is_of_sensor("Time, Ch 1 (s)", "Position, Ch 1 (m)"));
  CHECK(is_of_sensor("Time (s) Run #2", "Position (m) Run #2"));
  CHECK(is_of_sensor("Latest: Time (s)", "Latest: Position (m)"));
  CHECK(is_of_sensor("Run 1: Time (s)", "Run 1: Distance (m)"));
  CHECK_FALSE(is_of_sensor("Time, Ch 1 (s)", "Velocity, Ch 1 (m/s)"));
}

TEST_CASE("positions that a person or a program for videos may have headed are no motion sensor's") {
  CHECK_FALSE(is_of_sensor("t (s)", "x (m)"));
  CHECK_FALSE(is_of_sensor("Time (s)", "Position (m)"));
  CHECK_FALSE(is_of_sensor("Time (s) Run 1", "Position (m) Run 1"));
  CHECK_FALSE(is_of_sensor("Latest: Time (s)", "Latest: X (m)"));
  CHECK_FALSE(is_of_sensor("Time (s) Run #1", "x (m) Run #1"));
}
