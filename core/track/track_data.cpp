#include "core/track/track_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/csv.h"
#include "core/experiment/file_names.h"
#include "core/math/quantile.h"
#include "core/math/time_gap.h"
#include "core/track/column_table.h"
#include "core/track/even_times.h"

namespace glidelab::core {

namespace {

constexpr double kNotableTick = 1e-3;  // of a frame: a coarser last digit is told

/// Times of an even camera in place of those that a table rounds.
void put_even(TrackData& track) {
  const std::optional<EvenTimes> even = even_times(track.t_s, StampSource::table);
  if (!even) return;
  if (even->tick_s > kNotableTick * even->step_s) {
    track.notes.push_back(fmt::format("the times are whole multiples of {:.2g} s and taken as even, {:.6g} s apart",
                                      even->tick_s, even->step_s));
  }
  double start_s = 0.0;
  for (std::size_t i = 0; i < track.t_s.size(); ++i) start_s += track.t_s[i] - even->t_s[i];
  start_s /= static_cast<double>(track.t_s.size());
  for (std::size_t i = 0; i < track.t_s.size(); ++i) track.t_s[i] = start_s + even->t_s[i];
}

}  // namespace

void take_rows_as_frames(TrackData& track) {
  put_even(track);
  track.frame.resize(track.t_s.size());
  std::iota(track.frame.begin(), track.frame.end(), std::size_t{0});
  track.frame_t_s = track.t_s;
  track.frame_rate_hz = 1.0 / median_step(track.t_s);
}

namespace {

constexpr std::size_t kMostRowIssues = 10;

/// One of the series of a track that is given as numbers.
struct GivenSeries {
  const char* name;
  const std::vector<double>& values;
};

std::vector<base::Issue> issues_of_numbers(const std::vector<GivenSeries>& series, const std::string& what) {
  const std::vector<double>& t_s = series.front().values;
  std::vector<base::Issue> issues;
  for (const GivenSeries& one : series) {
    if (one.values.size() != t_s.size()) {
      issues.push_back({what, 0, one.name, fmt::format("{} numbers", one.values.size()),
                        fmt::format("as many as times, {}", t_s.size())});
    }
    for (std::size_t i = 0; i < one.values.size() && issues.size() < kMostRowIssues; ++i) {
      if (std::isfinite(one.values[i])) continue;
      issues.push_back({what, 0, fmt::format("{}[{}]", one.name, i),
                        std::isnan(one.values[i]) ? "nan" : fmt::format("{}", one.values[i]),
                        "a finite number; leave out what was not measured"});
    }
  }
  for (std::size_t i = 1; i < t_s.size() && issues.size() < kMostRowIssues; ++i) {
    if (!(t_s[i] <= t_s[i - 1])) continue;
    issues.push_back({what, 0, fmt::format("t_s[{}]", i),
                      fmt::format("{}{}", t_s[i], t_s[i] == t_s[i - 1] ? " twice" : ""),
                      fmt::format("a time above {}", t_s[i - 1])});
  }
  if (issues.empty() && t_s.size() < kFewestTrackPoints) {
    issues.push_back(
        {what, 0, "t_s", fmt::format("{} points", t_s.size()), fmt::format("at least {}", kFewestTrackPoints)});
  }
  return issues;
}

/// InputError, with the line of the file, where the times have a gap that no motion bridges.
void check_gaps(const TrackData& track, const std::string& file, const std::string& column,
                const std::vector<int>& lines) {
  const std::optional<TimeGap> gap = too_long_gap(track.t_s);
  if (!gap) return;
  throw base::InputError(base::Issue{
      file, lines[gap->after], column,
      fmt::format("{} s, a gap of {:.6g} s after line {}", track.t_s[gap->after], gap->gap_s, lines[gap->after - 1]),
      fmt::format("a gap of at most {:.6g} s, {:.0f} times the median step; two recordings are two clips",
                  gap->longest_s, kLongestGapSteps)});
}

bool is_acceleration(const TableColumn& column) {
  const std::string name = lower(column.name);
  return column.unit.starts_with("m/s^2") || column.unit.starts_with("m/s\xC2\xB2") ||
         name.find("accel") != std::string::npos || name.find("beschleunigung") != std::string::npos ||
         name.find("aceler") != std::string::npos || name.find("acc\xC3\xA9l") != std::string::npos;
}

std::string columns_text(const ColumnTable& table) {
  std::vector<std::string> names;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const TableColumn& column = table.columns[c];
    const bool run_apart = !column.run.empty() && column.text.find(column.run) == std::string::npos;
    names.push_back(fmt::format("{} \"{}{}\"", c + 1, run_apart ? column.run + ": " : "", column.text));
  }
  return fmt::format("columns {}", fmt::join(names, ", "));
}

base::InputError wrong_column(const ColumnTable& table, const std::string& found, const std::string& expected) {
  return base::InputError(base::Issue{table.file, 0, "column", found, expected});
}

bool is_asked(const TableColumn& column, std::size_t index, const std::string& asked) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(asked.data(), asked.data() + asked.size(), number);
  if (error == std::errc{} && end == asked.data() + asked.size()) return number == index + 1;
  const std::string small = lower(asked);
  return small == lower(column.text) || small == lower(column.name) ||
         small == lower(column.run + ": " + column.text) || small == lower(column.run + ": " + column.name);
}

/// Accelerations alone are no track, and a person who exported them from a phone should know why.
void refuse_accelerations(const ColumnTable& table) {
  if (std::none_of(table.columns.begin(), table.columns.end(), is_acceleration)) return;
  throw wrong_column(table, "accelerations without positions, " + columns_text(table),
                     "positions over time: an accelerometer's offset of 0.02 m/s² grows to 1 m in 10 s when it is "
                     "integrated, and a phone on an incline measures gravity besides. Film the glider, or record its "
                     "distance with a motion sensor (phyphox: Sonar, or Tracker on a video)");
}

std::size_t place_column(const ColumnTable& table, const std::string& asked) {
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const TableColumn& column = table.columns[c];
    if (asked.empty() ? is_place_column(column) : is_asked(column, c, asked)) {
      found.push_back(c);
    }
  }
  if (asked.empty() && !table.has_header && table.columns.size() == 2) return 1;
  if (found.size() == 1) return found.front();
  if (!asked.empty()) {
    throw wrong_column(table, fmt::format("{} of the name or number \"{}\"", found.empty() ? "none" : "several", asked),
                       "one of the " + columns_text(table));
  }
  if (found.empty()) refuse_accelerations(table);
  throw wrong_column(
      table, columns_text(table),
      fmt::format("{} that is called x or position; say which one is x (--column, or column = \"…\" in "
                  "experiment.toml) by its header or its number{}",
                  found.empty() ? "one" : "just one", found.empty() ? "" : ", or take all as clips (--runs all)"));
}

std::size_t time_column(const ColumnTable& table, std::size_t place) {
  if (!table.has_header && place != 0) return 0;
  std::vector<std::size_t> times;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const bool same_run = table.columns[c].run == table.columns[place].run || table.columns[c].run.empty();
    if (c != place && is_time_column(table.columns[c]) && same_run) times.push_back(c);
  }
  const auto right = std::lower_bound(times.begin(), times.end(), place);
  if (right != times.begin()) return *std::prev(right);
  if (times.size() == 1) return times.front();
  throw wrong_column(table,
                     fmt::format("{} columns of time for \"{}\" among {}", times.size(), table.columns[place].text,
                                 columns_text(table)),
                     "one, called t or time or with a unit of time");
}

double factor_of(const ColumnTable& table, const TableColumn& column, std::optional<double> (*factor)(std::string_view),
                 const char* kind, const char* standard, std::vector<std::string>& notes) {
  if (column.unit.empty()) {
    notes.push_back(fmt::format("\"{}\" states no unit and is taken as {}", column.text, standard));
    return 1.0;
  }
  const auto value = factor(column.unit);
  if (value) return *value;
  throw wrong_column(table, fmt::format("the unit \"{}\" of \"{}\"", column.unit, column.text), kind);
}

}  // namespace

TrackData track_of_numbers(std::vector<double> t_s, std::vector<double> x_m, std::vector<double> force_n,
                           const std::string& what) {
  std::vector<GivenSeries> series = {{"t_s", t_s}, {"x_m", x_m}};
  if (!force_n.empty()) series.push_back({"force_n", force_n});
  std::vector<base::Issue> issues = issues_of_numbers(series, what);
  if (!issues.empty()) throw base::InputError(std::move(issues));
  TrackData track;
  track.t_s = std::move(t_s);
  track.x_m = std::move(x_m);
  track.force_n = std::move(force_n);
  take_rows_as_frames(track);
  return track;
}

TrackData import_track(const std::filesystem::path& file, const std::string& column, int downhill) {
  assert(downhill == 1 || downhill == -1);
  const ColumnTable table = read_column_table(file);
  const std::size_t place = place_column(table, column), time = time_column(table, place);
  const TableColumn &x = table.columns[place], &t = table.columns[time];
  TrackData track;
  const double metres =
      downhill * factor_of(table, x, metres_per, "m, dm, cm, mm, um, km, in or ft", "metres", track.notes);
  const double seconds = factor_of(table, t, seconds_per, "s, ms, us or min", "seconds", track.notes);
  if (table.columns.size() > 2) {
    track.notes.push_back(fmt::format("x is \"{}\", its time \"{}\"{}", x.text, t.text,
                                      x.run.empty() || x.text.find(x.run) != std::string::npos ? "" : ", " + x.run));
  }
  std::vector<base::Issue> issues;
  std::vector<int> lines;
  std::size_t missing = 0, missing_so_far = 0;
  for (std::size_t row = 0; row < table.line.size(); ++row) {
    if (!x.values[row] || !t.values[row]) {
      ++missing_so_far;
      continue;
    }
    if (!lines.empty()) missing += missing_so_far;
    missing_so_far = 0;
    const double at = *t.values[row] * seconds;
    if (!lines.empty() && at <= track.t_s.back() && issues.size() < kMostRowIssues) {
      issues.push_back({table.file, table.line[row], fmt::format("column \"{}\"", t.text),
                        fmt::format("{}", *t.values[row]), fmt::format("a time above that of line {}", lines.back())});
    }
    track.t_s.push_back(at);
    track.x_m.push_back(*x.values[row] * metres);
    lines.push_back(table.line[row]);
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
  if (track.t_s.size() < kFewestTrackPoints) {
    throw base::InputError(base::Issue{table.file, 0, fmt::format("column \"{}\"", x.text),
                                       fmt::format("{} points", track.t_s.size()),
                                       fmt::format("at least {}", kFewestTrackPoints)});
  }
  check_gaps(track, table.file, fmt::format("column \"{}\"", t.text), lines);
  if (missing > 0)
    track.notes.push_back(fmt::format("{} rows between others lack a time or x and are left out", missing));
  take_rows_as_frames(track);
  return track;
}

namespace {

constexpr std::size_t kMostTimeIssues = 10;  // unsorted times are wrong on many lines

void check_times(const base::CsvTable& table, const std::vector<double>& t_s) {
  std::vector<base::Issue> issues;
  for (std::size_t i = 1; i < t_s.size() && issues.size() < kMostTimeIssues; ++i) {
    if (t_s[i] > t_s[i - 1]) continue;
    issues.push_back({table.file, table.line[i], "column \"t_s\"",
                      fmt::format("{}{}", t_s[i], t_s[i] == t_s[i - 1] ? " twice" : ""),
                      fmt::format("a time above {} (line {})", t_s[i - 1], table.line[i - 1])});
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
  if (t_s.size() < kFewestTrackPoints) {
    throw base::InputError(base::Issue{table.file, 0, "", fmt::format("{} points", t_s.size()),
                                       fmt::format("at least {}", kFewestTrackPoints)});
  }
}

bool has_field(std::string_view line, std::string_view name) {
  while (!line.empty()) {
    const auto end = line.find_first_of(",;\t");
    std::string_view field = line.substr(0, end);
    line.remove_prefix(end == std::string_view::npos ? line.size() : end + 1);
    constexpr std::string_view kAround = " \r\"";
    field.remove_prefix(std::min(field.find_first_not_of(kAround), field.size()));
    field = field.substr(0, field.find_last_not_of(kAround) + 1);
    if (field == name) return true;
  }
  return false;
}

/// The first line that is neither empty nor a comment has a field `t_s`.
bool has_own_header(const std::filesystem::path& file) {
  const std::string text = base::read_file(file);
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  while (!rest.empty()) {
    const auto newline = rest.find('\n');
    const std::string_view line = rest.substr(0, newline);
    rest.remove_prefix(newline == std::string_view::npos ? rest.size() : newline + 1);
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || line[first] == '#') continue;
    return has_field(line, "t_s");
  }
  return true;  // an empty file: its error is the plain one
}

}  // namespace

TrackData read_track_csv(const std::filesystem::path& file, int downhill, const std::string& column) {
  assert(downhill == 1 || downhill == -1);
  if (!column.empty() || !has_own_header(file)) return import_track(file, column, downhill);
  const base::CsvTable table = base::read_csv(file, {"t_s", "x_m"}, {"force_n"});
  TrackData track;
  track.t_s = table.column("t_s");
  check_times(table, track.t_s);
  check_gaps(track, table.file, "column \"t_s\"", table.line);
  track.x_m = table.column("x_m");
  for (double& x : track.x_m) x *= downhill;
  if (table.has("force_n")) {
    track.force_n = table.column("force_n");
    for (double& force : track.force_n) force *= downhill;
  }
  take_rows_as_frames(track);
  return track;
}

}  // namespace glidelab::core
