#include "validate/challenge/challenge_folder.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <filesystem>
#include <string>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/analysis/analyze.h"
#include "core/experiment/experiment.h"
#include "core/result/quantity.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using namespace glidelab::validate;
namespace fs = std::filesystem;

namespace {

std::string made(const fs::path& folder, ChallengeLevel level, std::uint64_t seed, std::size_t cases, int jobs = 2) {
  fs::create_directories(folder);
  std::string truth = make_challenge(level, seed, cases, folder, jobs);
  base::write_file(truth_file_of(folder), truth);
  return truth;
}

std::string all_of(const fs::path& folder) {
  std::string text;
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) text += fs::relative(file, folder).string() + "\n" + base::read_file(file) + "\n";
  return text;
}

}  // namespace

TEST_CASE("level and seed fix a challenge, another seed makes another, and the folder does not tell the seed") {
  const tests::TempDir temp;
  for (const ChallengeLevel level : {ChallengeLevel::easy, ChallengeLevel::hard}) {
    const std::string name(word(level));
    INFO(name);
    const std::string truth = made(temp / (name + "-a"), level, 987654321, 3, 1);
    CHECK(made(temp / (name + "-b"), level, 987654321, 3) == truth);
    CHECK(all_of(temp / (name + "-a")) == all_of(temp / (name + "-b")));
    CHECK(made(temp / (name + "-c"), level, 987654322, 3) != truth);
    CHECK(all_of(temp / (name + "-a")).find("987654321") == std::string::npos);
    CHECK(truth.find("987654321") != std::string::npos);
  }
}

TEST_CASE("the cases of an easy challenge are those that its truth is of") {
  const tests::TempDir temp;
  made(temp / "easy", ChallengeLevel::easy, 5, 3);
  const Challenge challenge = read_challenge(temp / "easy");
  CHECK(challenge.cases == 3);
  CHECK(challenge.truth_sha256.size() == 64);
  const auto truths = read_sealed_truth(truth_file_of(temp / "easy"), challenge);
  REQUIRE(truths.size() == 3);
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const core::AnalysisResults results = core::analyze({temp / "easy" / case_name(i)}, {});
    REQUIRE(results.configurations.size() == 1);
    REQUIRE(truths[i].size() == 1);
    CHECK(results.configurations[0].clips == truths[i][0].clips);
    for (const core::QuantityName& quantity : core::kQuantities) {
      INFO(quantity.key);
      const std::optional<double> truth = core::value_of(truths[i][0], quantity.which);
      const core::Quantity& found = core::value_of(results.configurations[0], quantity.which);
      if (!truth || !found.estimate) continue;
      CHECK(std::abs(found.estimate->value - *truth) < 5.0 * found.estimate->sd);
    }
    REQUIRE(truths[i][0].k_over_m_1_s);
    CHECK(results.configurations[0].k_over_m_1_s.estimate);
  }
}

TEST_CASE("a truth that was altered is refused, and so is a folder that is no challenge") {
  const tests::TempDir temp;
  const std::string truth = made(temp / "easy", ChallengeLevel::easy, 5, 1);
  const Challenge challenge = read_challenge(temp / "easy");
  base::write_file(temp / "altered.json", truth + " ");
  CHECK_THROWS_AS(read_sealed_truth(temp / "altered.json", challenge), base::InputError);
  CHECK_THROWS_AS(read_sealed_truth(temp / "none.json", challenge), base::InputError);
  CHECK_THROWS_AS(read_challenge(temp.path()), base::InputError);
  base::write_file(temp / "challenge.json", "{\"version\": 99}");
  CHECK_THROWS_AS(read_challenge(temp.path()), base::InputError);
}

TEST_CASE("an everyday challenge states the truth of every clip of its folders") {
  const tests::TempDir temp;
  made(temp / "everyday", ChallengeLevel::everyday, 3, 2);
  const auto truths = read_sealed_truth(truth_file_of(temp / "everyday"), read_challenge(temp / "everyday"));
  for (std::size_t i = 0; i < truths.size(); ++i) {
    const core::Experiment experiment = core::read_experiment(temp / "everyday" / case_name(i));
    std::size_t clips = 0;
    for (const ChallengeConfiguration& of : truths[i]) {
      CHECK_FALSE(of.clips.empty());
      clips += of.clips.size();
    }
    CHECK(clips == experiment.clips.size());
  }
}

TEST_CASE("a challenge's answers are kept with how each run went, and read again") {
  const tests::TempDir temp;
  made(temp / "easy", ChallengeLevel::easy, 5, 3);
  fs::create_directory(temp / "answers");
  std::atomic<int> alone = 0;  // folders that lie by themselves: no case beside it, no truth
  const ChallengeSolver solver = [&](const fs::path& folder) {
    alone += std::distance(fs::directory_iterator(folder.parent_path()), fs::directory_iterator{}) == 1 ? 1 : 0;
    ChallengeAnswer answer;
    answer.run.seconds = 0.5;
    answer.json = "{\"format\": 1, \"configurations\": []}";
    return answer;
  };
  const auto runs = run_challenge(temp / "easy", "mine", "mine {folder} {out}", solver, temp / "answers", 2);
  CHECK(runs.size() == 3);
  CHECK(alone == 3);
  fs::remove_all(temp / "answers" / case_name(1));
  const ChallengeEntrant entrant = read_entrant(temp / "answers", temp / "easy", read_challenge(temp / "easy"));
  CHECK(entrant.name == "mine");
  CHECK(entrant.timed);
  REQUIRE(entrant.cases.size() == 3);
  CHECK(entrant.runs[0].failure == fit::OutsideFailure::none);
  CHECK(entrant.runs[1].failure == fit::OutsideFailure::no_output);
  CHECK(entrant.runs[2].seconds == 0.5);
  CHECK_FALSE(entrant.cases[1].configurations[0].mu.estimate);
  // Of another challenge.
  made(temp / "other", ChallengeLevel::easy, 6, 3);
  CHECK_THROWS_AS(read_entrant(temp / "answers", temp / "other", read_challenge(temp / "other")), base::InputError);
  // Without run.json the name is the folder's; with nothing at all it is none.
  fs::remove(temp / "answers/run.json");
  CHECK(read_entrant(temp / "answers", temp / "easy", read_challenge(temp / "easy")).name == "answers");
  fs::create_directory(temp / "empty");
  CHECK_THROWS_AS(read_entrant(temp / "empty", temp / "easy", read_challenge(temp / "easy")), base::InputError);
}

TEST_CASE("a filmed challenge has images, positions and a truth that its own analysis recovers", "[slow]") {
  const tests::TempDir temp;
  made(temp / "camera", ChallengeLevel::camera, 2, 1);
  const fs::path folder = temp / "camera" / case_name(0);
  CHECK(fs::exists(folder / "tracks/up-1.csv"));
  CHECK(fs::exists(folder / "clips"));
  const auto truths = read_sealed_truth(truth_file_of(temp / "camera"), read_challenge(temp / "camera"));
  const core::AnalysisResults results = core::analyze({folder}, {});
  REQUIRE(results.configurations.at(0).k_over_m_1_s.estimate);
  const core::Estimate& k = *results.configurations[0].k_over_m_1_s.estimate;
  CHECK(std::abs(k.value - truths.at(0).at(0).k_over_m_1_s.value()) < 5.0 * k.sd);
}
