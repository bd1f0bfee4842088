#include "validate/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "catch.h"
#include "render/camera_file.h"
#include "temp_dir.h"
#include "test_paths.h"
#include "validate/run_sweep.h"
#include "validate/small_sweep.h"
#include "validate/sweep_scenario.h"
#include "validate/sweep_summary.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

/// All tables but the times, in order.
std::string contents(const std::filesystem::path& file) {
  validate::Database database(file, validate::Database::Mode::read);
  std::string text;
  for (const char* select : {"SELECT * FROM run ORDER BY run", "SELECT * FROM result ORDER BY 1, 2, 3, 4",
                             "SELECT * FROM clip ORDER BY 1, 2, 3"}) {
    validate::SqlStatement rows = database.prepare(select);
    while (rows.step()) {
      for (int column = 0; column < 12; ++column) text += rows.text(column) + "|";
      text += "\n";
    }
  }
  return text;
}

using tests::kNoise;

}  // namespace

TEST_CASE("A sweep of tracks gives the same rows on one thread and on two, and at once or in parts") {
  const tests::TempDir dir;
  const validate::Sweep sweep = validate::read_sweep(tests::write_sweep(dir.path(), "replicates = 2", tests::kTwoKeys));
  validate::SweepOutcome outcome;
  {
    validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {});
    CHECK(validate::estimate_sweep(sweep, database, {}, 1, dir.path()).missing == 12);
    outcome = validate::run_sweep(sweep, database, {}, 1);
    CHECK(outcome.done == 12);
    CHECK(outcome.failed == 0);
    CHECK(validate::run_sweep(sweep, database, {}, 1).done == 0);
  }
  {
    validate::SweepDatabase database(dir / "b.sqlite", sweep, "1", {});
    CHECK_THROWS_AS(validate::run_sweep(sweep, database, {}, 2,
                                        [](std::string_view, double fraction) {
                                          if (fraction > 0.3) throw base::Interrupted();
                                        }),
                    base::Interrupted);
    CHECK(database.runs() >= 4);
    CHECK(database.runs() <= 6);
  }
  {
    validate::SweepDatabase database(dir / "b.sqlite", sweep, "1", {});
    validate::run_sweep(sweep, database, {}, 2);
  }
  for (const std::uint64_t part : {1u, 2u, 3u}) {
    validate::SweepDatabase database(dir / fmt::format("c{}.sqlite", part), sweep, "1", {part, 3});
    CHECK(validate::run_sweep(sweep, database, {part, 3}, 1).done == 4);
  }
  validate::SweepDatabase merged(dir / "c.sqlite", sweep, "1", {});
  // Half of a merge is none: what is missing, or differs, leaves nothing behind.
  CHECK_THROWS_AS(merged.take({dir / "c3.sqlite", dir / "none.sqlite", dir / "c1.sqlite"}), base::InputError);
  CHECK(merged.runs() == 0);
  std::filesystem::copy_file(dir / "c3.sqlite", dir / "changed.sqlite");
  validate::Database(dir / "changed.sqlite", validate::Database::Mode::write)
      .run("UPDATE result SET value = value * (1 + 1e-15) WHERE run = (SELECT max(run) FROM run)");
  CHECK_THROWS_WITH(merged.take({dir / "c3.sqlite", dir / "c1.sqlite", dir / "changed.sqlite"}),
                    Contains("changed.sqlite: run 11: found other results than " + (dir / "c3.sqlite").string()));
  CHECK(merged.runs() == 0);
  // What several have alike is taken once, in one merge or in two.
  merged.take({dir / "c3.sqlite", dir / "c1.sqlite", dir / "c3.sqlite"});
  CHECK(merged.runs() == 8);
  CHECK_THROWS_WITH(merged.take({dir / "c2.sqlite", dir / "changed.sqlite"}),
                    Contains("changed.sqlite: run 11: found other results than " + (dir / "c.sqlite").string()));
  CHECK(merged.runs() == 8);
  merged.take({dir / "c3.sqlite", dir / "c1.sqlite", dir / "c2.sqlite"});
  CHECK(merged.runs() == 12);
  const std::string all = contents(dir / "a.sqlite");
  // 12 runs; 1 configuration x 2 estimators x 4 quantities; 1 clip
  CHECK(std::count(all.begin(), all.end(), '\n') == 12 + 12 * 8 + 12);
  CHECK(contents(dir / "b.sqlite") == all);
  CHECK(contents(dir / "c.sqlite") == all);
}

TEST_CASE("Rows hold the truth that was varied, and the bound shrinks as noise and frames say") {
  const tests::TempDir dir;
  const validate::Sweep sweep = validate::read_sweep(tests::write_sweep(dir.path(), "replicates = 4", tests::kTwoKeys));
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {});
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
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {});
  const validate::SweepOutcome outcome = validate::run_sweep(sweep, database, {}, 1);
  CHECK(outcome.done == 4);
  CHECK(outcome.failed == 1);
  validate::SqlStatement why = database.database().prepare("SELECT why FROM run WHERE status = 'failed'");
  REQUIRE(why.step());
  CHECK_THAT(why.text(0), Contains("exposure_s"));
}

TEST_CASE("What is wrong with a sweep is said before the first run, by its key") {
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"camera.frame_rate\"\nvalues = [30]\n"),
             Contains("sweep.toml:8: camera.frame_rate: ") && Contains("did you mean \"frame_rate_hz\""));
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"camera.frame_rate_hz\"\nvalues = [30, -1]\n"),
             Contains("sweep.toml:8: camera.frame_rate_hz: found -1") && Contains("camera.frame_rate_hz = -1"));
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"x\"\nrange = { from = 2, to = 2, count = 3 }\n"),
             Contains("an empty range"));
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"x\"\nvalues = []\n"), Contains("an empty list"));
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"x\"\n"), Contains("exactly one of values"));
  CHECK_THAT(
      tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"x\"\nlog_range = { from = 0, to = 2, count = 3 }\n"),
      Contains("log_range.from"));
  CHECK_THAT(tests::refusal_of_sweep("", ""), Contains("tracks"));
  CHECK_THAT(tests::refusal_of_sweep("estimators = [\"magic\"]", kNoise), Contains("magic"));
  CHECK_THAT(tests::refusal_of_sweep("samples = 3", kNoise), Contains("samples"));
  CHECK_THAT(tests::refusal_of_sweep("level = \"clips\"", kNoise), Contains("tracks"));
  CHECK_THAT(tests::refusal_of_sweep("level = \"clips\"", "[[vary]]\nkey = \"tracks.noise_m\"\nvalues = [1e-5]\n"),
             Contains("tracks.noise_m"));
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"camera.exposure_s\"\nvalues = [0.001]\n"
                                                  "[[vary]]\nkey = \"camera.exposure_s\"\nvalues = [0.001]\n"),
             Contains("twice"));
  CHECK_THAT(tests::refusal_of_sweep("colour = 3", kNoise), Contains("colour"));
  CHECK_THAT(tests::refusal_of_sweep("bandwidths_s = [0.02, 0.02]", kNoise),
             Contains("sweep.toml:4: bandwidths_s: found \"phase-diagram h=0.02 s\" twice"));
  const std::string none = tests::refusal_of_sweep("bandwidths_s = [0.0, 0.0]", kNoise);
  CHECK_THAT(none, Contains("bandwidths_s: found 0, expected") && !Contains("nan"));
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nname = \"x\"\nkey = \"camera.frame_rate_hz\"\n"
                                                  "choices = [{ \"camera.frame_rate_hz\" = 60 }]\n"),
             Contains("sweep.toml:9: vary[1].key: found a key beside choices, expected none: each choice names"));
}

TEST_CASE("Names that the database would take for one column are refused, whatever their capitals") {
  const auto two = [](const std::string& a, const std::string& b) {
    return tests::refusal_of_sweep("", kNoise + "[[vary]]\nname = \"" + a +
                                           "\"\nkey = \"camera.frame_rate_hz\"\nvalues = [50]\n[[vary]]\nname = \"" +
                                           b + "\"\nkey = \"camera.exposure_s\"\nvalues = [0.001]\n");
  };
  CHECK_THAT(two("a", "A"), Contains("sweep.toml:12: vary[2].name: found \"A\" beside \"a\""));
  CHECK_THAT(two("Run", "b"), Contains("sweep.toml:8: vary[1].name: found the name \"Run\""));
  CHECK_THAT(two("a", "sTaTuS"), Contains("sweep.toml:12: vary[2].name"));
  // SQLite is the judge: it keeps capitals apart where they are not of the letters a to z.
  CHECK(two("µ Ä", "µ ä") == "no error");
  const tests::TempDir dir;
  validate::Database database(dir / "a.sqlite", validate::Database::Mode::create);
  database.run("CREATE TABLE t (\"µ Ä\", \"µ ä\")");
  CHECK_THROWS_WITH(database.run("CREATE TABLE u (\"a\", \"A\")"), Contains("duplicate column"));
}

TEST_CASE("Keys that reach the same value of the scenario by two spellings are refused with the line of the later") {
  const auto two = [](const std::string& a, const std::string& b) {
    return tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"" + a +
                                           "\"\nvalues = [0.3, 0.4]\n[[vary]]\nkey = \"" + b + "\"\nvalues = [0.35]\n");
  };
  const std::string all = "configuration[*].mass_kg", first = "configuration[1].mass_kg";
  CHECK_THAT(two(all, first), Contains("sweep.toml:11: " + first + ": found a key that reaches " + first) &&
                                  Contains("as \"" + all + "\" does"));
  CHECK_THAT(two("configuration[*].force[law=viscous].k_over_m_1_s", "configuration[1].force[*].k_over_m_1_s"),
             Contains("sweep.toml:11: ") && Contains("k_over_m_1_s, as"));
  CHECK(two(all, "camera.position_m[2]") == "no error");
  CHECK(two("camera.position_m[1]", "camera.position_m[2]") == "no error");
}

TEST_CASE("A value, a word or a camera that an axis has twice is refused") {
  const auto of = [](const std::string& rest) { return tests::refusal_of_sweep("", kNoise + "[[vary]]\n" + rest); };
  CHECK_THAT(of("key = \"camera.frame_rate_hz\"\nvalues = [100, 80, 1e2]\n"),
             Contains("sweep.toml:9: vary[1].values: found 100 twice"));
  CHECK_THAT(of("key = \"shutter.kind\"\nwords = [\"global\", \"global\"]\n"),
             Contains("sweep.toml:9: vary[1].words: found \"global\" twice"));
  const std::string cameras = std::string(tests::kSourceDir) + "/scenarios/cameras";
  CHECK_THAT(of("cameras = [\"" + cameras + "\", \"" + cameras + "/chronos-14.toml\"]\n"),
             Contains("sweep.toml:8: vary[1].cameras: found") && Contains("chronos-14.toml\" twice"));
}

TEST_CASE("Every column of every table has a row in the schema") {
  const tests::TempDir dir;
  const validate::Sweep sweep = validate::read_sweep(tests::write_sweep(dir.path(), "", tests::kTwoKeys));
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {});
  validate::SqlStatement none = database.database().prepare(
      "SELECT t.name || '.' || c.name FROM sqlite_master t JOIN pragma_table_info(t.name) c "
      "WHERE t.type = 'table' AND t.name IN ('run', 'result', 'clip', 'timing') AND NOT EXISTS "
      "(SELECT 1 FROM \"schema\" s WHERE s.\"table\" = t.name AND s.\"column\" = c.name)");
  std::string missing;
  while (none.step()) missing += none.text(0) + " ";
  CHECK(missing == "");
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
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {});
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
  { validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}); }
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
  CHECK_THROWS_WITH(validate::SweepDatabase(dir / "a.sqlite", validate::read_sweep(file), "1", {}),
                    Contains("camera file"));
}

TEST_CASE("A database of another sweep, another version or no sweep at all is refused, and so is a second writer") {
  const tests::TempDir dir;
  const std::filesystem::path file = tests::write_sweep(dir.path(), "replicates = 2", tests::kTwoKeys);
  const validate::Sweep sweep = validate::read_sweep(file);
  {
    validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {});
    CHECK_THROWS_AS(validate::SweepDatabase(dir / "a.sqlite", sweep, "1", {}), base::EnvironmentError);
  }
  CHECK_THROWS_WITH(validate::SweepDatabase(dir / "a.sqlite", sweep, "2", {}),
                    Contains("program version") && Contains("\"1\""));
  CHECK_THROWS_WITH(validate::SweepDatabase(dir / "a.sqlite", sweep, "1", {1, 2}), Contains("shard"));
  validate::Sweep other = sweep;
  other.scenario_text += "\n# another\n";
  CHECK_THROWS_WITH(validate::SweepDatabase(dir / "a.sqlite", other, "1", {}), Contains("scenario's text"));
  base::write_file(dir / "b.sqlite", "this is a text and certainly no database, however long one makes it");
  CHECK_THROWS_AS(validate::SweepDatabase(dir / "b.sqlite", sweep, "1", {}), base::InputError);
}

TEST_CASE("A full disk is an error of the environment that keeps what is finished, and the sweep goes on later") {
  const tests::TempDir dir;
  const validate::Sweep sweep =
      validate::read_sweep(tests::write_sweep(dir.path(), "replicates = 20", tests::kTwoKeys));
  std::uint64_t kept = 0;
  {
    validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {});
    database.database().run("PRAGMA max_page_count = 24");  // what a full disk is to SQLite, for this connection
    CHECK_THROWS_WITH(validate::run_sweep(sweep, database, {}, 1), Contains("disk is full"));
    kept = database.runs();
    CHECK(kept > 0);
    CHECK(kept < 120);
  }
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {});
  CHECK(validate::run_sweep(sweep, database, {}, 2).done == 120 - kept);
}

TEST_CASE("A sweep over cameras takes each one over, and refuses a scenario that writes the camera itself") {
  const tests::TempDir dir;
  const std::string vary =
      kNoise + "[[vary]]\ncameras = [\"" + std::string(tests::kSourceDir) + "/scenarios/cameras\"]\n";
  tests::write_sweep(dir.path(), "", vary);
  CHECK_THROWS_WITH(validate::read_sweep(dir / "sweep.toml"), Contains("camera.frame_rate_hz"));
  std::string scenario = tests::kSweptScenario;
  for (const char* key : {"width_px", "height_px", "frame_rate_hz", "focal_px"}) {
    const std::size_t at = scenario.find(key);
    scenario.erase(at, scenario.find('\n', at) - at + 1);
  }
  base::write_file(dir / "scenario.toml", scenario);
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
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {});
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
    // At h = 0.02 s the noise makes an error of sqrt(0.2116 s² dt / h^5) (core/local_cubic.h), and the best h is two to
    // three times as long: the sd goes with h^-2.5.
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

TEST_CASE("A part whose runs are not those of the sweep by number or seed is refused whole") {
  const tests::TempDir dir;
  const validate::Sweep sweep = validate::read_sweep(tests::write_sweep(dir.path(), "", tests::kTwoKeys));
  const auto refusal = [&](const std::string& change) {
    std::filesystem::remove(dir / "part.sqlite");
    {
      validate::SweepDatabase part(dir / "part.sqlite", sweep, "1", {1, 2});
      validate::run_sweep(sweep, part, {1, 2}, 1);
      part.database().run(change);
    }
    validate::SweepDatabase whole(dir / "whole.sqlite", sweep, "1", {});
    std::string said = "taken";
    try {
      whole.take({dir / "part.sqlite"});
    } catch (const base::InputError& error) {
      said = error.what();
      CHECK(whole.runs() == 0);
    }
    return said;
  };
  const std::string all_tables =
      "; UPDATE result SET run = run + %; UPDATE clip SET run = run + %; "
      "UPDATE timing SET run = run + %";
  const auto moved = [&](const std::string& by) {
    std::string sql = "UPDATE run SET run = run + %" + all_tables;
    for (std::size_t at = sql.find('%'); at != std::string::npos; at = sql.find('%')) sql.replace(at, 1, by);
    return sql;
  };
  CHECK_THAT(refusal(moved("1000")),
             Contains("part.sqlite: run 1000: found no run of this sweep, expected the runs 0 to 5"));
  CHECK_THAT(refusal(moved("1")), Contains("part.sqlite: run 1: found the seed"));  // there is such a run
  CHECK_THAT(refusal("UPDATE clip SET run = run + 1000 WHERE run = 2"), Contains("run 1002: found rows in clip alone"));
  CHECK(refusal("SELECT 1") == "taken");
}
