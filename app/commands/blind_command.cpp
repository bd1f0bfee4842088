/// glidelab blind --cases N: experiments with a withheld cause, each diagnosed by another process, then scored.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/files/child_process.h"
#include "base/files/file_io.h"
#include "report/blind/blind_report.h"
#include "report/html/gnuplot.h"
#include "validate/blind/run_blind.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct BlindCommand {
  CommonOptions common;
  validate::BlindOptions blind;
  OutsideOptions outside;
};

/// Starts this program's own executable again: that process knows the folder and nothing else.
std::string diagnose_apart(const fs::path& folder, const fs::path& out, const std::vector<std::string>& without) {
  std::vector<std::string> arguments = {"diagnose", folder.string(), "-o",       out.string(), "--jobs",
                                        "1",        "--quiet",       "--no-page"};
  if (!without.empty()) arguments.emplace_back("--without");
  arguments.insert(arguments.end(), without.begin(), without.end());
  const fs::path log = out / "log.txt";
  const std::string how = base::how_it_failed(base::run_program("/proc/self/exe", arguments, log, {}, {}, interrupted));
  throw_if_interrupted();
  const std::string said = base::read_file(log);
  fs::remove(log);
  return how.empty() ? "" : fmt::format("{}: {}", how, said);
}

/// The same for the renderer, which knows the scenario and nothing about the diagnosis.
std::string render_apart(const fs::path& scenario, const fs::path& folder) {
  const fs::path log = folder.parent_path() / "log.txt";
  const std::string how = base::how_it_failed(base::run_program(
      "/proc/self/exe", {"render", scenario.string(), "-o", folder.string(), "--jobs", "1", "--quiet"}, log, {}, {},
      interrupted));
  throw_if_interrupted();
  return how.empty() ? "" : fmt::format("{}: {}", how, base::read_file(log));
}

void blind(const BlindCommand& options) {
  const std::optional<fit::OutsideEstimator> outside = options.outside.estimator();
  report::check_gnuplot();
  const fs::path out = output_folder(options.common, "blind", "cases");
  check_writable(out);
  ProgressDisplay display(options.common.quiet, options.common.verbose);
  validate::BlindOptions wanted = options.blind;
  wanted.seed = options.common.seed.value_or(1);
  wanted.jobs = options.common.jobs;
  wanted.outside = outside;
  report::BlindRun run;
  run.seed = wanted.seed;
  run.images = wanted.images;
  keep_on_interrupt(
      [&] { run.outcomes = validate::run_blind(wanted, out, diagnose_apart, display.callback(), render_apart); },
      [&] {
        return fmt::format("{} of {} cases are kept in {}; the same command continues with the rest",
                           validate::kept_cases(wanted, out), wanted.cases, out.string());
      });
  if (outside) run.outside = validate::tally_of(*outside, run.outcomes);
  if (wanted.everyday) {
    run.everyday = validate::score_everyday(run.outcomes);
  } else {
    run.score = validate::score_blind(run.outcomes);
  }
  const std::string json = report::blind_json(run);
  base::StagedOutput staged(out);
  base::write_file(staged.dir() / "blind.json", json);
  report::write_page(staged.dir(), "report.html", report::blind_page(run));
  throw_if_interrupted();
  staged.publish_files();
  display.clear();
  print_answer(options.common.json ? json : report::blind_text(run));
  say(options.common, fmt::format("report: {}", (out / "report.html").string()));
}

}  // namespace

void add_blind(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<BlindCommand>();
  CLI::App* command = app.add_subcommand(
      "blind", "Make experiments whose cause is withheld, diagnose each in another process, and score the diagnoses");
  command
      ->add_option("--cases", options->blind.cases, "Number of cases; run again with more to continue where it stopped")
      ->check(CLI::Range(std::size_t{1}, validate::kMostBlindCases))
      ->required();
  command
      ->add_option("--only", options->blind.only,
                   "Give every case this effect; default: none, one, two, or one that is not on the list")
      ->type_name("EFFECT");
  CLI::Option* images = command->add_flag(
      "--films,--pictures", options->blind.images,
      "Film the experiments as rendered clips instead of tracks; their effects are those that images show");
  CLI::Option* leave_out =
      command->add_flag("--leave-out", options->blind.leave_out,
                        "Diagnose each case of one effect again with that effect taken off the list");
  command
      ->add_flag(
          "--everyday", options->blind.everyday,
          "Tracks as students record them: one cause, two, none, or one that is not on the list, each with three "
          "to five small imperfections")
      ->excludes(images)
      ->excludes(leave_out);
  add_outside_options(*command, options->outside,
                      "With --everyday: also have an estimator of your own answer the same cases");
  add_common_options(*command, options->common, "glidelab-out/blind-cases", "Seed of the cases; default: 1");
  command->callback([options, &chosen] { chosen = [options] { blind(*options); }; });
}

}  // namespace glidelab::app
