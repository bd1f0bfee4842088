#include "validate/study/sweep/sweep_merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <span>
#include <string>

#include "base/errors.h"

namespace glidelab::validate {
namespace {

namespace fs = std::filesystem;

/// Its first column is the run.
struct TableOfRuns {
  const char* name;
  int columns;
};

/// All rows of single runs, in the order of their keys.
class RowsOfRun {
 public:
  RowsOfRun(Database& database, const std::vector<TableOfRuns>& tables) : tables_(tables) {
    for (const TableOfRuns& table : tables) {
      select_.push_back(
          database.prepare(fmt::format("SELECT * FROM {} WHERE run = ?1 ORDER BY 1, 2, 3, 4", table.name)));
    }
  }
  /// The other has the same rows of the run.
  bool same(std::int64_t run, RowsOfRun& other) {
    bool all = true;
    for (std::size_t t = 0; t < tables_.size() && all; ++t) {
      SqlStatement &a = select_[t], &b = other.select_[t];
      a.bind(1, run);
      b.bind(1, run);
      for (bool more = true; more && all;) {
        more = a.step();
        all = more == b.step() && (!more || a.same_row(b, tables_[t].columns));
      }
      a.reset();
      b.reset();
    }
    return all;
  }

 private:
  std::vector<TableOfRuns> tables_;
  std::vector<SqlStatement> select_;
};

bool has_run(const fs::path& file, std::int64_t run) {
  Database database(file, Database::Mode::read);
  return database.prepare("SELECT 1 FROM run WHERE run = ?1").bind(1, run).step();
}

/// What is no database of this sweep is said before anything is taken.
void check_file(const fs::path& file, const Sweep& sweep, const SweepEntries& expected) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw base::InputError(base::Issue{file.string(), 0, "", "no such file", "a database of this sweep"});
  }
  Database database(file, Database::Mode::read);
  check_entries(database, expected);
  check_runs(database, sweep);
}

/// Runs of a file that are in the database already, with the same rows. `before`: the files that were taken over.
std::set<std::int64_t> runs_alike(Database& into, Database& there, const std::vector<TableOfRuns>& tables,
                                  std::span<const fs::path> before) {
  RowsOfRun here_rows(into, tables), there_rows(there, tables);
  SqlStatement known = into.prepare("SELECT 1 FROM run WHERE run = ?1");
  std::set<std::int64_t> alike;
  SqlStatement runs = there.prepare("SELECT run FROM run");
  while (runs.step()) {
    const std::int64_t run = runs.integer(0);
    const bool twice = known.bind(1, run).step();
    known.reset();
    if (!twice) continue;
    if (!here_rows.same(run, there_rows)) {
      const auto first =
          std::find_if(before.begin(), before.end(), [&](const fs::path& other) { return has_run(other, run); });
      const fs::path& has = first == before.end() ? into.file() : *first;
      throw base::InputError(base::Issue{there.file().string(), 0, fmt::format("run {}", run),
                                         fmt::format("other results than {} has of it", has.string()),
                                         "the same; leave one of the two out, or give another --out"});
    }
    alike.insert(run);
  }
  return alike;
}

/// All rows of a table but those of the runs that are left out.
void copy_rows(Database& into, Database& there, const TableOfRuns& table, const std::set<std::int64_t>& left_out) {
  std::string marks = "?1";
  for (int i = 2; i <= table.columns; ++i) marks += fmt::format(", ?{}", i);
  SqlStatement add = into.prepare(fmt::format("INSERT INTO {} VALUES ({})", table.name, marks));
  SqlStatement rows = there.prepare(fmt::format("SELECT * FROM {}", table.name));
  while (rows.step()) {
    if (left_out.contains(rows.integer(0))) continue;
    for (int i = 0; i < table.columns; ++i) add.bind_column(i + 1, rows, i);
    add.run();
  }
}

}  // namespace

void take_over(Database& into, const Sweep& sweep, const SweepEntries& expected, const std::vector<fs::path>& others) {
  for (const fs::path& other : others) check_file(other, sweep, expected);
  const std::vector<TableOfRuns> tables = {
      {"run", 6 + static_cast<int>(sweep.axes.size())}, {"result", 12}, {"clip", 10}};
  Transaction transaction(into);
  for (std::size_t which = 0; which < others.size(); ++which) {
    Database there(others[which], Database::Mode::read);
    const std::set<std::int64_t> alike = runs_alike(into, there, tables, std::span(others).first(which));
    for (const TableOfRuns& table : tables) copy_rows(into, there, table, alike);
    copy_rows(into, there, {"timing", 2}, alike);
  }
  transaction.commit();
}

}  // namespace glidelab::validate
