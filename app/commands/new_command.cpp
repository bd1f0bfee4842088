/// glidelab new FOLDER: a commented experiment folder, to be filled with a recording.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/toml/strict_toml.h"
#include "core/experiment/experiment_template.h"
#include "report/text/json_numbers.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct NewOptions {
  CommonOptions common;
  std::string folder;
};

void check_free(const fs::path& folder) {
  std::error_code failure;  // a folder that cannot be read fails when it is made
  if (!fs::exists(fs::symlink_status(folder, failure))) return;
  if (fs::is_directory(folder) && fs::is_empty(folder)) return;
  throw base::InputError(base::Issue{folder.string(), 0, "",
                                     fs::is_directory(folder) ? "a folder that is not empty" : "something that exists",
                                     "a new folder, or an empty one"});
}

void make_new(const NewOptions& options) {
  if (!options.folder.empty() && !options.common.out.empty()) {
    throw CommandLineError(
        base::describe({"", 0, "--out", options.common.out, "either FOLDER or --out, which mean the same"}));
  }
  CommonOptions where = options.common;
  if (where.out.empty()) where.out = options.folder;
  if (where.out.empty()) {
    throw CommandLineError(base::describe({"", 0, "FOLDER", "nothing", "the name of a new folder"}));
  }
  const fs::path folder = named_folder(where, "new", where.out);
  check_free(folder);
  const std::string name = folder.filename().string();
  const std::string toml = core::experiment_template(name);
  base::TomlFile::parse(toml, folder.string());  // a name that is not UTF-8 text fails here
  base::StagedOutput staged(folder);
  base::write_file(staged.dir() / "experiment.toml", toml);
  base::write_file(staged.dir() / "README.md", core::experiment_readme(name));
  fs::create_directory(staged.dir() / "clips");
  fs::create_directory(staged.dir() / "calibration");
  throw_if_interrupted();
  staged.publish_whole();
  if (options.common.json) {
    print_result(report::json_text({{"folder", folder.string()},
                                    {"files", {"experiment.toml", "README.md"}},
                                    {"folders", {"clips", "calibration"}}}));
    return;
  }
  print_result(folder.string() + "\n");
  say(options.common, "README.md says what goes where, experiment.toml explains every key.");
}

}  // namespace

void add_new(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<NewOptions>();
  CLI::App* command = app.add_subcommand("new", "Make a commented experiment folder, to be filled with a recording");
  command->add_option("FOLDER", options->folder, "The folder to make; must not exist, or be empty");
  add_common_options(*command, options->common, "FOLDER");
  hide_options(*command, {"--out", "--jobs", "--verbose"});
  command->callback([options, &chosen] { chosen = [options] { make_new(*options); }; });
}

}  // namespace glidelab::app
