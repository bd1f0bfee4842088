/// glidelab diagnose EXPERIMENT…: which unmodelled effect makes the gap between the motion and its model.
#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <memory>

#include "app/commands.h"
#include "app/common_options.h"
#include "app/interrupt.h"
#include "app/progress_display.h"
#include "base/staged_output.h"
#include "core/experiment.h"
#include "diagnose/diagnose.h"
#include "report/diagnosis_json.h"
#include "report/diagnosis_report.h"
#include "report/diagnosis_text.h"
#include "report/gnuplot.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct DiagnoseCommand {
  CommonOptions common;
  std::vector<std::string> experiments;
  std::vector<std::string> without;
  bool no_page = false;
};

void diagnose(const DiagnoseCommand& options) {
  const std::vector<fs::path> folders(options.experiments.begin(), options.experiments.end());
  std::string title = core::read_experiment(folders.front()).name;
  if (folders.size() > 1) title += fmt::format(" and {} more", folders.size() - 1);
  if (!options.no_page) report::check_gnuplot();
  const fs::path out = output_folder(options.common, "diagnose", folders.front());
  check_writable(out);
  base::StagedOutput staged(out);

  ProgressDisplay display(options.common.quiet);
  const diagnose::Diagnosis diagnosis =
      diagnose::diagnose(folders, {.without = options.without, .jobs = options.common.jobs}, display.callback());
  base::write_file(staged.dir() / "diagnosis.json", report::diagnosis_json(diagnosis));
  if (!options.no_page) {
    base::write_file(staged.dir() / "report.html", report::diagnosis_report(title, diagnosis));
  }
  throw_if_interrupted();
  staged.publish_files();
  display.clear();

  print_result(options.common.json ? report::diagnosis_json(diagnosis) : report::diagnosis_text(diagnosis));
  say(options.common, options.no_page ? fmt::format("diagnosis: {}", (out / "diagnosis.json").string())
                                      : fmt::format("report: {}", (out / "report.html").string()));
}

}  // namespace

void add_diagnose(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<DiagnoseCommand>();
  CLI::App* command = app.add_subcommand(
      "diagnose",
      "Say which unmodelled effect makes the gap between measured motions and the model, or that none does");
  command
      ->add_option("EXPERIMENT", options->experiments,
                   "Folders that hold an experiment.toml; several share the glider and the track")
      ->type_name("DIR")
      ->required();
  command->add_option("--without", options->without, "Effects that are not considered (ids as in docs/diagnose.md)")
      ->type_name("EFFECT");
  command->add_flag("--no-page", options->no_page, "Write diagnosis.json only, no report.html");
  add_common_options(*command, options->common, "glidelab-out/diagnose-<name of the first folder>",
                     "Accepted as by every command; a diagnosis draws no random numbers");
  command->callback([options, &chosen] { chosen = [options] { diagnose(*options); }; });
}

}  // namespace glidelab::app
