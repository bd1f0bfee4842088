/// glidelab require SWEEP.toml --target mu=0.0005: which cameras and settings reach a target, the cheapest first.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/result/quantity.h"
#include "report/html/gnuplot.h"
#include "report/requirement/requirement_report.h"
#include "validate/study/requirement/requirement.h"
#include "validate/study/sweep/design/read_sweep.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct RequireOptions {
  CommonOptions common;
  std::string sweep;
  std::vector<std::string> targets;
  std::string confirm;  // empty: rendered if the sweep has images
  std::uint64_t runs = 20, track_runs = 200;
};

validate::Confirm confirm_of(const std::string& confirm, const validate::Sweep& sweep) {
  if (confirm == "none") return validate::Confirm::none;
  if (confirm.empty()) return validate::usual_confirm(sweep);
  return confirm == "clips" ? validate::Confirm::clips : validate::Confirm::tracks;
}

void require_command(const RequireOptions& options) {
  validate::RequirementOptions how;
  of_command_line([&] {
    for (const std::string& target : options.targets) how.targets.push_back(validate::parse_target(target));
  });
  how.runs = options.runs;
  how.track_runs = options.track_runs;
  how.jobs = options.common.jobs;
  validate::Sweep sweep = validate::read_sweep(options.sweep);
  how.confirm = confirm_of(options.confirm, sweep);
  if (options.common.seed) sweep.seed = *options.common.seed;
  report::check_gnuplot();
  const fs::path out = output_folder(options.common, "require", options.sweep);
  check_writable(out);
  base::StagedOutput staged(out);
  ProgressDisplay display(options.common.quiet, options.common.verbose);
  how.before_rendering = [&](const validate::ConfirmationSize& size) {
    display.clear();
    say(options.common,
        fmt::format("the bound allows {} of {}; they are filmed from the cheapest up, until one reaches the target: "
                    "about {:.2g} min with --jobs {} if the first does, {:.2g} min or more if only the last does",
                    size.close, size.points, size.seconds / 60.0, options.common.jobs,
                    std::max(size.seconds, size.seconds_each) / 60.0));
  };
  how.watch = throw_if_interrupted;
  const validate::Requirement requirement = validate::find_requirement(sweep, how, display.callback());
  const std::string json = report::requirement_json(requirement);
  base::write_file(staged.dir() / "require.json", json);
  report::write_page(staged.dir(), "report.html", report::requirement_report(requirement));
  throw_if_interrupted();
  staged.publish_files();
  display.clear();
  print_answer(options.common.json ? json : report::requirement_text(requirement));
  say(options.common, fmt::format("report: {}", (out / "report.html").string()));
  if (!requirement.any_reached()) {
    throw base::NotMet(fmt::format("{}: nothing reaches {}", options.sweep, fmt::join(options.targets, ", ")));
  }
}

}  // namespace

void add_require(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<RequireOptions>();
  CLI::App* command = app.add_subcommand(
      "require",
      "Find which cameras and settings of a sweep reach a target, cheapest first, and what limits the others");
  command->add_option("SWEEP", options->sweep, "A sweep over cameras or settings (docs/reference/sweep.md)")
      ->type_name("FILE")
      ->required();
  command
      ->add_option(
          "--target", options->targets,
          fmt::format(
              "QUANTITY=VALUE or QUANTITY:error95=VALUE (what 95 % of the errors stay within), QUANTITY:sd=VALUE "
              "(root mean square error) or QUANTITY:bias=VALUE (mean error); quantities are {}",
              fmt::join(core::quantity_keys(), ", ")))
      ->type_name("TARGET")
      ->required();
  command
      ->add_option("--confirm", options->confirm,
                   "How to judge what the bound allows: by rendered \"clips\" (the default if the sweep says level "
                   "= \"clips\"), by \"tracks\" with the predicted noise (the default otherwise), or by \"none\"")
      ->type_name("HOW")
      ->check(CLI::IsMember({"tracks", "clips", "none"}));
  CLI::Option* runs = command
                          ->add_option("--runs", options->runs,
                                       "Maximum number of rendered runs for a camera that may be the one to buy "
                                       "or is close to the target")
                          ->type_name("N")
                          ->check(CLI::Range(2, 100000))
                          ->capture_default_str();
  command->add_option("--track-runs", options->track_runs, "Number of runs per camera as simulated tracks")
      ->type_name("N")
      ->check(CLI::Range(2, 1000000))
      ->capture_default_str();
  add_common_options(*command, options->common, "glidelab-out/require-<name of the sweep file>",
                     "Seed of the runs; default: the sweep's");
  command->callback([options, runs, &chosen] {
    if (runs->count() > 0 && !options->confirm.empty() && options->confirm != "clips") {
      throw CLI::RequiresError("--runs", "--confirm clips");
    }
    chosen = [options] { require_command(*options); };
  });
}

}  // namespace glidelab::app
