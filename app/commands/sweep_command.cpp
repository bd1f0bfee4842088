/// glidelab sweep SWEEP.toml: many scenarios, one database; a repeated run continues where the last one stopped.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <memory>

#include "app/shell/build_version.h"
#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "render/scenario/scenario.h"
#include "report/html/gnuplot.h"
#include "report/sweep/sweep_report.h"
#include "report/text/json_numbers.h"
#include "report/text/why_words.h"
#include "validate/study/sweep/design/read_sweep.h"
#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/design/sweep_scenario.h"
#include "validate/study/sweep/run_sweep.h"
#include "validate/study/sweep/sweep_summary.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kManyRuns = 1000000;

struct SweepOptions {
  CommonOptions common;
  std::string sweep;
  std::string shard;
  std::vector<std::string> merge;
  std::optional<std::uint64_t> show;
  bool many = false;
  bool dry_run = false;
  OutsideOptions outside;
};

constexpr std::uint64_t kMostShards = 1000000000;

/// Reads "2/8"; empty for any other text.
std::optional<validate::Shard> read_shard(const std::string& text) {
  validate::Shard shard;
  const char* const end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, shard.index);
  if (index.ec != std::errc{} || index.ptr == end || *index.ptr != '/') return std::nullopt;
  const auto count = std::from_chars(index.ptr + 1, end, shard.count);
  if (count.ec != std::errc{} || count.ptr != end) return std::nullopt;
  if (shard.index < 1 || shard.index > shard.count || shard.count > kMostShards) return std::nullopt;
  return shard;
}

std::string check_shard(const std::string& text) {
  if (read_shard(text)) return {};
  return fmt::format("\"{}\" is not a part such as 2/8, with at most {} parts", text, kMostShards);
}

std::string bytes_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", bytes / 1e3);
  if (bytes < 1e9) return fmt::format("{:.0f} MB", bytes / 1e6);
  return fmt::format("{:.1f} GB", bytes / 1e9);
}

void show_run(const validate::Sweep& sweep, std::uint64_t run) {
  if (run >= validate::run_count(sweep)) {
    throw base::InputError(base::Issue{sweep.file.string(), 0, "--show", fmt::format("run {}", run),
                                       fmt::format("one of the runs 0 to {}", validate::run_count(sweep) - 1)});
  }
  const validate::RunScenario scenario = validate::scenario_with(sweep, validate::values_of(sweep, run));
  print_result(fmt::format("# run {} of {}, seed {}, noise of tracks {} m\n{}", run, sweep.file.string(),
                           validate::seed_of(sweep, run), scenario.noise_m,
                           render::with_camera_written_in(scenario.text, sweep.scenario_file)));
}

void check_size(const SweepOptions& options, const validate::Sweep& sweep) {
  const std::uint64_t runs = validate::run_count(sweep);
  if (runs > kManyRuns && !options.many) {
    const validate::RunCost cost = validate::cost_of_runs(sweep, {}, runs, options.common.jobs);
    const auto all = static_cast<double>(runs);
    throw base::InputError(base::Issue{options.sweep, 0, "",
                                       fmt::format("{} runs (about {} on {} threads, {} of disk space)", runs,
                                                   duration_text(cost.seconds * all / options.common.jobs),
                                                   options.common.jobs, bytes_text(cost.bytes * all)),
                                       fmt::format("at most {}, or the option --many-runs", kManyRuns)});
  }
}

void finish(const SweepOptions& options, const validate::Sweep& sweep, validate::SweepDatabase& database,
            const fs::path& out, const base::Progress& progress, ProgressDisplay& display) {
  const validate::SweepSummary summary = validate::summarize(sweep, database.database());
  // The shards of a job array share a folder; a page covers all of them.
  const bool page = options.shard.empty();
  if (page) {
    base::StagedOutput staged(out);
    report::write_page(staged.dir(), "report.html", report::sweep_report(summary, progress));
    throw_if_interrupted();
    staged.publish_files();
  }
  display.clear();
  print_answer(options.common.json ? report::sweep_json(summary) : report::sweep_text(summary));
  if (page) say(options.common, fmt::format("report: {}", (out / "report.html").string()));
}

/// For work whose progress is not shown.
void only_interrupts(std::string_view, double) {
  throw_if_interrupted();
}

void say_size(const SweepOptions& options, const validate::SweepEstimate& estimate) {
  say(options.common,
      fmt::format("{} runs, {} still to do: about {} with --jobs {}, {} of disk space in the end ({} free)",
                  estimate.runs, estimate.missing, duration_text(estimate.seconds), options.common.jobs,
                  bytes_text(estimate.bytes), bytes_text(estimate.free_bytes)));
}

std::string estimate_json(const SweepOptions& options, const validate::SweepEstimate& estimate) {
  return report::json_text({{"runs", estimate.runs},
                            {"missing_runs", estimate.missing},
                            {"jobs", options.common.jobs},
                            {"seconds", estimate.seconds},
                            {"bytes", estimate.bytes},
                            {"bytes_to_come", estimate.bytes_to_come},
                            {"free_bytes", estimate.free_bytes}});
}

std::string database_name(const validate::Shard& shard) {
  return shard.count == 1 ? "sweep.sqlite" : fmt::format("sweep-{}-of-{}.sqlite", shard.index, shard.count);
}

/// Nothing is written: if there is no database yet, the size is that of an empty one elsewhere.
void dry_run(const SweepOptions& options, const validate::Sweep& sweep, const validate::Shard& shard,
             const fs::path& out) {
  const base::TemporaryFolder elsewhere("dry-run");
  const bool there = fs::exists(out / database_name(shard));
  validate::SweepDatabase database((there ? out : elsewhere.path()) / database_name(shard), sweep, build_version(),
                                   shard, report::why_words);
  fs::path disk = out, made = out;  // the nearest existing folder, and what would be made in it
  for (; !fs::exists(disk) && disk.has_relative_path(); disk = disk.parent_path()) made = disk;
  if (disk == out) {
    check_writable(out);
  } else {
    check_file_writable(made);
  }
  const validate::SweepEstimate estimate =
      validate::estimate_sweep(sweep, database, shard, options.common.jobs, disk, only_interrupts);
  if (options.common.json) return print_result(estimate_json(options, estimate));
  say_size(options, estimate);
}

/// If nothing was there before, a failed merge leaves nothing.
void merge(const SweepOptions& options, const validate::Sweep& sweep, const fs::path& out) {
  std::vector<fs::path> others;
  for (const std::string& other : options.merge) others.push_back(fs::absolute(other));
  const fs::path file = out / database_name({});
  const bool was_there = fs::exists(file);
  try {
    validate::SweepDatabase(file, sweep, build_version(), {}, report::why_words).merge_runs_of(others);
  } catch (...) {
    std::error_code ignored;  // the error of the merge is the one to report
    if (!was_there) fs::remove(file, ignored);
    throw;
  }
}

/// Runs what is missing and writes the page.
void fill(const SweepOptions& options, const validate::Sweep& sweep, const validate::Shard& shard,
          validate::SweepDatabase& database, const fs::path& out, const base::Progress& progress,
          ProgressDisplay& display) {
  if (options.merge.empty()) {
    const validate::SweepEstimate estimate =
        validate::estimate_sweep(sweep, database, shard, options.common.jobs, out, only_interrupts);
    say_size(options, estimate);
    if (estimate.missing > 0 && estimate.bytes_to_come > estimate.free_bytes) {
      throw base::EnvironmentError(fmt::format("{}: the rest of the sweep needs about {}, and {} are free",
                                               out.string(), bytes_text(estimate.bytes_to_come),
                                               bytes_text(estimate.free_bytes)));
    }
    display.count("runs", estimate.missing);
    const validate::SweepOutcome outcome = validate::run_sweep(sweep, database, shard, options.common.jobs, progress);
    display.clear();
    if (outcome.done > 0) {
      say(options.common, fmt::format("{} runs in {}: {:.3g} runs/s", outcome.done, duration_text(outcome.wall_s),
                                      static_cast<double>(outcome.done) / outcome.wall_s));
    }
  } else if (database.runs() < validate::run_count(sweep)) {
    display.clear();
    say(options.common, fmt::format("incomplete: {} of {} runs are missing; run the sweep without --merge to do them",
                                    validate::run_count(sweep) - database.runs(), validate::run_count(sweep)));
  }
  finish(options, sweep, database, out, progress, display);
}

void sweep_command(const SweepOptions& options) {
  validate::Sweep sweep = validate::read_sweep(options.sweep);
  if (options.common.seed) sweep.seed = *options.common.seed;
  sweep.outside = options.outside.estimator();
  if (options.show) return show_run(sweep, *options.show);
  check_size(options, sweep);
  const validate::Shard shard = read_shard(options.shard).value_or(validate::Shard{});
  if (options.shard.empty()) report::check_gnuplot();
  const fs::path out = output_folder(options.common, "sweep", options.sweep);
  if (options.dry_run) return dry_run(options, sweep, shard, out);
  check_writable(out);
  std::error_code error;
  fs::create_directories(out, error);
  if (error) base::throw_system_error(out.string(), "cannot be made", error.value());

  ProgressDisplay display(options.common.quiet, options.common.verbose);
  const base::Progress progress = display.callback();
  if (!options.merge.empty()) {
    progress("merging", 0.0);
    merge(options, sweep, out);
  }
  validate::SweepDatabase database(out / database_name(shard), sweep, build_version(), shard, report::why_words);
  keep_on_interrupt([&] { fill(options, sweep, shard, database, out, progress, display); },
                    [&] {
                      return fmt::format("{} of {} runs are kept in {}; the same command continues with the rest",
                                         database.runs(), validate::run_count(sweep, shard),
                                         (out / database_name(shard)).string());
                    });
}

}  // namespace

void add_sweep(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<SweepOptions>();
  CLI::App* command = app.add_subcommand(
      "sweep",
      "Run a scenario many times with varied values, and see how errors depend on them (docs/reference/sweep.md)");
  command->add_option("SWEEP", options->sweep, "A sweep file (docs/reference/sweep.md)")->type_name("FILE")->required();
  CLI::Option* shard =
      command
          ->add_option("--shard", options->shard, "Run only part I of N, into a database of its own, and write no page")
          ->type_name("I/N")
          ->check(check_shard);
  CLI::Option* merge = command
                           ->add_option("--merge", options->merge,
                                        "Merge the databases of shards into sweep.sqlite, all or none; runs nothing")
                           ->type_name("FILE")
                           ->excludes(shard);
  CLI::Option* show =
      command->add_option("--show", options->show, "Print the complete scenario of one run, camera included, and stop")
          ->type_name("RUN")
          ->check(check_whole_number)
          ->excludes(shard, merge);
  command->add_flag("--many-runs", options->many, fmt::format("Allow more than {} runs", kManyRuns));
  command
      ->add_flag("--dry-run", options->dry_run,
                 "Print the number of runs, the time and the disk space needed, and stop")
      ->excludes(merge, show);
  add_outside_options(*command, options->outside);
  add_common_options(*command, options->common, "glidelab-out/sweep-<name of the sweep file>",
                     "Seed of the sweep; default: the file's");
  command->callback([options, &chosen] { chosen = [options] { sweep_command(*options); }; });
}

}  // namespace glidelab::app
