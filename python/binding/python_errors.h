/// The rooms' errors as Python's exceptions (glidelab/_errors.py), each a subclass of the nearest one of Python's own:
///
///     InputError        ValueError        file, line, key, found, expected; all issues in `issues`
///     NumericalError    ArithmeticError
///     EnvironmentError  OSError           as SystemFailure: Python's EnvironmentError is OSError itself
///     NotMet            RuntimeError
///     Interrupted       KeyboardInterrupt
#pragma once

namespace glidelab::python {

/// For all functions of this module.
void translate_errors();

}  // namespace glidelab::python
