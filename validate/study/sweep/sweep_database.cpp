#include "validate/study/sweep/sweep_database.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

#include "base/errors.h"
#include "validate/study/sweep/sweep_merge.h"

namespace glidelab::validate {

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
  ::close(file_);  // the file stays: to remove it would let two processes lock two files of one name
}

SweepDatabase::SweepDatabase(const fs::path& file, const Sweep& sweep, const std::string& version, const Shard& shard)
    : lock_(file), database_(file, Database::Mode::create), entries_(entries_of(sweep, version)), sweep_(sweep) {
  SqlStatement any = database_.prepare("SELECT count(*) FROM sqlite_master");
  any.step();
  const bool empty = any.integer(0) == 0;
  any.reset();
  entries_.emplace_back("shard", fmt::format("{}/{}", shard.index, shard.count));
  if (empty) {
    database_.run("PRAGMA journal_mode = WAL");
    Transaction transaction(database_);
    make_tables(database_, sweep, entries_);
    transaction.commit();
  } else {
    check_entries(database_, entries_);
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
    if (!row.why.empty()) add_result_->bind(11, std::string_view(row.why));
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

void SweepDatabase::take(const std::vector<fs::path>& others) {
  SweepEntries of_any_shard = entries_;
  of_any_shard.pop_back();  // the shard
  take_over(database_, sweep_, of_any_shard, others);
}

double bytes_of(const RunRecord& record) {
  constexpr std::size_t kRow = 12, kNumber = 9;  // record header and key; an 8-byte real with its type
  std::size_t bytes = 2 * kRow + 6 * kNumber + record.why.size();
  for (const base::TomlScalar& value : record.values) {
    const auto* text = std::get_if<std::string>(&value);
    bytes += text == nullptr ? kNumber : text->size() + 1;
  }
  for (const QuantityRow& row : record.quantities) {
    bytes +=
        kRow + 6 * kNumber + row.configuration.size() + row.estimator.size() + row.quantity.size() + row.why.size();
  }
  for (const ClipRow& row : record.clips) bytes += kRow + 5 * kNumber + row.clip.size() + row.estimator.size();
  constexpr double kPacking = 1.25;  // pages of a tree that grows at its end are not full
  return kPacking * static_cast<double>(bytes);
}

}  // namespace glidelab::validate
