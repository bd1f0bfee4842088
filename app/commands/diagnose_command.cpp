/// glidelab diagnose EXPERIMENT…: which unmodelled effect causes the gap between the motion and its model.
#include <CLI/CLI.hpp>

#include <fmt/format.h>

#include <memory>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/program_texts.h"
#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/analysis/analyze.h"
#include "core/experiment/experiment.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/lines/line_model.h"
#include "diagnose/next/plan.h"
#include "diagnose/twin/twin.h"
#include "diagnose/verdict/diagnose.h"
#include "render/scenario/scenario.h"
#include "report/diagnosis/diagnosis_json.h"
#include "report/diagnosis/diagnosis_report.h"
#include "report/diagnosis/plan_report.h"
#include "report/html/gnuplot.h"
#include "report/text/display_text.h"
#include "validate/film/twin_motions.h"
#include "validate/made_tracks/made_tracks.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct DiagnoseCommand {
  CommonOptions common;
  std::vector<std::string> experiments;
  std::vector<std::string> without;
  bool no_page = false;
  std::string twin;
  bool plan = false;
  std::optional<double> noise_m;  // of a plan
  core::TrackFileOptions bare;
};

/// Whether the plan is for recorded folders and not for a scenario.
bool of_recordings(const DiagnoseCommand& options) {
  std::error_code ignored;  // an unreadable path is treated as a scenario, whose reader reports the error
  return fs::is_directory(options.experiments.front(), ignored);
}

/// Checks that need no file.
void check_plan(const DiagnoseCommand& options) {
  if (of_recordings(options)) {
    if (!options.noise_m) return;
    throw CommandLineError(base::describe({options.experiments.front(), 0, "--noise-m", "a noise with a recording",
                                           "none: recorded positions show their own noise"}));
  }
  if (options.experiments.size() > 1) {
    throw CommandLineError(
        base::describe({"", 0, "EXPERIMENT", fmt::format("{} of them, the first a file", options.experiments.size()),
                        "with --plan, one scenario, or folders only"}));
  }
  if (!options.noise_m) {
    throw CommandLineError(options.experiments.front() +
                           ": --noise-m is missing: a scenario does not state the position noise (in metres, such as "
                           "1.5e-5)");
  }
}

/// The plan: for a scenario's motions with noise, or for recorded folders.
diagnose::Plan planned(const DiagnoseCommand& options, const base::Progress& progress) {
  const fs::path first = options.experiments.front();
  if (of_recordings(options)) {
    const std::vector<fs::path> folders(options.experiments.begin(), options.experiments.end());
    std::vector<core::ClipSetup> setups;
    for (const fs::path& folder : folders) {
      const core::Experiment experiment = diagnose::read_recording(folder, options.bare);
      if (experiment.lines) {
        throw base::InputError(
            base::Issue{experiment.file.string(), 0, "lines", "a table of lines",
                        "clips or tracks: --plan says what motions will show, and a table of lines holds no motions"});
      }
      setups.insert(setups.end(), experiment.clips.begin(), experiment.clips.end());
    }
    return diagnose::plan_of(
        core::analyze(folders, {.bandwidth_s = {}, .jobs = options.common.jobs, .bare = options.bare}, progress),
        setups);
  }
  const render::Scenario scenario = render::read_scenario(first);
  const std::uint64_t seed = options.common.seed.value_or(scenario.seed);
  const validate::MadeTracks made = validate::with_noise(validate::make_tracks(scenario, seed), *options.noise_m, seed);
  return diagnose::plan_of(validate::analyze_tracks(made, std::optional<double>(), options.common.jobs), made.setups);
}

void plan(const DiagnoseCommand& options) {
  check_plan(options);
  const fs::path out = output_folder(options.common, "diagnose", options.experiments.front());
  if (!options.no_page) report::check_gnuplot();
  check_writable(out);
  base::StagedOutput staged(out);
  ProgressDisplay display(options.common.quiet, options.common.verbose);
  const diagnose::Plan plan = planned(options, display.callback());
  base::write_file(staged.dir() / "plan.json", report::plan_json(plan));
  const std::string title = "Plan: " + fs::path(options.experiments.front()).stem().string();
  if (!options.no_page) report::write_page(staged.dir(), "plan.html", report::plan_page(title, plan));
  throw_if_interrupted();
  staged.publish_files();
  display.clear();
  print_answer(options.common.json ? report::plan_json(plan) : report::plan_text(plan));
  say(options.common, fmt::format("plan: {}", (out / (options.no_page ? "plan.json" : "plan.html")).string()));
}

void diagnose(const DiagnoseCommand& options) {
  if (options.plan) return plan(options);
  const std::vector<fs::path> folders(options.experiments.begin(), options.experiments.end());
  const fs::path out = output_folder(options.common, "diagnose", folders.front());
  refuse_scenarios(options.experiments);
  check_bare_options(options.bare, options.experiments);
  std::string title = report::title_of(diagnose::read_recording(folders.front(), options.bare).name, folders.size());
  if (!options.twin.empty()) {
    check_file_writable(options.twin);
    check_own_file(options.twin, "--twin", diagnose::kTwinHead);
  }
  if (!options.no_page) report::check_gnuplot();
  check_writable(out);
  base::StagedOutput staged(out);

  ProgressDisplay display(options.common.quiet, options.common.verbose);
  const diagnose::Diagnosis diagnosis = diagnose::diagnose(
      folders,
      {.without = options.without, .jobs = options.common.jobs, .twin = !options.twin.empty(), .bare = options.bare},
      display.callback());
  base::write_file(staged.dir() / "diagnosis.json", report::diagnosis_json(diagnosis));
  if (!options.no_page) {
    const bool twin = !options.twin.empty() && !diagnosis.twin.empty();
    report::write_page(
        staged.dir(), "report.html",
        report::diagnosis_report(title, diagnosis,
                                 twin ? validate::twin_motions(diagnosis, options.common.seed.value_or(1))
                                      : std::vector<validate::TwinMotion>{}));
  }
  throw_if_interrupted();
  staged.publish_files();
  display.clear();
  if (!options.twin.empty() && !diagnosis.twin.empty()) write_whole(options.twin, diagnosis.twin);

  print_answer(options.common.json ? report::diagnosis_json(diagnosis) : report::diagnosis_text(diagnosis));
  say(options.common, options.no_page ? fmt::format("diagnosis: {}", (out / "diagnosis.json").string())
                                      : fmt::format("report: {}", (out / "report.html").string()));
  if (options.twin.empty()) return;
  if (diagnosis.twin.empty()) throw base::NotMet("a table of lines has no motions that a twin could repeat");
  if (!diagnosis.twin_lacks.empty()) {
    std::string lacks;
    for (const diagnose::TwinLack& lack : diagnosis.twin_lacks) {
      lacks += fmt::format("{}{} ({})", lacks.empty() ? "" : ", ", lack.what, lack.why);
    }
    throw base::NotMet(fmt::format("{} is written without {}", options.twin, lacks));
  }
  say(options.common, fmt::format("twin: {}", options.twin));
}

}  // namespace

void add_diagnose(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<DiagnoseCommand>();
  CLI::App* command = app.add_subcommand(
      "diagnose", "Find what the simple law leaves out: which effects explain the motions, and how much each explains");
  command
      ->add_option(
          "EXPERIMENT", options->experiments,
          "Folders that hold an experiment.toml; several must share the glider and the track. Or track files, as "
          "analyze takes them; or one .csv with a table of lines")
      ->type_name("DIR|FILE")
      ->required();
  CLI::Option* without =
      command->add_option("--without", options->without, "Effects to leave out (ids as in docs/reference/effects.md)")
          ->type_name("EFFECT")
          ->check(one_of(diagnose::effect_words()));
  CLI::Option* twin =
      command
          ->add_option(
              "--twin", options->twin,
              "Write the fitted motions, with the diagnosed effect and the camera as far as it is known, as a scenario "
              "for simulate, render and validate; exit status 4 if a scenario cannot express all of it")
          ->type_name("SCENARIO.toml")
          ->check([](const std::string& text) {
            return text.ends_with(".toml") ? std::string()
                                           : fmt::format(
                                                 "found \"{}\", expected the name of a scenario to write, "
                                                 "NAME.toml",
                                                 text);
          });
  CLI::Option* plan = command
                          ->add_flag("--plan", options->plan,
                                     "Before any recording: say which effects these motions could show and tell apart; "
                                     "EXPERIMENT may be a scenario file")
                          ->excludes(without, twin);
  command
      ->add_option("--noise-m", options->noise_m,
                   "With --plan and a scenario: standard deviation of the position noise in metres")
      ->type_name("METRES")
      ->check(check_noise_m)
      ->needs(plan);
  command->add_flag("--no-page", options->no_page, "Write diagnosis.json only, no report.html");
  add_bare_options(*command, options->bare);
  add_common_options(
      *command, options->common, "glidelab-out/diagnose-<name of the first folder>",
      "Seed of a plan's noise, default the scenario's, and of the noise shown with a twin on the page; a "
      "diagnosis draws no random numbers");
  command->callback([options, &chosen] {
    chosen = [options] {
      options->bare = with_masses(options->bare, options->experiments);
      diagnose(*options);
    };
  });
}

}  // namespace glidelab::app
