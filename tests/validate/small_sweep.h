/// A sweep of track-level runs of milliseconds: one glider, one clip, few frames.
#pragma once

#include <filesystem>
#include <string>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "tests/one_glider.h"
#include "tests/temp_dir.h"
#include "validate/study/sweep/design/read_sweep.h"

namespace glidelab::tests {

inline const std::string kSweptScenario = R"(format = 1
name = "swept"
[camera]
width_px = 320
height_px = 240
frame_rate_hz = 60.0
focal_px = [480.0, 480.0]
position_m = [0.0, 0.1, 2.4]
)" + one_glider(4.0, 2.768, 0.0071, {{"up", 0.2, -1.2, 1.2}});

/// `more` is appended: the [[vary]] tables.
inline std::filesystem::path write_sweep(const std::filesystem::path& folder, const std::string& head,
                                         const std::string& more) {
  base::write_file(folder / "scenario.toml", kSweptScenario);
  base::write_file(folder / "sweep.toml",
                   "format = 1\nname = \"small\"\nscenario = \"scenario.toml\"\n" + head + "\n" + more);
  return folder / "sweep.toml";
}

/// What is said of a wrong sweep; "no error" where nothing is.
inline std::string refusal_of_sweep(const std::string& head, const std::string& more) {
  const TempDir dir;
  try {
    validate::read_sweep(write_sweep(dir.path(), head, more));
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "no error";
}

inline const std::string kNoise = "[tracks]\nnoise_m = 1e-5\n";

inline constexpr const char* kTwoKeys = R"(
[tracks]
noise_m = 2e-5
[[vary]]
key = "camera.frame_rate_hz"
values = [50, 80]
[[vary]]
name = "K/m"
keys = ["configuration[*].force[law=viscous].k_over_m_1_s"]
range = { from = 2.0, to = 3.0, count = 3 }
)";

}  // namespace glidelab::tests
