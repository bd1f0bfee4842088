/// check: checks a recording before it is analysed. FileOptions: what a track file does not state.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <utility>

#include "base/files/file_io.h"
#include "core/check/check_recording.h"
#include "core/track/bare_track.h"
#include "python/binding/bindings.h"
#include "python/binding/outcome.h"
#include "python/binding/watched_work.h"
#include "report/check/check_report.h"

namespace glidelab::python {

namespace py = pybind11;

namespace {

struct Checked {
  core::Experiment experiment;
  core::RecordingCheck found;
};

core::TrackFileOptions file_options(std::string column, std::optional<double> mass_kg,
                                    std::optional<double> incline_deg, std::optional<double> incline_sd_deg,
                                    std::optional<double> gravity_m_s2, std::optional<double> gravity_sd_m_s2,
                                    std::string runs, std::vector<double> masses_kg, bool allow_outside,
                                    std::optional<double> most_megapixels, const std::string& recorded_by,
                                    std::optional<double> frame_rate_hz, std::optional<double> px_per_m) {
  core::TrackFileOptions options;
  options.column = std::move(column);
  options.mass_kg = mass_kg;
  options.incline_deg = incline_deg;
  options.incline_sd_deg = incline_sd_deg;
  options.gravity_m_s2 = gravity_m_s2;
  options.gravity_sd_m_s2 = gravity_sd_m_s2;
  options.permitted.outside = allow_outside ? core::OutsideFiles::allowed : core::OutsideFiles::refused;
  if (most_megapixels) options.permitted.most_pixels = static_cast<std::size_t>(std::llround(1e6 * *most_megapixels));
  options.recorded_by = core::recorder_named(recorded_by);
  options.runs = std::move(runs);
  options.masses_kg = std::move(masses_kg);
  options.frame_rate_hz = frame_rate_hz;
  options.px_per_m = px_per_m;
  return options;
}

Outcome check(const std::string& input, const core::TrackFileOptions& bare, int jobs, const py::object& told) {
  const auto checked = WatchedWork(told).run([&](const base::Progress& progress) {
    Checked made{core::read_tracks(input, bare), {}};
    made.found = core::check_recording(made.experiment, jobs, progress);
    return std::make_shared<const Checked>(std::move(made));
  });
  return {report::check_json(checked->found), report::check_text(checked->found),
          [checked](const std::filesystem::path& out, const base::Progress&) {
            base::write_file(out / "check.json", report::check_json(checked->found));
            report::write_page(
                out, "report.html",
                report::check_report(checked->found, core::previews_of_check(checked->experiment, checked->found)));
          }};
}

}  // namespace

void bind_recording(py::module_& module) {
  py::class_<core::TrackFileOptions>(module, "FileOptions").def(py::init(&file_options));
  module.def("check", &check);
}

}  // namespace glidelab::python
