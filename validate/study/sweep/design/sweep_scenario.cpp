#include "validate/study/sweep/design/sweep_scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "validate/study/sweep/design/sweep.h"

namespace glidelab::validate {
namespace {

/// A camera file's own values would be overridden by those in the scenario, and would not vary.
void check_camera_is_free(const Sweep& sweep) {
  const base::TomlFile file = base::TomlFile::parse(sweep.scenario_text, sweep.scenario_file.string());
  const base::TomlTable root = file.root();
  const auto camera = root.maybe_table("camera");
  std::vector<base::Issue> issues;
  for (const char* key : {"width_px", "height_px", "frame_rate_hz", "focal_px", "exposure_s"}) {
    if (!camera || !camera->has(key)) continue;
    issues.push_back({sweep.scenario_file.string(), camera->line(key), camera->path(key),
                      "a value, in a sweep over cameras", "none: every camera has its own, which this would replace"});
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
}

render::Scenario read(const Sweep& sweep, const std::string& text, const std::string& shown_as,
                      render::ScenarioChecks checks) {
  try {
    return render::read_scenario(text, sweep.scenario_file, checks);
  } catch (const base::InputError& error) {
    // Line numbers would refer to the composed text, which the user never sees.
    std::vector<base::Issue> issues = error.issues();
    for (base::Issue& issue : issues) {
      if (issue.file != sweep.scenario_file.string()) continue;
      issue.file = shown_as;
      issue.line = 0;
    }
    throw base::InputError(std::move(issues));
  }
}

/// The assignments of an axis; for a choice, keys that only other choices have are removed.
std::vector<base::TomlAssignment> assignments_of(const Axis& axis, const base::TomlScalar& value) {
  std::vector<base::TomlAssignment> assignments;
  const auto chosen = std::find_if(axis.choices.begin(), axis.choices.end(),
                                   [&](const Choice& choice) { return choice.label == std::get<std::string>(value); });
  for (const std::string& key : axis.keys) {
    base::TomlAssignment assignment{key, value};
    if (chosen != axis.choices.end()) {
      const auto own = std::find_if(chosen->keys.begin(), chosen->keys.end(),
                                    [&](const base::TomlAssignment& of) { return of.path == key; });
      assignment.value = own == chosen->keys.end() ? std::nullopt : own->value;
    }
    assignments.push_back(std::move(assignment));
  }
  return assignments;
}

double noise_of(const Sweep& sweep, const Axis& axis, const base::TomlScalar& value) {
  const double* const noise_m = std::get_if<double>(&value);
  if (noise_m != nullptr && *noise_m >= 0.0) return *noise_m;
  throw base::InputError(
      base::Issue{sweep.file.string(), axis.line, kNoiseKey, base::toml_text(value), base::at_least(0.0).describe()});
}

}  // namespace

RunScenario scenario_with(const Sweep& sweep, const std::vector<base::TomlScalar>& values) {
  RunScenario run;
  run.noise_m = sweep.noise_m;
  std::vector<base::TomlAssignment> assignments;
  std::string shown_as = sweep.scenario_file.string();
  for (std::size_t i = 0; i < sweep.axes.size(); ++i) {
    const Axis& axis = sweep.axes[i];
    shown_as += fmt::format("{} {} = {}", i == 0 ? " with" : ",", axis.name, base::toml_text(values[i]));
    for (base::TomlAssignment& assignment : assignments_of(axis, values[i])) {
      if (assignment.path == kNoiseKey) {
        if (assignment.value) run.noise_m = noise_of(sweep, axis, *assignment.value);
        continue;
      }
      if (assignment.path == "camera_file") check_camera_is_free(sweep);
      assignments.push_back(std::move(assignment));
    }
  }
  run.text = base::with_values(sweep.scenario_text, shown_as, assignments);
  const render::ScenarioChecks checks =
      sweep.level == Level::tracks ? render::ScenarioChecks::values : render::ScenarioChecks::all;
  // The camera's position follows from its lens, which the camera's file may state.
  run.scenario = read(sweep, run.text, shown_as, sweep.field_m ? render::ScenarioChecks::values : checks);
  if (sweep.field_m) {
    const render::Camera& camera = run.scenario.camera;
    const double distance_m = camera.focal_px.x() * *sweep.field_m / camera.width_px;
    run.text = base::with_values(run.text, shown_as, {{"camera.position_m[3]", distance_m}});
    run.scenario = read(sweep, run.text, shown_as, checks);
  }
  return run;
}

namespace {

using Kind = AxisSource::Kind;
using Values = std::vector<base::TomlScalar>;

/// "configuration.force.mu": the path without the choice of a table.
std::string without_picks(const std::string& path) {
  std::string bare;
  int depth = 0;
  for (const char c : path) {
    depth += c == '[' ? 1 : 0;
    if (depth == 0) bare += c;
    depth -= c == ']' ? 1 : 0;
  }
  return bare;
}

/// The line of the sweep's file that sets `key`; 0 if none does.
int line_of(const Axis& axis, const base::TomlScalar& value, const std::string& key) {
  const std::string bare = without_picks(key);
  const auto is_it = [&](const std::string& path) { return without_picks(path) == bare; };
  for (const Choice& choice : axis.choices) {
    if (choice.label != std::get<std::string>(value)) continue;
    const auto found =
        std::find_if(choice.keys.begin(), choice.keys.end(), [&](const auto& of) { return is_it(of.path); });
    if (found != choice.keys.end()) return choice.line;
  }
  return std::any_of(axis.keys.begin(), axis.keys.end(), is_it) ? axis.line : 0;
}

/// `tried`: the axis whose value is not its first.
void try_scenario(const Sweep& sweep, const Values& values, const Axis* tried, const base::TomlScalar* tried_value) {
  try {
    scenario_with(sweep, values);
  } catch (const base::InputError& error) {
    std::vector<base::Issue> issues = error.issues();
    for (base::Issue& issue : issues) {
      if (!issue.file.starts_with(sweep.scenario_file.string() + " with ")) continue;
      int line = 0;
      for (std::size_t i = 0; i < values.size() && line == 0; ++i) {
        line = line_of(sweep.axes[i], values[i], issue.key);
      }
      if (line == 0 && tried != nullptr) {
        line = tried->line;
        for (const Choice& choice : tried->choices) {
          if (choice.label == std::get<std::string>(*tried_value)) line = choice.line;
        }
      }
      if (line == 0) continue;  // an error of the scenario itself
      issue.expected += fmt::format(" (in {})", issue.file);
      issue.file = sweep.file.string();
      issue.line = line;
    }
    throw base::InputError(std::move(issues));
  }
}

/// As try_scenario(); for a range of which whole numbers would be accepted, the message says so.
void try_value(const Sweep& sweep, Values values, std::size_t i) {
  const Axis& axis = sweep.axes[i];
  const base::TomlScalar value = values[i];
  try {
    try_scenario(sweep, values, &axis, &value);
  } catch (const base::InputError& error) {
    const double* const number = std::get_if<double>(&value);
    if (axis.source.kind == Kind::list || number == nullptr || *number == std::round(*number)) throw;
    values[i] = std::round(*number);
    try {
      scenario_with(sweep, values);
    } catch (const base::InputError&) {
      throw error;  // not because it is not a whole number
    }
    std::vector<base::Issue> issues = error.issues();
    issues.front().expected += "; \"whole = true\" in the range rounds its values to whole numbers";
    throw base::InputError(std::move(issues));
  }
}

/// A list, the grid of a range, or some values within it: its ends and one that is not a whole number, to detect keys
/// that take only whole numbers.
Values tried_values(const Sweep& sweep, const AxisSource& source) {
  if (source.kind == Kind::list) return source.values;
  constexpr double kGolden = 0.3819660112501051;  // of the range: hardly ever a whole number
  if (source.drawn()) return {value_at(source, 0.25), value_at(source, kGolden), value_at(source, 0.75)};
  if (sweep.design != Design::factorial) return {source.from, value_at(source, kGolden), source.to};
  return all_values(source);
}

}  // namespace

void try_values(const Sweep& sweep) {
  Values first;
  for (const Axis& axis : sweep.axes) {
    first.push_back(axis.source.kind == Kind::list ? axis.source.values.front() : value_at(axis.source, 0.0));
    if (axis.source.drawn()) first.back() = value_at(axis.source, 0.5);
  }
  const auto of_cameras = [](const Axis& axis) { return axis.keys == std::vector<std::string>{"camera_file"}; };
  const bool cameras = std::any_of(sweep.axes.begin(), sweep.axes.end(), of_cameras);
  if (!cameras) try_scenario(sweep, first, nullptr, nullptr);
  constexpr std::size_t kTried = 200;  // of one axis; a longer one is a grid, for which the ends and some values in
                                       // between suffice
  for (std::size_t i = 0; i < sweep.axes.size(); ++i) {
    const Values values = tried_values(sweep, sweep.axes[i].source);
    const std::size_t step = 1 + values.size() / kTried;
    // A camera that does not suit the scenario's view is a run's outcome, not an error of the sweep.
    Sweep as_tracks;
    const Sweep* tried = &sweep;
    if (of_cameras(sweep.axes[i])) {
      as_tracks = sweep;
      as_tracks.level = Level::tracks;
      tried = &as_tracks;
    }
    for (std::size_t k = 0; k < values.size(); k += k + 1 < values.size() ? std::min(step, values.size() - 1 - k) : 1) {
      Values one_other = first;
      one_other[i] = values[k];
      try_value(*tried, one_other, i);
    }
  }
}

}  // namespace glidelab::validate
