/// SIGINT, SIGTERM and SIGHUP set a flag; the work checks it, ends by itself and cleans up. A second
/// signal, two seconds later or more, ends the process at once and leaves what it had begun.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "base/errors.h"

namespace glidelab::app {

/// From now on those signals set the flag. Writing beyond a size limit or to a closed pipe becomes an error that the
/// write reports and no longer ends the process.
void catch_interrupts();

bool interrupted();

/// An interrupt of work that keeps what it has finished; what() says what that is.
class InterruptedKeeping : public base::Interrupted {
 public:
  explicit InterruptedKeeping(std::string kept) : kept_("interrupted; " + std::move(kept)) {}
  const char* what() const noexcept override { return kept_.c_str(); }

 private:
  std::string kept_;
};

/// Throws base::Interrupted if the flag is set.
void throw_if_interrupted();

/// `work`, which keeps what it has finished: InterruptedKeeping where an interrupt ends it, with what `kept` says.
void keep_on_interrupt(const std::function<void()>& work, const std::function<std::string()>& kept);

}  // namespace glidelab::app
