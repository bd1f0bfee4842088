/// Where experiment.toml contradicts the recording, or itself: masses, the launch, lengths, the inclination.
///
/// Each contradiction is told once, with the clips that show it, and with the keys of which one is wrong.
#pragma once

#include <vector>

#include "core/check/recording_check.h"
#include "core/experiment/experiment.h"

namespace glidelab::core {

/// Whether the marker's size in the picture differs from what its diameter and the scale make it by more than 15 %.
bool size_disagrees(const ClipCheck& clip);

/// The highest speed's smear, px: measured, or by the stated exposure, or by an exposure as long as a frame.
double likely_blur_px(const ClipCheck& clip);

std::vector<Finding> statement_findings(const Experiment& experiment, const RecordingCheck& check);

}  // namespace glidelab::core
