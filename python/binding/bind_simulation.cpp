/// simulate: the true motions of a scenario, which is a file or the text of one.
#include <fmt/format.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <utility>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "python/binding/bindings.h"
#include "python/binding/given_input.h"
#include "python/binding/outcome.h"
#include "python/binding/watched_work.h"
#include "render/scenario/clip_motion.h"
#include "report/simulation/simulation_report.h"

namespace glidelab::python {

namespace py = pybind11;

namespace {

constexpr double kMostRate_hz = 1e6;  // the limit of the command's --rate

std::vector<report::SimulatedClip> simulated(const render::Scenario& scenario, std::optional<double> rate_hz,
                                             const base::Progress& progress) {
  render::Recording recording = scenario.recording;
  if (rate_hz) recording.frame_rate_hz = *rate_hz;
  render::check_states(scenario.motion, recording, "", "rate_hz");
  std::vector<report::SimulatedClip> clips;
  double done = 0.0;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      progress("simulating", done / static_cast<double>(scenario.motion.configurations.size()));
      clips.push_back({motion.name, configuration.name, fmt::format("trajectory-{}.csv", motion.name),
                       render::recorded_motion(configuration.body, motion, recording)});
    }
    done += 1.0;
  }
  return clips;
}

py::dict state_arrays(const sim::Trajectory& trajectory) {
  const auto column = [&](double sim::State::*member) {
    std::vector<double> values;
    values.reserve(trajectory.states.size());
    for (const sim::State& state : trajectory.states) values.push_back(state.*member);
    return vector_of(values);
  };
  py::dict arrays;
  arrays["t_s"] = column(&sim::State::t_s);
  arrays["x_m"] = column(&sim::State::x_m);
  arrays["v_m_s"] = column(&sim::State::v_m_s);
  arrays["a_m_s2"] = column(&sim::State::a_m_s2);
  py::list modes;
  for (const sim::State& state : trajectory.states) modes.append(std::string(sim::name_of(state.mode)));
  arrays["mode"] = std::move(modes);
  return arrays;
}

py::tuple simulate(const GivenScenario& given, std::optional<double> rate_hz, const py::object& told) {
  if (rate_hz && !(std::isfinite(*rate_hz) && *rate_hz > 0.0 && *rate_hz <= kMostRate_hz)) {
    throw base::InputError(base::Issue{"", 0, "rate_hz", fmt::format("{}", *rate_hz),
                                       fmt::format("a number of hertz above 0, up to {:.0f}", kMostRate_hz)});
  }
  const auto clips = WatchedWork(told).run([&](const base::Progress& progress) {
    return std::make_shared<const std::vector<report::SimulatedClip>>(
        simulated(read_scenario(given), rate_hz, progress));
  });
  Outcome outcome;
  outcome.json = report::simulation_json(*clips);
  outcome.text = report::simulation_text(*clips);
  outcome.write = [clips](const std::filesystem::path& folder, const base::Progress&) {
    for (const report::SimulatedClip& clip : *clips) {
      base::write_file(folder / clip.file, report::trajectory_csv(clip.trajectory));
    }
  };
  py::list states;
  for (const report::SimulatedClip& clip : *clips) states.append(state_arrays(clip.trajectory));
  return py::make_tuple(std::move(outcome), std::move(states));
}

}  // namespace

void bind_simulation(py::module_& module) {
  module.def("simulate", &simulate);
}

}  // namespace glidelab::python
