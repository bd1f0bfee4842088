/// What the measurements of one clip say of it: marker, light, times (the limits stand in docs/reference/check.md).
#pragma once

#include "core/check/finding_words.h"
#include "core/check/recording_check.h"
#include "core/experiment/experiment.h"

namespace glidelab::core {

void judge_clip(const Experiment& experiment, const ClipCheck& clip, FindingBook book);

}  // namespace glidelab::core
