#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "base/errors.h"
#include "base/staged_output.h"
#include "base/strict_toml.h"
#include "core/bandwidth_rule.h"
#include "validate/sweep.h"
#include "validate/sweep_design.h"
#include "validate/sweep_scenario.h"

namespace glidelab::validate {
namespace {

using base::TomlTable;
using Kind = AxisSource::Kind;

/// { from = …, to = …, count = … }, from < to.
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
  if (source.drawn()) return;
  if (design == Design::factorial) {
    source.count = static_cast<std::size_t>(table.integer("count", 2, 1000000));
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

void read_source(const TomlTable& table, Design design, Axis& axis, const std::filesystem::path& folder) {
  const std::vector<std::string> forms = {"values", "words", "switch", "cameras", "range", "log_range", "random"};
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
  } else if (form == "words") {
    for (std::string& word : table.texts_or_none("words")) source.values.emplace_back(std::move(word));
    if (source.values.empty()) table.reject("words", "an empty list", "one text or more");
  } else if (form == "switch") {
    table.boolean_or("switch", true);
    source.values = {false, true};
  } else if (form == "cameras") {
    axis.keys = {"camera_file"};
    for (const std::string& name : table.texts_or_none("cameras")) {
      std::error_code ignored;  // what cannot be looked at says so when it is read
      const std::filesystem::path resolved = std::filesystem::weakly_canonical(folder / name, ignored);
      const std::filesystem::path path = resolved.empty() ? folder / name : resolved;
      if (!std::filesystem::is_directory(path, ignored)) {
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
  } else if (form == "random") {
    read_random(table, design, source);
  } else {
    read_range(table, form.c_str(), form == "range" ? Kind::linear : Kind::logarithmic, design, source);
  }
}

Axis read_axis(const TomlTable& table, Design design, const std::filesystem::path& folder) {
  Axis axis;
  if (table.has("cameras")) {
    axis.name = table.text_or("name", "camera_file");
  } else if (table.has("keys")) {
    axis.keys = table.texts_or_none("keys");
    axis.name = table.text("name");
  } else {
    axis.keys = {table.text("key")};
    axis.name = table.text_or("name", axis.keys.front());
  }
  read_source(table, design, axis, folder);
  return axis;
}

void read_analyses(const TomlTable& root, Sweep& sweep) {
  std::vector<std::string> names = {"phase-diagram", "trajectory"};
  if (root.has("estimators")) names = root.texts_or_none("estimators");
  for (const std::string& name : names) {
    if (name != "phase-diagram" && name != "phase-diagram-gls" && name != "trajectory") {
      root.reject("estimators", fmt::format("\"{}\"", name),
                  "\"phase-diagram\", \"phase-diagram-gls\", \"trajectory\"");
    }
    sweep.analyses.push_back({name, std::nullopt, {}});
  }
  if (const auto given = root.maybe_numbers("bandwidths_s", 0, base::above(0.0))) {
    for (const double bandwidth_s : *given) sweep.analyses.push_back({"phase-diagram", bandwidth_s, {}});
  }
  if (const auto given = root.maybe_numbers("all_points_bandwidths_s", 0, base::above(0.0))) {
    for (const double bandwidth_s : *given) sweep.analyses.push_back({"all-points", bandwidth_s, {}});
  }
  for (const std::string& rule : root.texts_or_none("bandwidth_rules")) {
    std::vector<std::string> known = core::bandwidth_rule_names();
    known.emplace_back(kBestPossible);
    if (std::find(known.begin(), known.end(), rule) == known.end()) {
      root.reject("bandwidth_rules", fmt::format("\"{}\"", rule), fmt::format("some of {}", fmt::join(known, ", ")));
    }
    sweep.analyses.push_back({"phase-diagram", std::nullopt, rule});
  }
  std::set<std::string> seen;
  for (const Analysis& analysis : sweep.analyses) {
    if (!seen.insert(analysis.name()).second) root.reject("estimators", analysis.name() + " twice", "each one once");
  }
  if (sweep.analyses.empty()) root.reject("estimators", "an empty list", "one or more");
}

void check_names(const TomlTable& root, const Sweep& sweep) {
  const std::set<std::string> taken = {"run", "point", "replicate", "seed", "status", "why"};
  std::set<std::string> names, keys;
  for (const Axis& axis : sweep.axes) {
    if (taken.contains(axis.name)) root.reject("vary", fmt::format("the name \"{}\"", axis.name), "another name");
    if (!names.insert(axis.name).second) root.reject("vary", fmt::format("\"{}\" twice", axis.name), "each name once");
    for (const std::string& key : axis.keys) {
      if (!keys.insert(key).second) root.reject("vary", fmt::format("the key \"{}\" twice", key), "each key once");
    }
  }
}

/// A value that the scenario refuses is found before the first run.
void try_values(const Sweep& sweep) {
  std::vector<base::TomlScalar> first;
  for (const Axis& axis : sweep.axes) {
    first.push_back(axis.source.kind == Kind::list ? axis.source.values.front() : value_at(axis.source, 0.0));
    if (axis.source.drawn()) first.back() = value_at(axis.source, 0.5);
  }
  const bool cameras = std::any_of(sweep.axes.begin(), sweep.axes.end(), [](const Axis& axis) {
    return axis.keys == std::vector<std::string>{"camera_file"};
  });
  if (!cameras) scenario_with(sweep, first);
  constexpr std::size_t kTried = 200;  // of one axis; a longer one is a grid, whose ends tell
  for (std::size_t i = 0; i < sweep.axes.size(); ++i) {
    const AxisSource& source = sweep.axes[i].source;
    std::vector<base::TomlScalar> values = source.values;
    if (source.kind != Kind::list)
      values = {source.drawn() ? value_at(source, 0.25) : source.from,
                source.drawn() ? value_at(source, 0.75) : source.to};
    for (std::size_t k = 0; k < values.size(); k += 1 + values.size() / kTried) {
      std::vector<base::TomlScalar> one_other = first;
      one_other[i] = values[k];
      // A camera that does not suit the scenario's view is a run's outcome, and no mistake of the sweep's.
      Sweep tried = sweep;
      if (sweep.axes[i].keys == std::vector<std::string>{"camera_file"}) tried.level = Level::tracks;
      scenario_with(tried, one_other);
    }
  }
}

/// As of a scenario a sweep (render/scenario.cpp): read apart, because asking for a key makes it a known one.
void refuse_scenario(const std::string& text, const std::filesystem::path& path) {
  const base::TomlFile file = base::TomlFile::parse(text, path.string());
  if (!file.root().has("configuration") || file.root().has("scenario") || file.root().has("vary")) return;
  throw base::InputError(base::Issue{path.string(), 0, "", "a scenario",
                                     "a sweep: scenario = \"FILE\" and tables [[vary]] (docs/sweep.md)"});
}

}  // namespace

std::string Analysis::name() const {
  if (bandwidth_s) return fmt::format("{} h={} s", estimator, *bandwidth_s);
  return bandwidth_rule.empty() ? estimator : fmt::format("{} {}", estimator, bandwidth_rule);
}

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
  sweep.field_m = root.maybe_number("field_m", base::above(0.0));
  read_analyses(root, sweep);
  for (const TomlTable& table : root.tables_or_none("vary")) {
    sweep.axes.push_back(read_axis(table, sweep.design, path.parent_path()));
  }
  check_names(root, sweep);
  const bool noise_varies = std::any_of(sweep.axes.begin(), sweep.axes.end(), [](const Axis& axis) {
    return std::find(axis.keys.begin(), axis.keys.end(), kNoiseKey) != axis.keys.end();
  });
  if (noise_varies && sweep.level == Level::clips) {
    root.reject("vary", fmt::format("the key \"{}\"", kNoiseKey), "a key of the scenario, with level = \"clips\"");
  }
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
