#include "app/shell/run_control.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <semaphore.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <thread>
#include <utility>

#include "base/errors.h"
#include "base/files/temporary_folders.h"

namespace glidelab::app {
namespace {

std::atomic<bool> flag = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

std::atomic<std::int64_t> first_s = 0;
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "likewise");
constexpr std::int64_t kLeastBetweenSignals_s = 2;  // a sender to both the process and its group sends two at once

sem_t asked;                                      // posted by the first signal
std::atomic<int> keeping = 0;                     // scopes of keep_on_interrupt()
constexpr timespec kGracePeriod{0, 800'000'000};  // for work to see the flag and end by itself

std::int64_t now_s() {
  timespec now = {};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec;
}

/// The first signal asks for a clean end; if that takes long, inside a library's loop, a later one ends the process at
/// once.
void set_flag(int signal) {
  if (!flag.exchange(true)) {
    first_s = now_s();
    ::sem_post(&asked);
  } else if (now_s() - first_s >= kLeastBetweenSignals_s) {
    ::_exit(128 + signal);
  }
}

/// Waits for the first signal, and ends a process that is still at work some time later: a library's loop does not
/// check the flag. Nothing has been put in place by then, and unfinished output is removed.
void end_what_does_not_end() {
  while (::sem_wait(&asked) != 0) {
  }
  timespec left = kGracePeriod;
  while (::nanosleep(&left, &left) != 0) {
  }
  if (keeping > 0 || !base::discard_temporary_folders()) return;  // ends after the current piece, or is about to end
  const char* const over_the_bar = ::isatty(STDERR_FILENO) == 1 ? "\r\033[K" : "";
  tell(fmt::format("{}glidelab: error: interrupted; nothing was written\n", over_the_bar));
  ::_exit(kInterruptedStatus);
}

}  // namespace

void catch_interrupts() {
  ::sem_init(&asked, 0, 0);
  std::thread(end_what_does_not_end).detach();
  struct sigaction action = {};
  action.sa_handler = set_flag;
  ::sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  struct sigaction present = {};
  ::sigaction(SIGHUP, nullptr, &present);
  if (present.sa_handler != SIG_IGN) ::sigaction(SIGHUP, &action, nullptr);  // started by nohup: continues
  action.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &action, nullptr);
  ::sigaction(SIGXFSZ, &action, nullptr);
}

namespace {

std::terminate_handler usual_end = nullptr;
int lost_memory_status = 0;

[[noreturn]] void end_with(const char* message) {
  base::discard_temporary_folders();
  std::fputs(message, stderr);
  ::_exit(lost_memory_status);
}

/// As the standard library ends a program that cannot go on, but for memory that is lost. Where g++ has put the end
/// into the function that promised to throw nothing, the exception is not caught and its type is not known.
[[noreturn]] void end_what_cannot_go_on() {
  static std::atomic_flag begun = ATOMIC_FLAG_INIT;  // an exception from here leads back here
  if (!begun.test_and_set()) {
    try {
      if (std::current_exception() != nullptr) throw;
      if (std::uncaught_exceptions() > 0) {
        end_with("glidelab: error: a library failed where it must not, most likely out of memory\n");
      }
    } catch (const std::bad_alloc&) {
      end_with("glidelab: error: out of memory\n");
    } catch (...) {
    }
  }
  usual_end();
  std::abort();
}

}  // namespace

void report_lost_memory(int status) {
  lost_memory_status = status;
  const std::terminate_handler before = std::set_terminate(end_what_cannot_go_on);
  if (before != end_what_cannot_go_on) usual_end = before;
}

void hold_standard_streams() {
  // The lowest free number is given: each stream that is closed takes its own.
  for (const auto& [stream, other_way] :
       {std::pair{STDIN_FILENO, O_WRONLY}, {STDOUT_FILENO, O_RDONLY}, {STDERR_FILENO, O_RDONLY}}) {
    if (::fcntl(stream, F_GETFD) == -1 && ::open("/dev/null", other_way) != stream) return;
  }
}

void tell(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

void end_without_reader() {
  base::discard_temporary_folders();
  ::signal(SIGPIPE, SIG_DFL);
  ::raise(SIGPIPE);
  ::_exit(128 + SIGPIPE);  // if the signal is blocked
}

bool interrupted() {
  return flag;
}

void throw_if_interrupted() {
  if (flag) throw base::Interrupted();
}

namespace {

struct Keeping {
  Keeping() { ++keeping; }
  ~Keeping() { --keeping; }
  Keeping(const Keeping&) = delete;
  Keeping& operator=(const Keeping&) = delete;
};

}  // namespace

void keep_on_interrupt(const std::function<void()>& work, const std::function<std::string()>& kept) {
  const Keeping scope;
  try {
    work();
  } catch (const std::exception&) {
    if (!interrupted()) throw;  // an error caused by the interrupt is not the one to report
    throw InterruptedKeeping(kept());
  }
}

namespace {

using namespace std::chrono_literals;

constexpr auto kBarInterval = 100ms;
constexpr auto kLineInterval = 1s;
constexpr double kEnoughToGuess = 0.02;  // of a stage: before that, the remaining time is a wild guess

/// ", 1:05 left", or nothing if there is too little to go by.
std::string time_left(double elapsed_s, double fraction) {
  if (fraction < kEnoughToGuess || elapsed_s < 0.5) return {};
  const long seconds = std::lround(elapsed_s * (1.0 - fraction) / fraction);
  return fmt::format(", {}:{:02} left", seconds / 60, seconds % 60);
}

int columns() {
  winsize size = {};
  if (::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0) return size.ws_col;
  return 80;
}

}  // namespace

ProgressDisplay::ProgressDisplay(bool quiet, bool verbose)
    : quiet_(quiet), verbose_(verbose), terminal_(::isatty(STDERR_FILENO) == 1) {}

ProgressDisplay::~ProgressDisplay() {
  clear();
}

base::Progress ProgressDisplay::callback() {
  return [this](std::string_view stage, double fraction) { update(stage, fraction); };
}

void ProgressDisplay::count(std::string stage, std::uint64_t pieces) {
  const std::lock_guard lock(mutex_);
  counted_stage_ = std::move(stage);
  pieces_ = static_cast<double>(pieces);
}

/// ", 25 runs/s"; slow ones by the minute or the hour.
std::string ProgressDisplay::rate(double elapsed_s) const {
  if (stage_ != counted_stage_ || elapsed_s <= 0.0 || fraction_ <= 0.0) return {};
  const double each_s = fraction_ * pieces_ / elapsed_s;
  if (each_s >= 1.0) return fmt::format(", {:.3g} {}/s", each_s, stage_);
  if (each_s * 60.0 >= 1.0) return fmt::format(", {:.3g} {}/min", each_s * 60.0, stage_);
  return fmt::format(", {:.3g} {}/h", each_s * 3600.0, stage_);
}

void ProgressDisplay::clear() {
  const std::lock_guard lock(mutex_);
  end_stage(Clock::now());
  erase_bar();
}

void ProgressDisplay::erase_bar() {
  if (!bar_shown_) return;
  tell(fmt::format("\r{:{}}\r", "", columns() - 1));
  bar_shown_ = false;
}

void ProgressDisplay::end_stage(Clock::time_point now) {
  if (!verbose_ || stage_.empty()) return;
  erase_bar();
  const double processor_s = static_cast<double>(std::clock() - stage_clock_) / CLOCKS_PER_SEC;
  tell(fmt::format("{}: took {:.2f} s, {:.3f} s of processor time\n", stage_,
                   std::chrono::duration<double>(now - stage_start_).count(), processor_s));
  stage_.clear();
}

void ProgressDisplay::update(std::string_view stage, double fraction) {
  throw_if_interrupted();
  if (quiet_) return;
  const std::lock_guard lock(mutex_);
  const Clock::time_point now = Clock::now();
  if (stage != stage_) {
    end_stage(now);
    stage_ = stage;
    fraction_ = 0.0;
    tenths_printed_ = -1;
    stage_start_ = now;
    stage_clock_ = std::clock();
    last_shown_ = {};
  }
  // Threads report in any order; progress never goes back.
  fraction_ = std::max(fraction_, std::isfinite(fraction) ? std::min(fraction, 1.0) : 0.0);
  if (terminal_) {
    draw_bar(now);
  } else {
    print_line(now);
  }
}

void ProgressDisplay::draw_bar(Clock::time_point now) {
  if (now - last_shown_ < kBarInterval && fraction_ < 1.0) return;
  last_shown_ = now;
  const double elapsed_s = std::chrono::duration<double>(now - stage_start_).count();
  constexpr int kWidth = 30;
  const int full = static_cast<int>(std::lround(fraction_ * kWidth));
  std::string line = fmt::format("{} [{}{}] {:3.0f} %{}{}", stage_, std::string(static_cast<std::size_t>(full), '#'),
                                 std::string(static_cast<std::size_t>(kWidth - full), '.'), 100.0 * fraction_,
                                 time_left(elapsed_s, fraction_), rate(elapsed_s));
  const auto room = static_cast<std::size_t>(std::max(columns() - 1, 10));
  line.resize(room, ' ');  // covers the previous text; cut if the terminal is narrow
  tell(fmt::format("\r{}", line));
  bar_shown_ = true;
}

void ProgressDisplay::print_line(Clock::time_point now) {
  const int tenths = static_cast<int>(std::floor(fraction_ * 10.0 + 1e-9));
  if (tenths <= tenths_printed_ || (now - last_shown_ < kLineInterval && fraction_ < 1.0)) return;
  last_shown_ = now;
  tenths_printed_ = tenths;
  const double elapsed_s = std::chrono::duration<double>(now - stage_start_).count();
  tell(fmt::format("{}: {} %{}{}\n", stage_, 10 * tenths, tenths < 10 ? time_left(elapsed_s, fraction_) : "",
                   rate(elapsed_s)));
}

}  // namespace glidelab::app
