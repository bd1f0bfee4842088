/// glidelab._glidelab: the functions called by the package's Python sources, and the rooms' errors as Python's
/// exceptions (glidelab/_errors.py), each a subclass of the nearest one of Python's own:
///
///     InputError        ValueError        file, line, key, found, expected; all issues in `issues`
///     NumericalError    ArithmeticError
///     EnvironmentError  OSError           as SystemFailure: Python's EnvironmentError is OSError itself
///     NotMet            RuntimeError
///     Interrupted       KeyboardInterrupt
#include <pybind11/pybind11.h>

#include <boost/math/policies/error_handling.hpp>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "base/errors.h"
#include "python/binding/bindings.h"
#include "python/binding/given_input.h"
#include "python/binding/outcome.h"
#include "version_of_build.h"

namespace glidelab::python {
namespace {

template <typename... Arguments>
void raise(const char* name, const Arguments&... arguments) {
  const pybind11::object type = pybind11::module_::import("glidelab._errors").attr(name);
  PyErr_SetObject(type.ptr(), type(arguments...).ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const base::InputError& error) {
    pybind11::list issues;
    for (const base::Issue& issue : error.issues()) {
      issues.append(pybind11::make_tuple(issue.file, issue.line, issue.key, issue.found, issue.expected));
    }
    raise("InputError", error.what(), issues);
  } catch (const base::NumericalError& error) {
    raise("NumericalError", error.what());
  } catch (const base::EnvironmentError& error) {
    raise("SystemFailure", error.what());
  } catch (const base::NotMet& error) {
    raise("NotMet", error.what());
  } catch (const base::Interrupted&) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
  } catch (const std::filesystem::filesystem_error& error) {
    raise("SystemFailure", error.what());
  } catch (const boost::math::evaluation_error& error) {
    raise("NumericalError", std::string("a computation broke down: ") + error.what());
  } catch (const std::domain_error& error) {  // of boost as well
    raise("NumericalError", std::string("a computation broke down: ") + error.what());
  }
}

}  // namespace
}  // namespace glidelab::python

PYBIND11_MODULE(_glidelab, module) {
  using namespace glidelab::python;
  pybind11::register_local_exception_translator(translate);
  module.attr("version") = GLIDELAB_VERSION;
  module.attr("pybind11_version") = pybind11::make_tuple(PYBIND11_VERSION_MAJOR, PYBIND11_VERSION_MINOR);
  bind_outcome(module);
  bind_given_input(module);
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
