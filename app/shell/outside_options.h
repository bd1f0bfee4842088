/// Options of the commands that judge somebody else's estimator (fit/outside/outside_estimator.h).
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

  /// Nothing without a command; CommandLineError where it cannot be one. An interrupt ends the program.
  std::optional<fit::OutsideEstimator> estimator() const;
};

/// Adds --estimator-command, --estimator-name, --estimator-seconds and --estimator-megabytes.
void add_outside_options(CLI::App& command, OutsideOptions& options);

}  // namespace glidelab::app
