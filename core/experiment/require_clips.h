/// An experiment that can be analysed has clips or tracks; a table of lines has none.
#pragma once

#include "core/experiment/experiment.h"

namespace glidelab::core {

/// InputError, with what to do with a table of lines, where there is no clip.
void require_clips(const Experiment& experiment);

}  // namespace glidelab::core
