#include "python/binding/watched_work.h"

#include <algorithm>
#include <cmath>

namespace glidelab::python {

namespace py = pybind11;

base::Progress WatchedWork::progress() {
  return [this](std::string_view stage, double fraction) {
    if (stop_) throw base::Interrupted();
    const std::lock_guard lock(mutex_);
    if (stage != stage_) {
      stage_ = stage;
      fraction_ = 0.0;
    }
    // Threads report in any order; progress never goes back.
    fraction_ = std::max(fraction_, std::isfinite(fraction) ? std::min(fraction, 1.0) : 0.0);
    news_ = true;
  };
}

void WatchedWork::look() {
  if (stop_) return;
  std::string stage;
  double fraction = 0.0;
  bool news = false;
  {
    const std::lock_guard lock(mutex_);
    news = std::exchange(news_, false);
    stage = stage_;
    fraction = fraction_;
  }
  const py::gil_scoped_acquire with_lock;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (news && !told_.is_none()) told_(stage, fraction);
  } catch (py::error_already_set& error) {
    raised_ = std::make_unique<py::error_already_set>(error);
    stop_ = true;
  }
}

void WatchedWork::tell_done() {
  if (!told_.is_none() && !stage_.empty() && fraction_ < 1.0) told_(stage_, 1.0);
}

}  // namespace glidelab::python
