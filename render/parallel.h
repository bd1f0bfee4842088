/// Tasks on a few threads, with errors that come out where they were started.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace glidelab::render {

/// Runs `worker(next)` on up to `jobs` threads; each worker calls next() for the number of its next task until that
/// says `count` or more. The first exception stops the others at their next task and is thrown again here.
template <typename Worker>
void in_parallel(int jobs, std::size_t count, const Worker& worker) {
  std::atomic<std::size_t> taken{0};
  std::atomic<bool> failed{false};
  std::exception_ptr error;
  std::mutex error_mutex;
  const auto next = [&] { return failed.load() ? count : taken.fetch_add(1); };
  const auto run = [&] {
    try {
      worker(next);
    } catch (...) {
      const std::lock_guard lock(error_mutex);
      if (!error) error = std::current_exception();
      failed = true;
    }
  };
  const std::size_t threads = std::min(static_cast<std::size_t>(jobs < 1 ? 1 : jobs), count);
  {
    std::vector<std::jthread> others;
    for (std::size_t i = 1; i < threads; ++i) others.emplace_back(run);
    if (count > 0) run();
  }
  if (error) std::rethrow_exception(error);
}

}  // namespace glidelab::render
