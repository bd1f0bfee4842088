/// glidelab certify EXPERIMENT…: can the stated intervals be trusted on this recording?
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "diagnose/lines/line_model.h"
#include "fit/estimators.h"
#include "report/certificate/certificate_report.h"
#include "report/html/gnuplot.h"
#include "report/text/display_text.h"
#include "validate/study/certify/certify.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct CertifyCommand {
  CommonOptions common;
  std::vector<std::string> experiments;
  std::string estimator{fit::default_estimator().name};
  double bandwidth_s = 0.0;
  std::size_t twins = 40;
  core::TrackFileOptions bare;
};

void certify(const CertifyCommand& options, bool bandwidth_given) {
  const std::vector<fs::path> folders(options.experiments.begin(), options.experiments.end());
  const fs::path out = output_folder(options.common, "certify", folders.front());
  refuse_scenarios(options.experiments);
  check_bare_options(options.bare, options.experiments);
  std::string title = report::title_of(diagnose::read_recording(folders.front(), options.bare).name, folders.size());
  report::check_gnuplot();
  check_writable(out);
  base::StagedOutput staged(out);

  const auto start = std::chrono::steady_clock::now();
  ProgressDisplay display(options.common.quiet, options.common.verbose);
  validate::CertifyOptions how;
  how.runs = options.twins;
  how.estimator = *fit::find_estimator(options.estimator);  // a checked name
  if (bandwidth_given) how.bandwidth_s = options.bandwidth_s;
  how.seed = options.common.seed.value_or(1);
  how.jobs = options.common.jobs;
  how.bare = options.bare;
  how.before_filming = [&](const validate::FilmingSize& size) {
    display.clear();
    say(options.common,
        fmt::format("{} twins will be filmed, and another {} to {} with one thing improved. Judging by the first, this "
                    "takes at most {} of processor time",
                    size.twins, size.least_of_changes, size.most_of_changes, duration_text(size.processor_time_s)));
  };
  const validate::Certificate certificate = validate::certify(folders, how, display.callback());
  const std::string json = report::certificate_json(certificate);
  base::write_file(staged.dir() / "certify.json", json);
  report::write_page(staged.dir(), "report.html", report::certificate_page(title, certificate));
  throw_if_interrupted();
  staged.publish_files();
  display.clear();

  print_answer(options.common.json ? json : report::certificate_text(certificate));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  say(options.common, fmt::format("{} twins and their changes in {:.0f} s; report: {}", certificate.runs, seconds,
                                  (out / "report.html").string()));
  if (certificate.empty()) {
    throw base::NotMet("there is nothing to count: no twin yields a quantity with a known true value");
  }
  if (!certificate.holds()) {
    throw base::NotMet(
        fmt::format("the stated intervals contain the true value less often than stated; {} has the table",
                    (out / "report.html").string()));
  }
}

}  // namespace

void add_certify(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<CertifyCommand>();
  CLI::App* command = app.add_subcommand(
      "certify",
      "Find out whether a recording's results can be trusted: whether its intervals hold in simulated twins, what "
      "limits them, and what would help");
  command
      ->add_option("EXPERIMENT", options->experiments,
                   "Folders that hold an experiment.toml; several must share the glider and the track. Or files with a "
                   "track, as analyze takes them")
      ->type_name("DIR|FILE")
      ->required();
  command
      ->add_option(
          "--twins", options->twins,
          "Number of twins to record. For a filmed recording, each change that may help is filmed another 5 to 10 "
          "times")
      ->type_name("N")
      ->check(CLI::Range(validate::kFewestTwins, validate::kMostTwins))
      ->capture_default_str();
  command
      ->add_option("--estimator", options->estimator,
                   "The method whose intervals are judged: an estimator of glidelab analyze")
      ->type_name("NAME")
      ->check(CLI::IsMember(fit::estimator_names()))
      ->capture_default_str();
  CLI::Option* bandwidth = command
                               ->add_option("--bandwidth", options->bandwidth_s,
                                            "Bandwidth of the phase diagram in seconds; default: chosen clip by clip")
                               ->type_name("SECONDS")
                               ->check(check_above_0);
  add_bare_options(*command, options->bare);
  add_common_options(*command, options->common, "glidelab-out/certify-<name of the first folder>",
                     "Seed of the twins' noise, clock and calibration; default: 1");
  command->callback([options, bandwidth, &chosen] {
    chosen = [options, bandwidth] {
      options->bare = with_masses(options->bare, options->experiments);
      certify(*options, bandwidth->count() > 0);
    };
  });
}

}  // namespace glidelab::app
