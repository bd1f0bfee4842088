#include "validate/study/sweep/sweep_database.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "report/text/why_words.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"
#include "validate/study/sweep/run_sweep.h"
#include "validate/study/sweep/sweep_summary.h"

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

}  // namespace

TEST_CASE("Why a quantity has no value is stored in the words of the pages, and nothing where there is a value") {
  const tests::TempDir dir;
  const validate::Sweep sweep = validate::read_sweep(tests::write_sweep(dir.path(), "", tests::kTwoKeys));
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
  validate::QuantityRow unknown, known;
  unknown.quantity = "mu";
  unknown.why = core::WhyUnknown{core::unknown::NoDownhillLine{}};
  known.quantity = "alpha_deg";
  known.value = 4.0;
  database.add({0, 0, 0, validate::seed_of(sweep, 0), {50.0, 2.0}, false, "", {unknown, known}, {}}, 0.1);
  validate::SqlStatement rows = database.database().prepare("SELECT why, value FROM result ORDER BY quantity DESC");
  REQUIRE(rows.step());
  CHECK(rows.text(0) == "no line for v > 0");
  REQUIRE(rows.step());
  CHECK(rows.text(0).empty());
  CHECK(rows.text(1) == "4.0");
}

TEST_CASE("A sweep of tracks gives the same rows on one thread and on two, and at once or in parts") {
  const tests::TempDir dir;
  const validate::Sweep sweep = validate::read_sweep(tests::write_sweep(dir.path(), "replicates = 2", tests::kTwoKeys));
  validate::SweepOutcome outcome;
  {
    validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
    CHECK(validate::estimate_sweep(sweep, database, {}, 1, dir.path()).missing == 12);
    outcome = validate::run_sweep(sweep, database, {}, 1);
    CHECK(outcome.done == 12);
    CHECK(outcome.failed == 0);
    CHECK(validate::run_sweep(sweep, database, {}, 1).done == 0);
  }
  {
    validate::SweepDatabase database(dir / "b.sqlite", sweep, "1", {}, report::why_words);
    CHECK_THROWS_AS(validate::run_sweep(sweep, database, {}, 2,
                                        [](std::string_view, double fraction) {
                                          if (fraction > 0.3) throw base::Interrupted();
                                        }),
                    base::Interrupted);
    CHECK(database.runs() >= 4);
    CHECK(database.runs() <= 6);
  }
  {
    validate::SweepDatabase database(dir / "b.sqlite", sweep, "1", {}, report::why_words);
    validate::run_sweep(sweep, database, {}, 2);
  }
  for (const std::uint64_t part : {1u, 2u, 3u}) {
    validate::SweepDatabase database(dir / fmt::format("c{}.sqlite", part), sweep, "1", {part, 3}, report::why_words);
    CHECK(validate::run_sweep(sweep, database, {part, 3}, 1).done == 4);
  }
  validate::SweepDatabase merged(dir / "c.sqlite", sweep, "1", {}, report::why_words);
  // Half of a merge is none: what is missing, or differs, leaves nothing behind.
  CHECK_THROWS_AS(merged.merge_runs_of({dir / "c3.sqlite", dir / "none.sqlite", dir / "c1.sqlite"}), base::InputError);
  CHECK(merged.runs() == 0);
  std::filesystem::copy_file(dir / "c3.sqlite", dir / "changed.sqlite");
  validate::Database(dir / "changed.sqlite", validate::Database::Mode::write)
      .run("UPDATE result SET value = value * (1 + 1e-15) WHERE run = (SELECT max(run) FROM run)");
  CHECK_THROWS_WITH(merged.merge_runs_of({dir / "c3.sqlite", dir / "c1.sqlite", dir / "changed.sqlite"}),
                    Contains("changed.sqlite: run 11: found other results than " + (dir / "c3.sqlite").string()));
  CHECK(merged.runs() == 0);
  // What several have alike is taken once, in one merge or in two.
  merged.merge_runs_of({dir / "c3.sqlite", dir / "c1.sqlite", dir / "c3.sqlite"});
  CHECK(merged.runs() == 8);
  CHECK_THROWS_WITH(merged.merge_runs_of({dir / "c2.sqlite", dir / "changed.sqlite"}),
                    Contains("changed.sqlite: run 11: found other results than " + (dir / "c.sqlite").string()));
  CHECK(merged.runs() == 8);
  merged.merge_runs_of({dir / "c3.sqlite", dir / "c1.sqlite", dir / "c2.sqlite"});
  CHECK(merged.runs() == 12);
  const std::string all = contents(dir / "a.sqlite");
  // 12 runs; 1 configuration x 2 estimators x 4 quantities; 1 clip
  CHECK(std::count(all.begin(), all.end(), '\n') == 12 + 12 * 8 + 12);
  CHECK(contents(dir / "b.sqlite") == all);
  CHECK(contents(dir / "c.sqlite") == all);
}

TEST_CASE("Every column of every table has a row in the schema") {
  const tests::TempDir dir;
  const validate::Sweep sweep = validate::read_sweep(tests::write_sweep(dir.path(), "", tests::kTwoKeys));
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
  validate::SqlStatement none = database.database().prepare(
      "SELECT t.name || '.' || c.name FROM sqlite_master t JOIN pragma_table_info(t.name) c "
      "WHERE t.type = 'table' AND t.name IN ('run', 'result', 'clip', 'timing') AND NOT EXISTS "
      "(SELECT 1 FROM \"schema\" s WHERE s.\"table\" = t.name AND s.\"column\" = c.name)");
  std::string missing;
  while (none.step()) missing += none.text(0) + " ";
  CHECK(missing == "");
}

TEST_CASE("A database of another sweep, another version or no sweep at all is refused, and so is a second writer") {
  const tests::TempDir dir;
  const std::filesystem::path file = tests::write_sweep(dir.path(), "replicates = 2", tests::kTwoKeys);
  const validate::Sweep sweep = validate::read_sweep(file);
  {
    validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
    CHECK_THROWS_AS(validate::SweepDatabase(dir / "a.sqlite", sweep, "1", {}, report::why_words),
                    base::EnvironmentError);
  }
  CHECK_THROWS_WITH(validate::SweepDatabase(dir / "a.sqlite", sweep, "2", {}, report::why_words),
                    Contains("program version") && Contains("\"1\""));
  CHECK_THROWS_WITH(validate::SweepDatabase(dir / "a.sqlite", sweep, "1", {1, 2}, report::why_words),
                    Contains("shard"));
  validate::Sweep other = sweep;
  other.scenario_text += "\n# another\n";
  CHECK_THROWS_WITH(validate::SweepDatabase(dir / "a.sqlite", other, "1", {}, report::why_words),
                    Contains("scenario's text"));
  base::write_file(dir / "b.sqlite", "this is a text and certainly no database, however long one makes it");
  CHECK_THROWS_AS(validate::SweepDatabase(dir / "b.sqlite", sweep, "1", {}, report::why_words), base::InputError);
}

TEST_CASE("A full disk is an error of the environment that keeps what is finished, and the sweep goes on later") {
  const tests::TempDir dir;
  const validate::Sweep sweep =
      validate::read_sweep(tests::write_sweep(dir.path(), "replicates = 20", tests::kTwoKeys));
  std::uint64_t kept = 0;
  {
    validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
    database.database().run("PRAGMA max_page_count = 24");  // what a full disk is to SQLite, for this connection
    CHECK_THROWS_WITH(validate::run_sweep(sweep, database, {}, 1), Contains("disk is full"));
    kept = database.runs();
    CHECK(kept > 0);
    CHECK(kept < 120);
  }
  validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
  CHECK(validate::run_sweep(sweep, database, {}, 2).done == 120 - kept);
}

TEST_CASE("A part whose runs are not those of the sweep by number or seed is refused whole") {
  const tests::TempDir dir;
  const validate::Sweep sweep = validate::read_sweep(tests::write_sweep(dir.path(), "", tests::kTwoKeys));
  const auto refusal = [&](const std::string& change) {
    std::filesystem::remove(dir / "part.sqlite");
    {
      validate::SweepDatabase part(dir / "part.sqlite", sweep, "1", {1, 2}, report::why_words);
      validate::run_sweep(sweep, part, {1, 2}, 1);
      part.database().run(change);
    }
    validate::SweepDatabase whole(dir / "whole.sqlite", sweep, "1", {}, report::why_words);
    std::string said = "taken";
    try {
      whole.merge_runs_of({dir / "part.sqlite"});
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

TEST_CASE("A sweep judges an outside estimator in every run, counts its failures, and goes on with it alone") {
  const tests::TempDir dir;
  validate::Sweep sweep = validate::read_sweep(tests::write_sweep(dir.path(), "", tests::kTwoKeys));
  // Of the six runs the three of 50 frames a second have less than 70 rows.
  base::write_file(dir / "mine.sh", R"(test $(wc -l < "$1/tracks/up.csv") -lt 70 && { echo few >&2; exit 3; }
echo '{"format": 1, "configurations": [{"clips": ["up"], "k_over_m_1_s": {"value": 3, "sd": 0.5},
 "mu": null, "alpha_deg": null, "v_lim_m_s": null}]}' > "$2/results.json")");
  sweep.outside = fit::outside_estimator("sh " + (dir / "mine.sh").string() + " {folder} {out}");
  {
    validate::SweepDatabase database(dir / "a.sqlite", sweep, "1", {}, report::why_words);
    CHECK(validate::run_sweep(sweep, database, {}, 2).failed == 0);
    const validate::SweepSummary summary = validate::summarize(sweep, database.database());
    REQUIRE(summary.outside);
    CHECK(summary.outside->runs == 6);
    CHECK(summary.outside->failed() == 3);
    CHECK(summary.outside->failures[0].count == 3);
    CHECK(summary.outside->failures[0].first == "exit status 3: few");
    validate::SqlStatement values = database.database().prepare(
        "SELECT count(value) FROM result WHERE estimator = 'mine' AND quantity = 'k_over_m_1_s' AND value = 3");
    values.step();
    CHECK(values.integer(0) == 3);
  }
  validate::Sweep without = sweep, other = sweep;
  without.outside.reset();
  other.outside->words.back() = "{out}/.";
  for (const validate::Sweep& changed : {without, other}) {
    CHECK_THROWS_WITH(validate::SweepDatabase(dir / "a.sqlite", changed, "1", {}, report::why_words),
                      Contains("estimator"));
  }
}

TEST_CASE("a number that is not there comes back as none, and zero as zero") {
  const tests::TempDir dir;
  validate::Database database(dir / "numbers.sqlite", validate::Database::Mode::create);
  database.run("CREATE TABLE numbers (value REAL)");
  const std::vector<std::optional<double>> values = {0.0, std::nullopt, -2.5, std::numeric_limits<double>::infinity()};
  for (const std::optional<double>& value : values) {
    validate::SqlStatement insert = database.prepare("INSERT INTO numbers VALUES (?1)");
    insert.bind(1, value).run();
  }
  validate::SqlStatement rows = database.prepare("SELECT value FROM numbers ORDER BY rowid");
  for (const std::optional<double>& value : values) {
    REQUIRE(rows.step());
    const bool there = value && std::isfinite(*value);  // what is not finite is none
    CHECK(rows.maybe_number(0) == (there ? value : std::nullopt));
    CHECK(rows.is_null(0) == !there);
  }
  CHECK_FALSE(rows.step());
}
