#include "core/track/table_columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "base/errors.h"
#include "core/experiment/file_names.h"
#include "core/math/plane_path.h"
#include "core/math/quantile.h"

namespace glidelab::core {

namespace {

bool is_acceleration(const TableColumn& column) {
  const std::string name = lower(column.name);
  return column.unit.starts_with("m/s^2") || column.unit.starts_with("m/s\xC2\xB2") ||
         name.find("accel") != std::string::npos || name.find("beschleunigung") != std::string::npos ||
         name.find("aceler") != std::string::npos || name.find("acc\xC3\xA9l") != std::string::npos;
}

std::optional<double> metres_per_second(std::string_view unit) {
  static constexpr std::array<std::pair<std::string_view, double>, 5> kSpeeds{
      {{"m/s", 1.0}, {"cm/s", 1e-2}, {"mm/s", 1e-3}, {"km/h", 1.0 / 3.6}, {"m s-1", 1.0}}};
  const auto at = std::ranges::find(kSpeeds, unit, &std::pair<std::string_view, double>::first);
  return at == kSpeeds.end() ? std::nullopt : std::optional(at->second);
}

/// The header of a table of one's own, which reads as seconds to others: a "v_m" in "s".
bool is_own_speed(const TableColumn& column) {
  return column.text == "v_m_s";
}

bool is_speed(const TableColumn& column) {
  const std::string name = lower(column.name);
  // English, German, French, Spanish, Portuguese.
  for (const char* word : {"velocity", "speed", "geschwindigkeit", "vitesse", "velocidad", "velocidade"}) {
    if (name.find(word) != std::string::npos) return true;
  }
  return name == "v" || name == "vx" || name == "v_x" || is_own_speed(column) || metres_per_second(column.unit);
}

constexpr std::size_t kMostNamedColumns = 20;

std::string columns_text(const ColumnTable& table) {
  std::vector<std::string> names;
  for (std::size_t c = 0; c < std::min(table.columns.size(), kMostNamedColumns); ++c) {
    const TableColumn& column = table.columns[c];
    const bool run_apart = !column.run.empty() && column.text.find(column.run) == std::string::npos;
    names.push_back(fmt::format("{} \"{}{}\"", c + 1, run_apart ? column.run + ": " : "", column.text));
  }
  const std::size_t more = table.columns.size() - names.size();
  return fmt::format("columns {}{}", fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
}

bool is_asked(const TableColumn& column, std::size_t index, const std::string& asked) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(asked.data(), asked.data() + asked.size(), number);
  if (error == std::errc{} && end == asked.data() + asked.size()) return number == index + 1;
  const std::string small = lower(asked);
  return small == lower(column.text) || small == lower(column.name) ||
         small == lower(column.run + ": " + column.text) || small == lower(column.run + ": " + column.name);
}

bool is_force(const TableColumn& column) {
  return column.unit == "N" || lower(column.name) == "force";
}

base::InputError speeds_refused(const ColumnTable& table, const std::string& found) {
  return wrong_column(
      table, found,
      "positions over time; `glidelab analyze` without --with also takes speeds. Integrated speeds would give "
      "intervals that are too narrow. Export the distance as well: an encoder counts it, a motion sensor "
      "measures it");
}

/// Speeds, accelerations or forces alone are not a track, and a user who exported them should know why. Nothing is
/// refused if there is a column besides.
void refuse_without_positions(const ColumnTable& table) {
  bool times = false, speeds = false, accelerations = false, forces = false;
  for (const TableColumn& column : table.columns) {
    const bool time = is_time_column(column), speed = is_speed(column), acceleration = is_acceleration(column),
               force = is_force(column);
    if (!time && !speed && !acceleration && !force) return;
    times |= time;
    speeds |= speed;
    accelerations |= acceleration;
    forces |= force;
  }
  if (speeds) throw speeds_refused(table, "speeds without positions, " + columns_text(table));
  if (accelerations) {
    throw wrong_column(table, "accelerations without positions, " + columns_text(table),
                       "positions over time: an accelerometer's offset of 0.02 m/s² grows to 1 m in 10 s when it is "
                       "integrated, and a phone on an incline measures gravity besides. Film the glider, or record its "
                       "distance with a motion sensor (phyphox: Sonar, or Tracker on a video)");
  }
  if (times && forces) {
    throw wrong_column(table, "forces without positions, " + columns_text(table),
                       "positions over time: record where the body is, with a motion sensor or a video");
  }
}

/// Whether the integral of `rate` over the times is `place`, apart from a constant: a column of speeds.
bool is_rate_of(const TableColumn& rate, const TableColumn& place, const TableColumn& times) {
  constexpr double kMostOff = 0.1;  // of the range of the place, rms
  std::vector<double> off, places;
  double integral = 0.0;
  std::optional<std::size_t> last;
  for (std::size_t row = 0; row < times.values.size(); ++row) {
    if (!rate.values[row] || !place.values[row] || !times.values[row]) continue;
    if (last) {
      integral += 0.5 * (*rate.values[row] + *rate.values[*last]) * (*times.values[row] - *times.values[*last]);
    }
    last = row;
    off.push_back(*place.values[row] - integral);
    places.push_back(*place.values[row]);
  }
  if (off.size() < kFewestOfPath) return false;
  const Eigen::Map<const Eigen::ArrayXd> apart(off.data(), static_cast<Eigen::Index>(off.size()));
  return std::sqrt((apart - apart.mean()).square().mean()) < kMostOff * range_of(places);
}

/// A choice without its time.
ChosenColumns only(std::size_t place) {
  ChosenColumns chosen;
  chosen.place = place;
  return chosen;
}

/// The times of a table without a header: the first column, unless it counts the rows and the second advances evenly.
std::size_t unnamed_time(const ColumnTable& table) {
  constexpr double kEven = 0.2;  // of the median step: times may be rounded
  if (table.columns.size() < 3) return 0;
  const auto steps_of = [](const TableColumn& column) {
    std::vector<double> steps;
    for (std::size_t row = 1; row < column.values.size(); ++row) {
      if (column.values[row] && column.values[row - 1]) steps.push_back(*column.values[row] - *column.values[row - 1]);
    }
    return steps;
  };
  const std::vector<double> counts = steps_of(table.columns[0]), steps = steps_of(table.columns[1]);
  if (counts.size() < kFewestOfPath || steps.size() != counts.size()) return 0;
  const double middle = quantile(steps, 0.5);
  const bool counted = std::ranges::all_of(counts, [](double step) { return step == 1.0; });
  const bool even = middle > 0.0 && middle != 1.0 &&
                    std::ranges::all_of(steps, [&](double step) { return std::abs(step - middle) < kEven * middle; });
  return counted && even ? 1 : 0;
}

/// Three columns without a header whose first are times: t, x and perhaps y, as Tracker writes them. Empty if they are
/// not, or if the third covers so much more than the second that the body moves along it.
std::optional<ChosenColumns> unnamed_columns(const ColumnTable& table, std::vector<Note>& notes) {
  if (table.has_header || table.columns.size() != 3) return {};
  if (unnamed_time(table) == 1) {
    notes.emplace_back(ColumnsGuessed{table.columns[2].text, table.columns[1].text, true});
    return only(2);
  }
  const TableColumn &times = table.columns[0], &second = table.columns[1], &third = table.columns[2];
  std::optional<double> last;
  for (const std::optional<double>& time : times.values) {
    if (!time || (last && *time <= *last)) return {};
    last = time;
  }
  ChosenColumns chosen;
  chosen.place = 1;
  if (is_rate_of(third, second, times)) return chosen;
  const PlanePath path = path_of(second, third);
  if (path.x_m.size() < kFewestOfPath || range_of(path.y_m) > kOtherAxis * range_of(path.x_m)) return {};
  refuse_curve(table, 1, 2, path);
  // Only if the third follows the second is it a place in the same plane.
  const auto n = static_cast<Eigen::Index>(path.x_m.size());
  Eigen::ArrayXd x = Eigen::Map<const Eigen::ArrayXd>(path.x_m.data(), n),
                 y = Eigen::Map<const Eigen::ArrayXd>(path.y_m.data(), n);
  x -= x.mean();
  y -= y.mean();
  constexpr double kFollows = 0.99;  // squared correlation
  const bool follows = std::pow((x * y).sum(), 2) > kFollows * x.square().sum() * y.square().sum();
  if (follows) return along_path(table, 1, 2, notes);
  judge_bend(table, 1, 2, path, notes);
  return chosen;
}

std::vector<std::size_t> columns_that(const ColumnTable& table, bool (*is)(const TableColumn&)) {
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (is(table.columns[c])) found.push_back(c);
  }
  return found;
}

std::size_t asked_column(const ColumnTable& table, const std::string& asked) {
  std::vector<std::size_t> found;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (is_asked(table.columns[c], c, asked)) found.push_back(c);
  }
  if (found.size() == 1) return found.front();
  throw wrong_column(table, fmt::format("{} of the name or number \"{}\"", found.empty() ? "none" : "several", asked),
                     "one of the " + columns_text(table));
}

/// The steps from one value of a column to the next.
std::vector<double> steps_of(const TableColumn& column) {
  std::vector<double> steps;
  std::optional<double> last;
  for (const std::optional<double>& value : column.values) {
    if (value && last) steps.push_back(*value - *last);
    if (value) last = value;
  }
  return steps;
}

bool goes_up(double step) {
  return step > 0.0;
}

/// Whether all values increase, as times do.
bool increases(const TableColumn& column) {
  const bool any =
      std::any_of(column.values.begin(), column.values.end(), [](const auto& value) { return value.has_value(); });
  return any && std::ranges::all_of(steps_of(column), goes_up);
}

/// Whether few of the steps go back: times, one or the other of which is wrong or repeated.
bool goes_back_seldom(const TableColumn& column) {
  constexpr std::size_t kOneIn = 10;
  const std::vector<double> steps = steps_of(column);
  const auto back = std::ranges::count_if(steps, [](double step) { return step < 0.0; });
  return kOneIn * static_cast<std::size_t>(back) <= steps.size();
}

/// How much the steps of a column differ: their standard deviation over their mean.
double unevenness(const TableColumn& column) {
  const std::vector<double> list = steps_of(column);
  const Eigen::Map<const Eigen::ArrayXd> steps(list.data(), static_cast<Eigen::Index>(list.size()));
  return std::sqrt((steps - steps.mean()).square().mean()) / std::abs(steps.mean());
}

/// The part of the steps that are the median one, to within a hundredth: nearly all of a camera's times, of which some
/// frames may be missing, and few of any positions.
double even_part(const TableColumn& column) {
  constexpr double kSame = 0.01;  // of the median step
  const std::vector<double> steps = steps_of(column);
  if (steps.empty()) return 0.0;
  const double middle = quantile(steps, 0.5);
  const auto same =
      std::ranges::count_if(steps, [&](double step) { return std::abs(step - middle) <= kSame * std::abs(middle); });
  return static_cast<double>(same) / static_cast<double>(steps.size());
}

/// Two columns without a header: t and x, unless the second increases throughout and the first often goes back, or goes
/// back at all where the second has even steps. (Other times with a wrong one among them keep their place, and the
/// error names its line.) Where both increase, and the second in far more even steps, it may be the times of a camera
/// or the places of a picket fence.
ChosenColumns unnamed_pair(const ColumnTable& table, std::vector<Note>& notes) {
  const bool first = increases(table.columns[0]), second = increases(table.columns[1]);
  constexpr double kFarLess = 0.1, kEven = 1e-3, kNearlyAll = 0.9, kHalf = 0.5;
  const double uneven = first && second ? unevenness(table.columns[0]) : 0.0;
  const bool frames = even_part(table.columns[1]) >= kNearlyAll && even_part(table.columns[0]) < kHalf;
  if (uneven > kEven && (frames || unevenness(table.columns[1]) < kFarLess * uneven)) {
    throw wrong_column(table, "two columns without a header that both increase, the second in even steps",
                       "which of them is x: --column 1, or column = \"1\" in experiment.toml, if the second holds the "
                       "times of a camera or a sensor; --column 2 if it holds the places of marks");
  }
  const bool even = second && !first && steps_of(table.columns[0]).size() >= kFewestOfPath &&
                    even_part(table.columns[1]) >= kNearlyAll && even_part(table.columns[0]) < kHalf;
  const std::size_t time = even || (second && !goes_back_seldom(table.columns[0])) ? 1 : 0;
  if (second && (first || time == 1))
    notes.emplace_back(ColumnsGuessed{table.columns[1 - time].text, table.columns[time].text, first});
  return only(1 - time);
}

ChosenColumns place_columns(const ColumnTable& table, std::vector<Note>& notes) {
  if (!table.has_header && table.columns.size() == 2) return unnamed_pair(table, notes);
  if (const std::optional<ChosenColumns> unnamed = unnamed_columns(table, notes)) return *unnamed;
  const std::vector<std::size_t> found = columns_that(table, is_place_column),
                                 heights = columns_that(table, is_height_column);
  if (found.empty() && heights.size() == 1) return only(heights.front());
  if (found.size() == 1) {
    const bool plane = heights.size() == 1 && lower(table.columns[heights.front()].name).find('y') != std::string::npos;
    return plane ? along_path(table, found.front(), heights.front(), notes) : only(found.front());
  }
  const std::vector<std::size_t> lengths =
      columns_that(table, [](const TableColumn& column) { return metres_per(column.unit).has_value(); });
  if (found.empty() && heights.empty() && lengths.size() == 1) return only(lengths.front());  // "s (m)", "d / cm"
  if (found.empty() && heights.empty() && lengths.empty()) refuse_without_positions(table);
  throw wrong_column(
      table, columns_text(table),
      fmt::format("{} that is called x or position; say which one is x (--column, or column = \"…\" in "
                  "experiment.toml) by its header or its number{}",
                  found.empty() ? "one" : "just one", found.empty() ? "" : ", or take all as clips (--runs all)"));
}

/// `named`: a person said which column is x. Of two columns the other then holds the times, if they rise.
std::size_t time_column(const ColumnTable& table, std::size_t place, bool named, FrameNumbers frame_numbers) {
  if (!table.has_header && table.columns.size() == 2) return 1 - place;
  if (!table.has_header) {
    const std::size_t first = unnamed_time(table);
    if (place != first || first != 0) return place != first ? first : 0;
  }
  std::vector<std::size_t> times;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const bool same_run = table.columns[c].run == table.columns[place].run || table.columns[c].run.empty();
    if (c != place && is_time_column(table.columns[c]) && same_run) times.push_back(c);
  }
  const auto right = std::lower_bound(times.begin(), times.end(), place);
  if (right != times.begin()) return *std::prev(right);
  if (times.size() == 1) return times.front();
  if (named && times.empty() && table.columns.size() == 2 && increases(table.columns[1 - place]) &&
      !is_frame_column(table.columns[1 - place])) {
    return 1 - place;
  }
  const auto frames = std::find_if(table.columns.begin(), table.columns.end(), is_frame_column);
  if (times.empty() && frames != table.columns.end()) {
    if (frame_numbers == FrameNumbers::are_times) return static_cast<std::size_t>(frames - table.columns.begin());
    throw wrong_column(
        table, fmt::format("no times for \"{}\", only frame numbers (\"{}\")", table.columns[place].text, frames->text),
        "the frame rate (--frame-rate, or frame_rate_hz of [camera] in experiment.toml), or a column of times");
  }
  throw wrong_column(table,
                     fmt::format("{} columns of time for \"{}\" among {}", times.size(), table.columns[place].text,
                                 columns_text(table)),
                     "one, called t or time or with a unit of time (divide frame numbers by the frame rate); of two "
                     "columns, name the one that is x (--column), and the other is the time");
}

void note_force(const ColumnTable& table, std::vector<Note>& notes) {
  const auto force = std::ranges::find_if(table.columns, is_force);
  if (force != table.columns.end()) notes.emplace_back(ForceUnused{force->text});
}

double factor_of(const ColumnTable& table, const TableColumn& column, std::optional<double> (*factor)(std::string_view),
                 const char* kind, const char* standard, std::vector<Note>& notes) {
  if (column.unit.empty()) {
    notes.emplace_back(UnitAssumed{column.text, standard});
    return 1.0;
  }
  const auto value = factor(column.unit);
  if (value) return *value;
  throw wrong_column(table, fmt::format("the unit \"{}\" of \"{}\"", column.unit, column.text), kind);
}

}  // namespace

ChosenColumns choose_columns(const ColumnTable& table, const std::string& asked, FrameNumbers frame_numbers,
                             std::vector<Note>& notes) {
  ChosenColumns chosen = asked.empty() ? place_columns(table, notes) : only(asked_column(table, asked));
  if (!asked.empty() && metres_per_second(table.columns[chosen.place].unit)) {
    throw speeds_refused(table, fmt::format("speeds in \"{}\"", table.columns[chosen.place].text));
  }
  chosen.time = time_column(table, chosen.place, !asked.empty(), frame_numbers);
  if (asked.empty() && is_height_column(table.columns[chosen.place])) {
    notes.emplace_back(HeightTaken{table.columns[chosen.place].text});
  }
  if (!asked.empty()) note_other_axis(table, chosen.place, notes);
  note_force(table, notes);
  return chosen;
}

std::optional<ChosenColumns> choose_speeds(const ColumnTable& table, const std::string& asked,
                                           FrameNumbers frame_numbers) {
  const auto is_length = [](const TableColumn& column) {
    return is_place_column(column) || is_height_column(column) || is_pixels(column.unit) ||
           metres_per(column.unit).has_value();
  };
  if (asked.empty() && std::ranges::any_of(table.columns, is_length)) return {};
  // A quantity of one letter may be the distance: whoever wrote it should say.
  const auto is_letter = [](const TableColumn& column) {
    return column.unit.empty() && column.name.size() == 1 && !is_time_column(column) && !is_speed(column);
  };
  if (asked.empty() && std::ranges::any_of(table.columns, is_letter)) return {};
  const std::vector<std::size_t> found = columns_that(table, [](const TableColumn& column) {
    return is_speed(column) && (!is_time_column(column) || is_own_speed(column));
  });
  if (found.empty()) return {};
  if (asked.empty() && found.size() > 1) {
    throw wrong_column(table, fmt::format("{} columns of speeds among {}", found.size(), columns_text(table)),
                       "one: say which (--column, or column = \"…\" in experiment.toml)");
  }
  ChosenColumns chosen = only(asked.empty() ? found.front() : asked_column(table, asked));
  if (!std::ranges::count(found, chosen.place)) return {};
  chosen.time = time_column(table, chosen.place, !asked.empty(), frame_numbers);
  return chosen;
}

double metres_of(const ColumnTable& table, const TableColumn& column, std::vector<Note>& notes) {
  return factor_of(
      table, column, metres_per,
      is_pixels(column.unit)
          ? "the scale (--px-per-m, or [scale] in experiment.toml: its pixels in a metre), or lengths in m, "
            "cm or mm"
          : "m, dm, cm, mm, um, km, in or ft",
      "metres", notes);
}

double metres_per_second_of(const ColumnTable& table, const TableColumn& column, std::vector<Note>& notes) {
  note_force(table, notes);
  if (is_own_speed(column)) return 1.0;
  return factor_of(table, column, metres_per_second, "m/s, cm/s, mm/s or km/h", "metres per second", notes);
}

double seconds_of(const ColumnTable& table, const TableColumn& column, std::vector<Note>& notes) {
  return factor_of(table, column, seconds_per, "s, ms, us or min", "seconds", notes);
}

std::optional<std::size_t> first_repeated(const TableColumn& times) {
  const std::vector<double> steps = steps_of(times);
  const bool falls = std::ranges::any_of(steps, [](double step) { return step < 0.0; });
  if (falls || std::ranges::none_of(steps, goes_up)) return {};
  std::optional<double> last;
  for (std::size_t row = 0; row < times.values.size(); ++row) {
    if (!times.values[row]) continue;
    if (last && *last == *times.values[row]) return row;
    last = times.values[row];
  }
  return {};
}

bool rises_mostly(const TableColumn& times) {
  const std::vector<double> steps = steps_of(times);
  return 2 * static_cast<std::size_t>(std::ranges::count_if(steps, goes_up)) >= steps.size();
}

}  // namespace glidelab::core
