/// Axes of a sweep over keys that belong together, and over whole numbers.
#include <algorithm>
#include <cmath>

#include "base/files/file_io.h"
#include "report/text/why_words.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"
#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/design/sweep_scenario.h"
#include "validate/study/sweep/run_sweep.h"
#include "validate/study/sweep/sweep_summary.h"

using namespace glidelab;
using Catch::Matchers::Contains;
using tests::kNoise;

TEST_CASE("A choice brings its own keys and takes those of the other choices out") {
  const tests::TempDir dir;
  const std::string choices = R"(
[[vary]]
name = "shutter"
choices = [
  { "shutter.kind" = "global" },
  { label = "slow", "shutter.kind" = "rolling", shutter.line_readout_s = 4e-5 },
  { "shutter.kind" = "rolling", "shutter.line_readout_s" = 2e-5 },
]
[[vary]]
key = "camera.exposure_s"
values = [0.001, 0.002]
)";
  tests::write_sweep(dir.path(), "", kNoise + choices);
  // The scenario's own shutter has a line time, which a global one may not have.
  base::write_file(dir / "scenario.toml",
                   tests::kSweptScenario + "[shutter]\nkind = \"rolling\"\nline_readout_s = 1e-5\n");
  const validate::Sweep sweep = validate::read_sweep(dir / "sweep.toml");
  REQUIRE(validate::run_count(sweep) == 6);
  const std::vector<std::pair<std::string, double>> expected = {
      {"global", 0.0}, {"slow", 4e-5}, {"rolling, line_readout_s = 2e-05", 2e-5}};
  for (std::uint64_t run = 0; run < 6; ++run) {
    const std::vector<base::TomlScalar> values = validate::values_of(sweep, run);
    CHECK(std::get<std::string>(values[0]) == expected[run / 2].first);
    const render::Recording recording = validate::scenario_with(sweep, values).scenario.recording;
    CHECK(recording.shutter.rolling == (run >= 2));
    if (run >= 2) CHECK(recording.shutter.line_readout_s == expected[run / 2].second);
    CHECK(recording.exposure_s == (run % 2 == 0 ? 0.001 : 0.002));
  }
  // The results call them by their labels.
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
  CHECK(validate::run_sweep(sweep, database, {}, 1).failed == 0);
  const validate::SweepSummary summary = validate::summarize(sweep, database.database());
  REQUIRE(summary.axes[0].words);
  CHECK(summary.axes[0].labels.size() == 3);
  CHECK(std::count(summary.axes[0].labels.begin(), summary.axes[0].labels.end(), "slow") == 1);
}

TEST_CASE("What is wrong with a choice is said with the sweep's file, its line and the key") {
  // sweep.toml: three lines of head, one empty; [tracks] on 5 and 6; [[vary]] on 7, name on 8, choices from 9.
  const auto of = [](const std::string& first, const std::string& second) {
    return tests::refusal_of_sweep("",
                                   kNoise + "[[vary]]\nname = \"s\"\nchoices = [\n" + first + ",\n" + second + "]\n");
  };
  const std::string global = R"({ "shutter.kind" = "global" })";
  CHECK_THAT(of(global, R"({ "shutter.kind" = "rolling", "shutter.line_time_s" = 2e-5 })"),
             Contains("sweep.toml:11: shutter.line_time_s: found an unknown key") && Contains("line_readout_s"));
  CHECK_THAT(of(R"({ "shutter.knd" = "globe" })", global), Contains("sweep.toml:10: shutter.knd"));
  CHECK_THAT(of(global, R"({ "shutter.kind" = "rolling", "shutter.line_readout_s" = -1 })"),
             Contains("sweep.toml:11: shutter.line_readout_s: found -1"));
  CHECK_THAT(of(global, R"({ "shutter.kind" = "rolling" })"), Contains("sweep.toml:11: shutter.line_readout_s"));
  CHECK_THAT(of(global, global), Contains("sweep.toml:11: ") && Contains("the choice of line 10 again"));
  CHECK_THAT(of(R"({ label = "a", "camera.exposure_s" = 0.001 })", R"({ label = "a", "camera.exposure_s" = 0.002 })"),
             Contains("sweep.toml:11: vary[1].choices[2].label: found \"a\" twice"));
  CHECK_THAT(of(global, "{ label = \"none\" }"), Contains("sweep.toml:11: ") && Contains("a choice without a key"));
  CHECK_THAT(of(global, "{ camera_file = \"a.toml\" }"), Contains("sweep.toml:11: ") && Contains("cameras = "));
  CHECK_THAT(of(global, "{ \"shutter.kind\" = [1] }"), Contains("sweep.toml:11: ") && Contains("an array of 1"));
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nname = \"s\"\nchoices = []\n"),
             Contains("sweep.toml:9: vary[1].choices: found an array of 0"));
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nchoices = [" + global + "]\n"), Contains("vary[1].name"));
  // The noise of tracks is a run's own: given by some choices only, the others need one.
  CHECK_THAT(tests::refusal_of_sweep(
                 "", "[[vary]]\nname = \"s\"\nchoices = [{ \"tracks.noise_m\" = 1e-5 }, " + global + "]\n"),
             Contains("[tracks]"));
  CHECK(tests::refusal_of_sweep("", kNoise + "[[vary]]\nname = \"s\"\nchoices = [{ \"tracks.noise_m\" = 1e-5 }, " +
                                        global + "]\n") == "no error");
}

TEST_CASE("A range over a key of whole numbers gives whole numbers where it says so, and else an error that does") {
  const std::string width = "[[vary]]\nkey = \"camera.width_px\"\n";
  for (const char* design : {"", "design = \"sobol\"\nsamples = 16"}) {
    const std::string count = std::string(design).empty() ? ", count = 4" : "";
    CHECK_THAT(tests::refusal_of_sweep(design, kNoise + width + "range = { from = 300, to = 400" + count + " }\n"),
               Contains("camera.width_px: found 33") && Contains("\"whole = true\""));
    const tests::TempDir dir;
    const validate::Sweep sweep = validate::read_sweep(tests::write_sweep(
        dir.path(), design, kNoise + width + "range = { from = 300, to = 400, whole = true" + count + " }\n"));
    for (std::uint64_t run = 0; run < validate::run_count(sweep); ++run) {
      const double value = std::get<double>(validate::values_of(sweep, run)[0]);
      CHECK(value == std::floor(value));
      CHECK((value >= 300.0 && value <= 400.0));
      CHECK(validate::scenario_with(sweep, {value}).scenario.camera.width_px == static_cast<int>(value));
    }
  }
  CHECK_THAT(
      tests::refusal_of_sweep("", kNoise + width + "range = { from = 300, to = 303, whole = true, count = 6 }\n"),
      Contains("count: found 6 values, some of which are the same"));
  CHECK_THAT(
      tests::refusal_of_sweep("", kNoise + width + "range = { from = 300.5, to = 400, whole = true, count = 3 }\n"),
      Contains("range.from: found 300.5"));
  CHECK_THAT(
      tests::refusal_of_sweep("", kNoise + width + "random = { distribution = \"uniform\", from = 300, to = 400 }\n"),
      Contains("whole = true"));
}

TEST_CASE("Replicates that share a calibration are those of the first one's, whoever evaluates them and when") {
  const tests::TempDir dir;
  const auto sweep_of = [&](const std::string& calibration) {
    tests::write_sweep(dir.path(),
                       "level = \"clips\"\nreplicates = 2\nestimators = [\"phase-diagram\"]\n" + calibration, "");
    base::write_file(dir / "scenario.toml",
                     tests::kSweptScenario + "[calibration]\ninner_corners = [7, 4]\nsquare_m = 0.05\nviews = 6\n");
    return validate::read_sweep(dir / "sweep.toml");
  };
  const auto value = [](const validate::RunRecord& record) {
    INFO(record.why);
    REQUIRE_FALSE(record.failed);
    return record.quantities.front().value.value();
  };
  const validate::Sweep once = sweep_of("calibration = \"once\""), each = sweep_of("calibration = \"each\"");
  validate::RunWorker shared(once), alone(once), apart(each);
  const double first = value(shared.evaluate(0)), second = value(shared.evaluate(1));
  CHECK(value(alone.evaluate(1)) == second);
  CHECK(value(apart.evaluate(0)) == first);   // the first one's stills are its own either way
  CHECK(value(apart.evaluate(1)) != second);  // the other's are not
  CHECK_THAT(tests::refusal_of_sweep("calibration = \"once\"", kNoise), Contains("calibration"));
}
