/// Long work called from Python: it runs in its own thread, without the interpreter's lock, while the calling thread
/// forwards its progress and checks for Ctrl-C.
///
/// Only Python's main thread may run signal handlers, and only a thread with the lock may call the progress function.
/// Workers do neither: they leave their reports for the calling thread, and a flag tells them to stop.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/errors.h"
#include "base/long_work.h"

namespace glidelab::python {

class WatchedWork {
 public:
  /// `told` is None, or is called with a stage and the fraction done (0 to 1).
  explicit WatchedWork(pybind11::object told) : told_(std::move(told)) {}

  /// The result of work(progress). Must be called with the lock held. Throws what the work throws. If a signal handler
  /// or the progress function raises an exception, the work is ended at its next report and that exception is thrown.
  template <typename Work>
  auto run(const Work& work) {
    auto done = std::async(std::launch::async, [&] { return work(progress()); });
    {
      const pybind11::gil_scoped_release without_lock;
      while (done.wait_for(kInterval) != std::future_status::ready) look();
      look();  // forwards the last report
    }
    if (raised_) {
      end(done);
      throw pybind11::error_already_set(*raised_);
    }
    if constexpr (std::is_void_v<decltype(done.get())>) {
      done.get();
      tell_done();
    } else {
      auto result = done.get();
      tell_done();
      return result;
    }
  }

  /// For work that checks for interruption more often than it reports.
  bool stopped() const { return stop_; }
  /// Throws Interrupted.
  void throw_if_stopped() const {
    if (stop_) throw base::Interrupted();
  }

 private:
  static constexpr std::chrono::milliseconds kInterval{20};  // a user who presses Ctrl-C notices no shorter delay

  base::Progress progress();
  /// Called without the lock; takes it if there is something to do.
  void look();
  /// Called with the lock, after work without an error: its last stage is done, whatever it last reported.
  void tell_done();

  template <typename Done>
  static void end(Done& done) {
    const pybind11::gil_scoped_release without_lock;
    try {
      done.get();
    } catch (const std::exception&) {  // an error caused by the interrupt is not the one to report
      return;
    }
  }

  pybind11::object told_;
  std::atomic<bool> stop_ = false;
  std::unique_ptr<pybind11::error_already_set> raised_;
  std::mutex mutex_;  // protects the following members
  std::string stage_;
  double fraction_ = 0.0;
  bool news_ = false;
};

}  // namespace glidelab::python
