/// check: a look at a recording before any analysis.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>

#include "base/files/file_io.h"
#include "core/check/check_recording.h"
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

Outcome check(const std::string& folder, bool allow_outside, int jobs, const py::object& told) {
  const auto checked = WatchedWork(told).run([&](const base::Progress& progress) {
    Checked made{core::read_experiment(
                     folder, {.outside = allow_outside ? core::OutsideFiles::allowed : core::OutsideFiles::refused}),
                 {}};
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
  module.def("check", &check);
}

}  // namespace glidelab::python
