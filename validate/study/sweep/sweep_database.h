/// The file that a sweep fills: sweep.sqlite.
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
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/sqlite.h"
#include "validate/study/sweep/sweep_run.h"
#include "validate/study/sweep/sweep_tables.h"

namespace glidelab::validate {

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
  /// another one's; EnvironmentError if another process writes it.
  SweepDatabase(const std::filesystem::path& file, const Sweep& sweep, const std::string& version, const Shard& shard);

  /// Runs of [from, to) that are there, in order.
  std::vector<std::uint64_t> runs_within(std::uint64_t from, std::uint64_t to);
  /// How many are there.
  std::uint64_t runs();
  /// All rows of a run that is not there yet, in one transaction.
  void add(const RunRecord& record, double wall_s);

  /// take_over() of sweep_merge.h, of other databases of the same sweep and version (any shard).
  void take(const std::vector<std::filesystem::path>& others);

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
