/// Makes the missing runs of a sweep, on several threads, and stores them in its database.
#pragma once

#include <cstdint>
#include <filesystem>

#include "base/long_work.h"
#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/sweep_database.h"

namespace glidelab::validate {

/// Time and size of a sweep, estimated from some of its runs that were measured and discarded.
struct SweepEstimate {
  std::uint64_t runs = 0;      ///< of the shard
  std::uint64_t missing = 0;   ///< of these, not yet in the database
  double seconds = 0.0;        ///< for the missing runs, on `jobs` threads
  double bytes = 0.0;          ///< of the database in the end
  double bytes_to_come = 0.0;  ///< of these, for the missing runs
  double free_bytes = 0.0;     ///< on its disk
};

/// The cost of a run, measured by running some: time of one thread, and its share of the database.
struct RunCost {
  double seconds = 0.0, bytes = 0.0;
};

/// Means over runs spread evenly over the shard's part of the design: 5 if `runs` is 100 or more, 3 from 30 on,
/// otherwise 1, because these runs are discarded.
RunCost cost_of_runs(const Sweep& sweep, const Shard& shard, std::uint64_t runs, int jobs,
                     const base::Progress& progress = base::no_progress);

/// The number of runs of the whole sweep or a part of it.
std::uint64_t run_count(const Sweep& sweep, const Shard& shard);

/// `disk`: a folder on the disk whose free space is determined.
SweepEstimate estimate_sweep(const Sweep& sweep, SweepDatabase& database, const Shard& shard, int jobs,
                             const std::filesystem::path& disk, const base::Progress& progress = base::no_progress);

struct SweepOutcome {
  std::uint64_t done = 0;    ///< runs made in this call
  std::uint64_t failed = 0;  ///< of all runs in the database
  double wall_s = 0.0;
};

/// Makes every run of the shard that the database does not have. Memory does not grow with their number. The progress
/// counts the runs missing at the start; an exception from it ends the work, and finished runs stay.
SweepOutcome run_sweep(const Sweep& sweep, SweepDatabase& database, const Shard& shard, int jobs,
                       const base::Progress& progress = base::no_progress);

}  // namespace glidelab::validate
