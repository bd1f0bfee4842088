/// Tables that count frames and pixels, as DeepLabCut, SLEAP, TrackMate and scripts write them.
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/experiment/experiment.h"
#include "core/result/analysis_note.h"
#include "core/track/bare_track.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

constexpr double kRate_hz = 50.0, kPxPerM = 400.0;
constexpr int kRows = 30;

/// x = 0.3 t² in metres, from the 7th frame on.
double place_m(int row) {
  const double t = row / kRate_hz;
  return 0.3 * t * t;
}

core::ImageUnits units(std::optional<double> rate_hz = kRate_hz, std::optional<double> px_per_m = kPxPerM) {
  return {rate_hz, px_per_m, 0.0, true};
}

struct Made {
  tests::TempDir dir;
  std::filesystem::path file = dir / "cart.csv";
  explicit Made(const std::string& text) { base::write_file(file, text); }
  core::TrackData read(const core::ImageUnits& of, const std::string& column = "") const {
    return core::read_track(file, core::Downhill::plus_x, column, core::SpeedsAlone::refused, of);
  }
};

void check_motion(const core::TrackData& track) {
  REQUIRE(track.x_m.size() == kRows);
  for (int i = 0; i < kRows; ++i) {
    const auto at = static_cast<std::size_t>(i);
    CHECK(track.t_s[at] == Approx((7 + i) / kRate_hz).epsilon(1e-9));
    CHECK(track.x_m[at] - track.x_m[0] == Approx(place_m(i)).margin(2e-5));
  }
}

}  // namespace

TEST_CASE("a table of DeepLabCut is read in its frames and pixels, without what it is not sure of") {
  std::string text =
      "scorer,net,net,net,net,net,net\nbodyparts,cart,cart,cart,hand,hand,hand\n"
      "coords,x,y,likelihood,x,y,likelihood\n";
  for (int i = -5; i < kRows; ++i) {
    text +=
        i < 0 ? fmt::format("{},{},{},0.1{},1,1,0.9\n", 7 + i, (7919 * (i + 9)) % 640, (104729 * (i + 9)) % 480, i + 9)
              : fmt::format("{},{:.3f},240,{},{},2,0.2\n", 7 + i, 50.0 + kPxPerM * place_m(i), i == 3 ? 0.6 : 0.99, i);
  }
  const Made made(text);
  const core::TrackData track = made.read(units(), "cart: x");
  check_motion(track);
  const auto* const out = tests::note_of<core::UnlikelyLeftOut>(track.notes);
  REQUIRE(out);
  CHECK(out->rows == 5);
  const auto* const taken = tests::note_of<core::ImageUnitsTaken>(track.notes);
  REQUIRE(taken);
  CHECK(taken->frame_rate_hz == kRate_hz);
  CHECK(taken->px_per_m == kPxPerM);
  CHECK(tests::note_of<core::UnitAssumed>(track.notes) == nullptr);

  CHECK_THROWS_WITH(made.read(units()), Contains("cart: x") && Contains("hand: x") && Contains("--runs all"));
  CHECK_THROWS_WITH(made.read({}, "cart: x"), Contains("frame numbers (\"frame\")") && Contains("--frame-rate"));
  CHECK_THROWS_WITH(made.read(units(kRate_hz, {}), "cart: x"), Contains("the unit \"px\"") && Contains("--px-per-m"));
  const std::vector<core::TrackRun> runs = core::runs_in(made.file);
  REQUIRE(runs.size() == 2);
  CHECK(runs[1].label == "hand");
}

TEST_CASE("what a table of one body is not sure of takes no part in the choice of its path") {
  std::string text = "scorer,net,net,net\nbodyparts,cart,cart,cart\ncoords,x,y,likelihood\n";
  for (int i = 0; i < kRows; ++i) {
    text += fmt::format("{},{:.3f},240,0.99\n", 7 + i, 50.0 + kPxPerM * place_m(i));
    if (i % 6 == 3) text += fmt::format("{},{},{},0.1\n", 7.5 + i, (97 * i) % 640, 20 * i);  // all over the image
  }
  const core::TrackData track = Made(text).read(units());
  check_motion(track);
  CHECK(tests::note_of<core::SlantedPath>(track.notes) == nullptr);
}

TEST_CASE("a folder's scale, which may be that of its films, leaves a table with times in metres") {
  std::string text = "t,x\n";
  for (int i = 0; i < kRows; ++i) text += fmt::format("{},{:.6f}\n", (7 + i) / kRate_hz, place_m(i));
  core::ImageUnits of_folder = units();
  of_folder.for_this_table = false;
  check_motion(Made(text).read(of_folder));
}

TEST_CASE("the animals of a table of DeepLabCut are told apart") {
  std::string text =
      "scorer,net,net,net,net\nindividuals,left,left,right,right\nbodyparts,cart,cart,cart,cart\n"
      "coords,x,y,x,y\n";
  for (int i = 0; i < kRows; ++i)
    text += fmt::format("{},{:.3f},240,{},9\n", 7 + i, 50.0 + kPxPerM * place_m(i), i % 5);
  check_motion(Made(text).read(units(), "left cart: x"));
}

TEST_CASE("tables of SLEAP, of TrackMate and of scripts are read in frames and pixels, along their path") {
  std::string sleap = "track,frame_idx,instance.score,thorax.x,thorax.y,thorax.score\n", script = "frame,x_px,y_px\n",
              plain = "Frame,X (pixel),Y (pixel)\n",
              trackmate =
                  "LABEL,ID,POSITION_X,POSITION_Y,POSITION_T,FRAME\nLabel,Spot ID,X,Y,T,Frame\n"
                  "Label,Spot ID,X,Y,T,Frame\n,,(pixel),(pixel),(sec),\n";
  for (int i = 0; i < kRows; ++i) {
    const double along = kPxPerM * place_m(i), x = 50.0 + 0.8 * along, y = 60.0 + 0.6 * along;
    sleap += fmt::format("track_0,{},0.98,{:.4f},{:.4f},0.9\n", 7 + i, x, y);
    script += fmt::format("{},{:.4f},{:.4f}\n", 7 + i, x, y);
    plain += fmt::format("{},{:.4f},{:.4f}\n", 7 + i, x, y);
    trackmate += fmt::format("ID{0},{0},{1:.4f},{2:.4f},{3},{4}\n", i, x, y, (7 + i) / kRate_hz, 7 + i);
  }
  for (const std::string& text : {sleap, script, plain}) {
    INFO(text.substr(0, 40));
    check_motion(Made(text).read(units()));
  }
  const Made times(trackmate);
  check_motion(times.read(units({})));
  CHECK_THROWS_WITH(times.read(units()), Contains("--frame-rate") && Contains("times (\"T\")"));
}

namespace {

/// Qualisys: what was recorded above the numbers, one in a line, no times, millimetres. Two markers, cart and rail.
std::string qualisys(const std::string& header) {
  std::string text =
      "NO_OF_FRAMES\t30\nNO_OF_CAMERAS\t2\nNO_OF_MARKERS\t2\nFREQUENCY\t50\nNO_OF_ANALOG\t0\nDESCRIPTION\t--\n"
      "TIME_STAMP\t2023-09-23, 10:09:02.604\t117623.99684550\nDATA_INCLUDED\t3D\nMARKER_NAMES\tcart\trail\n"
      "TRAJECTORY_TYPES\tMeasured\tMeasured\n" +
      header;
  for (int i = 0; i < kRows; ++i)
    text += fmt::format("{:.3f}\t59.1\t397.7\t1.5\t60.2\t398.1\n", 1e3 * place_m(i) - 206);
  return text;
}

}  // namespace

TEST_CASE("a table of Qualisys has its frame rate above its header, millimetres, and a marker before each axis") {
  const std::string headed = "cart X\tcart Y\tcart Z\trail X\trail Y\trail Z\t\n";
  for (const std::string& header : {headed, std::string()}) {
    CAPTURE(header);
    const Made made(qualisys(header));
    const std::vector<core::TrackRun> runs = core::runs_in(made.file);
    REQUIRE(runs.size() == 2);
    CHECK(runs[0].label == "cart");
    CHECK(runs[1].label == "rail");
    const core::TrackData track = made.read({}, "cart: x");
    REQUIRE(track.x_m.size() == kRows);
    for (int i = 0; i < kRows; ++i) {
      const auto at = static_cast<std::size_t>(i);
      CHECK(track.t_s[at] == Approx(i / kRate_hz));
      CHECK(track.x_m[at] == Approx(place_m(i) - 0.206).margin(1e-6));
    }
    const auto* const taken = tests::note_of<core::ImageUnitsTaken>(track.notes);
    REQUIRE(taken);
    CHECK(taken->frame_rate_hz == kRate_hz);
    CHECK(made.read(units(100.0, {}), "cart: x").t_s[1] == Approx(0.01));  // what a person states counts
  }
  // With times of its own, whose header has words for the markers as well.
  std::string timed = "FREQUENCY\t7\nBODIES\t2\nTime\tcart X\tcart Y\n";
  for (int i = 0; i < kRows; ++i) timed += fmt::format("{}\t{:.6f}\t0.1\n", i / kRate_hz, place_m(i));
  const core::TrackData track = Made(timed).read({});
  CHECK(track.t_s[1] == Approx(1.0 / kRate_hz));
  CHECK(track.x_m[9] == Approx(place_m(9)).margin(1e-6));
}

TEST_CASE("components of a velocity are those of no body") {
  std::string text = "t,x,velocity x,velocity y\n";
  for (int i = 0; i < kRows; ++i) text += fmt::format("{},{:.6f},{},0\n", i / kRate_hz, place_m(i), 0.6 * i / kRate_hz);
  CHECK(Made(text).read({}).x_m[9] == Approx(place_m(9)).margin(1e-6));
}

TEST_CASE("columns that are named by numbers are no statements above a header") {
  std::string text = "time,10,20\n";
  for (int i = 0; i < kRows; ++i) text += fmt::format("{},{:.6f},3\n", i / kRate_hz, place_m(i));
  const core::TrackData track = Made(text).read({}, "2");
  CHECK(track.t_s[1] == Approx(1.0 / kRate_hz));
}

TEST_CASE("units of images that a file does not need are refused where they were stated for it") {
  std::string metres = "t (s),x (m)\n", own = "t_s,x_m\n";
  for (int i = 0; i < kRows; ++i) {
    metres += fmt::format("{},{:.6f}\n", (7 + i) / kRate_hz, place_m(i));
    own += fmt::format("{},{:.6f}\n", (7 + i) / kRate_hz, place_m(i));
  }
  const Made table(metres), csv(own);
  CHECK_THROWS_WITH(table.read(units(kRate_hz, {})), Contains("--frame-rate") && Contains("times (\"t (s)\")"));
  CHECK_THROWS_WITH(table.read(units({}, kPxPerM)), Contains("--px-per-m") && Contains("lengths in m"));
  CHECK_THROWS_WITH(csv.read(units({}, kPxPerM)), Contains("--px-per-m") && Contains("t_s"));
  // A folder states them for those of its tables that need them.
  core::ImageUnits of_folder = units();
  of_folder.for_this_table = false;
  check_motion(table.read(of_folder));
  check_motion(csv.read(of_folder));
}

TEST_CASE("a folder's camera and scale turn its tables into seconds and metres, and the scale has its uncertainty") {
  const tests::TempDir dir;
  std::string text = "frame,x,y\n";
  for (int i = 0; i < kRows; ++i) text += fmt::format("{},{:.4f},100\n", 7 + i, 50.0 + kPxPerM * place_m(i));
  base::write_file(dir / "a.csv", text);
  base::write_file(dir / "experiment.toml",
                   "format = 1\nname = \"cart\"\n[camera]\nframe_rate_hz = 50.0\n[scale]\npx_per_m = 400.0\n"
                   "px_per_m_sd = 8.0\n[[clip]]\nname = \"a\"\ntrack = \"a.csv\"\nmass_kg = 0.2\nincline_deg = 2.0\n"
                   "launched = \"released\"\n");
  const core::Experiment experiment = core::read_experiment(dir / ".");
  REQUIRE(experiment.clips.size() == 1);
  const core::ClipSetup& clip = experiment.clips.front();
  const core::TrackData track = core::read_track(clip.track, {}, "", core::SpeedsAlone::refused, clip.image_units);
  check_motion(track);
  CHECK(track.scale_sd_relative == Approx(8.0 / 400.0));
}
