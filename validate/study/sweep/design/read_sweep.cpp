#include "validate/study/sweep/design/read_sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include "base/errors.h"
#include "base/files/staged_output.h"
#include "base/toml/strict_toml.h"
#include "core/motion/bandwidth/bandwidth_rule.h"
#include "fit/estimators.h"
#include "validate/study/coverage/naive_lines.h"
#include "validate/study/sweep/design/sweep_axes.h"
#include "validate/study/sweep/design/sweep_design.h"
#include "validate/study/sweep/design/sweep_scenario.h"
#include "validate/study/sweep/design/sweep_trial.h"

namespace glidelab::validate {
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

/// As SQLite compares the names of columns: of the letters a to z, capitals are no others.
std::string folded(std::string name) {
  for (char& c : name) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return name;
}

/// `tables`: of the axes.
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

/// One value of the scenario that two keys reach would be that of the later one, in a row that has both.
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
        continue;  // try_values says what is wrong with it
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

/// Whether every run's noise of tracks comes from an axis.
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

/// As of a scenario a sweep (render/scenario.cpp): read apart, because asking for a key makes it a known one.
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
