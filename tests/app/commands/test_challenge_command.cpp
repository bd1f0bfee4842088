/// glidelab challenge as a user sees it: made, answered, scored.
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "base/files/file_io.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;
using nlohmann::json;
namespace fs = std::filesystem;

TEST_CASE("a challenge is made, answered by two estimators and scored, the better one first") {
  const tests::TempDir temp;
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "challenge");
    arguments.emplace_back("-q");
    return tests::glidelab(arguments, temp.path());
  };
  const tests::ProcessResult made = run({"make", "contest", "--level", "easy", "--cases", "12", "--seed", "5"});
  INFO(made.err);
  REQUIRE(made.status == 0);
  CHECK(fs::exists(temp / "contest.truth.json"));
  CHECK(fs::exists(temp / "contest/case-011/experiment.toml"));
  // Nothing is replaced: a truth that was made is kept.
  CHECK(run({"make", "contest"}).status == 1);

  const tests::ProcessResult own = run({"run", "contest", "--estimator", "trajectory", "-o", "answers/whole"});
  INFO(own.err);
  REQUIRE(own.status == 0);
  // Says 3 ± 2 whatever it sees.
  base::write_file(temp / "mine.sh",
                   R"(clips=$(sed -n 's/^name = \("up-.*"\|"down-.*"\)$/\1/p' "$1/experiment.toml" | paste -sd,)
q='{"value": 3, "sd": 2}'
echo "{\"format\": 1, \"configurations\": [{\"clips\": [$clips], \"k_over_m_1_s\": $q, \"mu\": $q, \"alpha_deg\": $q,
 \"v_lim_m_s\": null}]}" > "$2/results.json")");
  const tests::ProcessResult outside =
      run({"run", "contest", "--estimator-command", "sh mine.sh {folder} {out}", "-o", "answers/mine"});
  INFO(outside.err);
  REQUIRE(outside.status == 0);
  CHECK_THAT(outside.out, Contains("mine: 12 runs, none failed"));

  const tests::ProcessResult scored =
      run({"score", "contest", "answers/mine", "answers/whole", "-o", "scores", "--json"});
  INFO(scored.err);
  REQUIRE(scored.status == 0);
  const json score = json::parse(scored.out);
  CHECK(score.at("challenge").at("level") == "easy");
  CHECK(score == json::parse(base::read_file(temp / "scores/score.json")));
  CHECK(score.at("entrants").at(0).at("name") == "mine");
  for (const json& quantity : score.at("quantities")) {
    INFO(quantity.dump(1));
    const json &mine = quantity.at("entrants").at(0), &whole = quantity.at("entrants").at(1);
    if (mine.at("answers") == 0) {
      CHECK(mine.at("rank").is_null());
      CHECK(mine.at("why").at("rank") == "no answer");
    } else {
      CHECK(mine.at("rank") == 2);  // 12 of 12 cases: p = 2 / 4096
    }
    CHECK(whole.at("rank") == 1);
    CHECK(whole.at("answers") == whole.at("true_values"));
  }
  CHECK_THAT(base::read_file(temp / "scores/report.html"), Contains("is better than mine in 12 of 12 cases"));
  const tests::ProcessResult text = run({"score", "contest", "answers/mine", "answers/whole", "-o", "scores"});
  CHECK_THAT(text.out, Contains("interval score"));

  // A truth that was altered, or is not there.
  base::write_file(temp / "altered.json", base::read_file(temp / "contest.truth.json") + " ");
  const tests::ProcessResult altered = run({"score", "contest", "answers/mine", "--truth", "altered.json", "-o", "x"});
  CHECK(altered.status == 1);
  CHECK_THAT(altered.err, Contains("the truth that was sealed with"));
  CHECK_FALSE(fs::exists(temp / "x"));
}

TEST_CASE("a challenge without a seed has one of its own, with which alone it can be made again") {
  const tests::TempDir temp;
  const auto made = [&](const std::string& name, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"challenge", "make", name, "--cases", "1", "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const tests::ProcessResult result = tests::glidelab(arguments, temp.path());
    INFO(result.err);
    REQUIRE(result.status == 0);
    CHECK_THAT(result.out, Contains(name + ".truth.json, with the seed: keep it secret"));
    return base::read_file(temp / (name + ".truth.json"));
  };
  // Two draws of 53 bits are alike with a probability of 1e-16.
  const std::string one = made("one", {}), two = made("two", {});
  const std::uint64_t seed = json::parse(one).at("seed"), other = json::parse(two).at("seed");
  CHECK(seed != other);
  CHECK(seed < std::uint64_t{1} << 53);
  CHECK(one != two);
  CHECK(made("again", {"--seed", std::to_string(seed)}) == one);
  CHECK(base::read_file(temp / "again/challenge.json") == base::read_file(temp / "one/challenge.json"));
  CHECK(base::read_file(temp / "one/challenge.json").find(std::to_string(seed)) == std::string::npos);
}

TEST_CASE("challenge says which options belong to which action") {
  const tests::TempDir temp;
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"challenge", "make", "c", "--estimator", "trajectory"},
        {"challenge", "run", "c"},
        {"challenge", "run", "c", "--estimator", "trajectory", "--level", "easy"},
        {"challenge", "score", "c"},
        {"challenge", "score", "c", "r", "--cases", "3"},
        {"challenge", "make", "c", "-o", "d"},
        {"challenge", "win", "c"}}) {
    const tests::ProcessResult result = tests::glidelab(wrong, temp.path());
    INFO(result.err);
    CHECK(result.status == 2);
    CHECK(fs::is_empty(temp.path()));
  }
  const tests::ProcessResult none = tests::glidelab({"challenge", "score", "c", "r"}, temp.path());
  CHECK(none.status == 1);
  CHECK_THAT(none.err, Contains("challenge.json"));
}
