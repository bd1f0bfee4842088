#include "validate/challenge/challenge_folder.h"

#include <fmt/format.h>

#include <atomic>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/errors.h"
#include "base/files/child_process.h"
#include "base/files/file_io.h"
#include "base/text/json_text.h"
#include "core/experiment/experiment.h"
#include "core/result/quantity.h"
#include "fit/outside/estimator_results.h"

namespace glidelab::validate {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Ordered = nlohmann::ordered_json;

constexpr const char* kChallengeFile = "challenge.json";
constexpr const char* kRunFile = "run.json";
constexpr const char* kResultsFile = "results.json";

/// 64 hexadecimal digits, as coreutils' sha256sum prints them; anyone can verify them with it.
std::string sha256_of(const fs::path& file) {
  constexpr std::size_t kDigits = 64;
  const base::TemporaryFolder scratch("hash");
  const fs::path log = scratch / "log";
  const int status = base::run_program("sha256sum", {"-b", file.string()}, log, {}, " (coreutils)");
  const std::string said = base::read_file(log);
  // A backslash before it says that the name is quoted.
  const std::string hash = said.substr(said.starts_with("\\") ? 1 : 0, kDigits);
  if (status != 0 || hash.size() != kDigits) {
    throw base::EnvironmentError(fmt::format("sha256sum: {}", said));
  }
  return hash;
}

Ordered json_of(const std::vector<ChallengeConfiguration>& configurations) {
  Ordered list = Ordered::array();
  for (const ChallengeConfiguration& of : configurations) {
    Ordered object;
    object["clips"] = of.clips;
    for (const core::QuantityName& quantity : core::kQuantities) {
      const std::optional<double> value = core::value_of(of, quantity.which);
      object[std::string(quantity.key)] = value ? Ordered(*value) : Ordered(nullptr);
    }
    list.push_back(std::move(object));
  }
  return list;
}

/// Reads it by `read`; InputError with nlohmann's message for a document that is not as this program writes it.
template <typename Read>
auto read_as(const fs::path& file, const Read& read) {
  const std::string text = base::read_file(file);
  try {
    return read(base::parsed_json(text));
  } catch (const json::exception& error) {
    throw base::InputError(base::Issue{file.string(), 0, "", error.what(), "a file that glidelab challenge wrote"});
  }
}

[[noreturn]] void refuse(const fs::path& file, const std::string& key, const std::string& found,
                         const std::string& expected) {
  throw base::InputError(base::Issue{file.string(), 0, key, found, expected});
}

}  // namespace

std::string case_name(std::size_t index) {
  return fmt::format("case-{:03}", index);
}

fs::path truth_file_of(const fs::path& folder) {
  const fs::path whole = folder.has_filename() ? folder : folder.parent_path();
  return whole.string() + ".truth.json";
}

std::string make_challenge(ChallengeLevel level, std::uint64_t seed, std::size_t cases, const fs::path& folder,
                           int jobs, const base::Progress& progress) {
  std::vector<std::vector<ChallengeConfiguration>> truths(cases);
  std::atomic<std::size_t> done = 0;
  base::for_each_parallel(cases, jobs, [&](std::size_t i) {
    truths[i] = make_challenge_case(level, seed, i, folder / case_name(i));
    progress("cases", static_cast<double>(++done) / static_cast<double>(cases));
  });
  Ordered truth;
  truth["format"] = 1;
  truth["version"] = kChallengeVersion;
  truth["level"] = word(level);
  truth["seed"] = seed;
  truth["cases"] = Ordered::array();
  for (const auto& configurations : truths) truth["cases"].push_back(json_of(configurations));
  const std::string text = base::json_text(truth) + "\n";
  const base::TemporaryFolder scratch("seal");
  base::write_file(scratch / "truth.json", text);
  Ordered challenge;
  challenge["format"] = 1;
  challenge["version"] = kChallengeVersion;
  challenge["level"] = word(level);
  challenge["cases"] = cases;
  challenge["truth_sha256"] = sha256_of(scratch / "truth.json");
  base::write_file(folder / kChallengeFile, base::json_text(challenge) + "\n");
  return text;
}

Challenge read_challenge(const fs::path& folder) {
  const fs::path file = folder / kChallengeFile;
  return read_as(file, [&](const json& document) {
    Challenge challenge;
    challenge.version = document.at("version").get<int>();
    if (challenge.version != kChallengeVersion) {
      refuse(file, "version", fmt::format("{}", challenge.version), fmt::format("{}", kChallengeVersion));
    }
    const auto level = challenge_level(document.at("level").get<std::string>());
    if (!level)
      refuse(file, "level", base::json_text(document.at("level"), base::kOnOneLine), "easy, camera, hard or everyday");
    challenge.level = *level;
    challenge.cases = document.at("cases").get<std::size_t>();
    if (challenge.cases == 0 || challenge.cases > kMostChallengeCases) {
      refuse(file, "cases", fmt::format("{}", challenge.cases), fmt::format("1 to {}", kMostChallengeCases));
    }
    challenge.truth_sha256 = document.at("truth_sha256").get<std::string>();
    return challenge;
  });
}

std::vector<std::vector<ChallengeConfiguration>> read_sealed_truth(const fs::path& file, const Challenge& challenge) {
  static_cast<void>(base::read_file(file));  // throws if it does not exist
  const std::string hash = sha256_of(file);
  if (hash != challenge.truth_sha256) {
    refuse(file, "", fmt::format("a file of SHA-256 {}", hash),
           fmt::format("the truth that was sealed with {}", challenge.truth_sha256));
  }
  return read_as(file, [&](const json& document) {
    std::vector<std::vector<ChallengeConfiguration>> truths;
    for (const json& one : document.at("cases")) {
      truths.emplace_back();
      for (const json& object : one) {
        ChallengeConfiguration& of = truths.back().emplace_back();
        of.clips = object.at("clips").get<std::vector<std::string>>();
        for (const core::QuantityName& quantity : core::kQuantities) {
          const json& value = object.at(std::string(quantity.key));
          if (!value.is_null()) core::value_of(of, quantity.which) = value.get<double>();
        }
      }
    }
    return truths;
  });
}

std::vector<fit::OutsideRun> run_challenge(const fs::path& folder, const std::string& name, const std::string& command,
                                           const ChallengeSolver& solver, const fs::path& results, int jobs,
                                           const base::Progress& progress) {
  const Challenge challenge = read_challenge(folder);
  std::vector<fit::OutsideRun> runs(challenge.cases);
  std::atomic<std::size_t> done = 0;
  base::for_each_parallel(challenge.cases, jobs, [&](std::size_t i) {
    const base::TemporaryFolder alone("experiment");
    const fs::path copy = alone / "experiment";
    fs::copy(folder / case_name(i), copy, fs::copy_options::recursive);
    ChallengeAnswer answer = solver(copy);
    runs[i] = std::move(answer.run);
    if (!answer.json.empty()) {
      fs::create_directories(results / case_name(i));
      base::write_file(results / case_name(i) / kResultsFile, answer.json);
    }
    progress("cases", static_cast<double>(++done) / static_cast<double>(challenge.cases));
  });
  Ordered document;
  document["format"] = 1;
  document["name"] = name;
  document["command"] = command;
  document["truth_sha256"] = challenge.truth_sha256;
  document["cases"] = Ordered::array();
  for (const fit::OutsideRun& run : runs) {
    document["cases"].push_back({{"failure", fit::key_of(run.failure)}, {"what", run.what}, {"seconds", run.seconds}});
  }
  base::write_file(results / kRunFile, base::replaced_json_text(document) + "\n");
  return runs;
}

namespace {

/// Name, command and runs of run.json.
void read_run(const fs::path& file, const Challenge& challenge, ChallengeEntrant& entrant) {
  read_as(file, [&](const json& document) {
    entrant.name = document.at("name").get<std::string>();
    entrant.command = document.at("command").get<std::string>();
    if (document.at("truth_sha256").get<std::string>() != challenge.truth_sha256 ||
        document.at("cases").size() != challenge.cases) {
      refuse(file, "truth_sha256", "that of another challenge", challenge.truth_sha256);
    }
    for (std::size_t i = 0; i < challenge.cases; ++i) {
      const json& one = document.at("cases").at(i);
      const std::string key = one.at("failure").get<std::string>();
      for (const fit::OutsideFailure failure : fit::kOutsideFailures) {
        if (fit::key_of(failure) == key) entrant.runs[i].failure = failure;
      }
      entrant.runs[i].what = one.at("what").get<std::string>();
      entrant.runs[i].seconds = one.at("seconds").get<double>();
    }
    return 0;
  });
  entrant.timed = true;
}

}  // namespace

ChallengeEntrant read_entrant(const fs::path& results, const fs::path& folder, const Challenge& challenge) {
  ChallengeEntrant entrant;
  entrant.name = (results.has_filename() ? results : results.parent_path()).filename().string();
  entrant.runs.resize(challenge.cases);
  if (fs::exists(results / kRunFile)) read_run(results / kRunFile, challenge, entrant);
  std::size_t answers = 0;
  for (std::size_t i = 0; i < challenge.cases; ++i) {
    const std::vector<core::ClipSetup> clips = core::read_experiment(folder / case_name(i)).clips;
    const fs::path file = results / case_name(i) / kResultsFile;
    fit::OutsideRun& run = entrant.runs[i];
    if (fs::exists(file)) {
      ++answers;
      try {
        entrant.cases.push_back(fit::read_estimator_results(base::read_file(file), file, clips, entrant.name));
        continue;
      } catch (const base::InputError& error) {
        run.failure = fit::OutsideFailure::bad_output;
        run.what = error.what();
      }
    } else if (run.failure == fit::OutsideFailure::none) {
      run.failure = fit::OutsideFailure::no_output;
      run.what = "no results.json";
    }
    entrant.cases.push_back(fit::undetermined_results(clips, entrant.name, core::unknown::Told{fit::why_of(run)}));
  }
  if (answers == 0 && !entrant.timed) {
    refuse(results, "", "no answer", fmt::format("{}/{} and others", case_name(0), kResultsFile));
  }
  return entrant;
}

}  // namespace glidelab::validate
