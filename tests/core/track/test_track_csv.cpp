#include "core/track/track_data.h"

#include <fmt/format.h>

#include <fstream>

#include "base/errors.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;

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
