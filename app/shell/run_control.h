/// Control of a running command: signals that interrupt it, and its progress on standard error.
#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "base/errors.h"
#include "base/long_work.h"

namespace glidelab::app {

inline constexpr int kInterruptedStatus = 130;  ///< as a shell reports SIGINT

/// From now on SIGINT, SIGTERM and SIGHUP set a flag; the work checks it, ends by itself and cleans up. Work that has
/// not ended after 0.8 s is ended (kInterruptedStatus; unfinished output is removed), unless it keeps what it has
/// finished or is putting its results in place. Such work is ended by a second signal, two seconds later or more.
/// Writing beyond a size limit or to a closed pipe becomes an error that the write reports and no longer ends the
/// process.
void catch_interrupts();

/// From now on, if memory runs out where no exception may pass (in a function of a library that promises to throw
/// none), the process ends as it does elsewhere without memory: with `status`, one message, and no unfinished output.
void report_lost_memory(int status);

bool interrupted();

/// An interrupt of work that keeps its finished part; what() describes that part.
class InterruptedKeeping : public base::Interrupted {
 public:
  explicit InterruptedKeeping(std::string kept) : kept_("interrupted; " + std::move(kept)) {}
  const char* what() const noexcept override { return kept_.c_str(); }

 private:
  std::string kept_;
};

/// Throws base::Interrupted if the flag is set.
void throw_if_interrupted();

/// Runs `work`, which keeps its finished part: InterruptedKeeping if an interrupt ends it, with the text of `kept`.
void keep_on_interrupt(const std::function<void()>& work, const std::function<std::string()>& kept);

/// Progress on standard error: a bar on a terminal, an occasional line elsewhere, nothing with --quiet; with --verbose
/// also how long each stage took, on a line of its own.
///
/// An interrupt also ends the work here: every call checks the flag first.
class ProgressDisplay {
 public:
  explicit ProgressDisplay(bool quiet, bool verbose = false);
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// The function to pass to the work; refers to this object.
  base::Progress callback();

  /// Sets the number of pieces of this stage, so that the rate per second can be shown.
  void count(std::string stage, std::uint64_t pieces);

  /// Removes the bar, so that something else can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  void update(std::string_view stage, double fraction);
  void draw_bar(Clock::time_point now);
  void print_line(Clock::time_point now);
  void end_stage(Clock::time_point now);
  void erase_bar();
  /// The number of pieces of the stage done per second, in words; empty if it has none.
  std::string rate(double elapsed_s) const;

  bool quiet_;
  bool verbose_;
  bool terminal_;
  std::mutex mutex_;
  std::string stage_;
  std::string counted_stage_;
  double pieces_ = 0.0;
  double fraction_ = 0.0;
  int tenths_printed_ = -1;
  bool bar_shown_ = false;
  Clock::time_point stage_start_;
  std::clock_t stage_clock_ = 0;  ///< processor time of all threads when the stage began
  Clock::time_point last_shown_;
};

}  // namespace glidelab::app
