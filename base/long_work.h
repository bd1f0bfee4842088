/// Long work: how it reports its progress, how it is stopped, and how it is shared out among threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <future>
#include <string_view>
#include <vector>

namespace glidelab::base {

/// Called with the current stage and the fraction done (0 to 1). May be called from several threads at once. May throw
/// Interrupted, which ends the work and cleans up.
using Progress = std::function<void(std::string_view stage, double fraction)>;

/// Reports nothing and never stops.
inline void no_progress(std::string_view, double) {}

/// Called again and again by work that has no progress to report. May throw Interrupted, which ends the work.
using StopCheck = std::function<void()>;

inline void never_stop() {}

/// Sets a flag if its scope is left by an exception.
class FlagOnThrow {
 public:
  explicit FlagOnThrow(std::atomic<bool>& flag) : flag_(flag) {}
  FlagOnThrow(const FlagOnThrow&) = delete;
  FlagOnThrow& operator=(const FlagOnThrow&) = delete;
  ~FlagOnThrow() {
    if (std::uncaught_exceptions() > before_) flag_ = true;
  }

 private:
  std::atomic<bool>& flag_;
  int before_ = std::uncaught_exceptions();
};

/// Runs `worker(next)` on up to `jobs` threads, this one among them; each worker calls next() for the number of its
/// next piece until it returns `count`. Errors are thrown where the work was started: of the pieces that failed, the
/// exception of the one with the smallest number is rethrown. Once one has failed, no new piece is begun.
template <typename Worker>
void in_parallel(int jobs, std::size_t count, const Worker& worker) {
  const std::size_t threads = std::min(count, static_cast<std::size_t>(std::max(jobs, 1)));
  if (threads == 0) return;
  std::atomic<std::size_t> taken{0};
  std::atomic<bool> failed{false};
  std::vector<std::size_t> at(threads, count);  // the piece on which each thread works
  const auto run = [&](std::size_t thread) {
    const FlagOnThrow flag(failed);
    worker([&] { return at[thread] = failed ? count : std::min(count, taken.fetch_add(1)); });
  };
  std::packaged_task<void()> own([&] { run(0); });
  std::vector<std::future<void>> results;
  results.push_back(own.get_future());
  for (std::size_t thread = 1; thread < threads; ++thread) {
    results.push_back(std::async(std::launch::async, run, thread));
  }
  own();
  for (const std::future<void>& result : results) result.wait();
  results[static_cast<std::size_t>(std::min_element(at.begin(), at.end()) - at.begin())].get();
  for (std::future<void>& result : results) {
    if (result.valid()) result.get();
  }
}

/// Calls work(0) … work(count - 1), at most `jobs` at a time.
template <typename Work>
void for_each_parallel(std::size_t count, int jobs, const Work& work) {
  in_parallel(jobs, count, [&](const auto& next) {
    for (std::size_t i = next(); i < count; i = next()) work(i);
  });
}

}  // namespace glidelab::base
