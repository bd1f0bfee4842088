#include "validate/study/sweep/design/sweep_scenario.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.h"

namespace glidelab::validate {
namespace {

/// A camera's own values would stand behind those that the scenario writes itself, and not vary.
void check_camera_is_free(const Sweep& sweep) {
  const base::TomlFile file = base::TomlFile::parse(sweep.scenario_text, sweep.scenario_file.string());
  const base::TomlTable root = file.root();
  const auto camera = root.maybe_table("camera");
  std::vector<base::Issue> issues;
  for (const char* key : {"width_px", "height_px", "frame_rate_hz", "focal_px", "exposure_s"}) {
    if (!camera || !camera->has(key)) continue;
    issues.push_back({sweep.scenario_file.string(), camera->line(key), camera->path(key),
                      "a value of the scenario's own",
                      "none: it would replace every camera's own in a sweep over cameras"});
  }
  if (!issues.empty()) throw base::InputError(std::move(issues));
}

render::Scenario read(const Sweep& sweep, const std::string& text, const std::string& shown_as,
                      render::ScenarioChecks checks) {
  try {
    return render::read_scenario(text, sweep.scenario_file, checks);
  } catch (const base::InputError& error) {
    // Lines are those of the text that was put together; nobody has it before his eyes.
    std::vector<base::Issue> issues = error.issues();
    for (base::Issue& issue : issues) {
      if (issue.file != sweep.scenario_file.string()) continue;
      issue.file = shown_as;
      issue.line = 0;
    }
    throw base::InputError(std::move(issues));
  }
}

/// What an axis puts in; of a choice, without the keys that only other choices have.
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
  // Where the camera stands follows from its lens, which the camera's file may say.
  run.scenario = read(sweep, run.text, shown_as, sweep.field_m ? render::ScenarioChecks::values : checks);
  if (sweep.field_m) {
    const render::Camera& camera = run.scenario.camera;
    const double distance_m = camera.focal_px.x() * *sweep.field_m / camera.width_px;
    run.text = base::with_values(run.text, shown_as, {{"camera.position_m[3]", distance_m}});
    run.scenario = read(sweep, run.text, shown_as, checks);
  }
  return run;
}

}  // namespace glidelab::validate
