/// glidelab challenge make|run|score FOLDER: cases with a sealed truth, answers to them, and a ranking.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <memory>
#include <random>

#include "app/shell/cli.h"
#include "app/shell/common_options.h"
#include "app/shell/run_control.h"
#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/analysis/analyze.h"
#include "fit/estimators.h"
#include "report/analysis/result_files.h"
#include "report/challenge/challenge_report.h"
#include "report/html/gnuplot.h"
#include "report/text/outside_text.h"
#include "validate/challenge/challenge_folder.h"
#include "validate/challenge/challenge_score.h"

namespace glidelab::app {
namespace {

namespace fs = std::filesystem;

struct ChallengeCommand {
  CommonOptions common;
  std::string action, folder, level = "easy", truth, estimator;
  std::size_t cases = 20;
  std::vector<std::string> results;
  OutsideOptions outside;
};

void refuse_to_replace(const fs::path& path) {
  if (!fs::exists(path)) return;
  throw base::InputError(base::Issue{path.string(), 0, "", "something that exists", "a new name"});
}

/// A seed that nobody can guess, for with it anybody could make the truth. It has 53 bits, which every reader of JSON
/// keeps.
std::uint64_t drawn_seed() {
  std::random_device random;
  const std::uint64_t high = random(), low = random();
  return ((high << 32) ^ low) >> 11;
}

void make(const ChallengeCommand& options) {
  const fs::path folder = fs::absolute(options.folder);
  const fs::path truth = validate::truth_file_of(folder);
  refuse_to_replace(folder);
  refuse_to_replace(truth);
  check_file_writable(truth);
  base::StagedOutput staged(folder);
  ProgressDisplay display(options.common.quiet, options.common.verbose);
  const std::uint64_t seed = options.common.seed ? *options.common.seed : drawn_seed();
  const std::string text = validate::make_challenge(*validate::challenge_level(options.level), seed, options.cases,
                                                    staged.dir(), options.common.jobs, display.callback());
  throw_if_interrupted();
  write_whole(truth, text);
  staged.publish_whole();
  display.clear();
  const std::string made = base::read_file(folder / "challenge.json");
  print_result(options.common.json
                   ? made
                   : fmt::format("{} cases in {}\nthe truth is in {}, with the seed: keep it secret until all "
                                 "answers are in; its SHA-256 is in challenge.json\n",
                                 options.cases, folder.string(), truth.string()));
}

/// The answer of one of Glidelab's own estimators.
validate::ChallengeAnswer solved(const fit::Estimator& estimator, const fs::path& folder) {
  const auto start = std::chrono::steady_clock::now();
  validate::ChallengeAnswer answer;
  try {
    core::AnalysisOptions how;
    how.lines = estimator.lines;
    core::AnalysisResults results = estimator.estimate(core::analyze({folder}, how), {});
    results.estimator = estimator.name;
    answer.json = report::results_json(results);
  } catch (const base::InputError& error) {
    answer.run = {fit::OutsideFailure::exit_status, error.what()};
  } catch (const base::NumericalError& error) {
    answer.run = {fit::OutsideFailure::exit_status, error.what()};
  }
  answer.run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return answer;
}

void answer(const ChallengeCommand& options) {
  const std::optional<fit::OutsideEstimator> outside = options.outside.estimator();
  const fit::Estimator* const own = fit::find_estimator(options.estimator);
  const std::string name = outside ? outside->name : options.estimator;
  const fs::path out = options.common.out.empty() ? fs::absolute("glidelab-out") / ("answers-" + name)
                                                  : fs::absolute(options.common.out);
  refuse_to_replace(out);
  base::StagedOutput staged(out);
  ProgressDisplay display(options.common.quiet, options.common.verbose);
  const validate::ChallengeSolver solver = [&](const fs::path& folder) {
    if (!outside) return solved(*own, folder);
    fit::OutsideOutcome outcome = fit::run_outside(*outside, folder);
    return validate::ChallengeAnswer{std::move(outcome.run), std::move(outcome.json)};
  };
  const std::string command = outside ? options.outside.command : "glidelab analyze --estimator " + name;
  const std::vector<fit::OutsideRun> runs = validate::run_challenge(options.folder, name, command, solver, staged.dir(),
                                                                    options.common.jobs, display.callback());
  throw_if_interrupted();
  staged.publish_whole();
  display.clear();
  const fit::OutsideTally tally = fit::tally_of(name, command, runs);
  print_result(options.common.json ? report::json_text(report::outside_json(tally))
                                   : fmt::format("{}\nanswers: {}\n", report::outside_text(tally), out.string()));
}

void score(const ChallengeCommand& options) {
  report::check_gnuplot();
  const fs::path out = output_folder(options.common, "challenge", options.folder);
  check_writable(out);
  const validate::Challenge challenge = validate::read_challenge(options.folder);
  const auto truths = validate::read_sealed_truth(
      options.truth.empty() ? validate::truth_file_of(options.folder) : fs::path(options.truth), challenge);
  std::vector<validate::ChallengeEntrant> entrants;
  for (const std::string& results : options.results) {
    entrants.push_back(validate::read_entrant(results, options.folder, challenge));
  }
  const validate::ChallengeScore scored = validate::score_challenge(challenge, truths, entrants);
  const std::string json = report::challenge_json(scored);
  base::StagedOutput staged(out);
  base::write_file(staged.dir() / "score.json", json);
  report::write_page(staged.dir(), "report.html", report::challenge_page(scored));
  throw_if_interrupted();
  staged.publish_files();
  print_answer(options.common.json ? json : report::challenge_text(scored));
  say(options.common, fmt::format("report: {}", (out / "report.html").string()));
}

/// Checks which options an action needs and which it does not use.
void check_use(const CLI::App& command, const ChallengeCommand& options) {
  const auto given = [&](const char* name) { return command.get_option(name)->count() > 0; };
  const auto only_for = [&](const char* action, std::initializer_list<const char*> names) {
    if (options.action == action) return;
    for (const char* name : names) {
      if (given(name)) throw CLI::ValidationError(name, fmt::format("only for challenge {}", action));
    }
  };
  only_for("make", {"--level", "--cases", "--seed"});
  only_for("run", {"--estimator", "--estimator-command"});
  only_for("score", {"--truth", "RESULTS"});
  if (options.action == "make" && given("--out"))
    throw CLI::ValidationError("--out", "FOLDER already says where it goes");
  if (options.action == "run" && given("--estimator") == given("--estimator-command")) {
    throw CLI::RequiresError("challenge run", "either --estimator or --estimator-command");
  }
  if (options.action == "score" && options.results.empty()) throw CLI::RequiresError("challenge score", "RESULTS");
}

}  // namespace

void add_challenge(CLI::App& app, Command& chosen) {
  auto options = std::make_shared<ChallengeCommand>();
  CLI::App* command = app.add_subcommand("challenge",
                                         "Make experiments with a sealed truth (make), have an estimator answer them "
                                         "(run), and rank the answers of several "
                                         "estimators (score)");
  command->add_option("ACTION", options->action, "What to do")
      ->type_name("make|run|score")
      ->check(CLI::IsMember({"make", "run", "score"}))
      ->required();
  command->add_option("FOLDER", options->folder, "The challenge; its truth is FOLDER.truth.json")
      ->type_name("DIR")
      ->required();
  command->add_option("RESULTS", options->results, "For score: a folder of answers for each entrant")->type_name("DIR");
  std::vector<std::string> levels;
  for (const validate::ChallengeLevel level : validate::kChallengeLevels) levels.emplace_back(word(level));
  command->add_option("--level", options->level, "For make: how hard the cases are")
      ->check(CLI::IsMember(levels))
      ->capture_default_str();
  command->add_option("--cases", options->cases, "For make: number of cases")
      ->check(CLI::Range(std::size_t{1}, validate::kMostChallengeCases))
      ->capture_default_str();
  command->add_option("--truth", options->truth, "For score: the truth's file, if it lies elsewhere")
      ->type_name("FILE");
  command->add_option("--estimator", options->estimator, "For run: one of Glidelab's own estimators")
      ->check(CLI::IsMember(fit::estimator_names()));
  add_outside_options(*command, options->outside, "For run: an estimator of your own");
  add_common_options(*command, options->common,
                     "glidelab-out/answers-<name of the estimator>, glidelab-out/challenge-<name of the folder>",
                     "For make: seed of the cases, stored only in the truth file; default: drawn at random");
  command->callback([options, command, &chosen] {
    check_use(*command, *options);
    chosen = [options] {
      if (options->action == "make") return make(*options);
      if (options->action == "run") return answer(*options);
      score(*options);
    };
  });
}

}  // namespace glidelab::app
