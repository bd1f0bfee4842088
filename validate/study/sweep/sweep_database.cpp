#include "validate/study/sweep/sweep_database.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <set>
#include <span>
#include <string>

#include "base/errors.h"
#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/sweep_tables.h"

namespace glidelab::validate {
namespace {

std::string shorten(const std::string& text) {
  constexpr std::size_t kShownLength = 60;
  if (text.find('\n') != std::string::npos) return "another text";
  return fmt::format("\"{}\"", text.size() > kShownLength ? text.substr(0, kShownLength) + "…" : text);
}

}  // namespace

namespace {

constexpr const char* kEstimatorEntry = "estimator";  // only for a sweep that judges an estimator of the command line

}  // namespace

SweepEntries entries_of(const Sweep& sweep, const std::string& version) {
  SweepEntries entries = {{"format", "2"},
                          {"program version", version},
                          {"sweep", sweep.name},
                          {"sweep file's text", sweep.text},
                          {"scenario's text", sweep.scenario_text},
                          {"seed", fmt::format("{}", sweep.seed)},
                          {"runs", fmt::format("{}", run_count(sweep))}};
  for (std::size_t i = 0; i < sweep.camera_files.size(); ++i) {
    entries.emplace_back(fmt::format("camera file {}", i + 1), sweep.camera_files[i]);
  }
  if (sweep.outside) {
    entries.emplace_back(kEstimatorEntry, sweep.outside->name);
    entries.emplace_back("estimator's command", fit::command_text(*sweep.outside));
  }
  return entries;
}

namespace {

SweepEntries sweep_entries(Database& database) {
  SweepEntries entries;
  SqlStatement select = database.prepare("SELECT key, value FROM sweep ORDER BY key");
  while (select.step()) entries.emplace_back(select.text(0), select.text(1));
  return entries;
}

/// InputError, which says what differs, if the database has other entries.
void check_entries(Database& database, const SweepEntries& expected) {
  SweepEntries found;
  if (has_entries(database)) found = sweep_entries(database);
  for (const auto& wanted : expected) {
    const auto entry =
        std::find_if(found.begin(), found.end(), [&](const auto& pair) { return pair.first == wanted.first; });
    if (entry != found.end() && entry->second == wanted.second) continue;
    throw base::InputError(base::Issue{
        database.file().string(), 0, wanted.first, entry == found.end() ? "nothing" : shorten(entry->second),
        fmt::format("{}: a database is continued only by the sweep and the program that began it; give another --out",
                    wanted.second.find('\n') == std::string::npos ? shorten(wanted.second) : "that of this sweep")});
  }
  const auto of_estimator = [](const auto& pair) { return pair.first == kEstimatorEntry; };
  const auto other = std::ranges::find_if(found, of_estimator);
  if (other != found.end() && std::ranges::none_of(expected, of_estimator)) {
    throw base::InputError(base::Issue{database.file().string(), 0, kEstimatorEntry, other->second,
                                       "none: a sweep begun with --estimator-command must be continued with it"});
  }
}

/// InputError if a row belongs to no run of the sweep, or to a run that has another seed there.
void check_runs(Database& database, const Sweep& sweep) {
  const std::uint64_t count = run_count(sweep);
  const auto refuse = [&](std::int64_t run, const std::string& found, const std::string& expected) {
    throw base::InputError(base::Issue{database.file().string(), 0, fmt::format("run {}", run), found, expected});
  };
  SqlStatement runs = database.prepare("SELECT run, seed, point, replicate, status FROM run");
  while (runs.step()) {
    const std::int64_t run = runs.integer(0);
    if (run < 0 || static_cast<std::uint64_t>(run) >= count) {
      refuse(run, "no run of this sweep", fmt::format("the runs 0 to {}", count - 1));
    }
    const std::uint64_t number = static_cast<std::uint64_t>(run), seed = seed_of(sweep, number);
    if (static_cast<std::uint64_t>(runs.integer(1)) != seed) {
      refuse(run, fmt::format("the seed {}", static_cast<std::uint64_t>(runs.integer(1))),
             fmt::format("{}, which is that of this run", seed));
    }
    const std::uint64_t point = number / sweep.replicates, replicate = number % sweep.replicates;
    if (static_cast<std::uint64_t>(runs.integer(2)) != point ||
        static_cast<std::uint64_t>(runs.integer(3)) != replicate) {
      refuse(run, fmt::format("replicate {} of point {}", runs.integer(3), runs.integer(2)),
             fmt::format("{} of {}", replicate, point));
    }
    if (runs.text(4) == "done" || runs.text(4) == "failed") continue;
    refuse(run, fmt::format("the status {}", shorten(runs.text(4))), "done or failed");
  }
  for (const char* const table : {"result", "clip", "timing"}) {
    SqlStatement stray =
        database.prepare(fmt::format("SELECT run FROM {} WHERE run NOT IN (SELECT run FROM run) LIMIT 1", table));
    if (stray.step()) refuse(stray.integer(0), fmt::format("rows in {} alone", table), "a row in run as well");
  }
}

}  // namespace

void check_database(Database& database, const Sweep& sweep, const SweepEntries& expected) {
  refuse_code(database);
  check_entries(database, expected);
  check_tables(database, sweep);
  check_values(database);
  check_runs(database, sweep);
}

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
  /// Whether the other has the same rows for the run.
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

/// Files that are not databases of this sweep are reported before anything is copied.
void check_file(const fs::path& file, const Sweep& sweep, const SweepEntries& expected) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) {
    throw base::InputError(base::Issue{file.string(), 0, "", "no such file", "a database of this sweep"});
  }
  Database database(file, Database::Mode::read);
  check_database(database, sweep, expected);
}

/// Runs of a file that are already in the database, with the same rows. `before`: the files already merged.
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

/// Copies all rows of a table except those of the runs that are left out.
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

void merge_runs(Database& into, const Sweep& sweep, const SweepEntries& expected, const std::vector<fs::path>& others) {
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

namespace fs = std::filesystem;

WriterLock::WriterLock(const fs::path& database) {
  const std::string name = database.string() + "-lock";
  file_ = ::open(name.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) base::throw_system_error(name, "cannot be made", errno);
  if (::flock(file_, LOCK_EX | LOCK_NB) == 0) return;
  const int error = errno;
  ::close(file_);
  if (error == EWOULDBLOCK) {
    throw base::EnvironmentError(
        fmt::format("{}: another process is filling it; wait for it, or give another --out", database.string()));
  }
  base::throw_system_error(name, "cannot be locked", error);
}

WriterLock::~WriterLock() {
  ::close(file_);  // the file stays: removing it would let two processes lock two files of one name
}

SweepDatabase::SweepDatabase(const fs::path& file, const Sweep& sweep, const std::string& version, const Shard& shard,
                             WhyWords why_words)
    : lock_(file),
      database_(file, Database::Mode::create),
      entries_(entries_of(sweep, version)),
      sweep_(sweep),
      why_words_(why_words) {
  SqlStatement any = database_.prepare("SELECT count(*) FROM sqlite_master");
  any.step();
  const bool empty = any.integer(0) == 0;
  any.reset();
  entries_.emplace_back("shard", fmt::format("{}/{}", shard.index, shard.count));
  if (empty) {
    database_.run("PRAGMA journal_mode = WAL");
    Transaction transaction(database_);
    make_tables(database_, sweep);
    SqlStatement entry = database_.prepare("INSERT INTO sweep VALUES (?1, ?2)");
    for (const auto& [key, value] : entries_) entry.bind(1, key).bind(2, value).run();
    transaction.commit();
  } else {
    check_database(database_, sweep, entries_);
  }
  database_.run("PRAGMA synchronous = NORMAL");  // a killed process loses nothing; a power cut at most the last runs
  std::string marks;
  for (std::size_t i = 0; i < sweep_.axes.size(); ++i) marks += fmt::format(", ?{}", 7 + i);
  add_run_ = database_.prepare(fmt::format("INSERT INTO run VALUES (?1, ?2, ?3, ?4, ?5, ?6{})", marks));
  add_result_ = database_.prepare("INSERT INTO result VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12)");
  add_clip_ = database_.prepare("INSERT INTO clip VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10)");
  add_timing_ = database_.prepare("INSERT INTO timing VALUES (?1, ?2)");
}

std::vector<std::uint64_t> SweepDatabase::runs_within(std::uint64_t from, std::uint64_t to) {
  std::vector<std::uint64_t> runs;
  SqlStatement select = database_.prepare("SELECT run FROM run WHERE run >= ?1 AND run < ?2 ORDER BY run");
  select.bind(1, static_cast<std::int64_t>(from)).bind(2, static_cast<std::int64_t>(to));
  while (select.step()) runs.push_back(static_cast<std::uint64_t>(select.integer(0)));
  return runs;
}

std::uint64_t SweepDatabase::runs() {
  SqlStatement select = database_.prepare("SELECT count(*) FROM run");
  select.step();
  return static_cast<std::uint64_t>(select.integer(0));
}

void SweepDatabase::add(const RunRecord& record, double wall_s) {
  Transaction transaction(database_);
  const auto run = static_cast<std::int64_t>(record.run);
  add_run_->bind(1, run).bind(2, static_cast<std::int64_t>(record.point));
  add_run_->bind(3, static_cast<std::int64_t>(record.replicate)).bind(4, static_cast<std::int64_t>(record.seed));
  add_run_->bind(5, record.failed ? "failed" : "done");
  if (record.failed) add_run_->bind(6, std::string_view(record.why));
  for (std::size_t i = 0; i < record.values.size(); ++i) {
    const int parameter = 7 + static_cast<int>(i);
    const base::TomlScalar& value = record.values[i];
    if (const auto* number = std::get_if<double>(&value)) {
      add_run_->bind(parameter, *number);
    } else if (const auto* flag = std::get_if<bool>(&value)) {
      add_run_->bind(parameter, std::int64_t{*flag ? 1 : 0});
    } else {
      add_run_->bind(parameter, std::string_view(std::get<std::string>(value)));
    }
  }
  add_run_->run();
  for (const QuantityRow& row : record.quantities) {
    add_result_->bind(1, run).bind(2, std::string_view(row.configuration)).bind(3, std::string_view(row.estimator));
    add_result_->bind(4, std::string_view(row.quantity)).bind(5, row.truth).bind(6, row.value).bind(7, row.sd);
    add_result_->bind(8, row.low95).bind(9, row.high95).bind(10, row.least_sd);
    const std::string why = why_words_(row.why);
    if (!why.empty()) add_result_->bind(11, std::string_view(why));
    add_result_->bind(12, row.uncorrected);
    add_result_->run();
  }
  for (const ClipRow& row : record.clips) {
    add_clip_->bind(1, run).bind(2, std::string_view(row.clip)).bind(3, std::string_view(row.estimator));
    add_clip_->bind(4, static_cast<std::int64_t>(row.frames)).bind(5, static_cast<std::int64_t>(row.detected));
    add_clip_->bind(6, row.bandwidth_s).bind(7, row.position_noise_m).bind(8, row.r2_up).bind(9, row.r2_down);
    add_clip_->bind(10, row.a_rms_error_m_s2);
    add_clip_->run();
  }
  add_timing_->bind(1, run).bind(2, wall_s).run();
  transaction.commit();
}

void SweepDatabase::merge_runs_of(const std::vector<fs::path>& others) {
  SweepEntries of_any_shard = entries_;
  of_any_shard.pop_back();  // the shard
  merge_runs(database_, sweep_, of_any_shard, others);
}

double bytes_of(const RunRecord& record) {
  constexpr std::size_t kRow = 12, kNumber = 9;  // record header and key; an 8-byte real with its type
  constexpr std::size_t kReason = 100;           // text of a usual reason for a missing value
  std::size_t bytes = 2 * kRow + 6 * kNumber + record.why.size();
  for (const base::TomlScalar& value : record.values) {
    const auto* text = std::get_if<std::string>(&value);
    bytes += text == nullptr ? kNumber : text->size() + 1;
  }
  for (const QuantityRow& row : record.quantities) {
    bytes += kRow + 6 * kNumber + row.configuration.size() + row.estimator.size() + row.quantity.size() +
             (row.why ? kReason : 0);
  }
  for (const ClipRow& row : record.clips) bytes += kRow + 5 * kNumber + row.clip.size() + row.estimator.size();
  constexpr double kPacking = 1.25;  // pages of a tree that grows at its end are not full
  return kPacking * static_cast<double>(bytes);
}

}  // namespace glidelab::validate
