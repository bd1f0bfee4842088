#include "fit/outside/outside_estimator.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/readable_text.h"
#include "core/experiment/experiment.h"
#include "fit/estimators.h"
#include "fit/outside/estimator_results.h"

namespace glidelab::fit {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kFolder = "{folder}", kOut = "{out}";

/// Everything that is wrong with a file, for a line of a report.
std::string on_one_line(const std::vector<base::Issue>& issues) {
  constexpr std::size_t kMost = 20;  // as of a message
  std::vector<std::string> parts;
  for (const base::Issue& issue : issues) {
    if (parts.size() == kMost) {
      parts.push_back(fmt::format("and {} more", issues.size() - kMost));
      break;
    }
    parts.push_back(base::describe(issue));
  }
  return fmt::format("{}", fmt::join(parts, "; "));
}

[[noreturn]] void refuse(std::string found, std::string expected) {
  throw base::InputError(base::Issue{"", 0, "--estimator-command", std::move(found), std::move(expected)});
}

std::vector<std::string> words_in(std::string_view command) {
  std::vector<std::string> words;
  std::string word;
  bool begun = false;
  char quote = 0;
  for (std::size_t i = 0; i < command.size(); ++i) {
    const char c = command[i];
    if (c == '\\' && quote != '\'') {
      if (i + 1 == command.size()) refuse("a backslash at the end", "a character after it");
      word += command[++i];
      begun = true;
    } else if (quote != 0) {
      if (c == quote) {
        quote = 0;
      } else {
        word += c;
      }
    } else if (c == '\'' || c == '"') {
      quote = c;
      begun = true;
    } else if (c == ' ' || c == '\t' || c == '\n') {
      if (begun) words.push_back(std::move(word));
      word.clear();
      begun = false;
    } else {
      word += c;
      begun = true;
    }
  }
  if (quote != 0) refuse(fmt::format("a {} that is not closed", quote), "quotes in pairs");
  if (begun) words.push_back(std::move(word));
  return words;
}

std::string replaced(std::string text, std::string_view what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

/// The last non-empty line of the program's output, shortened; UTF-8 whatever it wrote.
std::string last_line(const fs::path& log) {
  constexpr std::size_t kMostShown = 200;
  const std::string text = fs::exists(log) ? base::read_file(log) : std::string();
  const std::size_t end = text.find_last_not_of(" \t\r\n");
  if (end == std::string::npos) return {};
  const std::size_t start = text.rfind('\n', end);
  const std::string line =
      base::valid_utf8(text.substr(start == std::string::npos ? 0 : start + 1, end - (start + 1) + 1));
  return line.size() > kMostShown ? base::first_bytes(line, kMostShown) + "…" : line;
}

OutsideRun run_of(const base::ProgramEnd& end, const OutsideEstimator& estimator, const fs::path& log) {
  OutsideRun run{OutsideFailure::none, {}, end.wall_s};
  const auto failed = [&](OutsideFailure kind, std::string what) {
    run.failure = kind;
    run.what = std::move(what);
    if (const std::string said = last_line(log); !said.empty()) run.what += ": " + said;
  };
  if (end.by == base::ProgramEndedBy::time) {
    failed(OutsideFailure::time_out, fmt::format("not done after {} s", estimator.limits.wall_s));
  } else if (WIFSIGNALED(end.status)) {
    const char* const name = ::sigabbrev_np(WTERMSIG(end.status));
    failed(OutsideFailure::signal, name == nullptr ? fmt::format("signal {}", WTERMSIG(end.status))
                                                   : fmt::format("signal {} (SIG{})", WTERMSIG(end.status), name));
  } else if (WEXITSTATUS(end.status) != 0) {
    failed(OutsideFailure::exit_status, fmt::format("exit status {}", WEXITSTATUS(end.status)));
    if (!estimator.function.empty()) {
      const bool wrong = WEXITSTATUS(end.status) == kWrongAnswer;
      run.failure = wrong ? OutsideFailure::bad_output : OutsideFailure::raised;
      run.what = last_line(log);
    }
  }
  return run;
}

}  // namespace

OutsideEstimator outside_estimator(std::string_view command, std::string name) {
  OutsideEstimator estimator;
  estimator.words = words_in(command);
  const auto holds = [](std::string_view what) {
    return [what](const std::string& word) { return word.find(what) != std::string::npos; };
  };
  for (const std::string_view what : {kFolder, kOut}) {
    if (std::ranges::none_of(estimator.words, holds(what))) {
      refuse(fmt::format("\"{}\"", command), fmt::format("a command with {} in it", what));
    }
  }
  const auto placeholder = std::ranges::find_if(
      estimator.words, [&](const std::string& word) { return holds(kFolder)(word) || holds(kOut)(word); });
  if (placeholder == estimator.words.begin()) {
    refuse(fmt::format("\"{}\"", command), "a program before {folder} and {out}");
  }
  // The nearest preceding word that is not an option.
  auto named = std::prev(placeholder);
  while (named != estimator.words.begin() && named->starts_with("-")) --named;
  estimator.name = name.empty() ? fs::path(*named).stem().string() : std::move(name);
  if (!base::is_program(estimator.words.front())) {
    refuse(fmt::format("\"{}\"", estimator.words.front()), "a program that can be run");
  }
  if (find_estimator(estimator.name) != nullptr) {
    refuse(fmt::format("the name {}", estimator.name),
           "another one (--estimator-name): an estimator of Glidelab has this name");
  }
  return estimator;
}

OutsideOutcome run_outside(const OutsideEstimator& estimator, const fs::path& folder) {
  const std::vector<core::ClipSetup> clips = core::read_experiment(folder).clips;
  const base::TemporaryFolder scratch("estimator");
  const fs::path out = scratch / "out", log = scratch / "log";
  fs::create_directory(out);
  std::vector<std::string> words;
  for (const std::string& word : estimator.words) {
    words.push_back(replaced(replaced(word, kFolder, folder.string()), kOut, out.string()));
  }
  const std::string program = words.front();
  words.erase(words.begin());
  const base::ProgramEnd end = base::run_limited(program, words, log, estimator.limits, estimator.stop);
  if (end.by == base::ProgramEndedBy::request) throw base::Interrupted();
  OutsideOutcome outcome;
  outcome.run = run_of(end, estimator, log);
  const fs::path file = out / "results.json";
  if (outcome.run.failure == OutsideFailure::none && !fs::is_regular_file(file)) {
    outcome.run.failure = OutsideFailure::no_output;
    outcome.run.what = "no results.json in {out}";
  }
  if (outcome.run.failure == OutsideFailure::none) {
    try {
      constexpr std::uintmax_t kLargest_bytes = 1 << 26;
      if (fs::file_size(file) > kLargest_bytes) {
        throw base::InputError(base::Issue{"results.json", 0, "", fmt::format("{} bytes", fs::file_size(file)),
                                           fmt::format("at most {}", kLargest_bytes)});
      }
      outcome.json = base::read_file(file);
      outcome.results = read_estimator_results(outcome.json, "results.json", clips, estimator.name);
      return outcome;
    } catch (const base::InputError& error) {
      outcome.run.failure = OutsideFailure::bad_output;
      outcome.run.what = base::valid_utf8(on_one_line(error.issues()));
      outcome.json.clear();
    }
  }
  outcome.results = undetermined_results(clips, estimator.name, core::unknown::Told{why_of(outcome.run)});
  return outcome;
}

std::string command_text(const OutsideEstimator& estimator) {
  if (!estimator.function.empty()) return "the function " + estimator.function;
  return fmt::format("{}", fmt::join(estimator.words, " "));
}

OutsideTally tally_of(const OutsideEstimator& estimator, const std::vector<OutsideRun>& runs) {
  return tally_of(estimator.name, command_text(estimator), runs);
}

}  // namespace glidelab::fit
