#include "app/shell/experiment_arguments.h"

#include <CLI/App.hpp>
#include <filesystem>

#include "base/errors.h"
#include "base/files/staged_output.h"
#include "base/toml/strict_toml.h"

namespace glidelab::app {
namespace {

/// "a scenario", "a sweep", or empty: another file, or none that can be read.
std::string sort_of(const std::filesystem::path& path) {
  std::error_code ignored;
  if (path.extension() != ".toml" || path.filename() == "experiment.toml") return {};
  if (!std::filesystem::is_regular_file(path, ignored)) return {};
  try {
    const base::TomlFile file = base::TomlFile::parse(base::read_file(path), path.string());
    if (file.root().has("configuration")) return "a scenario";
    return file.root().has("scenario") && file.root().has("vary") ? "a sweep" : "";
  } catch (const base::InputError&) {
    return {};  // said by who reads it
  }
}

}  // namespace

void add_allow_outside(CLI::App& command, core::OutsideFiles& outside) {
  command.add_flag_callback(
      "--allow-outside", [&outside] { outside = core::OutsideFiles::allowed; },
      "Follow absolute names and `..` in experiment.toml to files outside the folder");
}

void refuse_scenarios(const std::vector<std::string>& inputs) {
  std::vector<base::Issue> issues;
  for (const std::string& input : inputs) {
    const std::string sort = sort_of(input);
    if (sort.empty()) continue;
    issues.push_back({input, 0, "", sort,
                      sort == "a sweep" ? "a recording; glidelab sweep and require take a sweep"
                                        : "a recording; glidelab render makes one of a scenario"});
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
}

}  // namespace glidelab::app
