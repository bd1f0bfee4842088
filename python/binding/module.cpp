/// glidelab._glidelab: the functions called by the package's Python sources.
#include <pybind11/pybind11.h>

#include "python/binding/bindings.h"
#include "python/binding/given_tracks.h"
#include "python/binding/outcome.h"
#include "python/binding/python_errors.h"
#include "version_of_build.h"

PYBIND11_MODULE(_glidelab, module) {
  using namespace glidelab::python;
  translate_errors();
  module.attr("version") = GLIDELAB_VERSION;
  module.attr("pybind11_version") = pybind11::make_tuple(PYBIND11_VERSION_MAJOR, PYBIND11_VERSION_MINOR);
  bind_outcome(module);
  bind_given_track(module);
  bind_analysis(module);
  bind_simulation(module);
  bind_diagnosis(module);
  bind_recording(module);
  bind_smoothing(module);
  bind_studies(module);
  bind_gate(module);
  bind_blind(module);
  bind_film(module);
  bind_camera(module);
  bind_tracks(module);
}
