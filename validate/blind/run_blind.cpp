#include "validate/blind/run_blind.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/long_work.h"
#include "base/text/json_text.h"
#include "validate/blind/case/blind_effects.h"
#include "validate/blind/case/blind_filmed_effects.h"
#include "validate/blind/case/everyday_causes.h"

namespace glidelab::validate {
namespace {

namespace fs = std::filesystem;
using Ordered = nlohmann::ordered_json;

void check(const BlindOptions& options) {
  if (options.cases < 1 || options.cases > kMostBlindCases) {
    throw base::InputError(
        base::Issue{"", 0, "--cases", fmt::format("{}", options.cases), fmt::format("1 to {}", kMostBlindCases)});
  }
  if (options.everyday && (options.images || options.leave_out)) {
    throw base::InputError(base::Issue{"", 0, "--everyday", options.images ? "with --films" : "with --leave-out",
                                       "everyday cases are tracks, diagnosed once"});
  }
  if (options.outside && !options.everyday) {
    throw base::InputError(base::Issue{"", 0, "--estimator-command", "an estimator without --everyday",
                                       "--everyday as well: only everyday cases state true values of K/m, mu and "
                                       "alpha, and an estimator names no cause"});
  }
  if (options.only.empty()) return;
  std::string known;
  const auto& library = options.images ? filmed_effects() : options.everyday ? everyday_effects() : library_effects();
  const auto& outside = options.images     ? filmed_outside_effects()
                        : options.everyday ? everyday_outside()
                                           : outside_effects();
  for (const auto* list : {&library, &outside}) {
    for (const std::string& id : *list) {
      if (id == options.only) return;
      known += (known.empty() ? "" : ", ") + id;
    }
  }
  throw base::InputError(base::Issue{"", 0, "--only", fmt::format("\"{}\"", options.only), "one of " + known});
}

/// Checks the settings that two runs must share, except for their number of cases.
void check_same_run(const BlindOptions& options, const fs::path& out) {
  Ordered wanted = {{"format", 1}, {"seed", options.seed}, {"only", options.only}};
  if (options.images) wanted["pictures"] = true;
  if (options.everyday) wanted["everyday"] = true;
  const fs::path file = out / "run.json";
  if (!fs::exists(file)) {
    for (const char* name : {"cases", "diagnoses", "truth"}) {  // whose parts are made again if incomplete
      if (!fs::exists(out / name)) continue;
      throw base::InputError(base::Issue{(out / name).string(), 0, "--out", "a folder that no run of blind made",
                                         "an empty folder, or that of an earlier run (it has a run.json)"});
    }
    base::StagedOutput staged(out);
    base::write_file(staged.dir() / "run.json", base::json_text(wanted) + "\n");
    staged.publish_files();
    return;
  }
  const Ordered found = Ordered::parse(base::read_file(file), nullptr, false);
  if (found == wanted) return;
  throw base::InputError(base::Issue{
      file.string(), 0, "", found.is_discarded() ? "no JSON" : base::json_text(found, base::kOnOneLine),
      "the seed and effect of this run, " + base::json_text(wanted, base::kOnOneLine) + ", or an empty folder"});
}

constexpr const char* kDiagnosis = "diagnosis.json";  // in the folder of a diagnosis,
constexpr const char* kFailure = "failure.txt";       // and its replacement if it failed
constexpr const char* kSeconds = "seconds.txt";

bool is_diagnosed(const fs::path& folder) {
  return fs::exists(folder / kDiagnosis) || fs::exists(folder / kFailure);
}

void diagnose_into(const fs::path& folder, const Diagnoser& diagnose, const fs::path& experiment,
                   const std::vector<std::string>& without) {
  fs::create_directories(folder);
  const std::string failure = diagnose(experiment, folder, without);
  if (!failure.empty()) base::write_file(folder / kFailure, failure);
}

/// The same, with its duration: measured once, when the case is diagnosed.
void diagnose_timed(const fs::path& folder, const Diagnoser& diagnose, const fs::path& experiment) {
  const auto start = std::chrono::steady_clock::now();
  diagnose_into(folder, diagnose, experiment, {});
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  base::write_file(folder / kSeconds, fmt::format("{:.3f}\n", took.count()));
}

std::optional<double> seconds_in(const fs::path& folder) {
  const fs::path file = folder / kSeconds;
  if (!fs::exists(file)) return std::nullopt;
  const std::string text = base::read_file(file);
  double seconds = 0.0;
  if (std::from_chars(text.data(), text.data() + text.size(), seconds).ec == std::errc()) return seconds;
  throw base::InputError(base::Issue{file.string(), 0, "", "\"" + text + "\"", "a number of seconds"});
}

/// The verdict without what the folder itself states.
BlindVerdict verdict_in(const fs::path& folder, const std::vector<std::string>& told) {
  BlindVerdict verdict;
  if (fs::exists(folder / kFailure)) {
    verdict.why = base::read_file(folder / kFailure);
  } else {
    verdict = read_blind_verdict(folder / kDiagnosis);
  }
  set_aside(told, verdict);
  return verdict;
}

/// A case of either kind.
struct Made {
  BlindKind kind = BlindKind::none;
  std::vector<BlindCause> causes;
  std::size_t clips = 0;
  std::vector<std::string> told;
  std::string truth_json;
  std::function<void(const fs::path& folder)> write;
  std::optional<EverydayTruth> everyday = {};
};

/// `look` as in BlindDraw.
Made make_case(const BlindOptions& options, const fs::path& out, std::size_t index, const FilmRenderer& render,
               const std::function<void()>& look) {
  if (options.everyday) {
    const auto one = std::make_shared<EverydayCase>(make_everyday_case(options.seed, index, {options.only, look}));
    return {one->kind,
            one->causes,
            one->design.clips.size(),
            {},
            everyday_truth_json(*one),
            [one](const fs::path& folder) { write_blind_folder(*one, folder); },
            one->truth};
  }
  if (!options.images) {
    const auto one = std::make_shared<BlindCase>(make_blind_case(options.seed, index, {options.only, look}));
    return {one->kind,
            one->causes,
            one->design.clips.size(),
            {},
            blind_truth_json(*one),
            [one](const fs::path& folder) { write_blind_folder(*one, folder); },
            {}};
  }
  const auto one = std::make_shared<FilmedCase>(make_filmed_case(options.seed, index, {options.only, look}));
  const fs::path scratch = out / fmt::format("making-{:04d}", index);
  return {one->kind,
          one->causes,
          one->scene.motion.clips.size(),
          one->told,
          filmed_truth_json(*one),
          [=](const fs::path& folder) { film_blind_folder(*one, folder, scratch, render); },
          {}};
}

/// What the estimator says of a case, whose folder it gets alone.
BlindEstimate estimate_of(const fit::OutsideEstimator& estimator, const Made& one) {
  const base::TemporaryFolder alone("experiment");
  one.write(alone / "experiment");
  fit::OutsideOutcome outcome = fit::run_outside(estimator, alone / "experiment");
  return {std::move(outcome.results), std::move(outcome.run)};
}

/// One whole case; its files are complete once the truth exists.
BlindOutcome run_case(const BlindOptions& options, const fs::path& out, std::size_t index, const Diagnoser& diagnose,
                      const FilmRenderer& render, const std::function<void()>& look) {
  const Made one = make_case(options, out, index, render, look);
  const std::string name = fmt::format("{:04d}", index);
  const fs::path folder = out / "cases" / name, diagnosis = out / "diagnoses" / name;
  const fs::path truth = out / "truth" / (name + ".json");
  const bool leaves_out = options.leave_out && one.kind == BlindKind::single;
  const fs::path without = diagnosis / "left-out";
  const bool done = fs::exists(truth) && is_diagnosed(diagnosis);
  if (done && base::read_file(truth) != one.truth_json) {
    throw base::InputError(base::Issue{truth.string(), 0, "", "a case of another version of this program",
                                       "an empty folder, or the version that made it"});
  }
  if (!done) {
    fs::remove_all(folder);
    fs::remove_all(diagnosis);
    one.write(folder);
    if (one.everyday) {
      diagnose_timed(diagnosis, diagnose, folder);
    } else {
      diagnose_into(diagnosis, diagnose, folder, {});
    }
  }
  std::optional<BlindEstimate> estimate;
  if (options.outside) estimate = estimate_of(*options.outside, one);
  if (leaves_out && !is_diagnosed(without)) diagnose_into(without, diagnose, folder, {one.causes.front().id});
  if (!done) {
    base::StagedOutput staged(out / "truth");
    base::write_file(staged.dir() / truth.filename(), one.truth_json);
    staged.publish_files();
  }
  BlindOutcome outcome{index, one.kind, one.causes, one.clips, {}, {}, options.images, one.everyday, {}};
  if (one.everyday) outcome.seconds = seconds_in(diagnosis);
  outcome.estimate = std::move(estimate);
  outcome.verdict = verdict_in(diagnosis, one.told);
  if (leaves_out) outcome.left_out = verdict_in(without, one.told);
  return outcome;
}

}  // namespace

std::size_t kept_cases(const BlindOptions& options, const fs::path& out) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < options.cases; ++i) kept += fs::exists(out / "truth" / fmt::format("{:04d}.json", i));
  return kept;
}

std::vector<BlindOutcome> run_blind(const BlindOptions& options, const fs::path& out, const Diagnoser& diagnose,
                                    const base::Progress& progress, const FilmRenderer& render) {
  check(options);
  fs::create_directories(out);
  check_same_run(options, out);
  std::vector<BlindOutcome> outcomes(options.cases);
  std::atomic<std::size_t> done{0};
  base::for_each_parallel(options.cases, options.jobs, [&](std::size_t i) {
    const auto look = [&] {
      progress("diagnosing blind cases", static_cast<double>(done) / static_cast<double>(options.cases));
    };
    look();
    outcomes[i] = run_case(options, out, i, diagnose, render, look);
    ++done;
  });
  return outcomes;
}

fit::OutsideTally tally_of(const fit::OutsideEstimator& estimator, const std::vector<BlindOutcome>& outcomes) {
  std::vector<fit::OutsideRun> runs;
  for (const BlindOutcome& outcome : outcomes) {
    if (outcome.estimate) runs.push_back(outcome.estimate->run);
  }
  return fit::tally_of(estimator, runs);
}

}  // namespace glidelab::validate
