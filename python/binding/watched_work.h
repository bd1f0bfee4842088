/// Long work called from Python: done in a thread of its own, without the interpreter's lock, while the calling thread
/// passes its progress on and looks for Ctrl-C.
///
/// Only Python's main thread may run signal handlers, and only a thread with the lock may call the progress function.
/// Workers do neither: they leave what they have to tell, and learn from a flag that they are to stop.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "base/errors.h"
#include "base/long_work.h"

namespace glidelab::python {

class WatchedWork {
 public:
  /// `told` is None, or is called with a stage and how much of it is done (0 to 1).
  explicit WatchedWork(pybind11::object told) : told_(std::move(told)) {}

  /// The result of work(progress). To be called with the lock held. Throws what the work throws; where a signal handler
  /// or the progress function raised something, the work is ended at its next report, and that is thrown.
  template <typename Work>
  auto run(const Work& work) {
    auto done = std::async(std::launch::async, [&] { return work(progress()); });
    {
      const pybind11::gil_scoped_release without_lock;
      while (done.wait_for(kInterval) != std::future_status::ready) look();
      look();  // what was told last
    }
    if (raised_) {
      end(done);
      throw pybind11::error_already_set(*raised_);
    }
    return done.get();
  }

  /// For work that looks more often whether it is to stop than it reports: throws Interrupted.
  void throw_if_stopped() const {
    if (stop_) throw base::Interrupted();
  }

 private:
  static constexpr std::chrono::milliseconds kInterval{20};  // a person who presses Ctrl-C notices no less

  base::Progress progress();
  /// Called without the lock; takes it where there is something to do.
  void look();

  template <typename Done>
  static void end(Done& done) {
    const pybind11::gil_scoped_release without_lock;
    try {
      done.get();
    } catch (const std::exception&) {  // what an interrupt tears down on its way is not the error to report
      return;
    }
  }

  pybind11::object told_;
  std::atomic<bool> stop_ = false;
  std::unique_ptr<pybind11::error_already_set> raised_;
  std::mutex mutex_;  // of what follows
  std::string stage_;
  double fraction_ = 0.0;
  bool news_ = false;
};

}  // namespace glidelab::python
