/// The file that a sweep fills, sweep.sqlite: its tables, its rows, and several files put together.
///
///     sweep   key, value                what was swept: the sweep's and the scenario's text, the program's version
///     schema  table, column, unit, meaning
///     run     run, point, replicate, seed, status, why, and a column for each varied key
///     result  run, configuration, estimator, quantity, truth, value, sd, low95, high95, least_sd, why, uncorrected
///     clip    run, clip, estimator, frames, detected, bandwidth_s, position_noise_m, r2_up, r2_down,
///             a_rms_error_m_s2
///     timing  run, wall_s
///
/// All rows of a run are written in one transaction (WAL), so a run is there whole or not at all. But for `timing` the
/// contents are a function of the sweep and the program alone.
///
/// A file is one of a sweep where each entry of its table `sweep` is the sweep's: texts, seed, number of runs and the
/// program's version. A row is one where its run has that number and that seed in the sweep's design. A file that was
/// damaged or changed is refused when it is opened (sweep_tables.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/sqlite.h"
#include "validate/study/sweep/sweep_run.h"

namespace glidelab::validate {

/// Name and value of each entry of the table `sweep`.
using SweepEntries = std::vector<std::pair<std::string, std::string>>;

/// What a sweep's file says of it, whichever of its runs the file is for.
SweepEntries entries_of(const Sweep& sweep, const std::string& version);

/// InputError if the file is no undamaged database of this sweep with these entries (sweep_tables.h), or if a row is of
/// no run of the sweep or of one that has another seed there. It says where and what differs.
void check_database(Database& database, const Sweep& sweep, const SweepEntries& expected);

/// Merges all runs of the other files, which several processes (the jobs of a Slurm array) may have made, into a
/// database of the sweep. `expected`: the entries that each of them must have. InputError for a file that is not there,
/// is damaged, is another sweep's, has rows of a run that the sweep has not or that is not in it with its seed, or has
/// other rows of a run than another file, which is named.
///
/// All runs of all files are taken, or none: one transaction. A run that several files have counts once where all its
/// rows but its time are the same to the last bit. What differs is refused, so that the result does not depend on the
/// files' order.
void merge_runs(Database& into, const Sweep& sweep, const SweepEntries& expected,
                const std::vector<std::filesystem::path>& others);

/// Part `index` (from 1) of `count`: the runs r with r mod count = index - 1.
struct Shard {
  std::uint64_t index = 1, count = 1;
  bool has(std::uint64_t run) const { return run % count == index - 1; }
};

/// What is held for as long as a process writes a database: flock(2) on "<file>-lock" beside it, let go when the
/// process ends, however it ends. EnvironmentError if another one does, or where the lock's file cannot be made.
class WriterLock {
 public:
  explicit WriterLock(const std::filesystem::path& database);
  ~WriterLock();
  WriterLock(const WriterLock&) = delete;
  WriterLock& operator=(const WriterLock&) = delete;

 private:
  int file_ = -1;
};

class SweepDatabase {
 public:
  /// Makes the file, or opens one of the same sweep, version and shard. InputError, which says what differs, for
  /// another one's or a damaged one; EnvironmentError if another process writes it.
  SweepDatabase(const std::filesystem::path& file, const Sweep& sweep, const std::string& version, const Shard& shard);

  /// Runs of [from, to) that are there, in order.
  std::vector<std::uint64_t> runs_within(std::uint64_t from, std::uint64_t to);
  /// How many are there.
  std::uint64_t runs();
  /// All rows of a run that is not there yet, in one transaction.
  void add(const RunRecord& record, double wall_s);

  /// merge_runs() of other databases of the same sweep and version (any shard).
  void merge_runs_of(const std::vector<std::filesystem::path>& others);

  Database& database() { return database_; }

 private:
  WriterLock lock_;
  Database database_;
  SweepEntries entries_;  ///< the shard is the last
  Sweep sweep_;
  std::optional<SqlStatement> add_run_, add_result_, add_clip_, add_timing_;
};

/// Bytes that the rows of a run take, roughly: for the estimate before a sweep.
double bytes_of(const RunRecord& record);

}  // namespace glidelab::validate
