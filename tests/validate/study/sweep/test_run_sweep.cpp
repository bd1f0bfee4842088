#include "validate/study/sweep/design/sweep.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "base/files/file_io.h"
#include "render/scenario/scenario.h"
#include "report/text/why_words.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"
#include "validate/study/sweep/design/sweep_scenario.h"
#include "validate/study/sweep/run_sweep.h"
#include "validate/study/sweep/sweep_summary.h"

using namespace glidelab;
using Catch::Matchers::Contains;
using tests::kNoise;

TEST_CASE("Rows hold the truth that was varied, and the bound shrinks as noise and frames say") {
  const tests::TempDir dir;
  const validate::Sweep sweep = validate::read_sweep(tests::write_sweep(dir.path(), "replicates = 4", tests::kTwoKeys));
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
  validate::run_sweep(sweep, database, {}, 2);
  validate::SqlStatement rows = database.database().prepare(
      "SELECT r.\"K/m\", s.truth, s.value, s.sd, s.least_sd FROM run r JOIN result s ON s.run = r.run "
      "WHERE quantity = 'k_over_m_1_s' AND estimator = 'trajectory'");
  int count = 0;
  while (rows.step()) {
    ++count;
    CHECK(rows.number(0) == rows.number(1));
    // Five stated standard deviations: 24 draws of fixed seeds.
    CHECK(std::abs(rows.number(2) - rows.number(1)) < 5.0 * rows.number(3));
    CHECK(rows.number(4) > 0.0);
  }
  CHECK(count == 24);
  // A kernel makes every slope of these lines larger; the fit of the whole motion has no kernel.
  validate::SqlStatement before = database.database().prepare(
      "SELECT estimator, value, uncorrected FROM result WHERE quantity = 'k_over_m_1_s' AND uncorrected IS NOT NULL");
  int corrected = 0;
  while (before.step()) {
    CHECK(before.text(0).starts_with("phase-diagram"));
    CHECK(before.number(2) > before.number(1));
    ++corrected;
  }
  CHECK(corrected > 0);
  const validate::SweepSummary summary = validate::summarize(sweep, database.database());
  REQUIRE(summary.axes.size() == 2);
  const auto series = std::find_if(summary.axes[0].series.begin(), summary.axes[0].series.end(), [](const auto& s) {
    return s.quantity == "k_over_m_1_s" && s.estimator == "trajectory";
  });
  REQUIRE(series != summary.axes[0].series.end());
  REQUIRE(series->groups.size() == 2);
  CHECK(series->groups[0].statistics.runs == 12);
  // The same motion seen at 50 and 80 Hz: the bound falls with the square root, but for the clip's ends (one frame of
  // 60).
  const double ratio = *series->groups[0].statistics.least_sd / *series->groups[1].statistics.least_sd;
  CHECK(std::abs(ratio - std::sqrt(80.0 / 50.0)) < 0.03);
}

TEST_CASE("A run that the scenario refuses is a failed row with its reason, and the others go on") {
  const tests::TempDir dir;
  // Alone each value passes; an exposure of 15 ms does not fit into 1/80 s.
  const validate::Sweep sweep = validate::read_sweep(tests::write_sweep(dir.path(), "", kNoise + R"(
[[vary]]
key = "camera.frame_rate_hz"
values = [50, 80]
[[vary]]
key = "camera.exposure_s"
values = [0.001, 0.015]
)"));
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
  const validate::SweepOutcome outcome = validate::run_sweep(sweep, database, {}, 1);
  CHECK(outcome.done == 4);
  CHECK(outcome.failed == 1);
  validate::SqlStatement why = database.database().prepare("SELECT why FROM run WHERE status = 'failed'");
  REQUIRE(why.step());
  CHECK_THAT(why.text(0), Contains("exposure_s"));
}

TEST_CASE("What a sweep takes is estimated from runs across its design, and disk only for what is missing") {
  const tests::TempDir dir;
  // The last of the four points is refused: a short row. Run 0 is of the first.
  const validate::Sweep sweep = validate::read_sweep(tests::write_sweep(dir.path(), "replicates = 10", kNoise + R"(
[[vary]]
key = "camera.frame_rate_hz"
values = [50, 80]
[[vary]]
key = "camera.exposure_s"
values = [0.001, 0.015]
)"));
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
  validate::RunWorker worker(sweep);
  const double full = validate::bytes_of(worker.evaluate(0)), refused = validate::bytes_of(worker.evaluate(39));
  REQUIRE(refused < 0.5 * full);
  // Three samples of 40: in the middle of each third, runs 6, 20 and 33.
  const validate::SweepEstimate before = validate::estimate_sweep(sweep, database, {}, 1, dir.path());
  CHECK(before.bytes == Approx(40.0 * (2.0 * full + refused) / 3.0).epsilon(0.01));
  CHECK(before.bytes_to_come == before.bytes);
  for (std::uint64_t run = 0; run < 10; ++run) database.add(worker.evaluate(run), 0.1);
  const validate::SweepEstimate later = validate::estimate_sweep(sweep, database, {}, 1, dir.path());
  CHECK(later.bytes_to_come == Approx(0.75 * later.bytes).epsilon(1e-12));
}

TEST_CASE("A camera file that the scenario names is part of what a sweep is, and a run shows what it says") {
  const tests::TempDir dir;
  const auto camera = [&](const char* exposure) {
    base::write_file(dir / "cams" / "c.toml", std::string("format = 1\nname = \"c\"\n[camera]\nexposure_s = ") +
                                                  exposure + "\n[shutter]\nkind = \"rolling\"\n" +
                                                  "line_readout_s = 2e-5\n");
  };
  std::filesystem::create_directory(dir / "cams");
  camera("0.002");
  const std::filesystem::path file = tests::write_sweep(dir.path(), "", tests::kTwoKeys);
  base::write_file(dir / "scenario.toml", "camera_file = \"cams/c.toml\"\n" + tests::kSweptScenario);
  const validate::Sweep sweep = validate::read_sweep(file);
  { validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words); }
  // Written in, the text says the same in a folder that has no such file.
  const validate::RunScenario run = validate::scenario_with(sweep, {50.0, 2.0});
  const std::string whole = render::with_camera_written_in(run.text, sweep.scenario_file);
  CHECK(whole.find("camera_file") == std::string::npos);
  const render::Scenario elsewhere = render::read_scenario(whole, dir / "no" / "such" / "run.toml");
  CHECK(elsewhere.recording.exposure_s == 0.002);
  CHECK(elsewhere.recording.shutter.rolling);
  CHECK(elsewhere.recording.shutter.line_readout_s == run.scenario.recording.shutter.line_readout_s);
  CHECK(elsewhere.recording.frame_rate_hz == 50.0);
  camera("0.003");
  CHECK_THROWS_WITH(validate::SweepDatabase(dir / "a.sqlite", validate::read_sweep(file), "1", {}, report::why_words),
                    Contains("camera file"));
}

namespace {

/// The swept scenario without a camera's keys.
std::string without_camera() {
  std::string scenario = tests::kSweptScenario;
  for (const char* key : {"width_px", "height_px", "frame_rate_hz", "focal_px"}) {
    const std::size_t at = scenario.find(key);
    scenario.erase(at, scenario.find('\n', at) - at + 1);
  }
  return scenario;
}

}  // namespace

TEST_CASE("Two camera files of one name in two folders are two groups of a sweep, told apart by their folders") {
  const tests::TempDir dir;
  const std::filesystem::path cameras = std::filesystem::path(tests::kSourceDir) / "scenarios/cameras";
  for (const auto& [folder, camera] : {std::pair{"old", "chronos-14.toml"}, std::pair{"new", "usb-webcam-vga.toml"}}) {
    std::filesystem::create_directory(dir / folder);
    std::filesystem::copy_file(cameras / camera, dir / folder / "lab.toml");
  }
  tests::write_sweep(dir.path(), "", kNoise + "[[vary]]\ncameras = [\"old/lab.toml\", \"new/lab.toml\"]\n");
  base::write_file(dir / "scenario.toml", without_camera());
  const validate::Sweep sweep = validate::read_sweep(dir / "sweep.toml");
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
  validate::run_sweep(sweep, database, {}, 1);
  const validate::SweepSummary summary = validate::summarize(sweep, database.database());
  const std::vector<validate::GroupStatistics>& groups = summary.axes[0].series.front().groups;
  REQUIRE(groups.size() == 2);
  for (const validate::GroupStatistics& group : groups) CHECK(group.statistics.runs == 1);
  CHECK_THAT(groups[0].label, Contains("new/lab.toml"));
  CHECK_THAT(groups[1].label, Contains("old/lab.toml"));
}

TEST_CASE("A sweep over cameras takes each one over, and refuses a scenario that writes the camera itself") {
  const tests::TempDir dir;
  const std::string vary =
      kNoise + "[[vary]]\ncameras = [\"" + std::string(tests::kSourceDir) + "/scenarios/cameras\"]\n";
  tests::write_sweep(dir.path(), "", vary);
  CHECK_THROWS_WITH(validate::read_sweep(dir / "sweep.toml"), Contains("camera.frame_rate_hz"));
  base::write_file(dir / "scenario.toml", without_camera());
  const validate::Sweep sweep = validate::read_sweep(dir / "sweep.toml");
  REQUIRE(sweep.axes.size() == 1);
  CHECK(sweep.axes[0].source.values.size() >= 16);
  const validate::RunScenario run = validate::scenario_with(sweep, {sweep.axes[0].source.values[0]});
  CHECK(run.scenario.recording.frame_rate_hz != 60.0);
}

TEST_CASE("The best possible bandwidth loses nothing to itself, and a bandwidth far from it loses much") {
  const tests::TempDir dir;
  const validate::Sweep sweep = validate::read_sweep(
      tests::write_sweep(dir.path(),
                         "replicates = 4\nestimators = [\"phase-diagram\"]\nbandwidth_rules = [\"best-possible\"]\n"
                         "bandwidths_s = [0.02]",
                         "[tracks]\nnoise_m = 1e-4\n[[vary]]\nkey = \"camera.frame_rate_hz\"\nvalues = [120]\n"));
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
  validate::run_sweep(sweep, database, {}, 1);
  const std::vector<validate::AccelerationError> errors = validate::summarize(sweep, database.database()).accelerations;
  REQUIRE(errors.size() == 3);
  for (const validate::AccelerationError& of : errors) {
    INFO(of.estimator);
    CHECK(of.clips == 4);
    REQUIRE(of.regret);
    if (of.estimator == "phase-diagram best-possible") {
      CHECK(*of.regret == 1.0);
      CHECK(*of.regret90 == 1.0);
    }
    // At h = 0.02 s the noise makes an error of sqrt(0.2116 s² dt / h^5) (core/motion/smoothing/local_polynomial.h),
    // and the best h is two to three times as long: the sd goes with h^-2.5.
    if (of.estimator == "phase-diagram h=0.02 s") {
      const double noise_m_s2 = std::sqrt(0.2116 * 1e-8 / 120.0 / std::pow(0.02, 5));
      CHECK(of.median_m_s2 == Approx(noise_m_s2).epsilon(0.3));  // some thirty independent points a clip
      CHECK(*of.regret > 2.0);
    }
  }
}

TEST_CASE("Rendered clips are swept like tracks, lossless ones in memory and lossy ones through a file") {
  const tests::TempDir dir;
  tests::write_sweep(dir.path(), "level = \"clips\"",
                     "[[vary]]\nkey = \"codec.name\"\nwords = [\"ffv1\", \"mjpeg\"]\n");
  base::write_file(dir / "scenario.toml",
                   tests::kSweptScenario + "[calibration]\ninner_corners = [7, 4]\nsquare_m = 0.05\nviews = 6\n");
  const validate::Sweep sweep = validate::read_sweep(dir / "sweep.toml");
  validate::RunWorker worker(sweep);
  std::vector<double> errors;
  for (std::uint64_t run = 0; run < 2; ++run) {
    const validate::RunRecord record = worker.evaluate(run);
    INFO(record.why);
    REQUIRE_FALSE(record.failed);
    REQUIRE(record.clips.size() == 1);
    CHECK(record.clips[0].frames == 72);  // 1.2 s at 60 Hz
    CHECK(record.clips[0].detected >= 70);
    for (const validate::QuantityRow& row : record.quantities) {
      if (row.quantity != "k_over_m_1_s" || row.estimator != "trajectory") continue;
      REQUIRE(row.value);
      errors.push_back(*row.value - *row.truth);
      CHECK(std::abs(errors.back()) < 5.0 * *row.sd);
    }
  }
  REQUIRE(errors.size() == 2);
  CHECK(errors[0] != errors[1]);  // the codec did something
}
