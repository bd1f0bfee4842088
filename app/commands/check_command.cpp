/// glidelab check FOLDER|FILE…: a look at a recording before any analysis; check.json and report.html out.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <vector>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/check/check_recording.h"
#include "core/track/bare_track.h"
#include "report/check/check_report.h"
#include "report/html/gnuplot.h"
#include "report/text/display_text.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct CheckOptions {
  CommonOptions common;
  std::vector<std::string> inputs;
  core::TrackFileOptions bare;
};

void check(const CheckOptions& options) {
  const fs::path out = output_folder(options.common, "check", options.inputs.front());
  refuse_scenarios(options.inputs);
  check_bare_options(options.bare, options.inputs);
  core::Experiment experiment = core::read_track_files({options.inputs.begin(), options.inputs.end()}, options.bare);
  experiment.name = report::title_of(experiment.name, options.inputs.size());
  report::check_gnuplot();
  check_writable(out);
  base::StagedOutput staged(out);
  ProgressDisplay display(options.common.quiet, options.common.verbose);
  const core::RecordingCheck found = core::check_recording(experiment, options.common.jobs, display.callback());
  const std::string json = report::check_json(found);
  base::write_file(staged.dir() / "check.json", json);
  report::write_page(staged.dir(), "report.html",
                     report::check_report(found, core::previews_of_check(experiment, found)));
  throw_if_interrupted();
  staged.publish_files();
  display.clear();
  print_answer(options.common.json ? json : report::check_text(found));
  say(options.common, fmt::format("report: {}", (out / "report.html").string()));
  if (!found.usable) {
    throw base::NotMet(fmt::format("{}: not usable as it is; {} says what to change",
                                   report::title_of(options.inputs.front(), options.inputs.size()),
                                   (out / "report.html").string()));
  }
}

}  // namespace

void add_check(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = app.add_subcommand(
      "check",
      "Check a recording before the analysis (pattern, marker, exposure, blur, frame times) and say what to change");
  command
      ->add_option("RECORDING", options->inputs,
                   "A folder that holds an experiment.toml, or track files, as analyze takes them")
      ->type_name("DIR|FILE")
      ->required();
  add_bare_options(*command, options->bare);
  add_common_options(*command, options->common, "glidelab-out/check-<name of the folder or file>");
  command->footer("Exit status: 0 usable, 4 not usable as it is, 1 wrong input (docs/reference/check.md).");
  command->callback([options, &chosen] {
    chosen = [options] {
      options->bare = with_masses(options->bare, options->inputs);
      check(*options);
    };
  });
}

}  // namespace glidelab::app
