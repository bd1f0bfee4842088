/// Options of the commands that judge an outside estimator (fit/outside/outside_estimator.h).
#pragma once

#include <optional>
#include <string>

#include "fit/outside/outside_estimator.h"

namespace CLI {
class App;
}  // namespace CLI

namespace glidelab::app {

struct OutsideOptions {
  std::string command;
  std::string name;  ///< empty: from the command
  double seconds = 60.0;
  double megabytes = 4096.0;

  /// Empty without a command; CommandLineError if it is not valid. An interrupt ends the estimator's program.
  std::optional<fit::OutsideEstimator> estimator() const;
};

/// Adds --estimator-command, --estimator-name, --estimator-seconds and --estimator-megabytes.
void add_outside_options(CLI::App& command, OutsideOptions& options);

}  // namespace glidelab::app
