/// glidelab analyze EXPERIMENT…: experiment folders or track files in; results.json, report.html, phase-<clip>.csv and
/// motion-<clip>.csv out.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/nearest_word.h"
#include "core/analysis/analyze.h"
#include "core/analysis/preview.h"
#include "core/check/motion_look.h"
#include "core/motion/bandwidth/bandwidth_rule.h"
#include "core/motion/smoothing/smoother_list.h"
#include "core/track/bare_track.h"
#include "diagnose/verdict/fit_given_causes.h"
#include "fit/estimators.h"
#include "report/analysis/analysis_report.h"
#include "report/analysis/result_files.h"
#include "report/diagnosis/given_causes_report.h"
#include "report/html/gnuplot.h"
#include "report/text/display_text.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct AnalyzeOptions {
  CommonOptions common;
  std::vector<std::string> experiments;
  std::string bandwidth{core::kLinesRule};
  std::string smoother{core::kLocalPolynomial};
  bool bandwidth_given = false;
  std::string estimator{fit::default_estimator().name};
  bool robust = false;
  std::vector<std::string> with;
  core::TrackFileOptions bare;
};

/// Reads a checked text: a number of seconds or the name of a rule.
void read_bandwidth(const std::string& text, core::AnalysisOptions& how) {
  double value = 0.0;
  if (text == core::kLinesRule) return;
  if (CLI::detail::lexical_cast(text, value)) {
    how.bandwidth_s = value;
  } else {
    how.bandwidth_rule = text;
  }
}

std::string title_of(const std::vector<fs::path>& folders, const core::TrackFileOptions& bare) {
  return report::title_of(core::read_tracks(folders.front(), bare).name, folders.size());
}

constexpr const char* kWith = "--with";

/// The fit with causes in the model, to the motions as used in the analysis; empty if none is named.
std::optional<diagnose::GivenCauses> with_causes(const AnalyzeOptions& options, const std::vector<fs::path>& folders,
                                                 const core::AnalysisResults& results, const base::Progress& progress) {
  if (options.with.empty()) return {};
  std::vector<core::ClipSetup> setups;
  std::vector<std::optional<core::CameraSettings>> cameras;
  for (const fs::path& folder : folders) {
    const core::Experiment experiment = core::read_tracks(folder, options.bare);
    setups.insert(setups.end(), experiment.clips.begin(), experiment.clips.end());
    cameras.resize(setups.size(), experiment.camera);
  }
  return diagnose::fit_given_causes(results, core::of_analysed(results, std::move(setups)),
                                    core::of_analysed(results, std::move(cameras)), options.with, kWith, progress);
}

/// A smoother that finds its own strength has no bandwidth, and lines fitted to local cubics need one.
void check_smoother(const AnalyzeOptions& options, const fit::Estimator& estimator) {
  if (core::find_smoother(options.smoother)->takes_bandwidth()) return;
  const std::string expected = fmt::format("--smoother {}", core::kLocalPolynomial);
  if (options.bandwidth_given) {
    throw CommandLineError(base::describe({"", 0, "--bandwidth", fmt::format("--smoother {}", options.smoother),
                                           expected + " (the other smoothers choose their own strength)"}));
  }
  if (estimator.lines == core::LineMethod::generalised) {
    throw CommandLineError(
        base::describe({"", 0, "--smoother", fmt::format("{} with --estimator {}", options.smoother, options.estimator),
                        expected + " (generalised lines are fitted to local cubics of their own)"}));
  }
}

void analyze(const AnalyzeOptions& options) {
  const fit::Estimator& estimator = *fit::find_estimator(options.estimator);  // a checked name
  if (options.robust && !estimator.takes_robust) {
    throw CommandLineError(
        base::describe({"", 0, "--robust", options.estimator,
                        "the estimator trajectory (the line estimators leave out outliers in any case)"}));
  }
  check_smoother(options, estimator);
  const std::vector<fs::path> folders(options.experiments.begin(), options.experiments.end());
  const fs::path out = output_folder(options.common, "analyze", folders.front());
  refuse_scenarios(options.experiments);
  check_bare_options(options.bare, options.experiments);
  diagnose::check_given_causes(options.with, kWith);
  const std::string title = title_of(folders, options.bare);
  report::check_gnuplot();
  check_writable(out);
  base::StagedOutput staged(out);

  ProgressDisplay display(options.common.quiet, options.common.verbose);
  const base::Progress progress = display.callback();
  core::AnalysisOptions how;
  how.jobs = options.common.jobs;
  how.bare = options.bare;
  if (options.with.empty()) how.bare.speeds = core::SpeedsAlone::taken;  // causes are fitted to positions
  read_bandwidth(options.bandwidth, how);
  how.lines = estimator.lines;
  how.smoother = options.smoother;
  how.images = !options.with.empty();
  how.without_marker = core::WithoutMarker::left_out;
  core::AnalysisResults results =
      fit::estimate_and_compare(estimator, core::analyze(folders, how, progress), {.robust = options.robust});
  core::note_no_runs(results);
  const std::optional<diagnose::GivenCauses> given = with_causes(options, folders, results, progress);
  const report::Json with = given ? report::given_causes_json(*given) : report::Json(nullptr);
  report::write_analysis_files(results, staged.dir(), with);
  const std::vector<core::Preview> previews = core::previews_of(folders, results, progress, options.bare);
  report::write_page(staged.dir(), "report.html",
                     report::analysis_report(title, results, previews, progress,
                                             given ? report::given_causes_section(results, *given) : report::Html{}));
  throw_if_interrupted();
  staged.publish_files();
  display.clear();

  print_answer(options.common.json ? report::results_json(results, with)
                                   : report::analysis_text(results) +
                                         (given ? report::given_causes_text(results, *given) : std::string()));
  say(options.common, fmt::format("report: {}", (out / "report.html").string()));
}

std::string check_bandwidth(const std::string& text) {
  const std::vector<std::string> rules = core::bandwidth_choices();
  if (std::find(rules.begin(), rules.end(), text) != rules.end()) return {};
  if (check_above_0(text).empty()) return {};
  return fmt::format("\"{}\" is neither a number of seconds above 0 nor one of {}{}", text, fmt::join(rules, ", "),
                     base::did_you_mean(text, rules));
}

std::string smoother_help() {
  std::string text = "How v(t) and a(t) are computed from the positions";
  const char* before = ": ";
  for (const core::Smoother* smoother : core::smoothers()) {
    text += fmt::format("{}\"{}\" {}", std::exchange(before, "; "), smoother->name(), smoother->words());
  }
  return text + " (docs/guide/bandwidth.md)";
}

std::string estimator_help() {
  std::string text = "Method";
  for (const fit::Estimator& estimator : fit::estimators()) {
    text += fmt::format("{} \"{}\" {}", text == "Method" ? ":" : ";", estimator.name, estimator.method);
  }
  return text;
}

}  // namespace

void add_analyze(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<AnalyzeOptions>();
  CLI::App* command = app.add_subcommand("analyze",
                                         "Analyse recordings: find the marker, smooth its motion, and recover K/m, mu, "
                                         "alpha and v_lim with uncertainties");
  command
      ->add_option(
          "EXPERIMENT", options->experiments,
          "Folders that hold an experiment.toml; several must share the glider and the track. Or track files: a table "
          "t_s,x_m or t_s,v_m_s (speeds; without --with), an export from Tracker, Logger Pro, Capstone or phyphox, a "
          "workbook (.xlsx), or a Tracker project (.trk, .trz)")
      ->type_name("DIR|FILE")
      ->required();
  command->add_option("--smoother", options->smoother, smoother_help())
      ->type_name("NAME")
      ->check(CLI::IsMember(core::smoother_names()))
      ->capture_default_str();
  CLI::Option* bandwidth =
      command
          ->add_option(
              "--bandwidth", options->bandwidth,
              fmt::format("Width of the smoothing kernel in seconds, or the rule that chooses it for each clip: "
                          "{} (docs/guide/bandwidth.md)",
                          fmt::join(core::bandwidth_choices(), ", ")))
          ->type_name("SECONDS|RULE")
          ->check(CLI::Validator([](std::string& text) { return check_bandwidth(text); },
                                 fmt::format("{{{}}}", fmt::join(core::bandwidth_choices(), ","))))
          ->capture_default_str();
  command->add_option("--estimator", options->estimator, estimator_help())
      ->type_name("NAME")
      ->check(CLI::IsMember(fit::estimator_names()))
      ->capture_default_str();
  command->add_flag(
      "--robust", options->robust,
      "With \"trajectory\": leave out positions that lie more than four scaled median absolute deviations "
      "from the motion, which is fitted with Huber's weights");
  command
      ->add_option("--with", options->with,
                   "Also give K/m, mu, alpha and v_lim with this effect in the model (ids as in "
                   "docs/reference/effects.md); may be repeated")
      ->type_name("EFFECT")
      ->allow_extra_args(false);
  add_bare_options(*command, options->bare);
  add_common_options(*command, options->common, "glidelab-out/analyze-<name of the first folder>");
  command->callback([options, bandwidth, &chosen] {
    options->bandwidth_given = bandwidth->count() > 0;
    chosen = [options] {
      options->bare = with_masses(options->bare, options->experiments);
      analyze(*options);
    };
  });
}

}  // namespace glidelab::app
