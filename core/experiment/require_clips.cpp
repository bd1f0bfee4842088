#include "core/experiment/require_clips.h"

#include "base/errors.h"

namespace glidelab::core {

void require_clips(const Experiment& experiment) {
  if (!experiment.clips.empty()) return;
  if (experiment.lines) {
    throw base::InputError(base::Issue{experiment.file.string(), 0, "lines", "a table of lines",
                                       "clips or tracks here; glidelab diagnose is what weighs such a table"});
  }
  throw base::InputError(base::Issue{experiment.file.string(), 0, "clip", "none", "one or more clips or tracks"});
}

}  // namespace glidelab::core
