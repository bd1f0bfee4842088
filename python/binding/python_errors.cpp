#include "python/binding/python_errors.h"

#include <pybind11/pybind11.h>

#include <boost/math/policies/error_handling.hpp>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "base/errors.h"

namespace glidelab::python {
namespace {

namespace py = pybind11;

template <typename... Arguments>
void raise(const char* name, const Arguments&... arguments) {
  const py::object type = py::module_::import("glidelab._errors").attr(name);
  PyErr_SetObject(type.ptr(), type(arguments...).ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const base::InputError& error) {
    py::list issues;
    for (const base::Issue& issue : error.issues()) {
      issues.append(py::make_tuple(issue.file, issue.line, issue.key, issue.found, issue.expected));
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

void translate_errors() {
  py::register_local_exception_translator(translate);
}

}  // namespace glidelab::python
