/// A challenge on disk: public cases, and a truth that is sealed until the answers are in.
///
///     OUT/challenge.json    {"format": 1, "version", "level", "cases", "truth_sha256"}
///     OUT/case-000/, …      experiment folders (challenge_case.h)
///     OUT.truth.json        {"format": 1, "version", "level", "seed", "cases": [[{"clips", "k_over_m_1_s", …}]]}
///
/// The hash of the truth's file is known from the start, so the truth cannot be altered once the answers are known. The
/// seed appears only in the truth: with it, the same cases and their truth can be made again.
///
///     RESULTS/run.json               {"format": 1, "name", "command", "cases": [{"failure", "what", "seconds"}]}
///     RESULTS/case-000/results.json  an answer (fit/outside/estimator_results.h); missing if the run failed
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/long_work.h"
#include "core/result/results.h"
#include "fit/outside/outside_tally.h"
#include "validate/challenge/challenge_case.h"

namespace glidelab::validate {

inline constexpr std::size_t kMostChallengeCases = 1000;

struct Challenge {
  int version = kChallengeVersion;
  ChallengeLevel level = ChallengeLevel::easy;
  std::size_t cases = 0;
  std::string truth_sha256;
};

/// "case-000".
std::string case_name(std::size_t index);
/// OUT.truth.json beside OUT.
std::filesystem::path truth_file_of(const std::filesystem::path& folder);

/// Writes the folder's contents (it exists and is empty) and returns the text of the truth's file. EnvironmentError if
/// `sha256sum` cannot be run.
std::string make_challenge(ChallengeLevel level, std::uint64_t seed, std::size_t cases,
                           const std::filesystem::path& folder, int jobs,
                           const base::Progress& progress = base::no_progress);

/// InputError for a folder that is not a challenge of this version.
Challenge read_challenge(const std::filesystem::path& folder);

/// The truth for each configuration of each case. InputError if the file is not the sealed one.
std::vector<std::vector<ChallengeConfiguration>> read_sealed_truth(const std::filesystem::path& file,
                                                                   const Challenge& challenge);

/// An answer to one case: the outcome of the run, and results.json (empty if it failed).
struct ChallengeAnswer {
  fit::OutsideRun run;
  std::string json;
};
/// Solves a case, whose folder lies on its own.
using ChallengeSolver = std::function<ChallengeAnswer(const std::filesystem::path& folder)>;

/// Solves every case and writes run.json and the answers into `results` (exists, empty).
std::vector<fit::OutsideRun> run_challenge(const std::filesystem::path& folder, const std::string& name,
                                           const std::string& command, const ChallengeSolver& solver,
                                           const std::filesystem::path& results, int jobs,
                                           const base::Progress& progress = base::no_progress);

/// One entrant's answers to all cases.
struct ChallengeEntrant {
  std::string name;
  std::string command;                       ///< empty without run.json
  std::vector<core::AnalysisResults> cases;  ///< all undetermined, with the reason, if there is no answer
  std::vector<fit::OutsideRun> runs;         ///< of each case
  bool timed = false;                        ///< run.json gives the duration of each
};

/// Without run.json the name is the folder's, and a case without results.json counts as failed. InputError if there is
/// no answer at all, or if run.json does not belong to this challenge.
ChallengeEntrant read_entrant(const std::filesystem::path& results, const std::filesystem::path& folder,
                              const Challenge& challenge);

}  // namespace glidelab::validate
