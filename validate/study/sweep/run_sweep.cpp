#include "validate/study/sweep/run_sweep.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>
#include <vector>

#include "base/errors.h"
#include "base/long_work.h"
#include "validate/study/sweep/design/sweep.h"

namespace glidelab::validate {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Hands out the missing runs in order, querying the database piece by piece for the runs that it has. One caller at a
/// time.
class MissingRuns {
 public:
  MissingRuns(SweepDatabase& database, const Shard& shard, std::uint64_t runs)
      : database_(database), shard_(shard), runs_(runs) {}

  std::optional<std::uint64_t> next() {
    while (true) {
      if (at_ >= end_ && !next_piece()) return std::nullopt;
      const std::uint64_t run = at_;
      at_ += shard_.count;
      if (!std::binary_search(there_.begin(), there_.end(), run)) return run;
    }
  }

 private:
  bool next_piece() {
    constexpr std::uint64_t kPiece = 4096;  // runs of the shard
    if (at_ == 0) at_ = shard_.index - 1;
    if (at_ >= runs_) return false;
    end_ = std::min(runs_, at_ + kPiece * shard_.count);
    there_ = database_.runs_within(at_, end_);
    return true;
  }

  SweepDatabase& database_;
  Shard shard_;
  std::uint64_t runs_;
  std::uint64_t at_ = 0, end_ = 0;
  std::vector<std::uint64_t> there_;
};

}  // namespace

std::uint64_t run_count(const Sweep& sweep, const Shard& shard) {
  const std::uint64_t all = run_count(sweep);
  return all < shard.index ? 0 : (all - shard.index) / shard.count + 1;
}

RunCost cost_of_runs(const Sweep& sweep, const Shard& shard, std::uint64_t runs, int jobs,
                     const base::Progress& progress) {
  const std::uint64_t there = run_count(sweep, shard);
  const std::uint64_t samples = std::min<std::uint64_t>(there, runs >= 100 ? 5 : runs >= 30 ? 3 : 1);
  std::vector<RunCost> costs(samples);
  base::for_each_parallel(samples, jobs, [&](std::size_t i) {
    const Clock::time_point start = Clock::now();
    // The middle of the i-th of equal parts; runs are at most 2^53, and 2 samples + 1 at most 11.
    const std::uint64_t of_shard = there * (2 * i + 1) / (2 * samples);
    const RunRecord record = RunWorker(sweep, progress).evaluate(shard.index - 1 + shard.count * of_shard);
    costs[i] = {seconds_since(start), bytes_of(record)};
  });
  RunCost mean;
  for (const RunCost& cost : costs) {
    mean.seconds += cost.seconds / static_cast<double>(samples);
    mean.bytes += cost.bytes / static_cast<double>(samples);
  }
  return mean;
}

SweepEstimate estimate_sweep(const Sweep& sweep, SweepDatabase& database, const Shard& shard, int jobs,
                             const std::filesystem::path& disk, const base::Progress& progress) {
  SweepEstimate estimate;
  estimate.runs = run_count(sweep, shard);
  estimate.missing = estimate.runs - std::min(estimate.runs, database.runs());
  estimate.free_bytes = static_cast<double>(std::filesystem::space(disk).available);
  if (estimate.missing == 0) return estimate;
  const RunCost cost = cost_of_runs(sweep, shard, estimate.missing, jobs, progress);
  estimate.seconds = cost.seconds * static_cast<double>(estimate.missing) / std::max(1, jobs);
  estimate.bytes = cost.bytes * static_cast<double>(estimate.runs);
  estimate.bytes_to_come = cost.bytes * static_cast<double>(estimate.missing);
  return estimate;
}

SweepOutcome run_sweep(const Sweep& sweep, SweepDatabase& database, const Shard& shard, int jobs,
                       const base::Progress& progress) {
  const Clock::time_point start = Clock::now();
  const std::uint64_t missing = run_count(sweep, shard) - std::min(run_count(sweep, shard), database.runs());
  MissingRuns runs(database, shard, run_count(sweep));
  SweepOutcome outcome;
  std::mutex mutex;  // of the database, the list of runs and the outcome
  std::atomic<double> fraction_done = 0.0;
  progress("runs", 0.0);
  base::for_each_parallel(static_cast<std::size_t>(std::max(1, jobs)), jobs, [&](std::size_t) {
    // A recording takes long enough that the user may want to stop during it.
    RunWorker worker(sweep, [&](std::string_view, double) { progress("runs", fraction_done); });
    while (true) {
      std::optional<std::uint64_t> run;
      {
        const std::lock_guard lock(mutex);
        run = runs.next();
      }
      if (!run) return;
      const Clock::time_point began = Clock::now();
      const RunRecord record = worker.evaluate(*run);
      const double wall_s = seconds_since(began);
      double fraction = 0.0;
      {
        const std::lock_guard lock(mutex);
        database.add(record, wall_s);
        ++outcome.done;
        fraction_done = fraction =
            static_cast<double>(outcome.done) / static_cast<double>(std::max<std::uint64_t>(1, missing));
      }
      progress("runs", fraction);
    }
  });
  SqlStatement failed = database.database().prepare("SELECT count(*) FROM run WHERE status = 'failed'");
  failed.step();
  outcome.failed = static_cast<std::uint64_t>(failed.integer(0));
  outcome.wall_s = seconds_since(start);
  return outcome;
}

}  // namespace glidelab::validate
