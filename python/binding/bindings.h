/// The functions of the module, one file bind_<topic>.cpp for each topic; glidelab/*.py turns their output into
/// results.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "fit/estimators.h"

namespace glidelab::python {

/// InputError if there is none of that name.
const fit::Estimator& estimator_named(const std::string& name);

void bind_analysis(pybind11::module_& module);
void bind_simulation(pybind11::module_& module);
void bind_diagnosis(pybind11::module_& module);
void bind_recording(pybind11::module_& module);
void bind_smoothing(pybind11::module_& module);
void bind_studies(pybind11::module_& module);
void bind_gate(pybind11::module_& module);
void bind_blind(pybind11::module_& module);
void bind_film(pybind11::module_& module);
void bind_camera(pybind11::module_& module);
void bind_tracks(pybind11::module_& module);

}  // namespace glidelab::python
