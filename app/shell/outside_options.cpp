#include "app/shell/outside_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "fit/estimators.h"

namespace glidelab::app {
namespace {

constexpr double kMegabyte = 1048576.0;  // bytes

}  // namespace

std::optional<fit::OutsideEstimator> OutsideOptions::estimator() const {
  if (command.empty()) return std::nullopt;
  return of_command_line([&] {
    fit::OutsideEstimator made = fit::outside_estimator(command, name);
    made.limits.wall_s = seconds;
    made.limits.memory_bytes = static_cast<std::uint64_t>(megabytes * kMegabyte);
    made.stop = interrupted;
    return made;
  });
}

void add_outside_options(CLI::App& command, OutsideOptions& options) {
  CLI::Option* judged =
      command
          .add_option("--estimator-command", options.command,
                      "Also judge an estimator of your own: a program that reads the experiment folder {folder} "
                      "and writes {out}/results.json (docs/reference/own-estimator.md)")
          ->type_name("COMMAND");
  command
      .add_option("--estimator-name", options.name, "Its name in the results; default: the name of the program file")
      ->type_name("NAME")
      ->needs(judged);
  command.add_option("--estimator-seconds", options.seconds, "Longest time that one run of it may take")
      ->type_name("SECONDS")
      ->check(check_above_0)
      ->needs(judged)
      ->capture_default_str();
  command.add_option("--estimator-megabytes", options.megabytes, "Most memory that one of its processes may use")
      ->type_name("MB")
      ->check(check_above_0)
      ->needs(judged)
      ->capture_default_str();
}

}  // namespace glidelab::app
