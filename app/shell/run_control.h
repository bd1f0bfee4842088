/// Control of a running command: signals that interrupt it, and its progress on standard error.
#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>
#include <exception>
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

/// Files that the command opens must not take the number of a standard stream that was closed (`2>&-`): what is meant
/// for the stream would be written into them. Closed streams are opened so that nothing can be written to them. To be
/// called before any file is opened.
void hold_standard_streams();

/// Writes to standard error. That it cannot be written (a pipe that nobody reads, a full disk) can be told to nobody
/// and ends no work.
void tell(std::string_view text);

/// Nobody reads standard output any more, as in `glidelab analyze … | head -1`.
class ReaderGone : public std::exception {
 public:
  const char* what() const noexcept override { return "standard output: nobody reads it"; }
};

/// Ends the process as other programs end there: by SIGPIPE, without a message. Results are in place by then.
[[noreturn]] void end_without_reader();

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
