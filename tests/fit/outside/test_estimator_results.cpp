/// results.json of an outside estimator: what is taken from it, and what is wrong with it.
#include "fit/outside/estimator_results.h"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "base/errors.h"
#include "base/files/child_process.h"
#include "base/files/file_io.h"
#include "base/math/distributions.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

std::vector<core::ClipSetup> three_clips() {
  std::vector<core::ClipSetup> clips(3);
  clips[0].name = "up";
  clips[1].name = "heavy";
  clips[2].name = "down";
  for (core::ClipSetup& clip : clips) {
    clip.mass_kg = clip.name == "heavy" ? 0.5 : 0.3;
    clip.group = "all";
  }
  return clips;
}

/// One configuration of the first and the last clip, with these members.
std::string document(const std::string& members) {
  return fmt::format(R"({{"format": 1, "configurations": [{{"clips": ["up", "down"], {}}}]}})", members);
}

const std::string kRest = R"("mu": null, "alpha_deg": null, "v_lim_m_s": null)";
const std::string kGood = R"("k_over_m_1_s": {"value": 2.5, "sd": 0.25}, )" + kRest;

core::AnalysisResults read(const std::string& text) {
  return fit::read_estimator_results(text, "results.json", three_clips(), "mine");
}

struct Bad {
  std::string text, key;
};

std::vector<Bad> bad_documents() {
  const auto quantity = [](const std::string& inner) { return document("\"k_over_m_1_s\": " + inner + ", " + kRest); };
  return {
      {"{", ""},
      {"[]", ""},
      {R"({"configurations": []})", "format"},
      {R"({"format": 2, "configurations": []})", "format"},
      {R"({"format": 1})", "configurations"},
      {R"({"format": 1, "configurations": {}})", "configurations"},
      {R"({"format": 1, "configurations": [3]})", "configurations[0]"},
      {R"({"format": 1, "configurations": [{)" + kGood + "}]}", "configurations[0].clips"},
      {R"({"format": 1, "configurations": [{"clips": [], )" + kGood + "}]}", "configurations[0].clips"},
      {R"({"format": 1, "configurations": [{"clips": [7], )" + kGood + "}]}", "configurations[0].clips[0]"},
      {document(kRest), "configurations[0].k_over_m_1_s"},
      {document(R"("k_over_m": {"value": 2.5, "sd": 0.25}, )" + kRest), "configurations[0].k_over_m_1_s"},
      {quantity("2.5"), "configurations[0].k_over_m_1_s"},
      {quantity(R"({"value": 2.5})"), "configurations[0].k_over_m_1_s.sd"},
      {quantity(R"({"value": "2.5", "sd": 0.25})"), "configurations[0].k_over_m_1_s.value"},
      {quantity(R"({"value": 2.5, "sd": -0.25})"), "configurations[0].k_over_m_1_s.sd"},
      {quantity(R"({"value": null, "sd": 0.25})"), "configurations[0].k_over_m_1_s.value"},
      {quantity(R"({"value": 2.5, "sd": 0.25, "interval95": [2.0]})"), "configurations[0].k_over_m_1_s.interval95"},
      {quantity(R"({"value": 2.5, "sd": 0.25, "interval95": 3})"), "configurations[0].k_over_m_1_s.interval95"},
      {quantity(R"({"value": 2.5, "sd": 0.25, "interval95": ["low", 3.0]})"),
       "configurations[0].k_over_m_1_s.interval95"},
      {quantity(R"({"value": 2.5, "sd": 0.25, "interval95": [2.0, null]})"),
       "configurations[0].k_over_m_1_s.interval95"},
      {quantity(R"({"value": 2.5, "sd": 0.25, "interval95": [2.0, 3.0, 4.0]})"),
       "configurations[0].k_over_m_1_s.interval95"},
      {document(R"("why": "because", "k_over_m_1_s": null, )" + kRest), "configurations[0].why"},
      {document(R"("why": {"mu": 3}, "k_over_m_1_s": null, )" + kRest), "configurations[0].why.mu"},
  };
}

/// Wrong of this experiment, which a schema cannot know.
std::vector<Bad> of_another_experiment() {
  const auto clips = [](const std::string& names) {
    return R"({"format": 1, "configurations": [{"clips": )" + names + ", " + kGood + "}]}";
  };
  return {
      {clips(R"(["sideways"])"), "configurations[0].clips[0]"},
      {clips(R"(["up", "up"])"), "configurations[0].clips[1]"},
      {clips(R"(["up", "heavy"])"), "configurations[0].clips[1]"},
      {R"({"format": 1, "configurations": [{"clips": ["up"], )" + kGood + R"(}, {"clips": ["down"], )" + kGood + "}]}",
       "configurations[1].clips"},
      {document(R"("k_over_m_1_s": {"value": 2.5, "sd": 0.25, "interval95": [2.6, 2.9]}, )" + kRest),
       "configurations[0].k_over_m_1_s.interval95"},
      {document(R"("k_over_m_1_s": {"value": 2.5, "sd": 0.25, "interval95": [2.0, 2.4]}, )" + kRest),
       "configurations[0].k_over_m_1_s.interval95"},
      {document(R"("k_over_m_1_s": {"value": 2.5, "sd": 0.25, "interval95": [3.0, 2.0]}, )" + kRest),
       "configurations[0].k_over_m_1_s.interval95"},
  };
}

std::vector<std::string> good_documents() {
  return {document(kGood), R"({"format": 1, "configurations": []})",
          R"({"format": 1, "by": "me", "configurations": [{"clips": ["heavy"], "note": 7, "why": {"mu": "one way only"},
              "k_over_m_1_s": {"value": 2.5, "sd": 0, "interval95": [2.0, 3.5], "more": 1}, )" +
              kRest + "}]}"};
}

}  // namespace

TEST_CASE("an outside result fills the configuration of its clips, and the others say that there is none") {
  const core::AnalysisResults results = read(document(kGood));
  CHECK(results.estimator == "mine");
  REQUIRE(results.configurations.size() == 2);
  const core::ConfigurationResult& light = results.configurations[0];
  CHECK(light.clips == std::vector<std::string>{"up", "down"});
  REQUIRE(light.k_over_m_1_s.estimate);
  CHECK(light.k_over_m_1_s.estimate->value == 2.5);
  CHECK(light.k_over_m_1_s.estimate->sd == 0.25);
  // To rounding.
  CHECK(light.k_over_m_1_s.estimate->high95 - 2.5 == Approx(base::kNormal95 * 0.25).epsilon(1e-9));
  CHECK_FALSE(light.mu.estimate);
  CHECK(tests::reason_of<core::unknown::NotTold>(light.mu) != nullptr);
  CHECK_FALSE(results.configurations[1].k_over_m_1_s.estimate);
  CHECK(tests::reason_of<core::unknown::NotAnswered>(results.configurations[1].k_over_m_1_s) != nullptr);
  const core::AnalysisResults wide = read(good_documents().back());
  CHECK(wide.configurations[1].k_over_m_1_s.estimate->high95 == 3.5);
  const auto* const told = tests::reason_of<core::unknown::Told>(wide.configurations[1].mu);
  REQUIRE(told != nullptr);
  CHECK(told->text == "one way only");
}

TEST_CASE("what is wrong with an outside result is named by its key") {
  for (const std::vector<Bad>& documents : {bad_documents(), of_another_experiment()}) {
    for (const Bad& bad : documents) {
      INFO(bad.text);
      try {
        read(bad.text);
        FAIL_CHECK("it was taken");
      } catch (const base::InputError& error) {
        CHECK(error.issues().front().key == bad.key);
        CHECK(error.issues().front().file == "results.json");
      }
    }
  }
}

TEST_CASE("a wrong value of forty characters is shown as it is, a longer one by its type") {
  const auto found = [](const std::string& sd) {
    try {
      read(document(R"("k_over_m_1_s": {"value": 2.5, "sd": ")" + sd + R"("}, )" + kRest));
    } catch (const base::InputError& error) {
      return error.issues().front().found;
    }
    return std::string("it was taken");
  };
  CHECK(found(std::string(38, 'x')) == '"' + std::string(38, 'x') + '"');
  CHECK(found(std::string(39, 'x')) == "string");
}

TEST_CASE("the JSON schema takes and refuses the documents that the reader takes and refuses") {
  const tests::TempDir temp;
  constexpr const char* kPython = "/usr/bin/python3";  // whose packages are Debian's
  if (!base::is_program(kPython) || base::run_program(kPython, {"-c", "import fastjsonschema"}, temp / "log") != 0) {
    WARN("skipped: no fastjsonschema (python3-fastjsonschema)");
    return;
  }
  std::vector<std::string> texts = good_documents();
  const std::size_t good = texts.size();
  for (const Bad& bad : bad_documents()) {
    if (bad.text != "{") texts.push_back(bad.text);  // not even JSON
  }
  for (std::size_t i = 0; i < texts.size(); ++i) base::write_file(temp / fmt::format("{}.json", i), texts[i]);
  base::write_file(temp / "judge.py", R"(import json, sys, fastjsonschema
judge = fastjsonschema.compile(json.load(open(sys.argv[1])))
for file in sys.argv[2:]:
    try:
        judge(json.load(open(file)))
        print("good")
    except fastjsonschema.JsonSchemaException:
        print("bad")
)");
  std::vector<std::string> arguments = {
      temp / "judge.py", std::string(tests::kSourceDir) + "/docs/reference/estimator-results.schema.json"};
  std::string expected;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    arguments.push_back(temp / fmt::format("{}.json", i));
    expected += i < good ? "good\n" : "bad\n";
  }
  REQUIRE(base::run_program(kPython, arguments, temp / "log") == 0);
  CHECK(base::read_file(temp / "log") == expected);
}

TEST_CASE("NaN in results.json, which Python's json writes, is told in words with its place") {
  const auto told = [](const std::string& text) {
    try {
      read(text);
    } catch (const base::InputError& error) {
      return std::string(error.what());
    }
    return std::string("nothing");
  };
  const std::string null = "a number, or null where nothing is determined: JSON has no NaN and no infinity";
  CHECK(told("{\"format\": 1,\n \"mu\": {\"value\": NaN}}") ==
        "results.json: found NaN at line 2, column 18, expected " + null);
  CHECK(told("{\"value\": -Infinity}") == "results.json: found -Infinity at line 1, column 11, expected " + null);
  CHECK(told("{\"value\": 0,5}") == "results.json: found 5 at line 1, column 13, expected JSON");
  CHECK(told("{\"value\": ") == "results.json: found the end of the text at line 1, column 11, expected JSON");
}
