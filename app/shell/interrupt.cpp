#include "app/shell/interrupt.h"

#include <signal.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <exception>

#include "base/errors.h"

namespace glidelab::app {
namespace {

std::atomic<bool> flag = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

std::atomic<std::int64_t> first_s = 0;
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "likewise");
constexpr std::int64_t kSeconds = 2;  // whoever sends one to the process and its group sends two at once

std::int64_t now_s() {
  timespec now = {};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec;
}

/// The first asks for a clean end; where that takes long, inside a library's loop, a later one ends at once.
void set_flag(int signal) {
  if (!flag.exchange(true)) {
    first_s = now_s();
  } else if (now_s() - first_s >= kSeconds) {
    ::_exit(128 + signal);
  }
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = set_flag;
  ::sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
  struct sigaction present = {};
  ::sigaction(SIGHUP, nullptr, &present);
  if (present.sa_handler != SIG_IGN) ::sigaction(SIGHUP, &action, nullptr);  // started by nohup: goes on
  action.sa_handler = SIG_IGN;
  ::sigaction(SIGPIPE, &action, nullptr);
  ::sigaction(SIGXFSZ, &action, nullptr);
}

bool interrupted() {
  return flag;
}

void throw_if_interrupted() {
  if (flag) throw base::Interrupted();
}

void keep_on_interrupt(const std::function<void()>& work, const std::function<std::string()>& kept) {
  try {
    work();
  } catch (const std::exception&) {
    if (!interrupted()) throw;  // what an interrupt tears down on its way is not the error to report
    throw InterruptedKeeping(kept());
  }
}

}  // namespace glidelab::app
