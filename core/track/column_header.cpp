#include "core/track/column_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

#include "base/text/readable_text.h"
#include "core/experiment/file_names.h"
#include "core/track/number_field.h"

namespace glidelab::core {
namespace {

std::string_view trimmed(std::string_view text) {
  return base::trimmed(text, " \t,:");
}

bool speaks_of_a_run(std::string_view field) {
  static constexpr std::array<std::string_view, 7> kWords{"run", "set", "latest", "trial", "versuch", "lauf", "serie"};
  const std::string text = lower(field);
  return std::any_of(kWords.begin(), kWords.end(), [&](std::string_view word) { return text.starts_with(word); });
}

/// "[s]" in a line of units is "s".
std::string_view without_brackets(std::string_view field) {
  const bool bracketed = field.size() > 2 && (field.front() == '[' || field.front() == '(') &&
                         (field.back() == ']' || field.back() == ')');
  return bracketed ? trimmed(field.substr(1, field.size() - 2)) : field;
}

bool looks_like_a_unit(std::string_view field) {
  if (without_brackets(field).size() < field.size()) return true;
  if (metres_per(field) || seconds_per(field) || is_pixels(field)) return true;
  // m/s, m/s^2, m/s², N, 1, °: short and without the name of a quantity.
  const auto slash = field.find('/');
  if (slash != std::string_view::npos) return metres_per(field.substr(0, slash)).has_value() || field.size() <= 6;
  return field == "N" || field == "kg" || field == "V" || field == "rad" || field == "deg" || field == "Hz";
}

template <typename Predicate>
bool all_that_is_there(const std::vector<std::string>& fields, Predicate predicate) {
  bool any = false;
  for (const std::string& field : fields) {
    if (field.empty()) continue;
    if (!predicate(field)) return false;
    any = true;
  }
  return any;
}

/// "cal[0]" and "x (2)" are names with an index, not a quantity in units of 0.
bool is_index(std::string_view bracketed) {
  return bracketed.find_first_of("0123456789") != std::string_view::npos &&
         bracketed.find_first_not_of("0123456789 ") == std::string_view::npos;
}

/// "v in km/h", "v / m/s", "speed m/s": their unit ends in one of time, or of nothing known.
void take_speed_unit(std::string& name, std::string& unit) {
  for (const std::string_view speed : {"cm/s", "mm/s", "km/h", "m/s"}) {
    if (!name.ends_with(speed) || name.size() == speed.size()) continue;
    std::string_view before = std::string_view(name).substr(0, name.size() - speed.size());
    if (std::string_view(" /,").find(before.back()) == std::string_view::npos) continue;
    before = trimmed(before);
    for (const std::string_view between : {"/", " in", " en", " em"}) {
      if (before.ends_with(between)) before.remove_suffix(between.size());
    }
    if (trimmed(before).empty()) continue;
    unit = std::string(speed);
    name = std::string(trimmed(before));
    return;
  }
}

/// "Run 1: Time (s)", "Time (s) Run #1", "Position, Run #2 (m)", "x_cm".
TableColumn column_of(const std::string& text) {
  TableColumn column;
  column.text = text;
  std::string_view rest = text;
  const auto open = rest.find_last_of("([");
  const auto close = open == std::string_view::npos ? open : rest.find_first_of(")]", open);
  std::string name(rest);
  if (close != std::string_view::npos && !is_index(rest.substr(open + 1, close - open - 1))) {
    std::string_view unit = trimmed(rest.substr(open + 1, close - open - 1));
    for (const std::string_view in : {"in ", "en "}) {  // "Zeit (in s)", "temps (en s)"
      if (unit.starts_with(in)) unit = trimmed(unit.substr(in.size()));
    }
    column.unit = std::string(unit);
    column.run = std::string(trimmed(rest.substr(close + 1)));
    name = std::string(trimmed(rest.substr(0, open)));
  }
  if (const auto colon = name.find(':'); colon != std::string::npos) {
    column.run = std::string(trimmed(std::string_view(name).substr(0, colon)));
    name = std::string(trimmed(std::string_view(name).substr(colon + 1)));
  }
  const std::string small = lower(name);
  // The channel distinguishes several sensors: "Position, Ch 1 (m)".
  if (const auto channel = small.find(", ch "); channel != std::string::npos && channel > 0) {
    std::string_view rest_of = std::string_view(name).substr(channel + 2);
    const auto run = lower(rest_of).find(", run");
    column.run = std::string(trimmed(run == std::string::npos ? rest_of : rest_of.substr(run)));
    name = std::string(trimmed(std::string_view(name).substr(0, channel)));
    column.name = name;
    return column;
  }
  for (const char* const mark : {", run", " run #", " run "}) {
    const auto at = small.find(mark);
    if (at == std::string::npos || at == 0) continue;
    column.run = std::string(trimmed(std::string_view(name).substr(at)));
    name = std::string(trimmed(std::string_view(name).substr(0, at)));
    break;
  }
  const auto underscore = name.rfind('_');
  if (column.unit.empty() && underscore != std::string::npos && underscore > 0) {
    const std::string_view tail = std::string_view(name).substr(underscore + 1);
    if (metres_per(tail) || seconds_per(tail) || is_pixels(tail)) {
      column.unit = std::string(tail);
      name.resize(underscore);
    }
  }
  if (column.unit.empty()) take_speed_unit(name, column.unit);
  // "x / cm", "t in s", "temps en s", "x em m", "x, cm".
  for (const std::string_view between : {"/", " in ", " en ", " em ", ","}) {
    const auto at = name.rfind(between);
    if (!column.unit.empty() || at == std::string::npos || at == 0) continue;
    const std::string_view tail = trimmed(std::string_view(name).substr(at + between.size()));
    if (!metres_per(tail) && !seconds_per(tail) && !is_pixels(tail)) continue;
    column.unit = std::string(tail);
    name = std::string(trimmed(std::string_view(name).substr(0, at)));
  }
  column.name = name;
  return column;
}

}  // namespace

bool is_time_name(std::string_view name) {
  static constexpr std::array<std::string_view, 13> kNames{"t",       "time",  "zeit",     "temps", "tiempo",
                                                           "tempo",   "tijd",  "czas",     "tid",   "elapsed time",
                                                           "seconds", "times", "timestamp"};
  return std::find(kNames.begin(), kNames.end(), lower(name)) != kNames.end();
}

bool is_frame_column(const TableColumn& column) {
  static constexpr std::array<std::string_view, 19> kNames{
      "frame",     "frames",      "frame number", "frame no", "frame #", "frame_number", "framenumber",
      "frame_idx", "frame index", "frame_index",  "frame_id", "frameid", "imagen",       "fotograma",
      "bild",      "image",       "fotogramma",   "klatka",   "cuadro"};
  return column.unit.empty() && std::find(kNames.begin(), kNames.end(), lower(column.name)) != kNames.end();
}

bool is_likelihood_column(const TableColumn& column) {
  const std::string name = lower(column.name);
  return (name == "likelihood" || name == "confidence") && std::ranges::all_of(column.values, [](const auto& value) {
           return !value || (*value >= 0.0 && *value <= 1.0);
         });
}

bool is_time_column(const TableColumn& column) {
  return column.unit.empty() ? is_time_name(column.name) : seconds_per(column.unit).has_value();
}

bool is_place_column(const TableColumn& column) {
  static const std::vector<std::string> kPlaces{
      "x", "position", "pos", "distance", "displacement", "position x", "x-position", "position (x)",
      // German, Spanish, French, Italian, Portuguese
      "weg", "ort", "abstand", "strecke", "entfernung", "posici\xC3\xB3n", "posici\xC3\x93n", "posicion", "distancia",
      "desplazamiento", "d\xC3\xA9placement", "distance x", "x position", "pos x", "x pos", "pos_x", "x_pos",
      "posizione", "spostamento", "distanza", "posi\xC3\xA7\xC3\xA3o", "dist\xC3\xA2ncia", "deslocamento",
      // Norwegian, Danish, Swedish, Dutch
      "posisjon", "strekning", "avstand", "afstand", "str\xC3\xA6kning",
      "str\xC3\xA4"
      "cka",
      "avst\xC3\xA5nd", "positie"};
  const std::string name = lower(column.name);
  if (is_time_column(column)) return false;
  return name.ends_with("x-koordinate") || std::find(kPlaces.begin(), kPlaces.end(), name) != kPlaces.end();
}

bool is_sensor_column(const TableColumn& column) {
  const std::string name = lower(column.name), text = lower(column.text);
  if (name != "position" && name != "distance") return false;
  if (text.find(", ch ") != std::string::npos || lower(column.run).starts_with("run #")) return true;
  const auto colon = text.find(':');
  return colon != std::string::npos && (text.starts_with("latest") || text.starts_with("run ")) &&
         colon < text.find(name);
}

bool is_height_column(const TableColumn& column) {
  static const std::vector<std::string> kHeights{
      "y",           "position y",        "y-position", "y position", "position (y)", "height",       "h",
      "h\xC3\xB6he", "hauteur",           "altura",     "altezza",    "h\xC3\xB8yde", "h\xC3\xB8jde", "h\xC3\xB6jd",
      "hoogte",      "vertical position", "z",          "altitude",   "alt",          "elevation",    "altitud",
      "altitudine"};
  const std::string name = lower(column.name);
  if (is_time_column(column)) return false;
  return name.ends_with("y-koordinate") || std::find(kHeights.begin(), kHeights.end(), name) != kHeights.end();
}

namespace {

/// A line of names of bodies or runs above the column names, each spanning several columns: Tracker writes the mass
/// above its t, x and y and pads the line.
bool names_several_columns(const std::vector<std::string>& line, const std::vector<std::string>& below) {
  const auto filled = [](const std::vector<std::string>& fields) {
    return std::count_if(fields.begin(), fields.end(), [](const std::string& field) { return !field.empty(); });
  };
  const bool has_time = std::any_of(below.begin(), below.end(),
                                    [](const std::string& field) { return is_time_name(column_of(field).name); });
  return filled(line) > 0 && filled(line) < filled(below) && has_time &&
         !std::any_of(line.begin(), line.end(),
                      [](const std::string& field) { return is_time_name(column_of(field).name); });
}

/// The columns of DeepLabCut's tables: frame numbers, then x, y and likelihood of each part of the body, which the line
/// "bodyparts" names. Empty for any other header.
std::vector<TableColumn> columns_of_body_parts(const std::vector<std::vector<std::string>>& lines, std::size_t width) {
  const auto line_of = [&](std::string_view first) {
    return std::ranges::find_if(lines, [&](const auto& line) { return !line.empty() && lower(line.front()) == first; });
  };
  const auto parts = line_of("bodyparts"), coordinates = line_of("coords"), animals = line_of("individuals");
  if (parts == lines.end() || coordinates == lines.end()) return {};
  if (parts->size() != width || coordinates->size() != width) return {};
  std::vector<TableColumn> columns(1);
  columns.front().text = columns.front().name = "frame";
  for (std::size_t c = 1; c < width; ++c) {
    TableColumn column;
    column.name = column.text = (*coordinates)[c];
    column.run = (*parts)[c];
    if (animals != lines.end() && animals->size() == width) column.run = (*animals)[c] + " " + column.run;
    if (column.name == "x" || column.name == "y") column.unit = "px";
    columns.push_back(std::move(column));
  }
  return columns;
}

/// Parts of a body as SLEAP heads them beside its scores: "thorax.x", "thorax.y", "thorax.score". Pixels, unless a line
/// of units says otherwise.
void split_parts(std::vector<TableColumn>& columns) {
  const auto is_score = [](const TableColumn& column) { return lower(column.name).ends_with(".score"); };
  if (std::ranges::none_of(columns, is_score)) return;
  for (TableColumn& column : columns) {
    const auto dot = column.name.rfind('.');
    if (dot == std::string::npos || dot == 0 || !column.run.empty()) continue;
    const std::string of_part = lower(column.name.substr(dot + 1));
    if (of_part != "x" && of_part != "y" && of_part != "score") continue;
    column.run = column.name.substr(0, dot);
    column.name = of_part;
    if (of_part != "score" && column.unit.empty()) column.unit = "px";
  }
}

/// A quantity with components, which is no body.
bool names_a_rate(const std::string& words) {
  static constexpr std::array<std::string_view, 12> kParts{"accel", "aceler", "acc\xC3\xA9l", "beschleun",
                                                           "veloc", "speed",  "vitesse",      "geschwindig",
                                                           "gyro",  "force",  "rotation",     "field"};
  return std::ranges::any_of(kParts, [&](std::string_view part) { return words.find(part) != std::string::npos; });
}

/// Bodies before their axes: "cart X", "cart Y". Of a single axis, the words may be a name.
void split_axes(std::vector<TableColumn>& columns) {
  const auto body_of = [](const TableColumn& column, char axis) -> std::string {
    const std::size_t size = column.name.size();
    const bool ends = size > 2 && column.name[size - 2] == ' ' && lower(column.name).back() == axis;
    const bool of_length = column.unit.empty() || metres_per(column.unit) || is_pixels(column.unit);
    const bool of_body = ends && of_length && column.run.empty() && !names_a_rate(lower(column.name));
    return of_body ? column.name.substr(0, size - 2) : std::string();
  };
  std::vector<std::string> bodies;
  for (const TableColumn& column : columns) {
    const std::string body = body_of(column, 'x');
    const auto is_y = [&](const TableColumn& other) { return body_of(other, 'y') == body; };
    if (!body.empty() && !is_place_column(column) && std::ranges::any_of(columns, is_y)) bodies.push_back(body);
  }
  for (TableColumn& column : columns) {
    for (const char axis : {'x', 'y', 'z'}) {
      const std::string body = body_of(column, axis);
      if (body.empty() || std::ranges::find(bodies, body) == bodies.end()) continue;
      column.run = body;
      column.name = std::string(1, axis);
      break;
    }
  }
}

/// "FREQUENCY", "Frame rate".
bool is_frame_rate(std::string_view key) {
  static constexpr std::array<std::string_view, 9> kNames{"frequency",  "frame rate",  "framerate",
                                                          "frame_rate", "fps",         "sample rate",
                                                          "samplerate", "sample_rate", "sampling rate"};
  return std::ranges::find(kNames, lower(trimmed(key))) != kNames.end();
}

std::size_t filled(const std::vector<std::string>& line) {
  return static_cast<std::size_t>(std::ranges::count_if(line, [](const std::string& field) { return !field.empty(); }));
}

/// A name and numbers, perhaps with words between.
bool is_statement(const std::vector<std::string>& line) {
  const auto is_number = [](const std::string& field) { return number_in(field, '.').has_value(); };
  return line.size() > 1 && !line.front().empty() && !is_number(line.front()) &&
         std::any_of(line.begin() + 1, line.end(), is_number);
}

/// A name and words, with nothing left empty between them, unlike a line of runs above their columns.
bool may_be_statement(const std::vector<std::string>& line) {
  return filled(line) > 1 && std::is_partitioned(line.begin(), line.end(), [](const auto& f) { return !f.empty(); });
}

constexpr const char* kMarkerNames = "MARKER_NAMES";

/// Names and units of Qualisys's columns: those of its header, which may hold frames and times besides, or of the
/// markers where it was not exported. Empty if they do not fit the numbers.
std::vector<std::vector<std::string>> markers_header(const std::vector<std::string>& markers,
                                                     const std::vector<std::string>& names, std::size_t width) {
  std::vector<std::string> columns = names, units;
  if (names.front() == kMarkerNames || names.front() == "TRAJECTORY_TYPES") {
    columns.clear();
    for (const std::string& marker : markers) {
      for (const char* axis : {" X", " Y", " Z"}) columns.push_back(marker + axis);
    }
    if (columns.size() != width) return {};
  }
  for (const std::string& column : columns) {
    const bool of_marker =
        std::ranges::any_of(markers, [&](const auto& name) { return column.starts_with(name + " "); });
    units.emplace_back(of_marker ? "mm" : "");
  }
  return {std::move(columns), std::move(units)};
}

}  // namespace

StatedAbove without_statements(std::vector<std::vector<std::string>> lines, std::size_t width) {
  auto first = std::find_if(lines.rbegin(), lines.rend(), is_statement).base();
  if (first == lines.begin() || first == lines.end()) return {std::move(lines)};  // none; or columns named by numbers
  StatedAbove found;
  std::vector<std::string> markers;
  for (auto line = lines.begin(); line != lines.end(); ++line) {
    if (line->front() == kMarkerNames) markers.assign(line->begin() + 1, line->end());
    if (line >= first || !is_frame_rate(line->front())) continue;
    const std::optional<double> rate_hz = number_in((*line)[1], '.');
    if (rate_hz && *rate_hz > 0.0) found.frame_rate_hz = rate_hz;
  }
  std::erase(markers, std::string());
  while (may_be_statement(*first) && filled(*first) < filled(lines.back())) ++first;
  found.header.assign(first, lines.end());
  if (!markers.empty()) found.header = markers_header(markers, found.header.back(), width);
  return found;
}

std::vector<TableColumn> columns_of_header(const std::vector<std::vector<std::string>>& lines, std::size_t width) {
  if (std::vector<TableColumn> parts = columns_of_body_parts(lines, width); !parts.empty()) return parts;
  auto header = lines;
  std::vector<std::string> runs, units;
  if (header.size() > 1 &&
      (all_that_is_there(header.front(), speaks_of_a_run) || names_several_columns(header.front(), header[1]))) {
    runs = header.front();
    header.erase(header.begin());
  }
  if (header.size() > 1 && all_that_is_there(header.back(), looks_like_a_unit)) {
    units = header.back();
    header.pop_back();
  }
  // A title with as many words as columns.
  const auto names_time = [](const std::vector<std::string>& line) {
    return std::any_of(line.begin(), line.end(),
                       [](const std::string& field) { return is_time_column(column_of(field)); });
  };
  const auto names = std::find_if(header.begin(), header.end(), names_time);
  if (names != header.end()) header.erase(header.begin(), names);
  std::vector<TableColumn> columns;
  std::string run;
  for (std::size_t c = 0; c < width; ++c) {
    const bool named = !header.empty() && c < header.front().size() && !header.front()[c].empty();
    columns.push_back(column_of(named ? header.front()[c] : fmt::format("column {}", c + 1)));
    if (c < runs.size() && !runs[c].empty()) run = runs[c];  // one word above several columns
    if (columns.back().run.empty()) columns.back().run = run;
    if (c < units.size() && columns.back().unit.empty()) columns.back().unit = without_brackets(units[c]);
  }
  split_parts(columns);
  split_axes(columns);
  return columns;
}

bool holds_units(const std::vector<std::string>& line) {
  return all_that_is_there(line, looks_like_a_unit);
}

namespace {

using Unit = std::pair<std::string_view, double>;
constexpr std::array<Unit, 10> kLengths{{{"m", 1.0},
                                         {"cm", 1e-2},
                                         {"mm", 1e-3},
                                         {"um", 1e-6},
                                         {"\xC2\xB5m", 1e-6},
                                         {"\xCE\xBCm", 1e-6},
                                         {"dm", 0.1},
                                         {"km", 1e3},
                                         {"in", 0.0254},
                                         {"ft", 0.3048}}};
constexpr std::array<Unit, 7> kTimes{
    {{"s", 1.0}, {"sec", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"\xC2\xB5s", 1e-6}, {"\xCE\xBCs", 1e-6}, {"min", 60.0}}};

// English, German, French, Spanish and Portuguese, Italian; in lower case.
using Words = std::span<const std::string_view>;
constexpr std::array<std::string_view, 9> kMetre{"meter",         "meters", "metre",  "metres", "m\xC3\xA8tre",
                                                 "m\xC3\xA8tres", "metro",  "metros", "metri"};
constexpr std::array<std::string_view, 10> kSecond{"second",   "seconds", "sekunde",  "sekunden", "seconde",
                                                   "secondes", "segundo", "segundos", "secondo",  "secondi"};
constexpr std::array<std::string_view, 6> kMinute{"minute", "minutes", "minuten", "minuto", "minutos", "minuti"};
constexpr std::array<Unit, 22> kPrefixes{
    {{"deci", 0.1},          {"dezi", 0.1},          {"d\xC3\xA9\x63i", 0.1}, {"dec\xC3\xAD", 0.1},
     {"centi", 1e-2},        {"zenti", 1e-2},        {"cent\xC3\xAD", 1e-2},  {"milli", 1e-3},
     {"mili", 1e-3},         {"mil\xC3\xAD", 1e-3},  {"micro", 1e-6},         {"mikro", 1e-6},
     {"micr\xC3\xB3", 1e-6}, {"micr\xC3\xB4", 1e-6}, {"kilo", 1e3},           {"kil\xC3\xB3", 1e3},
     {"quil\xC3\xB4", 1e3},  {"quil\xC3\xB3", 1e3},  {"quilo", 1e3},          {"chilo", 1e3},
     {"milis", 1e-3},  // Portuguese: milissegundos
     {"micros", 1e-6}}};
constexpr std::array<Unit, 7> kOtherLengths{{{"inch", 0.0254},
                                             {"inches", 0.0254},
                                             {"zoll", 0.0254},
                                             {"foot", 0.3048},
                                             {"feet", 0.3048},
                                             {"micron", 1e-6},
                                             {"microns", 1e-6}}};
template <std::size_t N>
std::optional<double> factor(const std::array<Unit, N>& units, std::string_view unit) {
  const auto found = std::find_if(units.begin(), units.end(), [&](const Unit& of) { return of.first == unit; });
  if (found == units.end()) return {};
  return found->second;
}

/// "metres" and "Zentimeter" by the words for a metre, "Millisekunden" by those for a second.
std::optional<double> word_factor(Words words, std::string_view word) {
  const auto is_whole = [&](std::string_view text) {
    return std::find(words.begin(), words.end(), text) != words.end();
  };
  if (is_whole(word)) return 1.0;
  for (const auto& [prefix, of_whole] : kPrefixes) {
    if (word.starts_with(prefix) && is_whole(word.substr(prefix.size()))) return of_whole;
  }
  return {};
}

}  // namespace

bool is_pixels(std::string_view unit) {
  const std::string word = lower(unit);
  return word == "px" || word == "pixel" || word == "pixels";
}

std::optional<double> metres_per(std::string_view unit) {
  const std::optional<double> symbol = factor(kLengths, unit);
  if (symbol) return symbol;
  const std::string word = lower(unit);
  const std::optional<double> metric = word_factor(kMetre, word);
  return metric ? metric : factor(kOtherLengths, word);
}

std::optional<double> seconds_per(std::string_view unit) {
  const std::optional<double> symbol = factor(kTimes, unit);
  if (symbol) return symbol;
  const std::string word = lower(unit);
  if (std::find(kMinute.begin(), kMinute.end(), word) != kMinute.end()) return 60.0;
  return word_factor(kSecond, word);
}

}  // namespace glidelab::core
