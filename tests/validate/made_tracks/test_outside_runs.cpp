/// What an outside estimator is given: the same numbers that Glidelab's own estimators see, and no truth.
#include "validate/made_tracks/outside_runs.h"

#include <filesystem>
#include <sstream>
#include <string>

#include "base/files/file_io.h"
#include "core/analysis/analyze.h"
#include "core/result/quantity.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

validate::MadeTracks noisy_tracks() {
  std::string text = tests::kSweptScenario;
  text += "[[configuration.clip]]\nname = \"down\"\nlaunched = \"down\"\nx0_m = -0.5\nv0_m_s = 1.0\nduration_s = 1.0\n";
  const render::Scenario scenario = render::read_scenario(text, "swept.toml", render::ScenarioChecks::values);
  return validate::with_noise(validate::make_tracks(scenario, 1), 2e-5, 1);
}

}  // namespace

TEST_CASE("the folder that an outside estimator gets has the results of the tracks that it was written from") {
  const tests::TempDir temp;
  const validate::MadeTracks made = noisy_tracks();
  validate::write_track_folder(made, temp / "folder");
  const core::AnalysisResults direct = validate::analyze_tracks(made, core::MotionOptions{});
  const core::AnalysisResults read = core::analyze({temp / "folder"}, {});
  REQUIRE(read.configurations.size() == direct.configurations.size());
  for (const core::QuantityName& quantity : core::kQuantities) {
    INFO(quantity.key);
    const core::Quantity& one = core::value_of(direct.configurations[0], quantity.which);
    const core::Quantity& other = core::value_of(read.configurations[0], quantity.which);
    REQUIRE((one.estimate && other.estimate));
    // All digits are written; the frame rate is the median step's in one of them, which moves the bandwidth's grid by
    // rounding alone.
    CHECK(std::abs(one.estimate->value - other.estimate->value) < 1e-9 * std::abs(one.estimate->value));
    CHECK(std::abs(one.estimate->sd - other.estimate->sd) < 1e-6 * one.estimate->sd);
  }
}

TEST_CASE("every position of a track is in the file that an outside estimator gets, to all digits") {
  const tests::TempDir temp;
  const validate::MadeTracks made = noisy_tracks();
  validate::write_track_folder(made, temp / "folder");
  for (std::size_t c = 0; c < made.tracks.size(); ++c) {
    std::istringstream csv(base::read_file(temp / "folder" / "tracks" / (made.setups[c].name + ".csv")));
    std::string line;
    std::getline(csv, line);
    for (std::size_t i = 0; i < made.tracks[c].t_s.size(); ++i) {
      REQUIRE(std::getline(csv, line));
      const std::size_t comma = line.find(',');
      CHECK(std::stod(line.substr(0, comma)) == made.tracks[c].t_s[i]);
      CHECK(std::stod(line.substr(comma + 1)) == made.tracks[c].x_m[i]);
    }
    CHECK_FALSE(std::getline(csv, line));
  }
}

TEST_CASE("nothing but the experiment lies where an outside estimator is run, on tracks and on a film") {
  const tests::TempDir temp;
  const fit::OutsideEstimator estimator = fit::outside_estimator(
      "sh -c 'find \"$1\"/.. -type f | sed \"s,.*/experiment/,,\" | sort; exit 5' look {folder} {out}");
  const fit::OutsideOutcome tracks = validate::run_outside_on_tracks(estimator, noisy_tracks());
  CHECK(tracks.run.failure == fit::OutsideFailure::exit_status);
  // The last line that it printed, of experiment.toml, tracks/down.csv, tracks/up.csv.
  CHECK(tracks.run.what == "exit status 5: tracks/up.csv");

  // A film: the folder as rendered, here with a file in place of a clip, and its truth beside it.
  validate::write_track_folder(noisy_tracks(), temp / "film");
  base::write_file(temp / "film.truth", "truth");
  core::AnalysisResults measured;
  measured.clips.resize(1);
  measured.clips[0].name = "zenith";
  measured.clips[0].motion.resize(2);
  measured.clips[0].motion[1].t_s = 0.5;
  measured.clips[0].motion[1].measured_m = 0.25;
  const fit::OutsideOutcome film = validate::run_outside_on_film(estimator, temp / "film", measured);
  CHECK(film.run.what == "exit status 5: tracks/zenith.csv");
  const fit::OutsideOutcome row = validate::run_outside_on_film(
      fit::outside_estimator("sh -c 'cat \"$1/tracks/zenith.csv\"; exit 5' look {folder} {out}"), temp / "film",
      measured);
  CHECK(row.run.what == "exit status 5: 0.5,0.25");
  CHECK_FALSE(fs::exists(temp / "film/tracks/zenith.csv"));
}

TEST_CASE(
    "an outside estimator is told how far the clock may be off, on tracks and on a film, and can read the folder") {
  const tests::TempDir temp;
  const fit::OutsideEstimator estimator = fit::outside_estimator(
      "sh -c 'grep -A1 \"^.extra\" \"$1/experiment.toml\" | grep -o \"clock_sd_ppm = [0-9.]*\"; cp -r \"$1\" " +
      (temp / "seen").string() + "; exit 5' look {folder} {out}");
  const validate::MadeTracks made = noisy_tracks();
  // A quartz crystal's 20 ppm (docs/reference/camera-sources.md, G1), of which coverage draws each replicate's clock.
  CHECK(validate::run_outside_on_tracks(estimator, made).run.what == "exit status 5: clock_sd_ppm = 20.0");
  CHECK(core::analyze({temp / "seen"}, {}).configurations.size() == 1);
  fs::remove_all(temp / "seen");
  validate::write_track_folder(made, temp / "film");
  const std::string before = base::read_file(temp / "film/experiment.toml");
  CHECK(validate::run_outside_on_film(estimator, temp / "film", {}).run.what == "exit status 5: clock_sd_ppm = 20.0");
  CHECK(base::read_file(temp / "film/experiment.toml") == before);
}
