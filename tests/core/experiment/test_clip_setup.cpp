#include "core/experiment/clip_setup.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/experiment/experiment.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

/// The message of a folder of tracks with these lines in its clips; "" where it is
/// accepted.
std::string message(const std::vector<std::string>& lines) {
  const tests::TempDir dir;
  base::write_file(dir / "t.csv", "t_s,x_m\n");
  std::string text = "format = 1\nname = \"test\"\n[track]\ndownhill = \"+X\"\n";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text +=
        fmt::format("[[clip]]\nname = \"c{}\"\ntrack = \"t.csv\"\nmass_kg = 1\nlaunched = \"up\"\n{}\n", i, lines[i]);
  }
  base::write_file(dir / "experiment.toml", text);
  try {
    core::read_experiment(dir.path());
  } catch (const base::InputError& error) {
    return error.what();
  }
  return "";
}

std::string reading(const std::string& degrees, const std::string& sd, const std::string& group) {
  return "incline_deg = " + degrees + (sd.empty() ? "" : "\nincline_sd_deg = " + sd) +
         (group.empty() ? "" : "\ngroup = \"" + group + "\"");
}

}  // namespace

TEST_CASE("readings of one group that no uncertainty brings together are refused, with line and both readings") {
  // Five standard deviations of both: 5 sqrt(2) 0.05 = 0.354 degrees.
  CHECK(message({reading("4.3", "0.05", "a"), reading("4.65", "0.05", "a")}).empty());
  const std::string wrong = message({reading("4.3", "0.05", "a"), reading("4.66", "0.05", "a")});
  INFO(wrong);
  CHECK(wrong.find("experiment.toml:18: clip[2].incline_deg: found 4.66 ± 0.05") != std::string::npos);
  CHECK(wrong.find("clip \"c0\" states 4.3 ± 0.05") != std::string::npos);
  // Exact readings contradict each other wherever they differ; other groups, and clips without an uncertainty, do not.
  CHECK(!message({reading("4.3", "0", "a"), reading("4.31", "0", "a")}).empty());
  CHECK(message({reading("4.3", "0.05", "a"), reading("0", "0.05", "b")}).empty());
  CHECK(message({reading("4.3", "0.05", ""), reading("0", "0.05", "")}).empty());
  CHECK(message({reading("4.3", "0.05", "a"), reading("0", "", "a")}).empty());
}
