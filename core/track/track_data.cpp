#include "core/track/track_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
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
#include "core/experiment/local_gravity.h"
#include "core/math/even_times.h"
#include "core/math/false_positions.h"
#include "core/math/frame_repeats.h"
#include "core/math/held_values.h"
#include "core/math/signed_drop.h"
#include "core/math/time_gap.h"
#include "core/track/column_table.h"
#include "core/track/table_columns.h"
#include "core/track/workbook.h"

namespace glidelab::core {

namespace {

constexpr double kSlowestUnstated_s = 5.0;  // from one position to the next, for times without a unit
constexpr double kNotableTick = 1e-3;       // of a frame: a coarser last digit gets a note

/// Replaces times rounded by a table with the uniform times of the camera.
void put_even(TrackData& track) {
  const std::optional<EvenTimes> even = even_times(track.t_s, StampSource::table);
  if (!even) return;
  if (even->tick_s > kNotableTick * even->step_s) {
    track.notes.emplace_back(RoundedTimes{even->tick_s, even->step_s});
  }
  double start_s = 0.0;
  for (std::size_t i = 0; i < track.t_s.size(); ++i) start_s += track.t_s[i] - even->t_s[i];
  start_s /= static_cast<double>(track.t_s.size());
  for (std::size_t i = 0; i < track.t_s.size(); ++i) track.t_s[i] = start_s + even->t_s[i];
}

void leave_out(const std::vector<bool>& flagged, TrackData& track) {
  for (std::vector<double>* values : {&track.t_s, &track.x_m, &track.force_n}) {
    if (!values->empty()) *values = without_flagged(*values, flagged);
  }
  if (track.frame.empty()) return;
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < track.frame.size(); ++i) {
    if (!flagged[i]) frames.push_back(track.frame[i]);
  }
  track.frame = std::move(frames);
}

}  // namespace

std::string few_points_expectation() {
  return fmt::format("at least {}: record at a higher rate, or for longer", kFewestTrackPoints);
}

void leave_out_false_positions(TrackData& track) {
  if (track.x_m.empty()) return;  // speeds
  if (const std::optional<UnseenPositions> unseen = unseen_positions(track.t_s, track.x_m)) {
    track.notes.emplace_back(PositionsUnseen{unseen->count, unseen->value, unseen->from_s});
    leave_out(unseen->is_unseen, track);
  }
  if (const std::optional<ScatteredEnds> ends = scattered_ends(track.t_s, track.x_m)) {
    track.notes.emplace_back(PositionsScattered{ends->at_start, ends->at_end});
    std::vector<bool> flagged(track.x_m.size(), false);
    std::fill_n(flagged.begin(), ends->at_start, true);
    std::fill_n(flagged.rbegin(), ends->at_end, true);
    leave_out(flagged, track);
  }
  if (const std::optional<StrayPositions> stray = stray_positions(track.t_s, track.x_m)) {
    track.notes.emplace_back(PositionsAstray{stray->count, stray->from_s, stray->off});
    leave_out(stray->is_stray, track);
  }
}

namespace {

/// The row of each time, counted by the median step; empty if the times do not lie on rows.
std::vector<std::size_t> rows_of(const std::vector<double>& t_s) {
  constexpr double kMostUneven = 0.1;  // of a row
  const double step_s = median_step(t_s);
  if (!(step_s > 0.0)) return {};
  std::vector<std::size_t> row(t_s.size());
  for (std::size_t i = 0; i < row.size(); ++i) {
    const double steps = (t_s[i] - t_s.front()) / step_s;
    row[i] = static_cast<std::size_t>(std::lround(steps));
    if (std::abs(steps - std::round(steps)) > kMostUneven || (i > 0 && row[i] <= row[i - 1])) return {};
  }
  return row;
}

/// Rows of a film that repeats frames (core/math/frame_repeats.h); their times become the camera's.
void leave_out_repeated_rows(TrackData& track) {
  const std::vector<std::size_t> row = rows_of(track.t_s);
  if (row.size() != track.x_m.size() || row.empty()) return;
  const std::optional<FrameRepeats> repeats = frame_repeats(row, track.x_m);
  if (!repeats) return;
  RepeatsLeftOut note{repeats->points.size(), track.t_s.size(), repeats->in_place_of_lost, 0.0};
  if (const auto& cadence = repeats->cadence) {
    const double step_s = median_step(track.t_s);
    note.camera_hz = cadence->rate_ratio / step_s;
    for (std::size_t i = 0; i < row.size(); ++i) track.t_s[i] -= step_s * cadence->early_frames(row[i]);
  }
  track.notes.emplace_back(note);
  std::vector<bool> flagged(track.t_s.size(), false);
  for (const std::size_t point : repeats->points) flagged[point] = true;
  leave_out(flagged, track);
}

/// Rows in which a logger repeats what a slower sensor gave before (core/math/held_values.h). A converter's film is not
/// of that kind: its cadence tells the camera's times.
void leave_out_held_values(TrackData& track) {
  constexpr std::size_t kMostOfFilm = 3;  // frames for each of the camera's images
  const std::optional<HeldValues> held = held_values(track.x_m);
  const std::vector<std::size_t> row = rows_of(track.t_s);
  const std::optional<FrameRepeats> repeats = row.empty() ? std::nullopt : frame_repeats(row, track.x_m);
  if (!held || (held->usual <= kMostOfFilm && repeats && repeats->cadence)) return;
  track.notes.emplace_back(ValuesHeld{held->count, track.x_m.size(), held->usual});
  leave_out(held->is_held, track);
}

}  // namespace

void take_rows_as_frames(TrackData& track) {
  leave_out_held_values(track);
  leave_out_false_positions(track);
  put_even(track);
  leave_out_repeated_rows(track);
  track.frame.resize(track.t_s.size());
  std::iota(track.frame.begin(), track.frame.end(), std::size_t{0});
  track.frame_t_s = track.t_s;
  track.frame_rate_hz = 1.0 / median_step(track.t_s);
}

namespace {

constexpr std::size_t kMostRowIssues = 10;

/// One series of a track given as numbers.
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
    issues.push_back({what, 0, "t_s", fmt::format("{} points", t_s.size()), few_points_expectation()});
  }
  return issues;
}

std::string gap_expectation(const TimeGap& gap) {
  return fmt::format("a gap of at most {:.6g} s, {:.0f} times the median step; two recordings are two clips",
                     gap.longest_s, kLongestGapSteps);
}

/// InputError, with the line of the file, if the times have a gap that no motion bridges.
void check_gaps(const TrackData& track, const std::string& file, const std::string& column,
                const std::vector<int>& lines) {
  const std::optional<TimeGap> gap = too_long_gap(track.t_s);
  if (!gap) return;
  throw base::InputError(base::Issue{
      file, lines[gap->after], column,
      fmt::format("{} s, a gap of {:.6g} s after line {}", track.t_s[gap->after], gap->gap_s, lines[gap->after - 1]),
      gap_expectation(*gap)});
}

}  // namespace

TrackData track_of_numbers(std::vector<double> t_s, std::vector<double> x_m, std::vector<double> force_n,
                           const std::string& what) {
  std::vector<GivenSeries> series = {{"t_s", t_s}, {"x_m", x_m}};
  if (!force_n.empty()) series.push_back({"force_n", force_n});
  std::vector<base::Issue> issues = issues_of_numbers(series, what);
  if (issues.empty()) {
    if (const std::optional<TimeGap> gap = too_long_gap(t_s)) {
      issues.push_back({what, 0, fmt::format("t_s[{}]", gap->after),
                        fmt::format("{} s, a gap of {:.6g} s", t_s[gap->after], gap->gap_s), gap_expectation(*gap)});
    }
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
  TrackData track;
  track.t_s = std::move(t_s);
  track.x_m = std::move(x_m);
  track.force_n = std::move(force_n);
  take_rows_as_frames(track);
  return track;
}

namespace {

/// InputError for speeds that lost their sign at a turn.
void check_signs(const TrackData& track, int downhill, const std::string& file, const std::string& column) {
  std::vector<double> v = track.v_m_s;
  for (double& one : v) one *= downhill;
  const std::optional<std::size_t> turn = lost_sign_at(v);
  if (!turn) return;
  throw base::InputError(
      base::Issue{file, 0, column,
                  fmt::format("speeds without sign (none is negative, and they touch 0 at {:.3g} s)", track.t_s[*turn]),
                  "velocities, negative in one direction: without a sign, up cannot be told from down"});
}

}  // namespace

void reverse(const std::vector<TrackData*>& tracks) {
  for (TrackData* track : tracks) {
    for (std::vector<double>* values : {&track->x_m, &track->v_m_s, &track->force_n}) {
      for (double& value : *values) value = -value;
    }
    const std::size_t reversed_before =
        std::erase_if(track->notes, [](const Note& note) { return std::holds_alternative<CountedAlongMotion>(note); });
    if (reversed_before == 0) track->notes.emplace_back(CountedAlongMotion{});
  }
}

void count_downwards(const std::vector<TrackData*>& tracks) {
  double drop = 0.0;
  for (const TrackData* track : tracks) {
    drop +=
        track->v_m_s.empty() ? signed_drop(track->t_s, track->x_m, kStandardGravity_m_s2) : signed_speed(track->v_m_s);
  }
  if (drop < 0.0) reverse(tracks);
}

void refuse_unneeded(const ImageUnits& units, const std::string& file, const std::string& found) {
  if (!units.for_this_table || (!units.frame_rate_hz && !units.px_per_m)) return;
  throw base::InputError(
      base::Issue{file, 0, units.frame_rate_hz ? "--frame-rate" : "--px-per-m", found,
                  "no such option: only a table that counts frames, or has its lengths in pixels, needs it"});
}

namespace {

/// The columns of a table that another program made of images, and what its numbers are divided by.
struct OfImages {
  double frame_rate_hz = 0.0, px_per_m = 0.0;  ///< 0 for what the table has itself
};

/// What of `units` the chosen columns need; the rate that the table states itself, where none is stated for it.
/// InputError for what was stated for this table and is not needed.
OfImages needed_of(const ImageUnits& units, std::optional<double> stated_hz, const std::string& file,
                   const TableColumn& x, const TableColumn& t, bool of_speeds) {
  OfImages needed;
  const bool frames = is_frame_column(t);
  if (frames) needed.frame_rate_hz = units.frame_rate_hz.value_or(stated_hz.value_or(0.0));
  // A scale of a folder, which may be that of its films, is not that of a table with times of its own.
  const bool in_pixels = is_pixels(x.unit) || (x.unit.empty() && (units.for_this_table || frames));
  if (in_pixels && !of_speeds) needed.px_per_m = units.px_per_m.value_or(0.0);
  if (units.frame_rate_hz && needed.frame_rate_hz == 0.0) {
    refuse_unneeded({units.frame_rate_hz, {}, 0.0, units.for_this_table}, file, fmt::format("times (\"{}\")", t.text));
  }
  if (units.px_per_m && needed.px_per_m == 0.0) {
    refuse_unneeded({{}, units.px_per_m, 0.0, units.for_this_table}, file,
                    of_speeds ? fmt::format("speeds (\"{}\")", x.text) : fmt::format("lengths in {}", x.unit));
  }
  return needed;
}

/// Empties the positions of each body where its own likelihood is low. How many of each column.
std::vector<UnlikelyLeftOut> leave_out_unlikely(ColumnTable& table) {
  std::vector<UnlikelyLeftOut> out(table.columns.size());
  for (const TableColumn& certainty : table.columns) {
    if (!is_likelihood_column(certainty)) continue;
    for (std::size_t c = 0; c < table.columns.size(); ++c) {
      TableColumn& column = table.columns[c];
      if (column.run != certainty.run || !(is_place_column(column) || is_height_column(column))) continue;
      out[c] = {certainty.text, 0, kLeastLikelihood};
      for (std::size_t row = 0; row < table.line.size(); ++row) {
        if (!column.values[row] || !certainty.values[row] || *certainty.values[row] >= kLeastLikelihood) continue;
        column.values[row].reset();
        ++out[c].rows;
      }
    }
  }
  return out;
}

}  // namespace

TrackData import_track(const std::filesystem::path& file, const std::string& column, std::optional<int> downhill,
                       SpeedsAlone speeds, const ImageUnits& units) {
  assert(!downhill || *downhill == 1 || *downhill == -1);
  ColumnTable table = read_column_table(file);
  TrackData track;
  if (!table.sheet.empty()) track.notes.emplace_back(SheetTaken{table.sheet});
  const FrameNumbers frame_numbers =
      units.frame_rate_hz || table.frame_rate_hz ? FrameNumbers::are_times : FrameNumbers::are_no_times;
  const std::vector<UnlikelyLeftOut> unlikely = leave_out_unlikely(table);
  const std::optional<ChosenColumns> of_speeds =
      speeds == SpeedsAlone::taken ? choose_speeds(table, column, frame_numbers) : std::nullopt;
  const ChosenColumns chosen = of_speeds ? *of_speeds : choose_columns(table, column, frame_numbers, track.notes);
  if (unlikely[chosen.place].rows > 0) track.notes.emplace_back(unlikely[chosen.place]);
  const TableColumn &x = table.columns[chosen.place], &t = table.columns[chosen.time];
  if (is_sensor_column(x)) track.sensor_column = x.text;
  const Across across = chosen.across.value_or(Across{chosen.place});
  const TableColumn& y = table.columns[across.column];
  const OfImages of_images = needed_of(units, table.frame_rate_hz, table.file, x, t, of_speeds.has_value());
  const double metres = downhill.value_or(1) * (of_speeds                  ? metres_per_second_of(table, x, track.notes)
                                                : of_images.px_per_m > 0.0 ? 1.0 / of_images.px_per_m
                                                                           : metres_of(table, x, track.notes));
  const bool like_x = y.unit.empty() || is_pixels(y.unit) || across.column == chosen.place;
  const double y_metres = like_x ? metres : downhill.value_or(1) * metres_of(table, y, track.notes);
  const double seconds =
      of_images.frame_rate_hz > 0.0 ? 1.0 / of_images.frame_rate_hz : seconds_of(table, t, track.notes);
  if (of_images.px_per_m > 0.0) track.scale_sd_relative = units.px_per_m_sd / of_images.px_per_m;
  if (of_images.frame_rate_hz > 0.0 || of_images.px_per_m > 0.0) {
    track.notes.emplace_back(
        ImageUnitsTaken{of_images.frame_rate_hz, of_images.px_per_m, track.scale_sd_relative == 0.0});
  }
  if (table.columns.size() > 2 || (table.has_header && !is_time_column(t))) {
    const bool run_apart = !x.run.empty() && x.text.find(x.run) == std::string::npos;
    track.notes.emplace_back(ColumnsTaken{x.text, t.text, run_apart ? x.run : ""});
  }
  const bool no_times = std::ranges::none_of(t.values, [](const auto& value) { return value.has_value(); });
  if (table.dates > 0 && no_times) {
    throw base::InputError(base::Issue{table.file, 0, fmt::format("column \"{}\"", t.text),
                                       fmt::format("{} cells with dates or times of day", table.dates),
                                       dates_expectation()});
  }
  std::vector<base::Issue> texts = x.texts;
  for (const TableColumn* const one : {&t, &y}) {
    if (one != &x) texts.insert(texts.end(), one->texts.begin(), one->texts.end());
  }
  if (!texts.empty()) {
    if (texts.size() > kMostRowIssues) texts.resize(kMostRowIssues);
    throw base::InputError(std::move(texts));
  }
  if (!rises_mostly(t)) {
    if (const std::optional<std::size_t> row = first_repeated(t)) {
      throw base::InputError(base::Issue{
          table.file, table.line[*row], fmt::format("column \"{}\"", t.text),
          fmt::format("{:.10g} again, and most values repeat the one before", *t.values[*row]),
          "a time in each row that is above the last: export times with more digits, or leave out rows that "
          "stand twice"});
    }
    throw base::InputError(
        base::Issue{table.file, 0, fmt::format("column \"{}\"", t.text), "values that do not increase",
                    "times; a table without them, such as x and y alone, says nothing about a motion"});
  }
  std::vector<base::Issue> issues;
  std::vector<int> lines;
  std::vector<double>& values = of_speeds ? track.v_m_s : track.x_m;
  std::size_t missing = 0, missing_so_far = 0;
  const bool may_repeat = repeats_seldom(t);
  TimesRepeated repeated;
  for (std::size_t row = 0; row < table.line.size(); ++row) {
    if (!x.values[row] || !y.values[row] || !t.values[row]) {
      ++missing_so_far;
      continue;
    }
    if (!lines.empty()) missing += missing_so_far;
    missing_so_far = 0;
    const double at = *t.values[row] * seconds;
    if (!lines.empty() && at == track.t_s.back() && may_repeat) {
      if (repeated.rows++ == 0) repeated.first_s = at;
      continue;
    }
    if (!lines.empty() && at <= track.t_s.back() && issues.size() < kMostRowIssues) {
      issues.push_back({table.file, table.line[row], fmt::format("column \"{}\"", t.text),
                        fmt::format("{}", *t.values[row]), fmt::format("a time above that of line {}", lines.back())});
    }
    track.t_s.push_back(at);
    values.push_back(across.cos * metres * *x.values[row] + across.sin * y_metres * *y.values[row]);
    lines.push_back(table.line[row]);
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
  if (track.t_s.size() < kFewestTrackPoints) {
    const std::size_t empty = x.run.empty() ? table.line.size() - track.t_s.size() : 0;  // other runs have others
    const std::string rows = empty == 1 ? "1 row" : fmt::format("{} rows", empty);
    throw base::InputError(
        base::Issue{table.file, 0, fmt::format("column \"{}\"", x.text),
                    fmt::format("{} points{}", track.t_s.size(),
                                empty == 0 ? "" : fmt::format(", and {} without a time or a position", rows)),
                    few_points_expectation()});
  }
  const double step_s = median_step(track.t_s);
  if (t.unit.empty() && of_images.frame_rate_hz == 0.0 && step_s > kSlowestUnstated_s) {
    throw base::InputError(base::Issue{
        table.file, 0, fmt::format("column \"{}\"", t.text),
        fmt::format("times without a unit, {:.4g} from one to the next", step_s),
        fmt::format("their unit in the header, as \"{0} (ms)\", or \"{0} (s)\" if they are seconds; call frame numbers "
                    "\"frame\", and state their rate (--frame-rate)",
                    t.name.starts_with("column ") ? "t" : t.name)});
  }
  check_gaps(track, table.file, fmt::format("column \"{}\"", t.text), lines);
  check_signs(track, downhill.value_or(1), table.file, fmt::format("column \"{}\"", x.text));
  if (missing > 0) track.notes.emplace_back(RowsIncomplete{missing});
  if (repeated.rows > 0) track.notes.emplace_back(repeated);
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
    throw base::InputError(
        base::Issue{table.file, 0, "", fmt::format("{} points", t_s.size()), few_points_expectation()});
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

/// The first line that is neither empty nor a comment, if it has a field `t_s`; empty otherwise.
std::optional<std::string> own_header(const std::filesystem::path& file) {
  const std::string text = base::read_file(file);
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  while (!rest.empty()) {
    const auto newline = rest.find('\n');
    const std::string_view line = rest.substr(0, newline);
    rest.remove_prefix(newline == std::string_view::npos ? rest.size() : newline + 1);
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string_view::npos || line[first] == '#') continue;
    return has_field(line, "t_s") ? std::optional<std::string>(line) : std::nullopt;
  }
  return "t_s,x_m";  // an empty file gets the plain error
}

}  // namespace

TrackData read_track_csv(const std::filesystem::path& file, std::optional<int> downhill, const std::string& column,
                         SpeedsAlone speeds, const ImageUnits& units) {
  assert(!downhill || *downhill == 1 || *downhill == -1);
  const std::optional<std::string> header = column.empty() ? own_header(file) : std::nullopt;
  if (!header) return import_track(file, column, downhill, speeds, units);
  refuse_unneeded(units, file.string(), "the header t_s, times in seconds and lengths in metres");
  const bool of_speeds = has_field(*header, "v_m_s") && !has_field(*header, "x_m");
  if (of_speeds && speeds == SpeedsAlone::refused) return import_track(file, column, downhill, speeds);  // says why
  const base::CsvTable table =
      of_speeds ? base::read_csv(file, {"t_s", "v_m_s"}, {}) : base::read_csv(file, {"t_s", "x_m"}, {"force_n"});
  TrackData track;
  track.t_s = table.column("t_s");
  check_times(table, track.t_s);
  check_gaps(track, table.file, "column \"t_s\"", table.line);
  std::vector<double>& values = of_speeds ? track.v_m_s : track.x_m;
  values = table.column(of_speeds ? "v_m_s" : "x_m");
  for (double& value : values) value *= downhill.value_or(1);
  check_signs(track, downhill.value_or(1), table.file, "column \"v_m_s\"");
  if (table.has("force_n")) {
    track.force_n = table.column("force_n");
    for (double& force : track.force_n) force *= downhill.value_or(1);
  }
  take_rows_as_frames(track);
  return track;
}

}  // namespace glidelab::core
