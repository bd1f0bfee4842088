#include "core/track/table_columns.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "base/files/file_io.h"
#include "core/track/track_data.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

struct Words {
  double factor;
  std::vector<std::string> words;
};

// English, German, French, Spanish, Portuguese, Italian; factors by the definition of the unit or the prefix.
const std::vector<Words> kLengths = {
    {1.0,
     {"m", "meter", "meters", "metre", "metres", "Meter", "mètre", "mètres", "metro", "metros", "metri", "METERS"}},
    {0.1, {"dm", "decimeter", "decimetres", "Dezimeter", "décimètres", "decímetros", "decimetri"}},
    {1e-2, {"cm", "centimeters", "centimetres", "Zentimeter", "centimètres", "centímetros", "centimetri"}},
    {1e-3, {"mm", "millimeters", "millimetres", "Millimeter", "millimètres", "milímetros", "millimetri"}},
    {1e-6,
     {"um", "µm", "μm", "micrometers", "micrometres", "Mikrometer", "micromètres", "micrómetros", "micrômetros",
      "micrometri"}},
    {1e3,
     {"km", "kilometers", "kilometres", "Kilometer", "kilomètres", "kilómetros", "quilômetros", "quilómetros",
      "chilometri"}},
    {0.0254, {"in", "inch", "inches", "Zoll"}},
    {0.3048, {"ft", "foot", "feet"}},
};

const std::vector<Words> kTimes = {
    {1.0,
     {"s", "sec", "second", "seconds", "Sekunde", "Sekunden", "seconde", "secondes", "segundo", "segundos", "secondo",
      "secondi"}},
    {1e-3,
     {"ms", "millisecond", "milliseconds", "Millisekunde", "Millisekunden", "milliseconde", "millisecondes",
      "milisegundo", "milisegundos", "milissegundos", "millisecondo", "millisecondi"}},
    {1e-6,
     {"us", "µs", "μs", "microseconds", "Mikrosekunden", "microsecondes", "microsegundos", "microssegundos",
      "microsecondi"}},
    {60.0, {"min", "minute", "minutes", "Minute", "Minuten", "minuto", "minutos", "minuti"}},
};

}  // namespace

TEST_CASE("units of length are symbols, and words of six languages with their prefixes") {
  for (const Words& unit : kLengths) {
    for (const std::string& word : unit.words) {
      INFO(word);
      CHECK(core::metres_per(word) == unit.factor);
      CHECK_FALSE(core::seconds_per(word));
    }
  }
}

TEST_CASE("units of time are symbols, and words of six languages with their prefixes") {
  for (const Words& unit : kTimes) {
    for (const std::string& word : unit.words) {
      INFO(word);
      CHECK(core::seconds_per(word) == unit.factor);
      CHECK_FALSE(core::metres_per(word));
    }
  }
}

TEST_CASE("other words, bare prefixes and symbols in the wrong case are no units") {
  for (const char* const word :
       {"", "milli", "kilo", "megameter", "metermeter", "millimillimeter", "secondary", "minus", "M", "S", "Pixel"}) {
    INFO(word);
    CHECK_FALSE(core::metres_per(word));
    CHECK_FALSE(core::seconds_per(word));
  }
}

namespace {

core::TrackData read_text(const std::string& text, const std::string& column = {}) {
  const tests::TempDir temp;
  base::write_file(temp / "table.csv", text);
  return core::read_track_csv(temp / "table.csv", 1, column);
}

/// Forty rows of two numbers.
std::string pairs(const std::function<std::pair<double, double>(double)>& at) {
  std::string text;
  for (int i = 0; i < 40; ++i) {
    const auto [one, other] = at(0.05 * i);
    text += fmt::format("{:.6f},{:.6f}\n", one, other);
  }
  return text;
}

}  // namespace

TEST_CASE("of two columns without a header the one that alone increases is the time") {
  // x falls from 1 m, or goes up and down; t in the second column.
  for (const auto& x : std::vector<std::function<double(double)>>{[](double t) { return 1.0 - 0.3 * t; },
                                                                  [](double t) { return 0.8 * t - 0.4 * t * t; }}) {
    const core::TrackData swapped = read_text(pairs([&](double t) { return std::pair(x(t), t); }));
    CHECK(swapped.t_s[7] == Approx(0.35));
    CHECK(swapped.x_m[7] == Approx(x(0.35)).margin(1e-6));
    const auto* const note = tests::note_of<core::ColumnsGuessed>(swapped.notes);
    REQUIRE(note != nullptr);
    CHECK(note->t == "column 2");
    CHECK_FALSE(note->either);
    const core::TrackData plain = read_text(pairs([&](double t) { return std::pair(t, x(t)); }));
    CHECK(plain.x_m[7] == Approx(x(0.35)).margin(1e-6));
    CHECK(tests::note_of<core::ColumnsGuessed>(plain.notes) == nullptr);
  }
}

TEST_CASE("two columns without a header that both increase, the second in even steps but for lost frames") {
  // A bead that sinks ever more slowly, seen at 30 Hz; two frames are missing.
  std::string text;
  for (int i = 0; i < 60; ++i) {
    if (i == 17 || i == 40) continue;
    text += fmt::format("{:.5f},{:.5f}\n", 0.3 * std::pow(i + 1.0, 0.8) + 4e-3 * std::sin(2.4 * i * i), i / 30.0);
  }
  CHECK_THROWS_WITH(read_text(text), Contains("both increase") && Contains("--column 1"));
  CHECK(read_text(text, "1").t_s[10] == Approx(1.0 / 3.0).margin(1e-5));
}

TEST_CASE("of two columns without a header, positions that seldom go back are not the times beside even steps") {
  std::string text;  // at rest, to within the noise, for three frames; then at 0.6 m/s
  const auto x = [](int i) { return i < 3 ? 0.1 - 1e-4 * i : 0.1 + 0.02 * (i - 2) + 1e-3 * (i * i % 7); };
  for (int i = 0; i < 40; ++i) text += fmt::format("{:.4f},{:.4f}\n", x(i), i / 30.0);
  const core::TrackData track = read_text(text);
  CHECK(track.t_s[9] == Approx(0.3));
  CHECK(track.x_m[9] == Approx(x(9)));
}

TEST_CASE("times of which one is wrong are times all the same: its line is named, or left out if it repeats the last") {
  const auto text = [](int wrong, int by) {
    std::string rows;
    for (int i = 0; i < 40; ++i)
      rows += fmt::format("{:.2f},{:.4f}\n", 0.01 * (i - (i % wrong == 7 ? by : 0)), 0.1 * i);
    return rows;
  };
  CHECK_THROWS_WITH(read_text(text(40, 2)), Contains("line 7") && Contains("0.05"));
  const core::TrackData track = read_text(text(40, 1));
  REQUIRE(track.x_m.size() == 39);
  CHECK(track.x_m[6] == Approx(0.6));
  CHECK(track.x_m[7] == Approx(0.8));
  CHECK(track.t_s[7] == Approx(0.08));
  const auto* const note = tests::note_of<core::TimesRepeated>(track.notes);
  REQUIRE(note != nullptr);
  CHECK(note->rows == 1);
  CHECK(note->first_s == Approx(0.06));
  CHECK_THROWS_WITH(read_text(text(10, 1)), Contains("line 7") && Contains("0.06"));  // one in ten: rounded times
}

TEST_CASE("of two columns without a header that both increase the first is the time, and a note says so") {
  const std::string text = pairs([](double t) { return std::pair(t, 0.2 + 0.7 * t); });
  const core::TrackData track = read_text(text);
  CHECK(track.x_m[10] == Approx(0.55));
  const auto* const note = tests::note_of<core::ColumnsGuessed>(track.notes);
  REQUIRE(note != nullptr);
  CHECK(note->t == "column 1");
  CHECK(note->either);
  // Whoever names x has named the time as well.
  const core::TrackData first = read_text(text, "1");
  CHECK(first.x_m[10] == Approx(0.5));
  CHECK(first.t_s[10] == Approx(0.55));
  CHECK(tests::note_of<core::ColumnsGuessed>(first.notes) == nullptr);
  CHECK(read_text(text, "2").x_m[10] == Approx(0.55));
}

TEST_CASE("of two columns without a header that both increase, the second in even steps, x must be named") {
  // A body that slows down from 1 m/s at 0.2 m/s²: in 2 s its steps shrink by 40 %.
  const auto x = [](double t) { return 0.3 + t - 0.1 * t * t; };
  const auto at = [](double place) { return 5.0 - std::sqrt(25.0 - 10.0 * (place - 0.3)); };  // x(t) solved for t
  const std::string frames = pairs([&](double t) { return std::pair(x(t), t); });
  const std::string marks = pairs([&](double step) { return std::pair(at(0.3 + 0.5 * step), 0.3 + 0.5 * step); });
  for (const std::string& text : {frames, marks}) {
    CHECK_THROWS_WITH(read_text(text), Contains("column") && Contains("both increase") && Contains("--column 1") &&
                                           Contains("--column 2"));
  }
  const core::TrackData of_frames = read_text(frames, "1"), of_marks = read_text(marks, "2");
  CHECK(of_frames.t_s[10] == Approx(0.5));
  CHECK(of_frames.x_m[10] == Approx(x(0.5)).margin(1e-6));
  CHECK(of_marks.x_m[10] == Approx(0.55));
  CHECK(x(of_marks.t_s[10]) == Approx(0.55).margin(1e-5));
  CHECK(read_text(pairs([&](double t) { return std::pair(t, x(t)); })).x_m[10] == Approx(x(0.5)).margin(1e-6));
}

TEST_CASE("units may be told in words: in s, en s, em m") {
  for (const auto& [t, x] :
       std::vector<std::pair<std::string, std::string>>{{"Zeit (in s)", "x (in cm)"},
                                                        {"temps en s", "x en cm"},
                                                        {"tempo (s)", "x em cm"},
                                                        {"Zeit (in s)", "Objekt 1 x-Koordinate (in cm)"},
                                                        {"Zeit in s", "y-Koordinate in cm"}}) {
    std::string text = "\"" + t + "\";\"" + x + "\"\n";
    for (int i = 0; i < 20; ++i) text += fmt::format("{:.2f};{:.4f}\n", 0.1 * i, 50.0 + 1.5 * i + 0.1 * i * i);
    CAPTURE(t, x);
    const core::TrackData track = read_text(text);
    CHECK(track.t_s[10] == Approx(1.0));
    CHECK(std::abs(track.x_m[10] - track.x_m[0]) == Approx(0.25));
  }
  std::string fruit = "Zeit (in s);x (in bananas)\n";
  for (int i = 0; i < 20; ++i) fruit += fmt::format("{:.2f};{:.4f}\n", 0.1 * i, 1.0 + 0.5 * i);
  CHECK_THROWS_WITH(read_text(fruit), Contains("bananas"));
}

TEST_CASE("a first column without a name that counts the rows is no time where the second is") {
  std::string counted, seconds;
  for (int i = 0; i < 20; ++i) {
    const double t = 0.05 * i;
    counted += fmt::format("{}\t{:.3f}\t{:.5f}\tok\n", i + 1, t, 0.5 * t + 0.1 * t * t);
    seconds += fmt::format("{}\t{:.5f}\t{:.5f}\n", i, 0.01 * i * i, 0.004 * i * i);  // t, x and y
  }
  const core::TrackData track = read_text(counted);
  CHECK(track.t_s[8] == Approx(0.4));
  CHECK(track.x_m[8] == Approx(0.216));
  CHECK(read_text(seconds).t_s[8] == 8.0);
  CHECK(read_text(counted, "2").t_s[8] == 9.0);  // as whoever names the times themselves gets it
}

namespace {

/// A table of x and y, in metres, of a body that runs 1.4 m along x and strays by `y`.
std::string plane(const std::function<double(double)>& y) {
  std::string text = "t,x,y\n";
  for (int i = 0; i < 60; ++i) {
    const double x = 1.4 * i / 59.0, noise = 4e-4 * std::sin(2.4 * i * i);
    text += fmt::format("{:.3f},{:.6f},{:.6f}\n", 0.02 * i, x, y(x) + noise);
  }
  return text;
}

}  // namespace

TEST_CASE("a wavy path is refused like an arc, a smaller bend is told, and a straight path is neither") {
  const auto wave = [](double height_m) {
    return [height_m](double x) { return height_m * std::sin(2.0 * std::numbers::pi * x / 0.9); };
  };
  CHECK_THROWS_WITH(read_text(plane(wave(0.065))), Contains("a curved path") && Contains("strays over"));
  CHECK_THROWS_WITH(read_text(plane(wave(0.03))), Contains("a curved path") && Contains("its direction changes by"));
  const core::TrackData bent = read_text(plane(wave(0.012)));
  const auto* const note = tests::note_of<core::PathBends>(bent.notes);
  REQUIRE(note != nullptr);
  CHECK(note->off_m == Approx(0.024).epsilon(0.15));  // the line through one wave and a half leans towards it
  CHECK(note->slope_deg > 5.0);  // the wave's slopes are ±0.084, 9.6 degrees in all; parts of 0.18 m average them
  CHECK(tests::note_of<core::PathBends>(read_text(plane([](double) { return 0.3; })).notes) == nullptr);
  CHECK(tests::note_of<core::PathBends>(read_text(plane([](double x) { return 0.5 * x; })).notes) == nullptr);
}

TEST_CASE("of two columns of which neither is called a time, the one that is not x is it") {
  std::string text = "x;Posicao\n";
  for (int i = 0; i < 20; ++i) text += fmt::format("{:.3f};{:.5f}\n", 0.05 * i, 0.3 - 0.002 * i * i);
  CHECK_THROWS_WITH(read_text(text), Contains("name the one that is x (--column)"));
  const core::TrackData track = read_text(text, "Posicao");
  CHECK(track.t_s[8] == Approx(0.4));
  CHECK(track.x_m[8] == Approx(0.3 - 0.128));
  const auto* const taken = tests::note_of<core::ColumnsTaken>(track.notes);
  REQUIRE(taken != nullptr);
  CHECK_THROWS_WITH(read_text(text, "x"), Contains("time"));  // positions that go back are no times
  CHECK_THROWS_WITH(read_text("frame" + text.substr(1), "Posicao"), Contains("only frame numbers"));
}

TEST_CASE("a track of few positions tells how many rows have none") {
  std::string text = "t,x\n";
  for (int i = 0; i < 14; ++i)
    text += i % 2 == 0 ? fmt::format("{:.2f},{:.3f}\n", 0.1 * i, 0.01 * i) : fmt::format("{:.2f},\n", 0.1 * i);
  CHECK_THROWS_WITH(read_text(text), Contains("7 points, and 7 rows without a time or a position") &&
                                         Contains("at least 8: record at a higher rate"));
}

TEST_CASE("three columns without a header that make a curved path are refused, and a column can be named") {
  const auto without_header = [](const std::string& text) { return text.substr(text.find('\n') + 1); };
  const std::string wavy = without_header(plane([](double x) { return 0.065 * std::sin(7.0 * x); }));
  CHECK_THROWS_WITH(read_text(wavy), Contains("a curved path") && Contains("--column"));
  CHECK(read_text(wavy, "2").x_m.back() == Approx(1.4));
  CHECK(read_text(without_header(plane([](double) { return 0.3; }))).x_m.back() == Approx(1.4));
  const core::TrackData bent =
      read_text(without_header(plane([](double x) { return 0.012 * std::sin(2.0 * std::numbers::pi * x / 0.9); })));
  CHECK(tests::note_of<core::PathBends>(bent.notes) != nullptr);
}

TEST_CASE("a requested x whose y is not level is read alone, and a note says so") {
  const auto note_of = [](const std::string& text, const char* column) {
    const core::TrackData track = read_text(text, column);
    const auto* const note = tests::note_of<core::OtherAxisUnused>(track.notes);
    return note != nullptr ? std::optional(*note) : std::nullopt;
  };
  const std::string slanted = plane([](double x) { return 0.5 * x; });
  CHECK(read_text(slanted, "x").x_m.back() == Approx(1.4));
  const auto note = note_of(slanted, "x");
  REQUIRE(note);
  CHECK(note->column == "y");
  CHECK(note->off_deg == Approx(std::atan(0.5) * 180.0 / std::numbers::pi).margin(0.1));
  const auto bent = note_of(plane([](double x) { return 0.01 * std::sin(7.0 * x); }), "2");
  REQUIRE(bent);
  CHECK(bent->off_m == Approx(0.02).epsilon(0.2));
  CHECK_FALSE(note_of(plane([](double) { return 0.3; }), "x"));
  CHECK_FALSE(note_of(slanted, "y"));
}

TEST_CASE("rows that say that nothing was seen are no part of a path") {
  std::string text = "t,x,y\n";
  for (int i = 0; i < 60; ++i) {
    const double along = i < 50 ? 0.5 + 0.02 * i : 0.0;
    text += fmt::format("{:.3f},{:.6f},{:.6f}\n", 0.02 * i, along, i < 50 ? 2.0 - 0.5 * along : 0.0);
  }
  const core::TrackData track = read_text(text);
  CHECK(track.x_m.size() == 50);
  const auto* const path = tests::note_of<core::SlantedPath>(track.notes);
  REQUIRE(path != nullptr);
  CHECK(path->off_deg == Approx(std::atan(0.5) * 57.29577951308232).epsilon(1e-6));
}

TEST_CASE("speeds stand beside other quantities, and their unit ends in no unit of time") {
  const tests::TempDir dir;
  const auto read = [&](const std::string& header, const std::string& column, core::SpeedsAlone speeds) {
    std::string text = header + "\n";
    for (int i = 0; i < 20; ++i) text += fmt::format("{};{:.1f};{}\n", i, 36.0 - 0.9 * i, 140 + i % 3);
    base::write_file(dir / "a.csv", text);
    return core::read_track_csv(dir / "a.csv", 1, column, speeds);
  };
  for (const char* header : {"Zeit in s;Geschwindigkeit in km/h;Herzfrequenz", "t (s);v / km/h;pulse (1/min)",
                             "time;speed, km/h;heart", "t / s;speed km/h;heart"}) {
    INFO(header);
    for (const char* column : {"", "2"}) {
      const core::TrackData track = read(header, column, core::SpeedsAlone::taken);
      REQUIRE(track.v_m_s.size() == 20);
      CHECK(track.v_m_s[10] == Approx(27.0 / 3.6));
    }
    CHECK_THROWS_WITH(read(header, "2", core::SpeedsAlone::refused), Contains("speeds in") && Contains("positions"));
  }
  // Where positions stand beside them, those are the track, unless the speeds are requested.
  const std::string both = "t (s);v (km/h);x (m)";
  CHECK(read(both, "", core::SpeedsAlone::taken).x_m.size() == 20);
  CHECK(read(both, "2", core::SpeedsAlone::taken).v_m_s.size() == 20);
}
