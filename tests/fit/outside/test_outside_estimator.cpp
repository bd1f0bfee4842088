/// Somebody else's program as an estimator: how its command is read, and how each way to fail is told.
#include "fit/outside/outside_estimator.h"

#include <string>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/temp_dir.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

void write_experiment(const fs::path& folder) {
  fs::create_directories(folder / "tracks");
  std::string csv = "t_s,x_m\n";
  for (int i = 0; i < 20; ++i) csv += std::to_string(0.01 * i) + "," + std::to_string(0.02 * i) + "\n";
  base::write_file(folder / "tracks/one.csv", csv);
  base::write_file(folder / "experiment.toml",
                   "format = 1\nname = \"x\"\n[track]\ndownhill = \"+X\"\n[[clip]]\nname = \"one\"\n"
                   "track = \"tracks/one.csv\"\nmass_kg = 0.3\nincline_deg = 4\nlaunched = \"down\"\n");
}

constexpr const char* kAnswer =
    R"({"format": 1, "configurations": [{"clips": ["one"], "k_over_m_1_s": {"value": 2, "sd": 1},)"
    R"( "mu": null, "alpha_deg": null, "v_lim_m_s": null}]})";

/// A shell script as the estimator; {folder} is $1, {out} is $2.
fit::OutsideOutcome outcome_of(const tests::TempDir& temp, const std::string& script, double seconds = 60.0) {
  write_experiment(temp / "folder");
  base::write_file(temp / "mine.sh", script);
  fit::OutsideEstimator estimator = fit::outside_estimator("sh '" + (temp / "mine.sh").string() + "' {folder} {out}");
  estimator.limits.wall_s = seconds;
  return fit::run_outside(estimator, temp / "folder");
}

}  // namespace

TEST_CASE("the words of a command are read without a shell") {
  CHECK(fit::outside_estimator("sh  -c 'a b' \"c 'd'\" e\\ f {folder} --out={out} $HOME").words ==
        std::vector<std::string>{"sh", "-c", "a b", "c 'd'", "e f", "{folder}", "--out={out}", "$HOME"});
  CHECK(fit::outside_estimator("sh mine.py {folder} {out}").name == "mine");
  CHECK(fit::outside_estimator("/bin/sh {folder} {out}").name == "sh");
  CHECK(fit::outside_estimator("sh mine.py --quick -o {out} {folder}").name == "mine");
  CHECK(fit::outside_estimator("sh {folder} {out}", "better").name == "better");
  for (const char* bad : {"", "sh {folder}", "sh {out}", "{folder} {out}", "sh 'x {folder} {out}",
                          "no-such-program {folder} {out}", "sh {folder} {out} \\"}) {
    INFO(bad);
    CHECK_THROWS_AS(fit::outside_estimator(bad), base::InputError);
  }
  CHECK_THROWS_AS(fit::outside_estimator("sh {folder} {out}", "trajectory"), base::InputError);
}

TEST_CASE("an estimator's program gets the folder and an empty place, and its answer is read") {
  const tests::TempDir temp;
  const fit::OutsideOutcome outcome =
      outcome_of(temp, std::string("test -f $1/experiment.toml && test -z \"$(ls $2)\" && echo '") + kAnswer +
                           "' > $2/results.json");
  INFO(outcome.run.what);
  REQUIRE(outcome.run.failure == fit::OutsideFailure::none);
  CHECK(outcome.run.what.empty());
  CHECK(outcome.results.estimator == "mine");
  CHECK(outcome.results.configurations.at(0).k_over_m_1_s.estimate->value == 2.0);
  CHECK(outcome.json == std::string(kAnswer) + "\n");
}

TEST_CASE("each way in which an estimator's program fails is told apart, with what it last said") {
  const tests::TempDir temp;
  struct Way {
    const char* script;
    fit::OutsideFailure failure;
    const char* what;
    double seconds;
  };
  for (const Way& way : {Way{"echo first; echo last words >&2; exit 3", fit::OutsideFailure::exit_status,
                             "exit status 3: last words", 60.0},
                         Way{"kill -9 $$", fit::OutsideFailure::signal, "signal 9 (SIGKILL)", 60.0},
                         Way{"sleep 60", fit::OutsideFailure::time_out, "not done after 0.1 s", 0.1},
                         Way{"true", fit::OutsideFailure::no_output, "no results.json", 60.0},
                         Way{"mkdir $2/results.json", fit::OutsideFailure::no_output, "no results.json", 60.0},
                         Way{"echo '{\"format\": 1}' > $2/results.json", fit::OutsideFailure::bad_output,
                             "results.json: configurations: found nothing, expected a list", 60.0}}) {
    INFO(way.script);
    const fit::OutsideOutcome outcome = outcome_of(temp, way.script, way.seconds);
    CHECK(outcome.run.failure == way.failure);
    CHECK(outcome.run.what.find(way.what) != std::string::npos);
    CHECK(outcome.json.empty());
    REQUIRE(outcome.results.configurations.size() == 1);
    CHECK_FALSE(outcome.results.configurations[0].mu.estimate);
    const auto* const told = tests::reason_of<core::unknown::Told>(outcome.results.configurations[0].mu);
    REQUIRE(told != nullptr);
    CHECK(told->text == fit::why_of(outcome.run));
    CHECK(fit::why_of(outcome.run).starts_with(fit::why_begins(way.failure)));
  }
}

TEST_CASE("a program that has a function called fails as the function does, and is shown by the function's name") {
  const tests::TempDir temp;
  write_experiment(temp / "folder");
  const auto run = [&](const std::string& script) {
    base::write_file(temp / "mine.sh", script);
    fit::OutsideEstimator estimator =
        fit::outside_estimator("sh '" + (temp / "mine.sh").string() + "' {folder} {out}", "mine");
    estimator.function = "mine";
    const fit::OutsideOutcome outcome = fit::run_outside(estimator, temp / "folder");
    CHECK(fit::tally_of(estimator, {outcome.run}).command == "the function mine");
    return outcome.run;
  };
  const fit::OutsideRun raised = run("echo 'ValueError: no line (mine.py, line 3)' >&2; exit 1");
  CHECK(raised.failure == fit::OutsideFailure::raised);
  CHECK(raised.what == "ValueError: no line (mine.py, line 3)");
  CHECK(fit::why_begins(raised.failure) == "the estimator failed (raised)");
  const fit::OutsideRun wrong = run("echo 'mu: found no standard deviation' >&2; exit 2");
  CHECK(wrong.failure == fit::OutsideFailure::bad_output);
  CHECK(wrong.what == "mu: found no standard deviation");
  CHECK(run("kill -9 $$").failure == fit::OutsideFailure::signal);
}

TEST_CASE("all that is wrong with an estimator's results is told on one line, parted by semicolons") {
  const tests::TempDir temp;
  const fit::OutsideOutcome outcome =
      outcome_of(temp, "echo '{\"format\": 2, \"configurations\": 3}' > $2/results.json");
  REQUIRE(outcome.run.failure == fit::OutsideFailure::bad_output);
  CHECK(outcome.run.what.find('\n') == std::string::npos);
  CHECK(outcome.run.what.find("; results.json: configurations: found 3") != std::string::npos);
}

TEST_CASE("what an estimator's program prints is UTF-8 in what is told of it, whatever bytes it wrote") {
  const tests::TempDir temp;
  // Latin-1, and 199 letters before a character of two bytes: the 200th byte is its first.
  const fit::OutsideOutcome latin = outcome_of(temp, "printf 'ung\\374ltig\\n' >&2; exit 2");
  CHECK(latin.run.what == "exit status 2: ung\uFFFDltig");
  const fit::OutsideOutcome cut = outcome_of(temp, "printf '" + std::string(199, 'a') + "\\303\\274bc\\n' >&2; exit 2");
  CHECK(cut.run.what == "exit status 2: " + std::string(199, 'a') + "…");
  const fit::OutsideOutcome json = outcome_of(temp, "printf '{\"format\": \\374}' > $2/results.json");
  CHECK(json.run.failure == fit::OutsideFailure::bad_output);
  CHECK(json.run.what.find('\xFC') == std::string::npos);
}

TEST_CASE("runs of an outside estimator are counted by how they failed, with what the first one said") {
  using fit::OutsideFailure;
  const fit::OutsideTally tally = fit::tally_of("mine", "mine {folder} {out}",
                                                {{OutsideFailure::none, "", 1.0},
                                                 {OutsideFailure::signal, "signal 9", 2.0},
                                                 {OutsideFailure::time_out, "late", 6.0},
                                                 {OutsideFailure::signal, "signal 11", 3.0}});
  CHECK(tally.runs == 4);
  CHECK(tally.failed() == 3);
  CHECK(tally.failures[1].count == 2);
  CHECK(tally.failures[1].first == "signal 9");
  CHECK(tally.failures[2].count == 1);
  CHECK(tally.seconds == 3.0);  // (1 + 2 + 6 + 3) / 4
  CHECK(tally.longest_s == 6.0);
}

TEST_CASE("an interrupt ends an estimator's program and the work") {
  const tests::TempDir temp;
  write_experiment(temp / "folder");
  fit::OutsideEstimator estimator = fit::outside_estimator("sh -c 'sleep 60' {folder} {out}");
  estimator.stop = [] { return true; };
  CHECK_THROWS_AS(fit::run_outside(estimator, temp / "folder"), base::Interrupted);
}
