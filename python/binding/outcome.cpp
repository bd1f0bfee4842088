#include "python/binding/outcome.h"

#include <pybind11/stl.h>

#include "base/files/file_io.h"
#include "python/binding/watched_work.h"
#include "report/html/gnuplot.h"

namespace glidelab::python {

namespace py = pybind11;

void bind_outcome(py::module_& module) {
  py::class_<Outcome>(module, "Outcome")
      .def_readonly("json", &Outcome::json)
      .def_readonly("text", &Outcome::text)
      .def("write", [](const Outcome& outcome, const std::string& folder, const py::object& told) {
        WatchedWork(told).run([&](const base::Progress& progress) {
          report::check_gnuplot();
          base::StagedOutput staged(std::filesystem::absolute(folder).lexically_normal());
          outcome.write(staged.dir(), progress);
          staged.publish_files();
        });
      });
}

}  // namespace glidelab::python
