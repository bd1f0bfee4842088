#include "core/track/track_data.h"

#include <fmt/format.h>

#include <fstream>
#include <functional>
#include <limits>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/temp_dir.h"

using Catch::Matchers::Contains;
using core::TrackData;
using namespace glidelab;

namespace {

/// The issues of numbers that are refused.
std::vector<base::Issue> issues_of(std::vector<double> t_s, std::vector<double> x_m, std::vector<double> force_n = {}) {
  try {
    core::track_of_numbers(std::move(t_s), std::move(x_m), std::move(force_n), "clip \"up\"");
  } catch (const base::InputError& error) {
    return error.issues();
  }
  return {};
}

const std::vector<double> kTimes = {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7};
const std::vector<double> kPlaces = {0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75};

TrackData track_of(double until_s, const std::function<double(double)>& x) {
  TrackData track;
  for (int i = 0; i * 0.01 <= until_s; ++i) {
    track.t_s.push_back(0.01 * i);
    track.x_m.push_back(x(0.01 * i));
  }
  return track;
}

TrackData reversed(TrackData track) {
  for (double& x : track.x_m) x = -x;
  return track;
}

}  // namespace

TEST_CASE("a track of numbers is that of a file with these numbers") {
  const tests::TempDir temp;
  std::string text = "t_s,x_m,force_n\n";
  for (std::size_t i = 0; i < kTimes.size(); ++i) {
    text +=
        std::to_string(kTimes[i]) + "," + std::to_string(kPlaces[i]) + "," + std::to_string(2.0 * kPlaces[i]) + "\n";
  }
  base::write_file(temp / "track.csv", text);
  const TrackData of_file = core::read_track_csv(temp / "track.csv", 1);
  const TrackData given = core::track_of_numbers(kTimes, kPlaces, of_file.force_n, "clip");
  CHECK(given.t_s == of_file.t_s);
  CHECK(given.x_m == of_file.x_m);
  CHECK(given.frame == of_file.frame);
  CHECK(given.frame_t_s == of_file.frame_t_s);
  CHECK(given.frame_rate_hz == of_file.frame_rate_hz);
  CHECK(given.notes.empty());
}

TEST_CASE("numbers that make no track are named by their place") {
  std::vector<double> bad = kPlaces;
  bad[3] = std::numeric_limits<double>::quiet_NaN();
  std::vector<base::Issue> issues = issues_of(kTimes, bad);
  REQUIRE(issues.size() == 1);
  CHECK(issues[0].file == "clip \"up\"");
  CHECK(issues[0].key == "x_m[3]");
  CHECK(issues[0].found == "nan");

  std::vector<double> back = kTimes;
  back[4] = back[3];
  issues = issues_of(back, kPlaces);
  REQUIRE(issues.size() == 1);
  CHECK(issues[0].key == "t_s[4]");
  CHECK(issues[0].found == "0.3 twice");

  issues = issues_of(kTimes, {0.0, 1.0});
  REQUIRE(issues.size() == 1);
  CHECK(issues[0].key == "x_m");
  CHECK(issues[0].found == "2 numbers");
  CHECK(issues[0].expected == "as many as times, 8");

  issues = issues_of({0.0, 1.0}, {0.0, 1.0});
  REQUIRE(issues.size() == 1);
  CHECK(issues[0].found == "2 points");

  CHECK(issues_of(std::vector<double>(100, 0.0), std::vector<double>(100, 0.0)).size() == 10);
}

TEST_CASE("a time far away from all others is no track of numbers either") {
  std::vector<double> t = kTimes;
  t.back() = 1e6;
  const std::vector<base::Issue> issues = issues_of(t, kPlaces);
  REQUIRE(issues.size() == 1);
  CHECK(issues[0].key == "t_s[7]");
  CHECK_THAT(issues[0].found, Catch::Matchers::Contains("a gap of 999999 s"));
  CHECK_THAT(issues[0].expected, Catch::Matchers::Contains("two recordings are two clips"));
}

TEST_CASE("the tracks of a set-up share one sign, and a second reversal takes the first one's note back") {
  TrackData fall = reversed(track_of(0.5, [](double t) { return 4.9 * t * t; }));
  TrackData unclear = track_of(0.1, [](double t) { return 0.01 * t; });  // a hand at the end of the rail
  const double x_m = unclear.x_m.back();
  core::count_downwards({&fall, &unclear});
  CHECK(fall.x_m.back() > fall.x_m.front());
  CHECK(unclear.x_m.back() == -x_m);
  CHECK(tests::note_of<core::CountedAlongMotion>(unclear.notes) != nullptr);
  fall = reversed(fall);
  core::count_downwards({&fall, &unclear});
  CHECK(unclear.x_m.back() == x_m);
  CHECK(tests::note_of<core::CountedAlongMotion>(unclear.notes) == nullptr);
}

TEST_CASE("speeds and forces are reversed with their track") {
  TrackData track = track_of(0.5, [](double t) { return -0.5 * 9.81 * t * t; });
  track.force_n.assign(track.t_s.size(), 2.0);
  core::count_downwards({&track});
  CHECK(track.force_n.front() == -2.0);
  TrackData speeds;
  for (int i = 0; i < 20; ++i) {
    speeds.t_s.push_back(0.01 * i);
    speeds.v_m_s.push_back(-0.1 * i);
  }
  core::count_downwards({&speeds});
  CHECK(speeds.v_m_s.back() == Approx(1.9));
}

TEST_CASE("what a sensor writes while it sees nothing is left out, before the sign of a fall is judged") {
  // A bead that sinks at 75 mm/s, which a sensor sees from 0.5 s to 3 s; else it writes 0. 60 mm at first.
  const tests::TempDir temp;
  std::string text = "t (s),y (mm)\n", own = "t_s,x_m\n";
  for (int i = 0; i < 80; ++i) {
    const double t = 0.05 * i, y = i < 10 || i > 60 ? 0.0 : 60.0 + 75.0 * (t - 0.5);
    text += std::to_string(t) + "," + std::to_string(y) + "\n";
    own += std::to_string(t) + "," + std::to_string(1e-3 * y) + "\n";
  }
  base::write_file(temp / "bead.csv", text);
  base::write_file(temp / "own.csv", own);
  const TrackData bead = core::read_track_csv(temp / "bead.csv", std::nullopt);
  for (const TrackData& track : {bead, core::read_track_csv(temp / "own.csv", 1)}) {
    REQUIRE(track.x_m.size() == 51);
    CHECK(track.frame_t_s.size() == 51);
    CHECK(track.t_s.front() == Approx(0.5));
    CHECK(track.x_m.back() - track.x_m.front() == Approx(0.075 * 2.5));  // downwards
    const auto* const note = tests::note_of<core::PositionsUnseen>(track.notes);
    REQUIRE(note != nullptr);
    CHECK(note->positions == 29);
    CHECK(note->value_m == 0.0);
    CHECK(note->from_s == 0.0);
  }
  CHECK(tests::note_of<core::CountedAlongMotion>(bead.notes) == nullptr);
}

TEST_CASE("a recorded force keeps its places when unseen positions are left out") {
  std::vector<double> t_s, x_m, force_n;
  for (int i = 0; i < 30; ++i) {
    t_s.push_back(0.1 * i);
    x_m.push_back(i >= 12 && i < 17 ? -5.0 : 0.05 * i);
    force_n.push_back(i);
  }
  const TrackData track = core::track_of_numbers(t_s, x_m, force_n, "clip");
  REQUIRE(track.x_m.size() == 25);
  CHECK(track.force_n[11] == 11.0);
  CHECK(track.force_n[12] == 17.0);
  CHECK(track.t_s[12] == Approx(1.7));
}

TEST_CASE("the rows of a film that a converter brought to a higher rate get the camera's times") {
  // 50 images a second in 60 rows a second; a recorded force keeps its places.
  std::vector<double> t_s, x_m, force_n;
  for (int row = 0; row < 120; ++row) {
    const double seen_s = std::floor(50.0 / 60.0 * row + 0.2) / 50.0;
    t_s.push_back(row / 60.0);
    x_m.push_back(0.9 * seen_s - 0.15 * seen_s * seen_s);
    force_n.push_back(seen_s);
  }
  const core::TrackData track = core::track_of_numbers(t_s, x_m, force_n, "clip");
  REQUIRE(track.t_s.size() == 100);
  CHECK(track.frame_rate_hz == Approx(50.0).epsilon(1e-9));
  double worst_s = 0.0;
  for (std::size_t i = 0; i < track.t_s.size(); ++i) {
    worst_s = std::max(worst_s, std::abs(track.t_s[i] - track.t_s[0] - (track.force_n[i] - track.force_n[0])));
  }
  CHECK(worst_s < 1e-12);
  const auto* const note = tests::note_of<core::RepeatsLeftOut>(track.notes);
  REQUIRE(note != nullptr);
  CHECK(note->repeats == 20);
  CHECK(note->frames == 120);
  CHECK(note->camera_hz == Approx(50.0).epsilon(1e-9));
}

TEST_CASE("rows that repeat the one before in place of lost frames are left out, and the others keep their times") {
  std::vector<double> t_s, x_m;
  for (int row = 0; row < 90; ++row) {
    const bool lost = row % 13 == 7 || row % 17 == 11;
    t_s.push_back(row / 30.0);
    x_m.push_back(lost ? x_m.back() : 0.4 * t_s.back() + 0.05 * t_s.back() * t_s.back());
  }
  const core::TrackData track = core::track_of_numbers(t_s, x_m, {}, "clip");
  const auto* const note = tests::note_of<core::RepeatsLeftOut>(track.notes);
  REQUIRE(note != nullptr);
  CHECK(note->in_place_of_lost);
  CHECK(note->repeats == 90 - track.t_s.size());
  for (std::size_t i = 0; i < track.t_s.size(); ++i) {
    CHECK(track.x_m[i] == Approx(0.4 * track.t_s[i] + 0.05 * track.t_s[i] * track.t_s[i]).margin(1e-12));
  }
}

namespace {

std::filesystem::path write(const tests::TempDir& folder, const std::string& text) {
  const std::filesystem::path file = folder / "track.csv";
  std::ofstream(file) << text;
  return file;
}

std::string rows(int count, const std::string& tail = {}) {
  std::string text;
  for (int i = 0; i < count; ++i) text += fmt::format("{},{}{}\n", 0.01 * i, 0.5 * i, tail);
  return text;
}

}  // namespace

TEST_CASE("a track file is read as it stands where x is positive downhill") {
  const tests::TempDir folder;
  const core::TrackData track = core::read_track_csv(write(folder, "# by hand\nt_s,x_m\n" + rows(10)), 1);
  REQUIRE(track.t_s.size() == 10);
  CHECK(track.x_m[9] == 4.5);
  CHECK(track.force_n.empty());
  CHECK(track.frame.back() == 9);
  CHECK(track.frame_t_s == track.t_s);
  CHECK(track.frame_rate_hz == Approx(100.0).epsilon(1e-12));  // one over a difference of decimal fractions: rounding
}

TEST_CASE("x and the force of a track change sign where downhill is -x") {
  const tests::TempDir folder;
  const core::TrackData track = core::read_track_csv(write(folder, "t_s,x_m,force_n\n" + rows(8, ",3")), -1);
  CHECK(track.x_m[7] == -3.5);
  CHECK(track.force_n[0] == -3.0);
}

TEST_CASE("times of a track that do not rise are named by line") {
  const tests::TempDir folder;
  const std::string head = "t_s,x_m\n" + rows(9);  // lines 1 to 10
  CHECK_THROWS_WITH(core::read_track_csv(write(folder, head + "0.08,1\n0.01,2\n"), 1),
                    Contains("track.csv:11") && Contains("twice") && Contains("track.csv:12"));
}

TEST_CASE("a track of fewer points than a local cubic needs is an input error") {
  const tests::TempDir folder;
  CHECK_THROWS_WITH(core::read_track_csv(write(folder, "t_s,x_m\n" + rows(7)), 1), Contains("7 points"));
  CHECK_THROWS_AS(core::read_track_csv(write(folder, "t_s,x_m\n"), 1), base::InputError);
}

TEST_CASE("a track with a decimal comma, a NaN or no file is an input error") {
  const tests::TempDir folder;
  CHECK_THROWS_AS(core::read_track_csv(write(folder, "t_s,x_m\n0,01,0,5\n"), 1), base::InputError);
  CHECK_THROWS_WITH(core::read_track_csv(write(folder, "t_s,x_m\n" + rows(8) + "1.0,nan\n"), 1), Contains(":10"));
  CHECK_THROWS_AS(core::read_track_csv(folder / "none.csv", 1), base::InputError);
}

TEST_CASE(
    "a gap in the times that no motion bridges is named by line, in a track of our own and in another program's") {
  const tests::TempDir folder;
  // A median step of 0.01 s allows for 1000 s. Line 11 is the first behind the gap.
  const std::string paused = rows(9) + "900.08,4\n900.09,4.1\n", lost = rows(9) + "1000001,4\n1000001.01,4.1\n";
  CHECK(core::read_track_csv(write(folder, "t_s,x_m\n" + paused), 1).t_s.size() == 11);
  CHECK(core::read_track_csv(write(folder, "time,x\n" + paused), 1).t_s.size() == 11);
  CHECK_THROWS_WITH(
      core::read_track_csv(write(folder, "t_s,x_m\n" + lost), 1),
      Contains("track.csv:11: column \"t_s\": found 1000001 s, a gap of 1e+06 s after line 10, expected a "
               "gap of at most 1000 s"));
  CHECK_THROWS_WITH(core::read_track_csv(write(folder, "time,x\n" + lost), 1),
                    Contains("track.csv:11: column \"time\": found 1000001 s, a gap"));
}
