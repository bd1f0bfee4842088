#include "validate/study/sweep/design/read_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string_view>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/toml/strict_toml.h"
#include "core/motion/bandwidth/bandwidth_rule.h"
#include "fit/estimators.h"
#include "validate/study/coverage/naive_lines.h"
#include "validate/study/sweep/design/sweep.h"
#include "validate/study/sweep/design/sweep_scenario.h"

namespace glidelab::validate {
namespace {

using base::TomlTable;
using Kind = AxisSource::Kind;

/// Rounded to whole numbers, neighbours in a short range would coincide.
void check_apart(const TomlTable& table, const AxisSource& source) {
  if (!std::isfinite(source.from) || !std::isfinite(source.to)) return;
  const std::vector<base::TomlScalar> values = all_values(source);
  if (std::adjacent_find(values.begin(), values.end()) == values.end()) return;
  table.reject("count", fmt::format("{} values, some of which are the same whole number", source.count),
               "fewer values, or a longer range");
}

/// { from = …, to = …, count = …, whole = … }, from < to.
void read_range(const TomlTable& axis, const char* key, Kind kind, Design design, AxisSource& source) {
  const TomlTable table = axis.table(key);
  const bool ratio = kind == Kind::logarithmic || kind == Kind::log_uniform;
  source.kind = kind;
  source.from = table.number("from", ratio ? base::above(0.0) : base::any_number());
  source.to = table.number("to", ratio ? base::above(0.0) : base::any_number());
  if (!(source.from < source.to) && std::isfinite(source.from) && std::isfinite(source.to)) {
    table.reject("to", fmt::format("{}: an empty range", source.to),
                 fmt::format("a number above from = {}", source.from));
  }
  source.whole = table.boolean_or("whole", false);
  for (const char* end : {"from", "to"}) {
    const double value = std::string_view(end) == "from" ? source.from : source.to;
    if (source.whole && std::isfinite(value) && value != std::floor(value)) {
      table.reject(end, fmt::format("{}", value), "a whole number, with whole = true");
    }
  }
  if (source.drawn()) return;
  if (design == Design::factorial) {
    source.count = static_cast<std::size_t>(table.integer("count", 2, 1000000));
    if (source.whole) check_apart(table, source);
  } else if (table.has("count")) {
    table.reject("count", "a number of values", "no count: the design places its samples anywhere in the range");
  }
}

void read_random(const TomlTable& axis, Design design, AxisSource& source) {
  const TomlTable table = axis.table("random");
  const std::string word = table.word("distribution", {"uniform", "log_uniform", "normal", "log_normal"});
  if (word == "uniform" || word == "log_uniform") {
    return read_range(axis, "random", word == "uniform" ? Kind::uniform : Kind::log_uniform, design, source);
  }
  source.kind = word == "normal" ? Kind::normal : Kind::log_normal;
  source.mean = source.kind == Kind::normal ? table.number("mean") : table.number("median", base::above(0.0));
  source.sd = table.number(source.kind == Kind::normal ? "sd" : "sd_of_log", base::above(0.0));
}

/// "rolling, line_readout_s = 2e-05": words are shown without their key.
std::string label_of(const std::vector<base::TomlAssignment>& keys) {
  std::string words, others;
  for (const auto& [path, value] : keys) {
    if (const auto* word = std::get_if<std::string>(&value.value())) {
      words += (words.empty() ? "" : ", ") + *word;
    } else {
      others += fmt::format(", {} = {}", path.substr(path.rfind('.') + 1), base::toml_text(*value));
    }
  }
  return words.empty() ? others.substr(std::min<std::size_t>(2, others.size())) : words + others;
}

/// [[vary]] choices = [{ "shutter.kind" = "global" }, { "shutter.kind" = "rolling", "shutter.line_readout_s" = 2e-5 }]
void read_choices(const TomlTable& table, Axis& axis) {
  std::set<std::string> keys;
  const auto same = [](const Choice& a, const Choice& b) {
    return std::equal(a.keys.begin(), a.keys.end(), b.keys.begin(), b.keys.end(),
                      [](const auto& x, const auto& y) { return x.path == y.path && x.value == y.value; });
  };
  for (const TomlTable& given : table.tables_or_none("choices")) {
    Choice choice;
    choice.line = given.line();
    for (auto& [path, value] : given.scalars()) {
      if (path == "label") continue;
      if (path == "camera_file") given.reject(path, "a camera", "cameras = [...], an axis of its own");
      choice.keys.push_back({path, std::move(value)});
      if (keys.insert(path).second) axis.keys.push_back(path);
    }
    choice.label = given.has("label") ? given.text("label") : label_of(choice.keys);
    if (choice.keys.empty()) given.reject("", "a choice without a key", "a key of the scenario or more");
    for (const Choice& other : axis.choices) {
      if (same(choice, other)) {
        given.reject("", fmt::format("the choice of line {} again", other.line), "each choice once");
      } else if (choice.label == other.label) {
        given.reject("label", fmt::format("\"{}\" twice", choice.label), "a label of its own for each choice");
      }
    }
    axis.source.values.emplace_back(choice.label);
    axis.choices.push_back(std::move(choice));
  }
}

/// A value given twice would make a duplicate point.
void check_values_once(const TomlTable& table, const std::string& form, const std::vector<base::TomlScalar>& values) {
  for (std::size_t i = 1; i < values.size(); ++i) {
    const auto here = values.begin() + static_cast<std::ptrdiff_t>(i);
    if (std::find(values.begin(), here, *here) == here) continue;
    table.reject(form, fmt::format("{} twice", base::toml_text(*here)), "each one once");
    return;
  }
}

void read_source(const TomlTable& table, Design design, Axis& axis, const std::filesystem::path& folder) {
  const std::vector<std::string> forms = {"values",  "words", "switch",    "choices",
                                          "cameras", "range", "log_range", "random"};
  std::vector<std::string> given;
  for (const std::string& form : forms) {
    if (table.has(form)) given.push_back(form);
  }
  if (given.size() != 1) {
    table.reject("key", given.empty() ? "no values for it" : fmt::format("{} and {}", given[0], given[1]),
                 fmt::format("exactly one of {}", fmt::join(forms, ", ")));
    return;
  }
  AxisSource& source = axis.source;
  const std::string& form = given.front();
  if (form == "values") {
    for (const double value : table.numbers("values", 0)) source.values.emplace_back(value);
    if (source.values.empty()) table.reject("values", "an empty list", "one value or more");
    check_values_once(table, form, source.values);
  } else if (form == "words") {
    for (std::string& word : table.texts_or_none("words")) source.values.emplace_back(std::move(word));
    if (source.values.empty()) table.reject("words", "an empty list", "one text or more");
    check_values_once(table, form, source.values);
  } else if (form == "switch") {
    table.boolean_or("switch", true);
    source.values = {false, true};
  } else if (form == "choices") {
    read_choices(table, axis);
  } else if (form == "cameras") {
    axis.keys = {"camera_file"};
    for (const std::string& name : table.texts_or_none("cameras")) {
      std::error_code ignored;  // a file that cannot be accessed fails when it is read
      const std::filesystem::path resolved = std::filesystem::weakly_canonical(folder / name, ignored);
      const std::filesystem::path path = resolved.empty() ? folder / name : resolved;
      if (!std::filesystem::is_directory(path, ignored)) {
        if (!std::filesystem::exists(path, ignored) && !ignored) {
          table.reject("cameras", fmt::format("no file or folder {}", path.string()),
                       "camera files, or folders with some, from this file's folder");
        }
        source.values.emplace_back(path.string());
        continue;
      }
      std::set<std::string> found;
      for (const auto& entry : std::filesystem::directory_iterator(path)) {
        if (entry.path().extension() == ".toml") found.insert(entry.path().string());
      }
      for (const std::string& file : found) source.values.emplace_back(file);
    }
    if (source.values.empty()) table.reject("cameras", "no camera file", "camera files, or folders with some");
    check_values_once(table, form, source.values);
  } else if (form == "random") {
    read_random(table, design, source);
  } else {
    read_range(table, form.c_str(), form == "range" ? Kind::linear : Kind::logarithmic, design, source);
  }
}

/// Keys that do not apply to the form; they are requested, so that they are not reported as unknown.
void refuse_beside(const TomlTable& table, const std::vector<std::string>& keys, const char* form,
                   const char* expected) {
  for (const std::string& key : keys) {
    if (table.has(key)) table.reject(key, fmt::format("a key beside {}", form), expected);
  }
}

}  // namespace

Axis read_axis(const TomlTable& table, Design design, const std::filesystem::path& folder) {
  Axis axis;
  if (table.has("choices")) {
    axis.name = table.text("name");
    axis.line = table.line("choices");
    refuse_beside(table, {"key", "keys"}, "choices", "none: each choice names its own");
  } else if (table.has("cameras")) {
    axis.line = table.line("cameras");
    refuse_beside(table, {"key", "keys"}, "cameras", "none: the files are the values");
    axis.name = table.text_or("name", "camera_file");
  } else if (table.has("keys")) {
    axis.line = table.line("keys");
    refuse_beside(table, {"key"}, "keys", "one of the two");
    axis.keys = table.texts_or_none("keys");
    axis.name = table.text("name");
  } else {
    axis.line = table.line("key");
    axis.keys = {table.text("key")};
    axis.name = table.text_or("name", axis.keys.front());
  }
  read_source(table, design, axis, folder);
  return axis;
}

namespace {

using base::TomlTable;

void read_analyses(const TomlTable& root, Sweep& sweep) {
  std::set<std::string> seen;
  const auto add = [&](const std::string& key, Analysis analysis) {
    const std::string name = analysis.name();
    if (!seen.insert(name).second) root.reject(key, fmt::format("\"{}\" twice", name), "each one once");
    sweep.analyses.push_back(std::move(analysis));
  };
  std::vector<std::string> names;
  for (const fit::Estimator& judged : fit::judged_estimators()) names.emplace_back(judged.name);
  if (root.has("estimators")) names = root.texts_or_none("estimators");
  for (const std::string& name : names) {
    if (fit::find_estimator(name) == nullptr) {
      root.reject("estimators", fmt::format("\"{}\"", name),
                  fmt::format("\"{}\"", fmt::join(fit::estimator_names(), "\", \"")));
    }
    add("estimators", {name, std::nullopt, {}});
  }
  const std::string lines(fit::default_estimator().name);
  if (const auto given = root.maybe_numbers("bandwidths_s", 0, base::above(0.0))) {
    for (const double bandwidth_s : *given) add("bandwidths_s", {lines, bandwidth_s, {}});
  }
  if (const auto given = root.maybe_numbers("all_points_bandwidths_s", 0, base::above(0.0))) {
    for (const double bandwidth_s : *given) add("all_points_bandwidths_s", {kAllPoints, bandwidth_s, {}});
  }
  for (const std::string& rule : root.texts_or_none("bandwidth_rules")) {
    std::vector<std::string_view> known;
    for (const core::BandwidthRule& one : core::bandwidth_rules()) known.push_back(one.name);
    known.emplace_back(kBestPossible);
    if (std::find(known.begin(), known.end(), rule) == known.end()) {
      root.reject("bandwidth_rules", fmt::format("\"{}\"", rule), fmt::format("some of {}", fmt::join(known, ", ")));
    }
    add("bandwidth_rules", {lines, std::nullopt, rule});
  }
  if (sweep.analyses.empty()) root.reject("estimators", "an empty list", "one or more");
}

/// Folds case as SQLite does for column names: only the letters A to Z.
std::string folded(std::string name) {
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return name;
}

/// `tables`: those of the axes.
void check_names(const std::vector<TomlTable>& tables, const Sweep& sweep) {
  const std::set<std::string> taken = {"run", "point", "replicate", "seed", "status", "why"};
  std::map<std::string, std::string> names;
  std::set<std::string> keys;
  for (std::size_t i = 0; i < sweep.axes.size(); ++i) {
    const Axis& axis = sweep.axes[i];
    const std::string at = tables[i].has("name") ? "name" : "key";
    if (taken.contains(folded(axis.name))) {
      tables[i].reject(at, fmt::format("the name \"{}\"", axis.name),
                       fmt::format("a name other than the columns {}", fmt::join(taken, ", ")));
    }
    const auto [other, is_new] = names.emplace(folded(axis.name), axis.name);
    if (!is_new) {
      tables[i].reject(at, fmt::format("\"{}\" beside \"{}\"", axis.name, other->second),
                       "each name once: columns that differ by capitals alone are one");
    }
    for (const std::string& key : axis.keys) {
      if (!keys.insert(key).second) {
        tables[i].reject(at, fmt::format("the key \"{}\" twice", key), "each key once");
      }
    }
  }
}

/// If two keys reach the same value of the scenario, the later one would win in a row that has both.
void check_reach(const Sweep& sweep) {
  std::map<std::string, const std::string*> reached;
  std::vector<base::Issue> issues;
  for (const Axis& axis : sweep.axes) {
    for (const std::string& key : axis.keys) {
      if (key == kNoiseKey) continue;
      std::vector<std::string> places;
      try {
        places = base::reached_by(sweep.scenario_text, sweep.scenario_file.string(), key);
      } catch (const base::InputError&) {
        continue;  // try_values reports the error
      }
      for (const std::string& place : places) {
        const auto [other, is_new] = reached.emplace(place, &key);
        if (is_new) continue;
        issues.push_back({sweep.file.string(), axis.line, key,
                          fmt::format("a key that reaches {}, as \"{}\" does", place, *other->second),
                          "keys that share no value of the scenario"});
        break;
      }
    }
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
}

/// Whether the tracks' noise of every run comes from an axis.
bool check_noise(const TomlTable& root, const Sweep& sweep) {
  bool any = false, of_every_run = false;
  for (const Axis& axis : sweep.axes) {
    if (std::find(axis.keys.begin(), axis.keys.end(), kNoiseKey) == axis.keys.end()) continue;
    any = true;
    of_every_run = std::all_of(axis.choices.begin(), axis.choices.end(), [](const Choice& choice) {
      return std::any_of(choice.keys.begin(), choice.keys.end(), [](const auto& of) { return of.path == kNoiseKey; });
    });
  }
  if (any && sweep.level == Level::clips) {
    root.reject("vary", fmt::format("the key \"{}\"", kNoiseKey), "a key of the scenario, with level = \"clips\"");
  }
  return of_every_run;
}

/// Refuses a scenario in place of a sweep, the counterpart of render/scenario/scenario.cpp; read separately, because
/// requesting a key makes it known.
void refuse_scenario(const std::string& text, const std::filesystem::path& path) {
  const base::TomlFile file = base::TomlFile::parse(text, path.string());
  if (!file.root().has("configuration") || file.root().has("scenario") || file.root().has("vary")) return;
  throw base::InputError(base::Issue{path.string(), 0, "", "a scenario",
                                     "a sweep: scenario = \"FILE\" and tables [[vary]] (docs/reference/sweep.md)"});
}

}  // namespace

Sweep read_sweep(const std::filesystem::path& path) {
  Sweep sweep;
  sweep.file = path;
  sweep.text = base::read_file(path);
  const base::TomlFile file = base::TomlFile::parse(sweep.text, path.string());
  refuse_scenario(sweep.text, path);
  const TomlTable root = file.root();
  root.integer("format", 1, 1);
  sweep.name = root.text("name");
  const std::string scenario = root.text("scenario");
  sweep.level = root.word("level", {"tracks", "clips"}, "tracks") == "tracks" ? Level::tracks : Level::clips;
  const std::string design = root.word("design", {"factorial", "latin-hypercube", "sobol"}, "factorial");
  sweep.design = design == "factorial" ? Design::factorial
                 : design == "sobol"   ? Design::sobol
                                       : Design::latin_hypercube;
  if (sweep.design != Design::factorial) {
    sweep.samples = static_cast<std::uint64_t>(root.integer("samples", 1, std::numeric_limits<long>::max()));
  }
  sweep.seed = static_cast<std::uint64_t>(root.integer_or("seed", 1, 0, std::numeric_limits<long>::max()));
  sweep.replicates = static_cast<std::uint64_t>(root.integer_or("replicates", 1, 1, std::numeric_limits<long>::max()));
  if (root.has("calibration")) {
    sweep.calibrate_once = root.word("calibration", {"each", "once"}) == "once";
    if (sweep.level == Level::tracks) {
      root.reject("calibration", "a calibration", "no such key with level = \"tracks\", which has no images");
    }
  }
  sweep.field_m = root.maybe_number("field_m", base::above(0.0));
  read_analyses(root, sweep);
  const std::vector<TomlTable> axes = root.tables_or_none("vary");
  for (const TomlTable& table : axes) {
    sweep.axes.push_back(read_axis(table, sweep.design, path.parent_path()));
  }
  check_names(axes, sweep);
  for (const TomlTable& table : root.tables_or_none("published_fall")) {
    sweep.published_falls.push_back({table.text("configuration"), table.number("mu_lightest"),
                                     table.number("mu_heaviest"), table.number("r2", base::between_open(0.0, 1.0)),
                                     table.text("source")});
    const PublishedFall& fall = sweep.published_falls.back();
    if (fall.mu_heaviest >= fall.mu_lightest) {
      table.reject("mu_heaviest", fmt::format("{}", fall.mu_heaviest), "less than mu_lightest");
    }
  }
  const bool noise_varies = check_noise(root, sweep);
  if (const auto tracks = root.maybe_table("tracks")) {
    sweep.noise_m = tracks->number("noise_m", base::at_least(0.0));
    if (sweep.level == Level::clips)
      root.reject("tracks", "the noise of tracks", "no such table with level = \"clips\"");
  } else if (sweep.level == Level::tracks && !noise_varies) {
    root.table("tracks");
  }
  file.finish();
  sweep.scenario_file = path.parent_path() / scenario;
  sweep.scenario_text = base::read_file(sweep.scenario_file);
  point_count(sweep);
  check_reach(sweep);
  const bool cameras_vary = std::any_of(sweep.axes.begin(), sweep.axes.end(), [](const Axis& axis) {
    return axis.keys == std::vector<std::string>{"camera_file"};
  });
  if (!cameras_vary) {
    const base::TomlFile own = base::TomlFile::parse(sweep.scenario_text, sweep.scenario_file.string());
    if (const auto camera = own.root().maybe_text("camera_file")) {
      sweep.camera_files.push_back(base::read_file(sweep.scenario_file.parent_path() / *camera));
    }
  }
  try_values(sweep);
  for (const Axis& axis : sweep.axes) {
    if (axis.keys != std::vector<std::string>{"camera_file"}) continue;
    for (const base::TomlScalar& value : axis.source.values) {
      sweep.camera_files.push_back(base::read_file(std::get<std::string>(value)));
    }
  }
  return sweep;
}

}  // namespace glidelab::validate
