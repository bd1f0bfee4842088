#include "app/shell/bare_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>

#include "app/shell/common_options.h"
#include "base/errors.h"

namespace glidelab::app {
namespace {

std::string check_incline(const std::string& text) {
  constexpr double kSteepest_deg = 90.0;  // a fall
  double value_deg = 0.0;
  if (CLI::detail::lexical_cast(text, value_deg) && std::abs(value_deg) <= kSteepest_deg) return {};  // false for NaN
  return fmt::format("\"{0}\" is not a number of degrees from -{1} to {1}{2}", text, kSteepest_deg,
                     decimal_point_for(text));
}

}  // namespace

void add_bare_options(CLI::App& command, core::TrackFileOptions& options) {
  command
      .add_option(
          "--column", options.column,
          "For a file: the column that holds x, by header or number; default: found by its header. For a Tracker "
          "project: the point mass; default: the only one")
      ->type_name("NAME|NUMBER");
  CLI::Option* mass = command.add_option("--mass", options.mass_kg, "For a file: mass of the glider in kilograms")
                          ->type_name("KG")
                          ->check(check_above_0);
  command.add_option("--incline", options.incline_deg, "For a file: stated inclination in degrees")
      ->type_name("DEG")
      ->check(check_incline);
  CLI::Option* runs =
      command.add_option("--runs", options.runs,
                         "For a file with several runs or masses: which of them become clips, \"all\" or "
                         "their numbers, such as 1,3");
  runs->type_name("all|N,N")->excludes("--column");
  command
      .add_option("--masses", options.masses_kg, "With --runs: the mass of each in kilograms, such as 0.0088,0.0079")
      ->type_name("KG,KG")
      ->delimiter(',')
      ->check(check_above_0)
      ->needs(runs)
      ->excludes(mass);
  add_permissions(command, options.permitted);
}

void check_bare_options(const core::TrackFileOptions& options, const std::vector<std::string>& inputs) {
  if (options.column.empty() && !options.mass_kg && !options.incline_deg && options.runs.empty()) return;
  for (const std::string& input : inputs) {
    if (core::is_bare_track(input)) continue;
    throw base::InputError(base::Issue{input, 0, "--column, --mass, --incline, --runs", "not a file with a track",
                                       "a file; for a folder, experiment.toml states column, mass_kg and incline_deg"});
  }
}

}  // namespace glidelab::app
