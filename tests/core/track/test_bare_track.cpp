#include "core/track/bare_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <variant>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/analysis/analyze.h"
#include "core/check/check_recording.h"
#include "tests/catch.h"
#include "tests/core/made_project.h"
#include "tests/core/notes.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

/// Capstone's layout: two runs side by side, x = 0.3 t² and 0.2 t².
struct TwoRuns {
  tests::TempDir dir;
  std::filesystem::path file = dir / "cups.csv";
  TwoRuns() {
    std::string text = "Time (s) Run #1,Position (m) Run #1,Time (s) Run #2,Position (m) Run #2\n";
    for (int i = 0; i < 60; ++i) {
      const double t = 0.02 * i, noise = i % 2 == 0 ? 1e-4 : -1e-4;
      text += fmt::format("{},{},{},{}\n", t, 0.3 * t * t + noise, t, 0.2 * t * t + noise);
    }
    base::write_file(file, text);
  }
};

}  // namespace

TEST_CASE("the runs of one file become clips with a mass each") {
  const TwoRuns made;
  core::TrackFileOptions options;
  options.runs = "all";
  options.masses_kg = {0.0088, 0.0079};
  const core::Experiment all = core::read_tracks(made.file, options);
  REQUIRE(all.clips.size() == 2);
  CHECK(all.clips[0].name == "Run #1");
  CHECK(all.clips[1].name == "Run #2");
  CHECK(all.clips[1].mass_kg == 0.0079);
  options.runs = "2";
  options.masses_kg = {};
  const core::Experiment second = core::read_tracks(made.file, options);
  REQUIRE(second.clips.size() == 1);
  CHECK(second.clips[0].name == "Run #2");
  CHECK(core::read_track_csv(made.file, 1, second.clips[0].column).x_m[10] == Approx(0.2 * 0.04 + 1e-4));
}

TEST_CASE("the point masses of a Tracker project become clips with a mass each") {
  const tests::TempDir temp;
  const auto falling = [](double a) { return [a](double i) { return std::pair(50.0, 100.0 + 2.0 * i + a * i * i); }; };
  const tests::MadeProject project{
      {tests::made_mass("cup", 12, falling(1.0)), tests::made_mass("two cups", 12, falling(2.0))}};
  const std::filesystem::path file = tests::write_text(temp / "made.trk", project.text());
  core::TrackFileOptions options;
  options.runs = "all";
  options.masses_kg = {0.001, 0.002};
  const core::Experiment all = core::read_tracks(file, options);
  REQUIRE(all.clips.size() == 2);
  CHECK(all.clips[0].name == "cup");
  CHECK(all.clips[1].name == "two cups");
  CHECK(all.clips[1].mass_kg == 0.002);
  const auto distance_m = [&](std::size_t clip) {
    const std::vector<double> x = core::read_track(file, std::nullopt, all.clips[clip].column).x_m;
    return x.back() - x.front();
  };
  CHECK(distance_m(1) / distance_m(0) == Approx((2.0 * 11.0 + 2.0 * 121.0) / (2.0 * 11.0 + 121.0)));
  options.runs = "3";
  options.masses_kg = {};
  CHECK_THROWS_WITH(core::read_tracks(file, options), Contains("1: cup, 2: two cups"));
}

TEST_CASE("several files have a mass each, without runs") {
  const TwoRuns one, other;
  core::TrackFileOptions stated;
  stated.column = "2";
  stated.masses_kg = {0.0088, 0.0079};
  const core::TrackFileOptions options = core::masses_of_files(stated, {one.file, other.file});
  CHECK(core::read_tracks(one.file, options).clips.front().mass_kg == 0.0088);
  CHECK(core::read_tracks(other.file, options).clips.front().mass_kg == 0.0079);
  CHECK_FALSE(core::read_tracks(one.file, options).clips.front().mass_assumed);
  CHECK_THROWS_WITH(core::masses_of_files(stated, {one.file}),
                    Contains("--masses") && Contains("2 of them") && Contains("each of the 1 file,"));
  CHECK_THROWS_WITH(core::masses_of_files(stated, {one.file, one.file}), Contains("two masses of one file"));
  stated.runs = "all";  // then they are those of the runs
  CHECK(core::masses_of_files(stated, {one.file}).masses_kg.size() == 2);
}

TEST_CASE("runs that the file does not have, and masses that do not fit, are refused with what there is") {
  const TwoRuns made;
  core::TrackFileOptions options;
  for (const char* wrong : {"3", "0", "x", "1,"}) {
    options.runs = wrong;
    CHECK_THROWS_WITH(core::read_tracks(made.file, options), Contains("1: Run #1, 2: Run #2"));
  }
  options.runs = "all";
  options.masses_kg = {0.1};
  CHECK_THROWS_WITH(core::read_tracks(made.file, options),
                    Contains("--masses") && Contains("one for each of the 2 runs"));
}

TEST_CASE("a bare track says which mass and inclination it assumed, and accuses nobody of stating them") {
  const TwoRuns made;  // accelerations of 0.6 m/s²: 3.5 degrees, not level
  core::TrackFileOptions options;
  options.column = "2";
  const auto notes_with = [&] {
    core::AnalysisOptions how;
    how.bare = options;
    return core::analyze({made.file}, how).configurations.front().notes;
  };
  const std::vector<core::Note> bare = notes_with();
  const auto* const assumed = tests::note_of<core::AssumedStatements>(bare);
  REQUIRE(assumed != nullptr);
  CHECK(assumed->mass_kg == 1.0);
  CHECK(assumed->level);
  CHECK(tests::note_of<core::InclineContradiction>(bare) == nullptr);
  for (const core::Finding& finding : core::check_recording(core::read_tracks(made.file, options), 1).findings) {
    CHECK(finding.topic != core::Topic::incline);
  }
  options.mass_kg = 400.0;
  options.incline_deg = 3.5;
  const std::vector<core::Note> stated = notes_with();
  CHECK(tests::note_of<core::AssumedStatements>(stated) == nullptr);
  const auto* const grams = tests::note_of<core::MassInGrams>(stated);
  REQUIRE(grams != nullptr);
  CHECK(grams->mass_kg == 400.0);
  CHECK_FALSE(grams->lightest_kg);
}

TEST_CASE("beside an assumed level track an analysis says that x is a height, which may be a fall") {
  const tests::TempDir folder;
  const std::filesystem::path file = folder / "drop.csv";
  {
    std::ofstream out(file);
    out << "t (s),hauteur (m)\n";
    for (int i = 0; i < 60; ++i) {
      const double t = 0.01 * i;
      out << t << ',' << 0.001 * std::round(1000.0 * (2.0 - 4.5 * t * t)) << '\n';
    }
  }
  core::AnalysisOptions how;
  const auto is_told = [&] {
    const std::vector<core::Note> notes = core::analyze({file}, how).configurations.front().notes;
    const auto* const height = tests::note_of<core::HeightTaken>(notes);
    return height != nullptr && height->column == "hauteur (m)";
  };
  const auto is_asked_by_check = [&] {
    const core::RecordingCheck check = core::check_recording(core::read_tracks(file, how.bare), 1);
    return std::ranges::any_of(check.findings, [](const core::Finding& finding) {
      const auto* const note = std::get_if<core::Note>(&finding.found);
      return note != nullptr && std::holds_alternative<core::HeightTaken>(*note);
    });
  };
  CHECK(is_told());
  CHECK(is_asked_by_check());
  how.bare.incline_deg = 90.0;
  CHECK_FALSE(is_told());
  CHECK_FALSE(is_asked_by_check());
}

TEST_CASE("a check of a recording whose frames are hardly marked does not ask for a higher rate") {
  const tests::TempDir folder;
  const std::filesystem::path file = folder / "marked.txt";
  {
    std::ofstream out(file);
    out << ",mass A,,\nt,x,y,\n";
    for (int i = 0; i <= 160; ++i) {
      const double t = 0.02 * i;
      if (i % 10 == 0) {
        out << t << ',' << 0.05 * t + 0.003 * t * t << ",0\n";
      } else {
        out << t << ",,\n";
      }
    }
  }
  std::size_t found = 0;
  for (const core::Finding& finding : core::check_recording(core::read_tracks(file, {}), 1).findings) {
    const auto* const few = std::get_if<core::found::FewPositions>(&finding.found);
    if (few == nullptr) continue;
    ++found;
    CHECK(few->positions == 17);
    CHECK(few->unmarked == 144);
  }
  CHECK(found == 1);
}

TEST_CASE("runs one below the other are read as runs side by side, named by their number") {
  const tests::TempDir temp;
  const std::filesystem::path file = temp / "tidy.csv";
  const auto rows = [](int run, double a) {
    std::string text;
    for (int i = 0; i < 20 + run; ++i) {
      const double t = 0.02 * i;
      text += fmt::format("{},{:.2f},{:.6f}\n", run, t, 0.5 * a * t * t + (i % 2 == 0 ? 1e-4 : -1e-4));
    }
    return text;
  };
  base::write_file(file, "Run,Time (s),Position (m)\n" + rows(1, 2.0) + rows(7, 3.0) + rows(4, 1.0));
  core::TrackFileOptions options;
  options.runs = "all";
  options.masses_kg = {0.1, 0.2, 0.3};
  const core::Experiment all = core::read_tracks(file, options);
  REQUIRE(all.clips.size() == 3);
  CHECK(all.clips[0].name == "Run 1");
  CHECK(all.clips[1].name == "Run 7");
  CHECK(all.clips[2].name == "Run 4");
  CHECK(all.clips[1].mass_kg == 0.2);
  const core::TrackData second = core::read_track_csv(file, 1, all.clips[1].column);
  REQUIRE(second.t_s.size() == 27);
  CHECK(second.t_s.front() == 0.0);
  CHECK(second.x_m[10] == Approx(0.5 * 3.0 * 0.04 + 1e-4));
  options.masses_kg = {};
  options.runs = "1,3";
  const core::Experiment two = core::read_tracks(file, options);
  REQUIRE(two.clips.size() == 2);
  CHECK(two.clips[1].name == "Run 4");
  CHECK_THROWS_WITH(core::read_track_csv(file, 1), Contains("Position (m) Run 1") && Contains("--runs"));
}

TEST_CASE("a column of whole numbers without times that begin anew numbers no runs") {
  const tests::TempDir temp;
  const auto text = [](const auto& run, const auto& time) {
    std::string rows = "Run,t (s),x (m)\n";
    for (int i = 0; i < 30; ++i)
      rows += fmt::format("{},{:.2f},{:.6f}\n", run(i), time(i), 0.01 * i * i + 1e-5 * (i % 3));
    return rows;
  };
  const auto goes_on = [](int i) { return 0.02 * i; };
  const auto again = [](int i) { return 0.02 * (i % 15); };
  base::write_file(temp / "a.csv", text([](int i) { return i / 15; }, goes_on));
  CHECK(core::read_track_csv(temp / "a.csv", 1).t_s.size() == 30);
  // Times that begin anew where no number changes, or a number that returns.
  base::write_file(temp / "b.csv", text([](int) { return 1; }, again));
  CHECK_THROWS_WITH(core::read_track_csv(temp / "b.csv", 1), Contains(":17:") && Contains("a time above"));
  base::write_file(temp / "c.csv", text([](int i) { return i / 10 % 2; }, [](int i) { return 0.02 * (i % 10); }));
  CHECK_THROWS_WITH(core::read_track_csv(temp / "c.csv", 1), Contains("a time above"));
}
