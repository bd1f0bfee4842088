/// An estimator written by someone else: a program that reads an experiment folder and writes results.json.
///
/// It runs in a process of its own, once for every experiment, within limits of time and memory. A failure of the
/// program counts as an outcome and is not an error: every quantity is then undetermined, and `why` says how the run
/// failed.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/files/child_process.h"
#include "core/result/results.h"
#include "fit/outside/outside_tally.h"

namespace glidelab::fit {

struct OutsideEstimator {
  std::string name;                ///< in results: no name of fit/estimators.h
  std::vector<std::string> words;  ///< of the command, with {folder} and {out} in them
  base::ProgramLimits limits = {};
  /// The name of a function, if all that the program does is to have it called: it stands for the words, and an exit
  /// status other than 0 means that the function raised an exception (kRaised), whose type, text and place the program
  /// prints, or that it gave a wrong answer (kWrongAnswer).
  std::string function = {};
  std::function<bool()> stop = {};  ///< polled while it runs; once true, the program is ended and Interrupted is thrown
};

/// Exit statuses of a program that has a function called.
inline constexpr int kRaised = 1, kWrongAnswer = 2;

/// In results: its words, or "the function mine".
std::string command_text(const OutsideEstimator& estimator);

/// From a command line such as "python3 mine.py {folder} {out}". Words are separated by blanks; '…' and "…" keep blanks
/// together, and a backslash keeps the next character as it is. No shell reads it: no other character is special.
/// If `name` is not given, it is the name of the file before the first word with a placeholder, without its extension:
/// "mine". InputError if a quote is not closed, {folder} or {out} is missing, there is no such program, or the name is
/// one of fit/estimators.h.
OutsideEstimator outside_estimator(std::string_view command, std::string name = {});

struct OutsideOutcome {
  core::AnalysisResults results;  ///< all configurations of the folder, all undetermined if it failed
  OutsideRun run;
  std::string json;  ///< results.json as it was written; empty if it failed
};

/// Runs the estimator on an experiment folder in place; the parent folder should hold nothing else. {out} is a new,
/// empty folder. InputError if the experiment cannot be read; EnvironmentError if the program cannot be started or
/// there is no room for its files.
OutsideOutcome run_outside(const OutsideEstimator& estimator, const std::filesystem::path& folder);

/// The tally of this estimator's runs.
OutsideTally tally_of(const OutsideEstimator& estimator, const std::vector<OutsideRun>& runs);

}  // namespace glidelab::fit
