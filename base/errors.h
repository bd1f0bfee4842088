/// The errors that leave a room, one class for each of the program's exit statuses.
///
/// What may normally be missing (no marker in a frame, a fit that does not converge) is a value, not an error.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace glidelab::base {

/// One thing that is wrong with an input: its place, what was found, and what is allowed there.
struct Issue {
  std::string file;      ///< as the user named it; empty if the input is not a file
  int line = 0;          ///< 1-based; 0 if there is none
  std::string key;       ///< "camera.frame_rate_hz", "column 'x_m'", "frame 12"; empty if there is none
  std::string found;     ///< "-3", "text \"abc\"", "nothing"
  std::string expected;  ///< "a number above 0"
};

/// "file:line: key: found X, expected Y", leaving out what is empty.
std::string describe(const Issue& issue);

/// The input is wrong (exit status 1). Holds every issue that was found; what() has a line for each of the first twenty
/// and says how many more there are.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Issue> issues);
  explicit InputError(Issue issue) : InputError(std::vector<Issue>{std::move(issue)}) {}
  const std::vector<Issue>& issues() const { return issues_; }

 private:
  std::vector<Issue> issues_;
};

/// The environment failed: disk full, output unwritable, codec or program missing (exit status 3).
class EnvironmentError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A solver broke down; the message gives time, step and tolerance (exit status 1: the input drove it there).
class NumericalError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A requested condition does not hold: a baseline, a target, a coverage (exit status 4). The results are still
/// written.
class NotMet : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The user interrupted the work (exit status 130); thrown from Progress.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

/// EnvironmentError "path: what: strerror(errno)".
[[noreturn]] void throw_system_error(std::string_view path, std::string_view what, int error_number);

}  // namespace glidelab::base
