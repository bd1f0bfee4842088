#include "core/track/number_field.h"

#include <fmt/format.h>

#include <string>

#include "base/files/file_io.h"
#include "core/track/column_table.h"
#include "core/track/track_data.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;

namespace {

constexpr int kRows = 40;

/// x = 0.5 t + 0.1 t² at t = i/40 s, with the time as `of` writes it.
template <typename Time>
core::TrackData read_rows(const std::string& header, const Time& of) {
  std::string text = header;
  for (int i = 0; i < kRows; ++i) {
    const double t = i / 40.0;
    text += fmt::format("{},{:.5f}\n", of(t), 0.5 * t + 0.1 * t * t);
  }
  const tests::TempDir temp;
  base::write_file(temp / "table.csv", text);
  return core::read_track_csv(temp / "table.csv", 1, {});
}

void check_motion(const core::TrackData& track) {
  REQUIRE(track.x_m.size() == kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    CHECK(track.t_s[i] - track.t_s[0] == Approx(static_cast<double>(i) / 40.0).margin(1e-9));
    CHECK(track.x_m[i] == Approx(track.t_s[i] * (0.5 + 0.1 * track.t_s[i])).margin(1e-5));
  }
}

}  // namespace

TEST_CASE("a time of day is the seconds since midnight, in the forms that loggers and spreadsheets write") {
  CHECK(core::clock_time_in("14:03:07.25") == 50587.25);
  CHECK(core::clock_time_in("14:03:07,25") == 50587.25);
  CHECK(core::clock_time_in("2024-03-05 14:03:07") == 50587.0);
  CHECK(core::clock_time_in("2024-03-05T14:03:07.5Z") == 50587.5);
  CHECK(core::clock_time_in("2024-03-05T14:03:07.5+01:00") == 50587.5);
  CHECK(core::clock_time_in("3/5/2024 2:03:07 PM") == 50587.0);
  CHECK(core::clock_time_in("12:00:01 AM") == 1.0);
  CHECK(core::clock_time_in("12:00:01 pm") == 43201.0);
  CHECK(core::clock_time_in("1:02.75") == 62.75);
}

TEST_CASE("what is no time of day, or may be one of two, is none") {
  for (const char* const text : {"", ":", "12:30", "25:00:00", "12:60:00", "12:00:61", "12:00:00.", "12:00:00 h",
                                 "13:00:00 PM", "1:2", "2024-03-05", "Run 1:00:02.5", "1.5:00:00", "12:00:00.5.5"}) {
    CAPTURE(text);
    CHECK_FALSE(core::clock_time_in(text));
  }
  CHECK(core::is_date("2024-03-05"));
  CHECK(core::is_date("5.3.2024"));
  CHECK_FALSE(core::is_date("5.3"));
  CHECK_FALSE(core::is_date("5.3/2024"));
}

TEST_CASE("times of day are the times of a table that has no others, across midnight too") {
  const auto at = [](double t) {
    const double s = 86399.5 + t;
    return s < 86400.0 ? fmt::format("23:59:{:06.3f}", s - 86340.0) : fmt::format("00:00:{:06.3f}", s - 86400.0);
  };
  check_motion(read_rows("Time,Position (m)\n", at));
  check_motion(read_rows("Date Time,x (m)\n", [&](double t) { return "2024-03-05T" + at(t); }));
  check_motion(read_rows("", at));
  check_motion(read_rows("Date,Time,x (m)\n", [&](double t) { return "2024-03-05," + at(t); }));
}

TEST_CASE("times of day beside a column of seconds are not used, whichever stands nearer to x") {
  const auto seconds = [](double t) { return fmt::format("{:.3f}", t); };
  check_motion(read_rows("Clock,t (s),x (m)\n", [&](double t) { return "12:00:0" + seconds(t) + "," + seconds(t); }));
  check_motion(
      read_rows("Elapsed time (s),Time,x (m)\n", [&](double t) { return seconds(t) + ",12:00:0" + seconds(t); }));
  check_motion(read_rows("t (s),Date Time,x (m)\n", [&](double t) { return seconds(t) + ",2024-03-05 12:00:00"; }));
}

TEST_CASE("one time of day among numbers is refused with its line, as other text is") {
  for (const bool in_x : {true, false}) {
    CAPTURE(in_x);
    std::string text = "t (s),x (m)\n";
    for (int i = 0; i < kRows; ++i) {
      const std::string odd = "1:00.5", t = fmt::format("{:.3f}", i / 40.0), x = fmt::format("{:.3f}", 0.01 * i * i);
      text += fmt::format("{},{}\n", i == 7 && !in_x ? odd : t, i == 7 && in_x ? odd : x);
    }
    const tests::TempDir temp;
    base::write_file(temp / "table.csv", text);
    CHECK_THROWS_WITH(core::read_track_csv(temp / "table.csv", 1, {}),
                      Catch::Matchers::Contains(":9:") && Catch::Matchers::Contains("a time of day"));
  }
}

TEST_CASE("runs one below the other whose times of day go on are told apart by the column that numbers them") {
  std::string text = "Run,Time,x (m)\n";
  for (int i = 0; i < 2 * kRows; ++i) {
    const int of_run = i % kRows;
    const double t = i * 0.025 + (i < kRows ? 0.0 : 20.0);
    text += fmt::format("{},12:00:{:06.3f},{:.5f}\n", i < kRows ? 1 : 2, t, 0.02 * of_run);
  }
  const core::ColumnTable table = core::table_of_text(text, "table.csv");
  REQUIRE(table.columns.size() == 4);
  CHECK(table.columns[0].run == "Run 1");
  CHECK(table.columns[3].run == "Run 2");
  CHECK(*table.columns[2].values[kRows] == Approx(21.0));
  CHECK_FALSE(table.columns[1].values[kRows]);
}

TEST_CASE("times of day count from the first, over gaps and over midnight twice") {
  std::vector<std::optional<double>> times = {86000.0, {}, 200.0, 80000.0, 100.0, 99.0};
  core::count_from_first(times);
  CHECK(*times[0] == 0.0);
  CHECK_FALSE(times[1]);
  CHECK(*times[2] == 600.0);
  CHECK(*times[3] == 80400.0);
  CHECK(*times[4] == 86900.0);
  CHECK(*times[5] == 86899.0);  // a step back is none over midnight
}

TEST_CASE("times that were rounded until most of them repeat are refused with the first row that does") {
  std::string text = "t (s),x (m)\n";
  for (int i = 0; i < kRows; ++i) text += fmt::format("{:.1f},{:.5f}\n", 0.1 * (i / 10), 0.01 * i);
  const tests::TempDir temp;
  base::write_file(temp / "table.csv", text);
  CHECK_THROWS_WITH(
      core::read_track_csv(temp / "table.csv", 1, {}),
      Catch::Matchers::Contains(":3:") && Catch::Matchers::Contains("and most values repeat the one before"));
}
