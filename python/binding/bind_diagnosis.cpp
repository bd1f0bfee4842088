/// diagnose and plan: for folders as in the command, for tracks given as arrays, and for a scenario.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <utility>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/analysis/analyze.h"
#include "core/motion/configurations.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/lines/line_model.h"
#include "diagnose/next/plan.h"
#include "diagnose/verdict/diagnose.h"
#include "python/binding/bindings.h"
#include "python/binding/given_input.h"
#include "python/binding/outcome.h"
#include "python/binding/watched_work.h"
#include "report/diagnosis/diagnosis_json.h"
#include "report/diagnosis/diagnosis_report.h"
#include "report/diagnosis/plan_report.h"
#include "report/text/display_text.h"
#include "validate/made_tracks/made_tracks.h"

namespace glidelab::python {

namespace py = pybind11;

namespace {

namespace fs = std::filesystem;

/// Residuals of each motion before and after, for plots.
py::list residual_arrays(const diagnose::Diagnosis& diagnosis) {
  py::list curves;
  for (const diagnose::ResidualCurve& curve : diagnosis.residuals) {
    py::dict arrays;
    arrays["clip"] = curve.clip;
    arrays["t_s"] = vector_of(curve.t_s);
    arrays["x_m"] = vector_of(curve.x_m);
    arrays["v_m_s"] = vector_of(curve.v_m_s);
    arrays["before_m"] = vector_of(curve.before_m);
    arrays["after_m"] = vector_of(curve.after_m);
    curves.append(std::move(arrays));
  }
  return curves;
}

py::tuple told(diagnose::Diagnosis found, std::string title) {
  const auto diagnosis = std::make_shared<const diagnose::Diagnosis>(std::move(found));
  Outcome outcome;
  outcome.json = report::diagnosis_json(*diagnosis);
  outcome.text = report::diagnosis_text(*diagnosis);
  outcome.write = [diagnosis, title = std::move(title)](const fs::path& folder, const base::Progress&) {
    base::write_file(folder / "diagnosis.json", report::diagnosis_json(*diagnosis));
    report::write_page(folder, "report.html", report::diagnosis_report(title, *diagnosis));
  };
  return py::make_tuple(std::move(outcome), residual_arrays(*diagnosis), diagnosis->twin);
}

py::tuple diagnose_files(const std::vector<std::string>& inputs, const std::vector<std::string>& without, int jobs,
                         const core::TrackFileOptions& given, const py::object& progress_told) {
  const std::vector<fs::path> folders(inputs.begin(), inputs.end());
  const core::TrackFileOptions bare = core::masses_of_files(given, folders);
  if (folders.empty()) throw base::InputError(base::Issue{"", 0, "", "no folder", "one or more experiment folders"});
  std::string title;
  diagnose::Diagnosis diagnosis = WatchedWork(progress_told).run([&](const base::Progress& progress) {
    diagnose::DiagnoseOptions how{.without = without, .jobs = jobs, .twin = false, .bare = bare};
    title = report::title_of(diagnose::read_recording(folders.front(), how.bare).name, folders.size());
    return diagnose::diagnose(folders, how, progress);
  });
  return told(std::move(diagnosis), title);
}

py::tuple diagnose_arrays(std::vector<GivenTrack> given, const GivenGravity& given_gravity, const std::string& name,
                          const std::vector<std::string>& without, const std::string& recorded_by, int jobs,
                          const py::object& progress_told) {
  const core::Gravity gravity = read_gravity(given_gravity);
  diagnose::Diagnosis diagnosis = WatchedWork(progress_told).run([&](const base::Progress& progress) {
    GivenTracks tracks = read_tracks(std::move(given));
    for (core::ClipSetup& setup : tracks.setups) setup.recorded_by = core::recorder_named(recorded_by);
    // As in diagnose::diagnose() for tracks from files: times as given, no camera.
    core::AnalysisResults results = core::analyze_tracks(tracks.setups, tracks.tracks, gravity,
                                                         {.lost_frames = core::LostFrameTimes::kept}, jobs, progress);
    for (core::ClipResult& clip : results.clips) clip.experiment = name;
    const std::vector<std::optional<core::CameraSettings>> no_cameras(tracks.setups.size());
    return diagnose::diagnose_results(results, tracks.setups, {.without = without, .jobs = jobs, .twin = false},
                                      progress, no_cameras);
  });
  return told(std::move(diagnosis), name);
}

Outcome told(diagnose::Plan found, const std::string& title) {
  const auto plan = std::make_shared<const diagnose::Plan>(std::move(found));
  return {report::plan_json(*plan), report::plan_text(*plan), [plan, title](const fs::path& folder, const auto&) {
            base::write_file(folder / "plan.json", report::plan_json(*plan));
            report::write_page(folder, "plan.html", report::plan_page("Plan: " + title, *plan));
          }};
}

Outcome plan_scenario(const GivenScenario& given, double noise_m, std::optional<std::uint64_t> seed, int jobs,
                      const py::object& progress_told) {
  diagnose::Plan plan = WatchedWork(progress_told).run([&](const base::Progress& progress) {
    const render::Scenario scenario = read_scenario(given);
    const std::uint64_t drawn = seed.value_or(scenario.seed);
    progress("simulating", 0.0);
    const validate::MadeTracks made = validate::with_noise(validate::make_tracks(scenario, drawn), noise_m, drawn);
    progress("phase diagram", 0.0);
    return diagnose::plan_of(validate::analyze_tracks(made, std::optional<double>(), jobs), made.setups);
  });
  return told(std::move(plan), fs::path(given.first).stem().string());
}

Outcome plan_arrays(std::vector<GivenTrack> given, const GivenGravity& given_gravity, const std::string& name, int jobs,
                    const py::object& progress_told) {
  const core::Gravity gravity = read_gravity(given_gravity);
  diagnose::Plan plan = WatchedWork(progress_told).run([&](const base::Progress& progress) {
    const GivenTracks tracks = read_tracks(std::move(given));
    return diagnose::plan_of(core::analyze_tracks(tracks.setups, tracks.tracks, gravity, {}, jobs, progress),
                             tracks.setups);
  });
  return told(std::move(plan), name);
}

}  // namespace

void bind_diagnosis(py::module_& module) {
  module.def("diagnose_files", &diagnose_files);
  module.def("diagnose_arrays", &diagnose_arrays);
  module.def("plan_scenario", &plan_scenario);
  module.def("plan_arrays", &plan_arrays);
  module.def("effect_words", &diagnose::effect_words);
}

}  // namespace glidelab::python
