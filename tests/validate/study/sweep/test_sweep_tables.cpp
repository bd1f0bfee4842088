#include "validate/study/sweep/sweep_tables.h"

#include <fmt/format.h>
#include <sqlite3.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "report/text/why_words.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"
#include "validate/study/sweep/run_sweep.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

/// Runs SQL as another program would, with everything that SQLite allows.
void change(const std::filesystem::path& file, const std::string& sql) {
  sqlite3* database = nullptr;
  REQUIRE(sqlite3_open(file.c_str(), &database) == SQLITE_OK);
  char* error = nullptr;
  const int status = sqlite3_exec(database, sql.c_str(), nullptr, nullptr, &error);
  INFO(sql << ": " << (error == nullptr ? "" : error));
  CHECK(status == SQLITE_OK);
  sqlite3_free(error);
  sqlite3_close(database);
}

/// A finished sweep of two runs, copied and changed; what is said of it when it is continued and when it is merged.
class Damaged {
 public:
  Damaged() : sweep_(validate::read_sweep(tests::write_sweep(dir_.path(), "replicates = 2", tests::kNoise + kOneKey))) {
    validate::SweepDatabase database(dir_ / "whole.sqlite", sweep_, "1", {}, report::why_words);
    CHECK(validate::run_sweep(sweep_, database, {}, 1).done == 2);
  }

  std::string by(const std::string& sql) {
    std::filesystem::copy_file(dir_ / "whole.sqlite", dir_ / "a.sqlite",
                               std::filesystem::copy_options::overwrite_existing);
    if (!sql.empty()) change(dir_ / "a.sqlite", sql);
    return said();
  }

  /// Zeros over its pages from the second on.
  std::string by_zeros(std::size_t bytes) {
    std::string all = base::read_file(dir_ / "whole.sqlite");
    all.replace(5 * 4096, bytes, std::string(bytes, '\0'));
    base::write_file(dir_ / "a.sqlite", all);
    return said();
  }

 private:
  static constexpr const char* kOneKey = "[[vary]]\nkey = \"camera.frame_rate_hz\"\nvalues = [50]\n";

  std::string said() {
    const std::string continued =
        refusal([&] { validate::SweepDatabase(dir_ / "a.sqlite", sweep_, "1", {}, report::why_words); });
    std::filesystem::remove(dir_ / "b.sqlite");
    const std::string merged = refusal([&] {
      validate::SweepDatabase(dir_ / "b.sqlite", sweep_, "1", {}, report::why_words).merge_runs_of({dir_ / "a.sqlite"});
    });
    CHECK(continued == merged);
    return continued;
  }

  template <class Work>
  static std::string refusal(const Work& work) {
    try {
      work();
    } catch (const base::InputError& error) {
      return error.what();
    }
    return "taken";
  }

  tests::TempDir dir_;
  validate::Sweep sweep_;
};

}  // namespace

TEST_CASE("a sweep's database with a trigger, a view or an index of somebody else is refused by their names") {
  Damaged damaged;
  CHECK(damaged.by("") == "taken");
  CHECK(damaged.by("CREATE TABLE notes (text TEXT)") == "taken");
  CHECK_THAT(damaged.by("CREATE TRIGGER late AFTER INSERT ON run BEGIN INSERT INTO timing WITH RECURSIVE n(i) AS "
                        "(SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT count(*), 1 FROM n; END"),
             Contains("a.sqlite: trigger \"late\": found a trigger on \"run\", expected tables only"));
  CHECK_THAT(damaged.by("CREATE VIEW fast AS SELECT * FROM run"), Contains("view \"fast\": found view"));
  CHECK_THAT(damaged.by("DROP TABLE timing; CREATE VIEW timing AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT "
                        "i + 1 FROM n) SELECT i AS run, 1.0 AS wall_s FROM n"),
             Contains("view \"timing\""));
  CHECK_THAT(damaged.by("CREATE UNIQUE INDEX one ON result (run, configuration, estimator, quantity)"),
             Contains("an index on \"result\""));
}

TEST_CASE("a trigger that gets into a database after it was opened does not run") {
  const tests::TempDir dir;
  { validate::Database(dir / "a.sqlite", validate::Database::Mode::create).run("CREATE TABLE t (n)"); }
  change(dir / "a.sqlite", "CREATE TRIGGER more AFTER INSERT ON t BEGIN INSERT INTO t VALUES (2); END");
  validate::Database database(dir / "a.sqlite", validate::Database::Mode::write);
  database.run("INSERT INTO t VALUES (1)");
  validate::SqlStatement count = database.prepare("SELECT count(*) FROM t");
  REQUIRE(count.step());
  CHECK(count.integer(0) == 1);
}

TEST_CASE("a table or a column that a sweep's database lacks is named") {
  Damaged damaged;
  CHECK_THAT(damaged.by("DROP TABLE clip"), Contains("table \"clip\": found no such table"));
  CHECK_THAT(damaged.by("DROP TABLE timing"), Contains("table \"timing\": found no such table"));
  CHECK_THAT(damaged.by("DROP TABLE result"), Contains("format: found nothing"));  // then it is no sweep's
  CHECK_THAT(damaged.by("ALTER TABLE result DROP COLUMN sd"), Contains("table \"result\": found no column \"sd\""));
  CHECK_THAT(damaged.by("ALTER TABLE sweep DROP COLUMN value"), Contains("table \"sweep\": found no column \"value\""));
  CHECK_THAT(damaged.by("ALTER TABLE run ADD COLUMN more"), Contains("table \"run\": found CREATE TABLE run"));
  CHECK_THAT(
      damaged.by("PRAGMA writable_schema = ON; UPDATE sqlite_master SET sql = replace(sql, 'sd REAL', 'sd TEXT') "
                 "WHERE name = 'result'"),
      Contains("table \"result\": found no column \"sd\", expected one of the type REAL"));
}

TEST_CASE("a value that no sweep writes is refused with its table, run and column") {
  Damaged damaged;
  CHECK_THAT(damaged.by("UPDATE result SET value = 9e999 WHERE run = 1"),
             Contains("table \"result\", run 1, column \"value\": found Inf, expected a finite number"));
  CHECK_THAT(damaged.by("UPDATE result SET truth = -9e999"), Contains("column \"truth\": found -Inf"));
  CHECK(damaged.by("UPDATE result SET value = 1e308, sd = NULL") == "taken");
  CHECK_THAT(damaged.by("UPDATE result SET sd = 'much'"), Contains("column \"sd\": found 'much'"));
  CHECK_THAT(damaged.by("UPDATE clip SET frames = 1.5"), Contains("column \"frames\": found 1.5, expected a whole"));
  CHECK_THAT(damaged.by("UPDATE run SET why = x'00ff' WHERE run = 0"),
             Contains("table \"run\", run 0, column \"why\": found X'00FF', expected text"));
  CHECK_THAT(damaged.by("UPDATE run SET \"camera.frame_rate_hz\" = 9e999"), Contains("found Inf"));
}

TEST_CASE("a run whose number, point or status is none of the sweep's is refused, also where the sweep goes on") {
  Damaged damaged;
  CHECK_THAT(damaged.by("UPDATE run SET run = -1 WHERE run = 1"),
             Contains("run -1: found no run of this sweep, expected the runs 0 to 1"));
  CHECK_THAT(damaged.by("UPDATE timing SET run = -7 WHERE run = 1"), Contains("run -7: found rows in timing alone"));
  CHECK_THAT(damaged.by("UPDATE run SET point = 3 WHERE run = 1"),
             Contains("run 1: found replicate 1 of point 3, expected 1 of 0"));
  CHECK_THAT(damaged.by("UPDATE run SET status = 'lost' WHERE run = 1"),
             Contains("run 1: found the status \"lost\", expected done or failed"));
}

TEST_CASE("a sweep's database with pages that were overwritten is damaged, not empty") {
  Damaged damaged;
  CHECK_THAT(damaged.by_zeros(2 * 4096), Contains("a damaged database"));
}
