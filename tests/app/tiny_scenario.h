/// A scenario that renders in about a second: one glider, one clip, a small image.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>

#include "base/files/file_io.h"
#include "tests/one_glider.h"

namespace glidelab::tests {

inline std::string tiny_scenario(double duration_s = 0.3, const std::string& more = {}) {
  return fmt::format(R"(format = 1
name = "tiny"
seed = 3
{}
[camera]
width_px = 160
height_px = 120
frame_rate_hz = 100.0
focal_px = [240.0, 240.0]
position_m = [0.0, 0.1, 2.4]
target_m = [0.0, 0.0, 0.0]

[calibration]
inner_corners = [5, 4]
square_m = 0.12
views = 3

)",
                     more) +
         one_glider(4.0, 2.768, 0.0071, {{"up", 0.2, -1.2, duration_s}});
}

inline void write_tiny_scenario(const std::filesystem::path& file, double duration_s = 0.3,
                                const std::string& more = {}) {
  base::write_file(file, tiny_scenario(duration_s, more));
}

}  // namespace glidelab::tests
