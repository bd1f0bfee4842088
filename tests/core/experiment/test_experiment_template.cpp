#include "core/experiment/experiment_template.h"

#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/experiment/experiment.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

/// A folder with every file that the template names (empty: read_experiment opens none).
struct Folder {
  tests::TempDir dir;
  Folder() {
    for (const char* folder : {"clips", "calibration", "tracks"}) fs::create_directories(dir / folder);
    for (const char* name : {"clips/m1-up.mp4", "clips/m1-down.mp4", "calibration/view-00.png", "calibration/plane.png",
                             "plumb.png", "tracks/m1-up.csv"}) {
      base::write_file(dir / name, "");
    }
  }
  core::Experiment read(const std::string& text) const {
    base::write_file(dir / "experiment.toml", text);
    return core::read_experiment(dir.path());
  }
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

const std::regex kOffered(R"(#(\[{1,2}\w+\]{1,2}|(\w+) = .*))");

}  // namespace

TEST_CASE("the template of an experiment is read as it is, once its files are there") {
  const Folder folder;
  const core::Experiment experiment = folder.read(core::experiment_template("my \"first\" glider\\\t\u2764"));
  CHECK(experiment.name == "my \"first\" glider\\\t\u2764");
  CHECK(experiment.clips.size() == 2);
  REQUIRE(experiment.calibration);
  CHECK(experiment.calibration->inner_corners == core::BoardSize{9, 6});
  CHECK(experiment.camera->frame_rate_hz == 240.0);
}

TEST_CASE("every key that the template offers is known, in the table under which it stands") {
  const Folder folder;
  const std::vector<std::string> lines = lines_of(core::experiment_template("all keys"));
  std::size_t offered = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    std::smatch match;
    if (!std::regex_match(lines[i], match, kOffered) || !match[2].matched) continue;
    ++offered;
    // This key alone, with its table where that is offered as well.
    std::string text;
    std::size_t table = i;
    while (table > 0 && !lines[table].starts_with("[") && !lines[table].starts_with("#[")) --table;
    for (std::size_t k = 0; k < lines.size(); ++k) {
      const bool taken = k == i || (k == table && lines[k].starts_with("#["));
      // A column is one of a track, and a track stands instead of a file.
      const bool of_column = lines[i].starts_with("#column") && k < i && k + 2 >= i;
      if (of_column && lines[k].starts_with("file")) continue;
      text += (taken || of_column ? lines[k].substr(1) : lines[k]) + "\n";
    }
    INFO(lines[i]);
    std::string message;
    try {
      folder.read(text);
    } catch (const base::InputError& error) {
      message = error.what();  // of a key that wants another one beside it
    }
    INFO(message);
    CHECK(message.find("an unknown key") == std::string::npos);
    CHECK(message.find("not allowed") == std::string::npos);
  }
  CHECK(offered > 25);
}

TEST_CASE("a key that is misspelt in the template would be found") {
  const Folder folder;
  std::string text = core::experiment_template("x");
  text.replace(text.find("#bit_depth"), 10, "bit_deep");
  try {
    folder.read(text);
    FAIL("read");
  } catch (const base::InputError& error) {
    CHECK(std::string(error.what()).find("an unknown key") != std::string::npos);
  }
}

TEST_CASE("the template names every key of the experiment folder's contract") {
  const std::string text = core::experiment_template("x");
  const std::set<std::string> contract = {
      "format",         "name",       "gravity_m_s2", "frame_rate_hz", "exposure_s",    "shutter",
      "line_readout_s", "bit_depth",  "time",         "pattern",       "inner_corners", "square_m",
      "views",          "plane",      "px_per_m",     "from_px",       "to_px",         "length_m",
      "px_per_m_sd",    "view",       "region",       "diameter_m",    "height_m",      "color",
      "start_px",       "downhill",   "file",         "track",         "mass_kg",       "launched",
      "incline_deg",    "mass_sd_kg", "start_s",      "end_s",         "group",         "incline_sd_deg"};
  for (const std::string& key : contract) {
    INFO(key);
    CHECK(std::regex_search(text, std::regex("(^|\n)#?" + key + " = ")));
  }
}
