/// --estimator-command as a user sees it: in validate, coverage, sweep and the gate.
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/files/file_io.h"
#include "test_paths.h"
#include "tests/app/run_process.h"
#include "tests/catch.h"
#include "tests/small_scenario.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"

using namespace glidelab;
using Catch::Matchers::Contains;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// Glidelab's own default estimator as somebody else's program.
std::string analyze_command() {
  return std::string(tests::kBinary) + " analyze {folder} -o {out} -q --jobs 1";
}

/// The rows of one estimator and quantity.
std::vector<json> rows_of(const json& document, const std::string& estimator, const std::string& quantity) {
  std::vector<json> rows;
  for (const json& row : document.at("quantities")) {
    if (row.at("estimator") == estimator && row.at("quantity") == quantity) rows.push_back(row);
  }
  return rows;
}

}  // namespace

TEST_CASE("validate judges an outside program beside its own estimators, and keeps what it wrote") {
  const tests::TempDir temp;
  base::write_file(temp / "small.toml", tests::kSmallScenario);
  const tests::ProcessResult result =
      tests::glidelab({"validate", "small.toml", "--out", "out", "--json", "--estimator-command", analyze_command(),
                       "--estimator-seconds", "600"},
                      temp.path());
  INFO(result.err);
  REQUIRE(result.status == 0);
  const json document = json::parse(result.out);
  CHECK(document.at("quantities").size() == 12);
  CHECK(document.at("outside").at("failed") == 0);
  CHECK(document.at("outside").at("name") == "analyze");
  CHECK(document.at("outside").at("mean_s").get<double>() > 0.0);
  for (const char* quantity : {"k_over_m_1_s", "mu", "alpha_deg", "v_lim_m_s"}) {
    INFO(quantity);
    const std::vector<json> inside = rows_of(document, "phase-diagram", quantity);
    const std::vector<json> outside = rows_of(document, "analyze", quantity);
    REQUIRE(outside.size() == inside.size());
    // The same program on the same images, by way of a file with all digits.
    CHECK(outside[0].at("value") == inside[0].at("value"));
    CHECK(outside[0].at("sd") == inside[0].at("sd"));
  }
  CHECK(base::read_file(temp / "out/results-analyze.json") == base::read_file(temp / "out/results.json"));
  CHECK(base::read_file(temp / "out/report.html").find("squares: analyze") != std::string::npos);
}

TEST_CASE("validate judges the example that takes finite differences") {
  const char* const python = "/usr/bin/python3";
  if (!fs::exists(python)) {
    WARN("skipped: no /usr/bin/python3");
    return;
  }
  const tests::TempDir temp;
  base::write_file(temp / "small.toml", tests::kSmallScenario);
  const std::string example = std::string(tests::kSourceDir) + "/examples/estimators/finite_differences.py";
  const tests::ProcessResult result =
      tests::glidelab({"validate", "small.toml", "--out", "out", "--json", "--estimator-command",
                       std::string(python) + " -B '" + example + "' {folder} {out}"},
                      temp.path());
  INFO(result.err);
  REQUIRE(result.status == 0);
  const json document = json::parse(result.out);
  CHECK(document.at("outside").at("failures") == json::object());
  const std::vector<json> k = rows_of(document, "finite_differences", "k_over_m_1_s");
  REQUIRE(k.size() == 1);
  // Second differences at 100 Hz of positions good to some 0.02 mm: a to 0.1 m/s², K/m of 250 points to some 10 %.
  CHECK(std::abs(k[0].at("error").get<double>()) < 0.5 * k[0].at("truth").get<double>());
  CHECK(rows_of(document, "finite_differences", "alpha_deg").at(0).at("value").is_number());
}

TEST_CASE("every example of an estimator answers for a film's positions, or says which package is missing") {
  const char* const python = "/usr/bin/python3";
  if (!fs::exists(python)) {
    WARN("skipped: no /usr/bin/python3");
    return;
  }
  const tests::TempDir temp;
  base::write_file(temp / "small.toml", tests::kSmallScenario);
  const fs::path examples = fs::path(tests::kSourceDir) / "examples/estimators";
  // A stand-in for an estimator that keeps the folder that it is given.
  const tests::ProcessResult filmed =
      tests::glidelab({"validate", "small.toml", "--out", "out", "--json", "--estimator-command",
                       "sh -c 'cp -r \"$1\" \"" + (temp / "given").string() + "\"; exit 1' keep {folder} {out}"},
                      temp.path());
  INFO(filmed.err);
  REQUIRE(filmed.status == 0);
  const json truth = rows_of(json::parse(filmed.out), "phase-diagram", "k_over_m_1_s").at(0).at("truth");
  std::size_t answered = 0, examples_tried = 0;
  for (const fs::directory_entry& example : fs::directory_iterator(examples)) {
    if (example.path().extension() != ".py" || example.path().stem() == "experiment_folder") continue;
    ++examples_tried;
    const fs::path out = temp / example.path().stem().string();
    fs::create_directories(out);
    const tests::ProcessResult result =
        tests::run({python, "-B", example.path().string(), (temp / "given").string(), out.string()});
    INFO(example.path() << ": " << result.err);
    if (result.status != 0) {
      CHECK_THAT(result.err, Catch::Matchers::StartsWith("skipped: no "));
      // Not the word that makes ctest count the whole test as skipped: the others are judged. tools/test names both.
      WARN("not run: " << example.path().filename().string() << ", "
                       << result.err.substr(std::string("skipped: ").size()));
      continue;
    }
    ++answered;
    const json results = json::parse(base::read_file(out / "results.json"));
    const json k = results.at("configurations").at(0).at("k_over_m_1_s");
    // Second differences at 100 Hz of positions good to some 0.02 mm: a to 0.1 m/s², K/m of 250 points to some 10 %.
    CHECK(std::abs(k.at("value").get<double>() - truth.get<double>()) < 0.5 * truth.get<double>());
  }
  CHECK(examples_tried == 8);
  CHECK(answered > 0);
}

TEST_CASE("an outside program that fails is told with its kind and last words, and the command ends well") {
  const tests::TempDir temp;
  base::write_file(temp / "small.toml", tests::kSmallScenario);
  const tests::ProcessResult result =
      tests::glidelab({"validate", "small.toml", "--out", "out", "--json", "--estimator-command",
                       "sh -c 'ls \"$1\"/..; echo no idea >&2; exit 9' mine {folder} {out}"},
                      temp.path());
  INFO(result.err);
  REQUIRE(result.status == 0);
  const json document = json::parse(result.out);
  CHECK(document.at("outside").at("failures").at("exit_status").at("count") == 1);
  CHECK(document.at("outside").at("failures").at("exit_status").at("first") == "exit status 9: no idea");
  const json row = rows_of(document, "mine", "mu").at(0);
  CHECK(row.at("value").is_null());
  CHECK(row.at("why").at("value") == "the estimator failed (exit_status): exit status 9: no idea");
  CHECK_FALSE(fs::exists(temp / "out/results-mine.json"));
}

TEST_CASE("a command that cannot be an estimator's is a wrong command line, before any work") {
  const tests::TempDir temp;
  base::write_file(temp / "small.toml", tests::kSmallScenario);
  struct Wrong {
    std::vector<std::string> words;
    const char* said;
  };
  for (const Wrong& wrong :
       {Wrong{{"--estimator-command", "./mine {folder} {out}"}, "a program that can be run"},
        Wrong{{"--estimator-command", "sh {folder}"}, "a command with {out} in it"},
        Wrong{{"--estimator-command", "sh {folder} {out}", "--estimator-name", "trajectory"},
              "an estimator of Glidelab has this name"},
        Wrong{{"--estimator-seconds", "3"}, "--estimator-command"},
        Wrong{{"--estimator-command", "sh {folder} {out}", "--estimator-seconds", "0"}, "--estimator-seconds"},
        Wrong{{"--estimator-command", "sh {folder} {out}", "--estimator-megabytes", "1e10"},
              "--estimator-megabytes"}}) {
    std::vector<std::string> arguments = {"validate", "small.toml", "--out", "out"};
    arguments.insert(arguments.end(), wrong.words.begin(), wrong.words.end());
    const tests::ProcessResult result = tests::glidelab(arguments, temp.path());
    CHECK(result.status == 2);
    CHECK_THAT(result.err, Contains(wrong.said));
    CHECK_FALSE(fs::exists(temp / "out"));
  }
}

TEST_CASE("coverage of an outside program that is the default estimator has the counts of the default estimator") {
  const tests::TempDir temp;
  base::write_file(temp / "swept.toml", tests::kSweptScenario);
  const tests::ProcessResult result =
      tests::glidelab({"coverage", "swept.toml", "--noise-m", "2e-5", "--replicates", "4", "--out", "out", "--json",
                       "--estimator-command", analyze_command(), "--estimator-seconds", "600"},
                      temp.path());
  INFO(result.err);
  // 4: of so few replicates the naive lines alone may fail, which are not judged.
  REQUIRE((result.status == 0 || result.status == 4));
  const json document = json::parse(result.out);
  CHECK(document.at("outside").at("runs") == 4);
  CHECK(document.at("outside").at("failed") == 0);
  const json inside = rows_of(document, "phase-diagram", "k_over_m_1_s").at(0);
  const json outside = rows_of(document, "analyze", "k_over_m_1_s").at(0);
  CHECK(outside.at("determined") == 4);
  CHECK(outside.at("covered") == inside.at("covered"));
  // The frame rate is stated in one and the median step in the other: rounding.
  CHECK(outside.at("sd").get<double>() == Approx(inside.at("sd").get<double>()).epsilon(1e-6));
  CHECK_THAT(base::read_file(temp / "out/report.html"), Contains("analyze: 4 runs, none failed"));
}

TEST_CASE("the gate judges an outside program alone, and finds a worse one under the same name") {
  const tests::TempDir temp;
  base::write_file(temp / "swept.toml", tests::kSweptScenario);
  // K/m from the parity of a digit of the last position, which is random: off by 0.1, and by 0.3 once it is worse.
  const auto script = [](const char* off) {
    return std::string(
               "d=$(tail -n 1 \"$1/tracks/up.csv\" | tail -c 2)\n"
               "case \"$d\" in [02468]) k=-") +
           off + ";; *) k=" + off +
           ";; esac\necho \"{\\\"format\\\": 1, \\\"configurations\\\": [{\\\"clips\\\": [\\\"up\\\"], "
           "\\\"k_over_m_1_s\\\": "
           "{\\\"value\\\": $k, \\\"sd\\\": 0.1}, \\\"mu\\\": null, \\\"alpha_deg\\\": null, \\\"v_lim_m_s\\\": "
           "null}]}\" > "
           "\"$2/results.json\"\n";
  };
  const std::vector<std::string> command = {
      "validate", "swept.toml", "-q", "--runs", "40", "--estimator-command", "sh mine.sh {folder} {out}"};
  const auto gate = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return tests::glidelab(arguments, temp.path());
  };
  base::write_file(temp / "mine.sh", script("0.1"));
  const tests::ProcessResult written = gate({"--write-baseline", "mine.json"});
  INFO(written.err);
  REQUIRE(written.status == 0);
  const json baseline = json::parse(base::read_file(temp / "mine.json"));
  CHECK(baseline.at("smoothing").empty());
  for (const json& record : baseline.at("records")) CHECK(record.at("estimator") == "mine");
  const tests::ProcessResult same = gate({"--baseline", "mine.json"});
  INFO(same.err);
  CHECK(same.status == 0);
  base::write_file(temp / "mine.sh", script("0.3"));
  const tests::ProcessResult worse = gate({"--baseline", "mine.json"});
  CHECK(worse.status == 4);
  CHECK_THAT(worse.err, Contains("m1 mine k_over_m_1_s: spread"));
}

TEST_CASE("a sweep with an outside program says in its text and its JSON how its runs went") {
  const tests::TempDir temp;
  tests::write_sweep(temp.path(), "estimators = [\"phase-diagram\"]", tests::kTwoKeys);
  const tests::ProcessResult result = tests::glidelab(
      {"sweep", "sweep.toml", "-o", "out", "-q", "--json", "--estimator-command", "sh -c 'exit 3' mine {folder} {out}"},
      temp.path());
  INFO(result.err);
  REQUIRE(result.status == 0);
  const json document = json::parse(result.out);
  CHECK(document.at("failed") == 0);
  CHECK(document.at("outside").at("runs") == 6);
  CHECK(document.at("outside").at("failures").at("exit_status").at("count") == 6);
}
