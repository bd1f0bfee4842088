/// The file that a sweep fills, sweep.sqlite: its tables, its rows, and the merging of several files.
///
///     sweep   key, value                what was swept: the sweep's and the scenario's text, the program's version
///     schema  table, column, unit, meaning
///     run     run, point, replicate, seed, status, why, and a column for each varied key
///     result  run, configuration, estimator, quantity, truth, value, sd, low95, high95, least_sd, why, uncorrected
///     clip    run, clip, estimator, frames, detected, bandwidth_s, position_noise_m, r2_up, r2_down,
///             a_rms_error_m_s2
///     timing  run, wall_s
///
/// All rows of a run are written in one transaction (WAL), so a run is present whole or not at all. Except for `timing`
/// the contents depend only on the sweep and the program.
///
/// A file belongs to a sweep if each entry of its table `sweep` is the sweep's: texts, seed, number of runs and the
/// program's version. A row belongs to it if its run has that number and that seed in the sweep's design. A file that
/// was damaged or changed is refused when it is opened (sweep_tables.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/result/why_unknown.h"
#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/one_run.h"
#include "validate/study/sweep/sqlite.h"

namespace glidelab::validate {

/// Name and value of each entry of the table `sweep`.
using SweepEntries = std::vector<std::pair<std::string, std::string>>;

/// The entries that describe a sweep in its file, independent of the runs that the file is for.
SweepEntries entries_of(const Sweep& sweep, const std::string& version);

/// InputError if the file is not an undamaged database of this sweep with these entries (sweep_tables.h), or if a row
/// belongs to no run of the sweep or to a run that has another seed there. It says where and what differs.
void check_database(Database& database, const Sweep& sweep, const SweepEntries& expected);

/// Merges all runs of the other files, which several processes (the jobs of a Slurm array) may have made, into a
/// database of the sweep. `expected`: the entries that each of them must have. InputError for a file that does not
/// exist, is damaged, belongs to another sweep, has rows of a run that is not in the sweep with its seed, or has
/// different rows for a run than another file, which is named.
///
/// All runs of all files are merged, or none: one transaction. A run in several files counts once if all its rows
/// except its time are the same to the last bit. Differences are refused, so that the result does not depend on the
/// order of the files.
void merge_runs(Database& into, const Sweep& sweep, const SweepEntries& expected,
                const std::vector<std::filesystem::path>& others);

/// Part `index` (from 1) of `count`: the runs r with r mod count = index - 1.
struct Shard {
  std::uint64_t index = 1, count = 1;
  bool has(std::uint64_t run) const { return run % count == index - 1; }
};

/// The lock held while a process writes a database: flock(2) on "<file>-lock" beside it, released when the process
/// ends, however it ends. EnvironmentError if another process holds it, or if the lock file cannot be made.
class WriterLock {
 public:
  explicit WriterLock(const std::filesystem::path& database);
  ~WriterLock();
  WriterLock(const WriterLock&) = delete;
  WriterLock& operator=(const WriterLock&) = delete;

 private:
  int file_ = -1;
};

/// Puts into words why a quantity has no value, for the column `why`: report/text/why_words.h, which this room may not
/// include.
using WhyWords = std::string (*)(const std::optional<core::WhyUnknown>& why);

class SweepDatabase {
 public:
  /// Makes the file, or opens one of the same sweep, version and shard. InputError, which says what differs, for any
  /// other file or a damaged one; EnvironmentError if another process writes it.
  SweepDatabase(const std::filesystem::path& file, const Sweep& sweep, const std::string& version, const Shard& shard,
                WhyWords why_words);

  /// Runs of [from, to) that are present, in order.
  std::vector<std::uint64_t> runs_within(std::uint64_t from, std::uint64_t to);
  /// The number of runs present.
  std::uint64_t runs();
  /// Adds all rows of a run that is not yet present, in one transaction.
  void add(const RunRecord& record, double wall_s);

  /// merge_runs() of other databases of the same sweep and version (any shard).
  void merge_runs_of(const std::vector<std::filesystem::path>& others);

  Database& database() { return database_; }

 private:
  WriterLock lock_;
  Database database_;
  SweepEntries entries_;  ///< the shard is the last entry
  Sweep sweep_;
  WhyWords why_words_;
  std::optional<SqlStatement> add_run_, add_result_, add_clip_, add_timing_;
};

/// Approximate size of the rows of a run, in bytes: for the estimate before a sweep.
double bytes_of(const RunRecord& record);

}  // namespace glidelab::validate
