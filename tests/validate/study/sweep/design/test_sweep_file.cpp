#include "validate/study/sweep/design/sweep.h"

#include <string>

#include "test_paths.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"
#include "validate/study/sweep/sqlite.h"

using namespace glidelab;
using Catch::Matchers::Contains;
using tests::kNoise;

TEST_CASE("What is wrong with a sweep is said before the first run, by its key") {
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"camera.frame_rate\"\nvalues = [30]\n"),
             Contains("sweep.toml:8: camera.frame_rate: ") && Contains("did you mean \"frame_rate_hz\""));
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"camera.frame_rate_hz\"\nvalues = [30, -1]\n"),
             Contains("sweep.toml:8: camera.frame_rate_hz: found -1") && Contains("camera.frame_rate_hz = -1"));
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"x\"\nrange = { from = 2, to = 2, count = 3 }\n"),
             Contains("an empty range"));
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"x\"\nvalues = []\n"), Contains("an empty list"));
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"x\"\n"), Contains("exactly one of values"));
  CHECK_THAT(
      tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"x\"\nlog_range = { from = 0, to = 2, count = 3 }\n"),
      Contains("log_range.from"));
  CHECK_THAT(tests::refusal_of_sweep("", ""), Contains("tracks"));
  CHECK_THAT(tests::refusal_of_sweep("estimators = [\"magic\"]", kNoise), Contains("magic"));
  CHECK_THAT(tests::refusal_of_sweep("samples = 3", kNoise), Contains("samples"));
  CHECK_THAT(tests::refusal_of_sweep("level = \"clips\"", kNoise), Contains("tracks"));
  CHECK_THAT(tests::refusal_of_sweep("level = \"clips\"", "[[vary]]\nkey = \"tracks.noise_m\"\nvalues = [1e-5]\n"),
             Contains("tracks.noise_m"));
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"camera.exposure_s\"\nvalues = [0.001]\n"
                                                  "[[vary]]\nkey = \"camera.exposure_s\"\nvalues = [0.001]\n"),
             Contains("twice"));
  CHECK_THAT(tests::refusal_of_sweep("colour = 3", kNoise), Contains("colour"));
  CHECK_THAT(tests::refusal_of_sweep("bandwidths_s = [0.02, 0.02]", kNoise),
             Contains("sweep.toml:4: bandwidths_s: found \"phase-diagram h=0.02 s\" twice"));
  const std::string none = tests::refusal_of_sweep("bandwidths_s = [0.0, 0.0]", kNoise);
  CHECK_THAT(none, Contains("bandwidths_s: found 0, expected") && !Contains("nan"));
  CHECK_THAT(tests::refusal_of_sweep("", kNoise + "[[vary]]\nname = \"x\"\nkey = \"camera.frame_rate_hz\"\n"
                                                  "choices = [{ \"camera.frame_rate_hz\" = 60 }]\n"),
             Contains("sweep.toml:9: vary[1].key: found a key beside choices, expected none: each choice names"));
}

TEST_CASE("Names that the database would take for one column are refused, whatever their capitals") {
  const auto two = [](const std::string& a, const std::string& b) {
    return tests::refusal_of_sweep("", kNoise + "[[vary]]\nname = \"" + a +
                                           "\"\nkey = \"camera.frame_rate_hz\"\nvalues = [50]\n[[vary]]\nname = \"" +
                                           b + "\"\nkey = \"camera.exposure_s\"\nvalues = [0.001]\n");
  };
  CHECK_THAT(two("a", "A"), Contains("sweep.toml:12: vary[2].name: found \"A\" beside \"a\""));
  CHECK_THAT(two("Run", "b"), Contains("sweep.toml:8: vary[1].name: found the name \"Run\""));
  CHECK_THAT(two("a", "sTaTuS"), Contains("sweep.toml:12: vary[2].name"));
  // SQLite is the judge: it keeps capitals apart where they are not of the letters a to z.
  CHECK(two("µ Ä", "µ ä") == "no error");
  const tests::TempDir dir;
  validate::Database database(dir / "a.sqlite", validate::Database::Mode::create);
  database.run("CREATE TABLE t (\"µ Ä\", \"µ ä\")");
  CHECK_THROWS_WITH(database.run("CREATE TABLE u (\"a\", \"A\")"), Contains("duplicate column"));
}

TEST_CASE("Keys that reach the same value of the scenario by two spellings are refused with the line of the later") {
  const auto two = [](const std::string& a, const std::string& b) {
    return tests::refusal_of_sweep("", kNoise + "[[vary]]\nkey = \"" + a +
                                           "\"\nvalues = [0.3, 0.4]\n[[vary]]\nkey = \"" + b + "\"\nvalues = [0.35]\n");
  };
  const std::string all = "configuration[*].mass_kg", first = "configuration[1].mass_kg";
  CHECK_THAT(two(all, first), Contains("sweep.toml:11: " + first + ": found a key that reaches " + first) &&
                                  Contains("as \"" + all + "\" does"));
  CHECK_THAT(two("configuration[*].force[law=viscous].k_over_m_1_s", "configuration[1].force[*].k_over_m_1_s"),
             Contains("sweep.toml:11: ") && Contains("k_over_m_1_s, as"));
  CHECK(two(all, "camera.position_m[2]") == "no error");
  CHECK(two("camera.position_m[1]", "camera.position_m[2]") == "no error");
}

TEST_CASE("A value, a word or a camera that an axis has twice is refused") {
  const auto of = [](const std::string& rest) { return tests::refusal_of_sweep("", kNoise + "[[vary]]\n" + rest); };
  CHECK_THAT(of("key = \"camera.frame_rate_hz\"\nvalues = [100, 80, 1e2]\n"),
             Contains("sweep.toml:9: vary[1].values: found 100 twice"));
  CHECK_THAT(of("key = \"shutter.kind\"\nwords = [\"global\", \"global\"]\n"),
             Contains("sweep.toml:9: vary[1].words: found \"global\" twice"));
  const std::string cameras = std::string(tests::kSourceDir) + "/scenarios/cameras";
  CHECK_THAT(of("cameras = [\"cams\"]\n"), Contains("sweep.toml:") && Contains("cameras: found no file or folder ") &&
                                               Contains("/cams, expected camera files, or folders with some"));
  CHECK_THAT(of("cameras = [\"" + cameras + "\", \"" + cameras + "/chronos-14.toml\"]\n"),
             Contains("sweep.toml:8: vary[1].cameras: found") && Contains("chronos-14.toml\" twice"));
}

TEST_CASE("each distribution of random values is read with its own keys, and those of others are refused") {
  using Kind = validate::AxisSource::Kind;
  struct Given {
    const char* text;
    Kind kind;
    double from, to, mean, sd;
  };
  const std::string rate = kNoise + "[[vary]]\nkey = \"camera.frame_rate_hz\"\nrandom = { distribution = ";
  for (const Given& given :
       {Given{"\"uniform\", from = 50, to = 70", Kind::uniform, 50.0, 70.0, 0.0, 0.0},
        Given{"\"log_uniform\", from = 40, to = 80", Kind::log_uniform, 40.0, 80.0, 0.0, 0.0},
        Given{"\"normal\", mean = 60, sd = 2", Kind::normal, 0.0, 0.0, 60.0, 2.0},
        Given{"\"log_normal\", median = 61, sd_of_log = 0.1", Kind::log_normal, 0.0, 0.0, 61.0, 0.1}}) {
    INFO(given.text);
    const tests::TempDir dir;
    const validate::Sweep sweep =
        validate::read_sweep(tests::write_sweep(dir.path(), "replicates = 2", rate + given.text + " }\n"));
    REQUIRE(sweep.axes.size() == 1);
    const validate::AxisSource& source = sweep.axes[0].source;
    CHECK(source.kind == given.kind);
    CHECK(source.from == given.from);
    CHECK(source.to == given.to);
    CHECK(source.mean == given.mean);
    CHECK(source.sd == given.sd);
    CHECK(source.drawn());
  }
  const auto refused = [&](const std::string& random) {
    return tests::refusal_of_sweep("replicates = 2", rate + random + " }\n");
  };
  CHECK_THAT(refused("\"log_uniform\", from = 0, to = 70"), Contains("random.from"));
  CHECK_THAT(refused("\"normal\", median = 60, sd = 2"), Contains("random.mean"));
  CHECK_THAT(refused("\"normal\", mean = 60, sd = 0"), Contains("random.sd"));
  CHECK_THAT(refused("\"log_normal\", median = -1, sd_of_log = 0.1"), Contains("random.median"));
  CHECK_THAT(refused("\"normal\", from = 50, to = 70"), Contains("random.mean"));
}
