/// gate: errors of replicated tracks, and their comparison with a baseline.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "python/binding/bindings.h"
#include "python/binding/given_input.h"
#include "python/binding/watched_work.h"
#include "report/validation/gate_text.h"
#include "validate/study/baseline/gate.h"

namespace glidelab::python {

namespace py = pybind11;

namespace {

/// The file of --write-baseline, and what the gate found as JSON and as text.
py::tuple run_gate(const GivenScenario& given, const std::string& baseline, std::optional<double> noise_m,
                   std::uint64_t runs, const std::optional<GivenEstimator>& judged, std::optional<std::uint64_t> seed,
                   int jobs, const py::object& told) {
  WatchedWork watched(told);
  const validate::Gate gate = watched.run([&](const base::Progress& progress) {
    const std::string text = text_of(given);
    const render::Scenario scenario = read_scenario(given, render::ScenarioChecks::values);
    validate::GateOptions options;
    options.baseline = baseline;
    options.noise_m = noise_m;
    options.seed = seed;
    options.runs = runs;
    options.jobs = jobs;
    options.outside = outside_of(judged, watched);
    return validate::compared(validate::run_gate(scenario, text, given.first, options, progress));
  });
  return py::make_tuple(validate::baseline_json(gate.now), report::gate_json(gate), report::gate_text(gate));
}

}  // namespace

void bind_gate(py::module_& module) {
  module.def("gate", &run_gate);
}

}  // namespace glidelab::python
