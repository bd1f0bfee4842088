#include "core/track/column_table.h"

#include <fmt/format.h>

#include <string>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/track/track_data.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

constexpr int kRows = 12;

core::TrackData read_text(const std::string& text, const std::string& column = {}) {
  const tests::TempDir temp;
  base::write_file(temp / "table.txt", text);
  return core::read_track_csv(temp / "table.txt", 1, column);
}

/// t = 0.05 i and x = 0.5 t + 0.1 t² between `before` and what `after` makes of the row's number.
template <typename After>
std::string rows(const std::string& before, const After& after, const char* delimiter = ",") {
  std::string text;
  for (int i = 0; i < kRows; ++i) {
    const double t = 0.05 * i;
    text += fmt::format("{}{:.3f}{}{:.5f}{}\n", before, t, delimiter, 0.5 * t + 0.1 * t * t, after(i));
  }
  return text;
}

void check_motion(const core::TrackData& track) {
  REQUIRE(track.x_m.size() == kRows);
  CHECK(track.t_s[8] == Approx(0.4));
  CHECK(track.x_m[8] == Approx(0.216));
}

}  // namespace

TEST_CASE("labels and remarks in other columns than those of t and x are no reason to refuse a table") {
  const auto label = [](int) { return "\tok"; };
  const auto remark = [](int i) { return i == 7 ? ",hit the end" : ","; };
  const auto from_third = [](int i) { return i < 3 ? "," : ",slides"; };
  check_motion(read_text("n\tt (s)\tx (m)\tremark\n" + rows("3\t", label, "\t")));
  check_motion(read_text(rows("", label, "\t")));
  check_motion(read_text("t (s),x (m),note\n" + rows("", remark)));
  check_motion(read_text("t (s),x (m),note\n" + rows("", from_third)));
  check_motion(read_text("run,t (s),x (m)\n" + rows("first,", [](int) { return ""; })));
  check_motion(read_text("t x\n" + rows(
                                       "", [](int i) { return i == 4 ? " hit the end" : ""; }, " ")));
  // A remark in the first line of numbers is no header.
  check_motion(read_text("t (s),x (m),note\n" + rows("", [](int i) { return i == 0 ? ",starts" : ","; })));
}

TEST_CASE("marks without a letter in other columns are no reason to refuse a table either") {
  for (const char* const mark : {" -", "--", "?", "*", ">", "100%", "5 %", "(3)", "#1", "$5", "1/2", "2024-01-05",
                                 "18:09:55.601", "NA", "null"}) {
    CAPTURE(mark);
    check_motion(read_text("t (s),x (m),event\n" + rows("", [&](int) { return std::string(",") + mark; })));
    if (mark[0] == '#') continue;  // a line that begins with it is a comment
    check_motion(read_text("when;t (s);x (m)\n" + rows(
                                                      std::string(mark) + ";", [](int) { return ""; }, ";")));
  }
}

TEST_CASE("dashes and the words of programs for no value leave a gap, as NaN does") {
  for (const char* const none : {"-", "--", "NA", "N/A", "null", "None", "#N/A", "#DIV/0!"}) {
    CAPTURE(none);
    const std::string text = "t (s),x (m)\n" + rows("", [](int) { return ""; }) + "0.600," + none + "\n0.650,0.36725\n";
    const core::TrackData track = read_text(text);
    CHECK(track.x_m.size() == kRows + 1);
    CHECK(track.t_s.back() == Approx(0.65));
  }
}

TEST_CASE("text among the times or the positions is refused with its line") {
  std::string text = "t (s),x (m),note\n" + rows("", [](int) { return ",ok"; });
  CHECK_THROWS_WITH(read_text(text + "0.600,lost,\n"),
                    Contains(":14:") && Contains("\"lost\"") && Contains("a number with a decimal point"));
  CHECK_THROWS_WITH(read_text(text + "later,0.4,\n"), Contains("\"later\""));
}

TEST_CASE("a row above the others with both decimal signs is no header: it is refused with its line") {
  std::string text = "t;x\n0.000;3,10E-02\n";
  for (int i = 1; i < kRows; ++i) text += fmt::format("{},{:02}E-02;{},{:02}E-02\n", i, i, i + 3, i);
  CHECK_THROWS_WITH(read_text(text),
                    Contains(":2:") && Contains("\"0.000;3,10E-02\"") && Contains("a decimal comma throughout"));
  const std::string rest = text.substr(text.find("1,01"));
  CHECK(read_text("t;x\n0,000;3,10E-02\n" + rest).x_m.size() == kRows);
  CHECK_THROWS_WITH(read_text("0.000;3,10E-02\n" + rest), Contains(":1:") && Contains("another decimal sign"));
  CHECK_THROWS_WITH(read_text("t;x\n0.000;0.031\n" + rest), Contains(":2:") && Contains("a decimal comma throughout"));
}

TEST_CASE("lines of words with numbers in them are no table") {
  std::string text;
  for (int i = 0; i < 20; ++i) {
    text +=
        i % 2 == 0 ? fmt::format("between {} and {} of ten\n", i, i + 1) : fmt::format("{} words and {} more\n", i, i);
  }
  CHECK_THROWS_WITH(read_text(text), Contains("no line with two numbers"));
}

TEST_CASE("brackets around digits belong to a name, and a column is found by it or by its number") {
  const std::string header = "frame, time, raw[0], cal[0], raw[1]\n";
  std::string text = header;
  for (int i = 0; i < kRows; ++i) {
    const double t = 0.05 * i;
    text += fmt::format("{},{:.3f},{},{:.5f},0\n", i, t, 100 * i, 0.5 * t + 0.1 * t * t);
  }
  for (const char* column : {"4", "cal[0]", "Cal[0]"}) check_motion(read_text(text, column));
  CHECK_THROWS_WITH(read_text(text), Contains("\"cal[0]\"") && Contains("--column"));
  const auto columns = core::columns_of_header({{"t [s]", "x[12]", "y (m)", "z ()"}}, 4);
  CHECK(columns[0].unit == "s");
  CHECK(columns[1].name == "x[12]");
  CHECK(columns[1].unit.empty());
  CHECK(columns[2].unit == "m");
  CHECK(columns[3].name == "z");
}

TEST_CASE("times before anything is seen are no header") {
  std::string text;
  for (int i = 0; i < 4; ++i) text += fmt::format("{:.3f},NaN\n", 0.05 * i - 0.2);
  check_motion(read_text(text + rows("", [](int) { return ""; })));
}
