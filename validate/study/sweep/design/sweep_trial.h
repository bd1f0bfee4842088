/// Tries a sweep's values before its first run.
#pragma once

#include "validate/study/sweep/design/sweep.h"

namespace glidelab::validate {

/// InputError if the scenario refuses a value of an axis, the others at their first ones; with the line of the
/// sweep's file that the key stands on, or the choice. Up to 200 values of an axis are tried, its ends among them.
void try_values(const Sweep& sweep);

}  // namespace glidelab::validate
