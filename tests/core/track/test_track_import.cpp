#include "core/track/track_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>

#include "base/errors.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

/// Ten rows of the given pattern; {0} is the number, {1} the time in hundredths of a second.
std::string rows(const std::string& pattern) {
  std::string text;
  for (int i = 0; i < 10; ++i) text += fmt::format(fmt::runtime(pattern), i, i * i);
  return text;
}

struct Made {
  tests::TempDir folder;
  std::filesystem::path file;
  explicit Made(const std::string& text) : file(folder / "export.txt") { std::ofstream(file) << text; }
  core::TrackData read(const std::string& column = {}) const { return core::read_track_csv(file, 1, column); }
};

/// t = 0.1 i, x = 0.01 i^2 in SI.
void check_motion(const core::TrackData& track) {
  REQUIRE(track.t_s.size() == 10);
  for (std::size_t i = 0; i < 10; ++i) {
    const auto n = static_cast<double>(i);
    CHECK(track.t_s[i] == Approx(0.1 * n).margin(1e-12));  // decimal fractions
    CHECK(track.x_m[i] == Approx(0.01 * n * n).margin(1e-12));
  }
  CHECK(track.frame_rate_hz == Approx(10.0).epsilon(1e-9));
}

}  // namespace

TEST_CASE("Tracker's table: tabs, a title, names without units, y beside x") {
  const Made made("mass A\nt\tx\ty\n" + rows("0.{0}00E0\t{1}E-2\t0.5\n"));
  const core::TrackData track = made.read();
  check_motion(track);
  const auto* const unit = tests::note_of<core::UnitAssumed>(track.notes);
  REQUIRE(unit != nullptr);
  CHECK(unit->column == "x");
  CHECK(unit->unit == "metres");
}

TEST_CASE("Tracker's table in a country of decimal commas: semicolons") {
  check_motion(Made("#multi:\nt;x;y\n" + rows("0,{0};{1}E-2;-0,5\n")).read());
}

TEST_CASE("Logger Pro's CSV: quoted names with units, several runs side by side, of different lengths") {
  const std::string text =
      "\"Run 1: Time (s)\",\"Run 1: Position (m)\",\"Run 1: Velocity (m/s)\",\"Latest: Time (s)\",\"Latest: Position "
      "(cm)\"\n"
      "0.05,0.7,1.0,0.0,0\n" +
      rows("0.{0}7,0.5,1.0,0.{0},{1}\n").substr(std::string("0.07,0.5,1.0,0.0,0\n").size()) +
      "1.5,0.5,1.0,,\n1.6,0.5,1.0,,\n";
  const Made made(text);
  CHECK_THROWS_WITH(made.read(), Contains("Run 1: Position") && Contains("--column") && Contains("Latest: Position"));
  check_motion(made.read("Latest: Position"));
  check_motion(made.read("latest: position (cm)"));
  check_motion(made.read("5"));
  const core::TrackData other = made.read("Run 1: Position");
  CHECK(other.t_s.size() == 12);
  CHECK(other.t_s[0] == 0.05);
  CHECK_THROWS_WITH(made.read("Velocity"), Contains("m/s"));
  CHECK_THROWS_WITH(made.read("height"), Contains("none of the name or number \"height\""));
}

TEST_CASE("Vernier's text: title lines, runs, names, short names and units in lines of their own") {
  const Made made(
      "Vernier Format 2\nUntitled.cmbl 11/4/2019 10:23:27 .\nRun 1\t\t\tLatest\t\t\n"
      "Time\tPosition\tVelocity\tTime\tPosition\tVelocity\nt\tx\tv\tt\tx\tv\ns\tm\tm/s\tms\tmm\tm/s\n\n" +
      rows("9.{0}\t7.5\t0\t{0}00\t{1}0\t0.3\n"));
  const core::TrackData track = made.read("Latest: Position");
  check_motion(track);
  const auto* const taken = tests::note_of<core::ColumnsTaken>(track.notes);
  REQUIRE(taken != nullptr);
  CHECK(taken->run == "Latest");
  CHECK(made.read("2").x_m[0] == 7.5);
}

TEST_CASE("PASCO's CSV: a line of runs above the names, and runs behind them") {
  check_motion(Made("Run #1,Run #1,Run #2,Run #2\nTime (s),Position (m),Time (s),Position (m)\n" +
                    rows("0.{0},{1}e-2,3.{0},4.0\n"))
                   .read("Run #1: Position"));
  check_motion(Made("\"Time (s) Run #2\"\t\"Position (m) Run #2\"\n" + rows("0.{0}\t{1}e-2\n")).read());
}

TEST_CASE("phyphox: quotes, semicolons, decimal commas, scientific notation, NaN") {
  const core::TrackData track =
      Made("\"Time (s)\";\"Position (cm)\"\n" + rows("{0},0E-1;{1},0E0\n") + "0,95;NaN\n").read();
  check_motion(track);
  CHECK(tests::note_of<core::RowsIncomplete>(track.notes) == nullptr);  // it is the last row
  const core::TrackData gap = Made("Time (s),x (m)\n" + rows("{0},{1}\n") + "10.5,NaN\n11,5\n").read();
  CHECK(gap.t_s.size() == 11);
  const auto* const incomplete = tests::note_of<core::RowsIncomplete>(gap.notes);
  REQUIRE(incomplete != nullptr);
  CHECK(incomplete->rows == 1);
}

TEST_CASE("two columns without a header are time and place, and a byte-order mark and CRLF do not matter") {
  check_motion(Made(rows("0.{0},{1}e-2\r\n")).read());
  check_motion(Made("\xEF\xBB\xBFt (s),x (mm)\r\n" + rows("0.{0},{1}0\r\n")).read());
  check_motion(Made("zeit_ms,weg_mm\n" + rows("{0}00,{1}0\n")).read());
}

TEST_CASE("Tracker's table with a padded line of masses, each over its t, x and y, and one behind a '#'") {
  const std::string text = "mass A\t\t\tmass B\t\t\nt\tx\ty\tt\tx\ty\n" + rows("0.{0}\t7.0\t0.5\t0.{0}\t{1}E-2\t0.5\n");
  const Made several(text);
  check_motion(several.read("mass B: x"));
  CHECK_THROWS_WITH(several.read(), Contains("--runs all"));
  check_motion(Made("mass A\t\t\nt\tx\ty\n" + rows("0.{0}\t{1}E-2\t0.5\n")).read());
  check_motion(Made("# exported by Tracker\n#t\tx\ty\n" + rows("0.{0}\t{1}E-2\t0.5\n")).read());
}

TEST_CASE("channels of a sensor and words of other languages are positions") {
  for (const char* name : {"Position, Ch 1 (m)", "Position, Ch 1, Run #2 (m)", "Abstand (m)", "Weg (m)",
                           "Posici\u00f3n (m)", "D\u00e9placement (m)", "Dist\u00e2ncia (m)"}) {
    INFO(name);
    check_motion(Made(fmt::format("\"Time (s)\";\"{}\"\n", name) + rows("0.{0};{1}e-2\n")).read());
  }
}

TEST_CASE("accelerations alone are refused with the reason") {
  const Made phone("\"Time (s)\",\"Linear Acceleration x (m/s^2)\",\"Linear Acceleration y (m/s^2)\"\n" +
                   rows("0.{0},0.{0},0.1\n"));
  CHECK_THROWS_WITH(phone.read(), Contains("accelerations without positions") && Contains("integrated"));
}

TEST_CASE("speeds alone are refused with the reason, and beside positions they are no matter") {
  for (const char* name : {"Velocity (m/s)", "Geschwindigkeit (m/s)", "v (cm/s)", "v", "Speed"}) {
    INFO(name);
    const Made radar(fmt::format("\"Time (s)\",\"{}\"\n", name) + rows("0.{0},0.{0}\n"));
    CHECK_THROWS_WITH(radar.read(), Contains("speeds without positions") && Contains("too narrow") &&
                                        Contains("`glidelab analyze` without --with also takes speeds"));
  }
  CHECK_THROWS_WITH(Made("t_s,v_m_s\n" + rows("0.{0},0.{0}\n")).read(), Contains("speeds without positions"));
  check_motion(Made("\"Time (s)\",\"Position (cm)\",\"Velocity (m/s)\"\n" + rows("0.{0},{1},0.1\n")).read());
}

TEST_CASE("a name that only contains t_s, as zeit_s, is another program's and imported") {
  check_motion(Made("zeit_s,weg_mm\n" + rows("0.{0},{1}0\n")).read());
  check_motion(Made("t_sec,x_mm\n" + rows("0.{0},{1}0\n")).read());
}

TEST_CASE("downhill towards -x turns the sign of an imported track") {
  const Made made("t (s),x (m)\n" + rows("0.{0},{1}\n"));
  CHECK(core::import_track(made.file, "", -1).x_m[3] == -9.0);
}

TEST_CASE("bad tables give one clear error each") {
  struct Row {
    std::string text, message;
  };
  const Row bad[] = {
      {"a few words\nand some more\n", "no line with two numbers"},
      {"", "t_s"},
      {"t (s),x (m)\n" + rows("0.{0},{1}\n") + "0.95,oops\n", ":12: column 2: found \"oops\""},
      {"t (s),x (m)\n" + rows("0.{0},{1}\n") + "0.8,1\n", ":12: column \"t (s)\""},
      {"t (s),x (m)\n" + rows("0,{0},0,{1}\n"), "decimal comma"},
      {"t (s),y (m),z (m)\n" + rows("0.{0},{1},1\n"), "--column"},
      {"t (s),x (px)\n" + rows("0.{0},{1}\n"), "the unit \"px\""},
      {"number,x (m)\n" + rows("{0},{1}\n"), "0 columns of time"},
      {"frame,x (m)\n" + rows("{0},{1}\n"), "only frame numbers (\"frame\")"},
      {"t (s),x (m)\n0,0\n1,1\n2,2\n", "3 points"},
      {std::string("t\0 \0x\0", 6), "zero bytes"},
      {std::string("\0\0\0\x20"
                   "ftypisom\0\0\2\0",
                   16),
       "found a video"},
      {std::string("RIFF\x10\0\0\0AVI LIST", 16), "found a video"},
      {"\x1A\x45\xDF\xA3\x01", "found a video"},
  };
  for (const Row& row : bad) {
    INFO(row.message);
    const Made made(row.text);
    CHECK_THROWS_AS(made.read(), base::InputError);
    CHECK_THROWS_WITH(made.read(), Contains(row.message));
  }
  CHECK_THROWS_AS(core::read_track_csv("nothing-here.csv", 1), base::InputError);
}

TEST_CASE("blanks between the columns, as numpy and MATLAB write them, with and without names, in any number") {
  check_motion(Made(rows("   0.{0}00E0    {1}E-2\n")).read());
  check_motion(Made("Falling ball, second try\nt (s)   x (cm)\n" + rows(" 0.{0}  {1}.0\n")).read());
  check_motion(Made("time position\n" + rows("0,{0} {1}e-2\n")).read());
  check_motion(Made("A title\nt x y\n" + rows("0.{0} {1}e-2 0.5\n")).read());
}

TEST_CASE("names behind a '#' and their units behind another, and units behind a stroke or \"in\"") {
  check_motion(Made("#made on a Tuesday\n#Time\tPos\n#[s]\t[cm]\n" + rows("0.{0}\t{1}\n")).read());
  check_motion(Made("t / s;x / cm\n" + rows("0,{0};{1}\n")).read());
  check_motion(Made("Zeit in ms;Weg in mm\n" + rows("{0}00;{1}0\n")).read());
  CHECK_THROWS_WITH(Made("#Time\tPos\n#[s]\t[au]\n" + rows("0.{0}\t{1}\n")).read(), Contains("the unit \"au\""));
}

TEST_CASE("a height alone is x as in its table, with a note, and counted downwards along the motion") {
  const auto downwards = [](const std::string& text) {
    core::TrackData track = core::read_track_csv(Made(text).file, std::nullopt);
    CHECK(tests::note_of<core::HeightTaken>(track.notes) != nullptr);
    core::count_downwards({&track});
    return track;
  };
  const std::string fall = "t (s)\ty (m)\n" + rows("0.{0}\t-{1}e-2\n");
  const core::TrackData down = downwards(fall);
  check_motion(down);
  CHECK(tests::note_of<core::CountedAlongMotion>(down.notes) != nullptr);
  CHECK(core::read_track_csv(Made(fall).file, std::nullopt).x_m[3] == Approx(-0.09));
  CHECK(core::read_track_csv(Made(fall).file, 1).x_m[3] == Approx(-0.09));
  // Thrown upwards and caught: it turns, and accelerates downwards.
  std::string text = "t,height\n";
  for (int i = 0; i <= 10; ++i) text += fmt::format("0.{},{}\n", i < 10 ? fmt::format("{}", i) : "95", i * (10 - i));
  const core::TrackData thrown = downwards(text);
  CHECK(thrown.x_m[5] == Approx(-25.0));
}

TEST_CASE("of x and y the one along which the body moves is x, a slanted path is told, a curved one is refused") {
  const auto plane = [](const std::string& pattern) {
    const Made made("mass A\t\t\nt\tx\ty\n" + rows(pattern));
    return core::read_track_csv(made.file, std::nullopt);
  };
  const core::TrackData upright = plane("0.{0}\t0.5\t{1}e-2\n");
  check_motion(upright);
  const auto* const along_y = tests::note_of<core::MotionAlongY>(upright.notes);
  REQUIRE(along_y != nullptr);
  CHECK(along_y->x_m == 0.0);
  CHECK(along_y->y_m > 0.63);  // 0.01 n² for n up to 9, of which the outermost may count as outliers: 0.64 or 0.81
  CHECK(along_y->y_m < 0.82);
  CHECK(tests::note_of<core::SlantedPath>(upright.notes) == nullptr);
  const core::TrackData slanted = plane("0.{0}\t{1}e-2\t{1}e-2\n");
  const auto* const path = tests::note_of<core::SlantedPath>(slanted.notes);
  REQUIRE(path != nullptr);
  CHECK(path->off_deg == Approx(45.0).epsilon(1e-9));
  CHECK(path->stretch == Approx(std::sqrt(2.0)).epsilon(1e-9));
  CHECK_FALSE(path->along_y);
  for (std::size_t i = 0; i < 10; ++i) {  // positions along the path, the hypotenuse of both columns
    CHECK(slanted.x_m[i] == Approx(std::sqrt(2.0) * 0.01 * static_cast<double>(i * i)).margin(1e-12));
  }
  const Made level("t,x (m),y (cm)\n" + rows("0.{0},{1}e-2,-{1}e-2\n"));  // 0.6 degrees: x alone
  CHECK(core::read_track_csv(level.file, std::nullopt).x_m[3] == Approx(0.09).epsilon(1e-12));
  // y = x²: with x 0 to 9 and y 0 to 81 the path's sagitta is 81²/4/(9² + 81²)... of its length, far from straight.
  CHECK_THROWS_WITH(plane("0.{0}\t{0}e-1\t{1}e-2\n"), Contains("a curved path"));
  const Made flight("t\tx\ty\n" + rows("0.{0}\t{0}e-1\t{1}e-2\n"));
  CHECK(flight.read("x").x_m[3] == Approx(0.3));  // whoever asks for it has it
}

TEST_CASE("a path that leads down to the right is followed with x rising, whatever the units of its columns") {
  std::string text = "t,x (m),y (cm)\n";
  for (int i = 0; i < 10; ++i) text += fmt::format("0.{},{},{}\n", i, 0.04 * i * i, 90.0 - 3.0 * i * i);
  const core::TrackData track = core::read_track_csv(Made(text).file, std::nullopt);
  REQUIRE(tests::note_of<core::SlantedPath>(track.notes) != nullptr);
  for (std::size_t i = 1; i < 10; ++i) {  // 3, 4 and 5
    CHECK(track.x_m[i] - track.x_m[0] == Approx(0.05 * static_cast<double>(i * i)).epsilon(1e-9));
  }
  // A row without y has no place on the path.
  const core::TrackData gap = core::read_track_csv(Made(text + "1.0,4.0,\n1.1,4.84,-273\n").file, std::nullopt);
  CHECK(gap.x_m.size() == 11);
}

TEST_CASE("three columns without a header are t, x and y if the third follows the second") {
  const auto read = [](const std::string& text) { return core::read_track_csv(Made(text).file, std::nullopt); };
  const core::TrackData along = read(rows("0.{0}\t{1}e-2\t-{1}e-2\n"));
  REQUIRE(along.x_m.size() == 10);
  CHECK(along.x_m[9] - along.x_m[0] == Approx(std::sqrt(2.0) * 0.81));
  CHECK(tests::note_of<core::SlantedPath>(along.notes) != nullptr);
  const auto* const taken = tests::note_of<core::ColumnsTaken>(along.notes);
  REQUIRE(taken != nullptr);
  CHECK(taken->x == "column 2");
  CHECK(taken->t == "column 1");
  // The speed, 0.2 t for x = 0.1 t² (t = 0.1 n, x = 0.001 n²), and numbers that have nothing to do with x.
  std::string speed, other;
  for (int i = 0; i < 10; ++i) {
    speed += fmt::format("0.{},{},{}\n", i, 0.001 * i * i, 0.02 * i);
    other += fmt::format("0.{},{},{}\n", i, 0.001 * i * i, 0.01 * ((7 * i) % 5));
  }
  for (const std::string& text : {speed, other}) {
    const core::TrackData track = read(text);
    CHECK(track.x_m[9] == Approx(0.081));
    CHECK(tests::note_of<core::SlantedPath>(track.notes) == nullptr);
  }
  CHECK_THROWS_WITH(read(rows("0.{0}\t{0}e-1\t{1}e-2\n")), Contains("sagitta of (column 2, column 3)"));
  // The third covers ten times as much: it may be the fall, or no place at all.
  CHECK_THROWS_WITH(read(rows("0.{0}\t{1}e-3\t{1}e-2\n")), Contains("say which one is x"));
  CHECK_THROWS_WITH(read(rows("0.1\t{1}e-2\t{1}e-2\n")), Contains("say which one is x"));  // times do not rise
}

TEST_CASE("frame numbers are no times without their rate, and the message asks for it") {
  const Made made("Frame,X_m,Y_m\n" + rows("{0},0.001,{1}e-2\n"));
  CHECK_THROWS_WITH(core::read_track_csv(made.file, std::nullopt),
                    Contains("frame numbers (\"Frame\")") && Contains("the frame rate (--frame-rate"));
}

TEST_CASE("decimal commas between single blanks are not thousands") {
  // 0,01 and 123,5; not 0, "01 123" and 5.
  const core::TrackData track = Made(rows("0,0{0} 12{0},5\n")).read();
  REQUIRE(track.x_m.size() > 5);
  CHECK(track.x_m[3] - track.x_m[2] == Approx(1.0).epsilon(1e-12));
  CHECK(track.x_m.front() > 120.0);
  CHECK(track.x_m.front() < 130.0);
  const core::TrackData mm = Made("t (s) x (mm)\n" + rows("4{0},5 12{0},5\n")).read();
  CHECK(mm.x_m[3] - mm.x_m[2] == Approx(1e-3).epsilon(1e-9));
}

TEST_CASE("speeds without their sign are refused where the motion turns, and not where it rests or only slows down") {
  const auto read = [](const std::function<double(double)>& v) {
    std::string text = "t (s),speed (m/s)\n";
    for (int i = 0; i < 100; ++i) text += fmt::format("{:.2f},{:.6f}\n", 0.01 * i, v(0.01 * i));
    const Made made(text);
    return core::import_track(made.file, "", {}, core::SpeedsAlone::taken);
  };
  CHECK_THROWS_WITH(read([](double t) { return std::abs(t - 0.5); }),
                    Contains("speeds without sign") && Contains("touch 0 at 0.5 s"));
  // It rests, is pushed up, turns, and comes back.
  CHECK_THROWS_WITH(read([](double t) { return t < 0.2   ? 0.0
                                               : t < 0.3 ? 5.0 * (t - 0.2)
                                                         : std::abs(0.8 - t); }),
                    Contains("speeds without sign"));
  CHECK_NOTHROW(read([](double t) { return t - 0.5; }));
  CHECK_NOTHROW(read([](double t) { return t; }));
  // Launched up fast, it comes back at a terminal velocity of a tenth of that.
  CHECK_THROWS_WITH(read([](double t) { return std::abs(0.2 - 2.2 * std::exp(-4.0 * t)); }),
                    Contains("speeds without sign"));
  CHECK_NOTHROW(read([](double t) { return std::max(0.0, 0.8 - t); }));             // it comes to rest
  CHECK_NOTHROW(read([](double t) { return std::max({0.0, 0.3 - t, t - 0.6}); }));  // and is pushed on later
}

TEST_CASE("a table with a column besides speeds is not refused as one of speeds") {
  CHECK_THROWS_WITH(Made("t,s,v\n" + rows("0.{0},{1},0.1\n")).read(), Contains("--column"));
  check_motion(Made("t (s),s (m),v (m/s),a (m/s^2)\n" + rows("0.{0},{1}e-2,0.1,0.2\n")).read());
}

TEST_CASE("a y without a unit has that of x, and a y in pixels is no length beside x") {
  // A path at 45 degrees: distances along it are sqrt(2) times those along x.
  const auto at = [&](const char* header) { return Made(header + rows("0.{0},{1},{1}\n")).read().x_m; };
  const auto along = at("t (s),x (cm),y\n"), alone = at("t (s),x (cm),y (px)\n");
  CHECK(along[5] - along[4] == Approx(std::sqrt(2.0) * (alone[5] - alone[4])).epsilon(1e-9));
  CHECK(at("t (s),x (cm),y (cm)\n")[5] == Approx(along[5]).epsilon(1e-12));
}

TEST_CASE("forces without positions are refused by that name") {
  const Made made("Czas Ft\ns N\n" + rows("0,{0} 1,{0}\n"));
  CHECK_THROWS_WITH(made.read(), Contains("forces without positions") && Contains("record where the body is"));
}

TEST_CASE("a decimal comma goes with a comma between fields if it is in quotes") {
  check_motion(Made("t,x\n" + rows("\"0,{0}\",\"{1},0E-2\"\n")).read());
}

TEST_CASE("a table in UTF-16 or Latin-1 is read as one in UTF-8") {
  std::string wide = "\xFF\xFE";
  for (const char c : "t (s)\tx (m)\n" + rows("0.{0}\t{1}E-2\n")) wide += {c, '\0'};
  check_motion(Made(wide).read());
  // Of two lengths the one called Posición is x.
  check_motion(Made("Tiempo (s);Posici\xF3n (m);Error (m)\n" + rows("0,{0};{1}E-2;0,001\n")).read());
}

TEST_CASE("formats that are no text are named, with what to do") {
  CHECK_THROWS_WITH(Made("\xD0\xCF\x11\xE0\xA1\xB1").read(),
                    Contains("an Excel file") && Contains("save the sheet as CSV"));
  CHECK_THROWS_WITH(Made("[{\"t\": 0.0, \"x\": 0.1}]\n").read(), Contains("JSON") && Contains("two columns"));
}

TEST_CASE("if no line is read, the message shows one and says what ails it") {
  CHECK_THROWS_WITH(Made("t,x,y\n0 .000,0,\"-1,70E+01\"\n").read(),
                    Contains(":2: ") && Contains("the first with digits is 0 .000,0,"));
  CHECK_THROWS_WITH(Made("0,1 0.149\n0,2 0.151\n").read(), Contains("do not go together"));
  CHECK_THROWS_WITH(Made("0,1;01.jan\n0,2;jan.13\n").read(), Contains("into dates"));
  CHECK_THROWS_WITH(Made("no numbers here\n").read(), Contains("no line with two numbers, expected"));
}

TEST_CASE("echoes after the landing do not turn a fall towards a sensor round") {
  // x from 1 m down to 0.1 m, then what a sensor writes when nothing is left to see.
  std::string text = "t,height\n";
  for (int i = 0; i < 40; ++i) text += fmt::format("{},{}\n", 0.02 * i, 1.0 - 0.9 * i / 40.0);
  for (int i = 40; i < 46; ++i) text += fmt::format("{},{}\n", 0.02 * i, i % 2 == 0 ? 5.8 : 2.6);
  core::TrackData track = core::read_track_csv(Made(text).file, std::nullopt);
  core::count_downwards({&track});
  CHECK(tests::note_of<core::CountedAlongMotion>(track.notes) != nullptr);
  CHECK(track.x_m[39] > track.x_m[0]);
}

TEST_CASE("a table without times says so once") {
  const Made made(
      "56.77,159.0\n56.73,159.1\n56.69,158.8\n56.63,158.3\n56.56,157.3\n56.46,156.1\n56.37,154.3\n"
      "56.29,152.2\n56.20,149.6\n");
  try {
    made.read();
    FAIL("read");
  } catch (const base::InputError& error) {
    CHECK(error.issues().size() == 1);
    CHECK_THAT(error.what(), Contains("values that do not increase"));
  }
}

TEST_CASE("times without a unit that would be 16.7 s apart are not taken as seconds") {
  std::string text = "frame,time,x\n";
  for (int i = 0; i < 10; ++i) text += fmt::format("{},{},0.{}\n", i, 600.0 + 16.683 * i, i);
  CHECK_THROWS_WITH(Made(text).read(), Contains("times without a unit, 16.68") && Contains("\"time (ms)\""));
  text.replace(text.find("time"), 4, "time (ms)");
  CHECK(Made(text).read().frame_rate_hz == Approx(1.0 / 0.016683).epsilon(1e-3));
  text.replace(text.find("(ms)"), 4, "(s)");
  CHECK(Made(text).read().t_s[1] == Approx(616.683));
}

TEST_CASE("a delimiter at the end of each line is no column, and a table that a spreadsheet put in quotes is a table") {
  check_motion(Made(rows("  {0}.0e-001\t  {1}.0e-002\t\r\n")).read());
  check_motion(Made(rows("0,{0};{1}E-2;\n")).read());
  check_motion(Made("t,x\n" + rows("0.{0},{1}E-2,\n")).read());  // which the header has none of
  check_motion(Made("\"mass A\"\n\"t\tx\ty\"\n" + rows("\"0.{0}00E0\t{1}E-2\t0.5\"\n")).read());
}

TEST_CASE("one long line does not make a short file fill the memory") {
  // 10 999 lines of two fields and one of 10 000 make 110 million, of which 32 thousand are there.
  std::string text = "t,x\n";
  for (int i = 0; i < 4000; ++i) text += fmt::format("{},{}\n", i, 2 * i);
  for (int i = 0; i < 10'000; ++i) text += i == 0 ? "4000" : ",8000";
  text += '\n';
  for (int i = 4001; i < 11'000; ++i) text += fmt::format("{},{}\n", i, 2 * i);
  CHECK_THROWS_WITH(Made(text).read(),
                    Contains(":4002: found 10000 columns, in 11000 lines, expected at most 100 million fields in all"));
}

TEST_CASE("units are also words, in several languages") {
  const auto with = [](const std::string& header) {
    const core::TrackData track = Made(header + "\n" + rows("0.{0},{1}E-2\n")).read();
    CHECK(tests::note_of<core::UnitAssumed>(track.notes) == nullptr);
    return track;
  };
  check_motion(with("Time (seconds),Distance (meters)"));
  check_motion(with("Tiempo (segundos),X_metros"));
  check_motion(with("Zeit (Sekunden),Ort (Meter)"));
  CHECK(with("Time (seconds),Position (centimeters)").x_m[3] == Approx(0.0009));
  for (const auto& [header, metres] :
       std::vector<std::pair<std::string, double>>{{"Zeit (s),Weg (Zentimeter)", 0.01},
                                                   {"t (s),distance (centimètres)", 0.01},
                                                   {"t (s),posición (milímetros)", 0.001},
                                                   {"t (s),Ort (Millimeter)", 0.001},
                                                   {"t (s),x (décimètres)", 0.1},
                                                   {"t (s),x (inches)", 0.0254},
                                                   {"t (s),Weg (Zoll)", 0.0254},
                                                   {"t (s),x (Kilometer)", 1000.0}}) {
    INFO(header);
    CHECK(with(header).x_m[3] == Approx(0.09 * metres));  // the fourth row says 9E-2
  }
}

TEST_CASE("Scandinavian and Dutch names of times and places, and h for a height") {
  check_motion(Made("tid (s),posisjon (m)\n" + rows("0.{0},{1}E-2\n")).read());
  check_motion(Made("tijd,afstand\n" + rows("0.{0},{1}E-2\n")).read());
  const core::TrackData fall = Made("t,h,h_err\n" + rows("0.{0},{1}E-2,0.001\n")).read();
  check_motion(fall);
  const auto* const height = tests::note_of<core::HeightTaken>(fall.notes);
  REQUIRE(height != nullptr);
  CHECK(height->column == "h");
}

TEST_CASE("of columns without a known name the only one with a unit of length is x") {
  const core::TrackData track = Made("t (s),s (m),v (m/s)\n" + rows("0.{0},{1}E-2,7\n")).read();
  check_motion(track);
  const auto* const taken = tests::note_of<core::ColumnsTaken>(track.notes);
  REQUIRE(taken != nullptr);
  CHECK(taken->x == "s (m)");
  CHECK(taken->t == "t (s)");
  CHECK(taken->run.empty());
  CHECK_THROWS_WITH(Made("t (s),a (m),b (m)\n" + rows("0.{0},{1}E-2,7\n")).read(), Contains("called x"));
}

TEST_CASE("a flight that comes down again is a curved path, and a straight way up and down an incline is none") {
  const auto read = [](auto place) {
    std::string text = "t,x,y\n";
    for (int i = 0; i < 40; ++i) {
      const auto [x, y] = place(0.04 * i);
      text += fmt::format("{:.2f},{:.4f},{:.4f}\n", 0.04 * i, x, y);
    }
    const Made made(text);
    return core::read_track_csv(made.file, std::nullopt);
  };
  // Thrown steeply, with a drag in proportion to the speed: it rises 5 m and falls back by 2 m.
  CHECK_THROWS_WITH(read([](double t) {
                      return std::pair(5.2 * (1.0 - std::exp(-1.6 * t)), 8.42 * (1.0 - std::exp(-3.0 * t)) - 3.27 * t);
                    }),
                    Contains("a curved path"));
  // Up and down a plane of 30°.
  CHECK_NOTHROW(read([](double t) {
    const double s = 2.0 * t - 1.3 * t * t;
    return std::pair(0.866 * s, 0.5 * s);
  }));
}
