/// Contradictions between experiment.toml and the recording, or within experiment.toml: masses, launch, lengths,
/// inclination.
///
/// Each is reported once, with the clips that show it and the keys, one of which is wrong.
#pragma once

#include <optional>
#include <vector>

#include "core/check/check_result.h"
#include "core/experiment/experiment.h"

namespace glidelab::core {

/// Whether a quarter or more of the free motion is opposite to its stated launch, throughout or until a turn: a hand
/// rests or pushes before it releases the glider, free motion turns.
bool moves_against_launch(const std::optional<AgainstLaunch>& against);

/// Whether the marker's light is centred off its outline's centre by more than a twentieth of its diameter.
bool is_lit_from_one_side(const ClipCheck& clip);

/// The level, of the largest code, above which a marker is saturated.
inline constexpr double kSaturatedLevel = 0.985;

/// Whether the marker's size in the image differs by more than 15 % from what its diameter and the scale predict (by
/// a factor of 1.5 if it is no disc or saturated). One that its own smear makes larger does not, nor a smaller one
/// that is lit from one side: the fit finds the lit part.
bool size_disagrees(const ClipCheck& clip);

/// The smear at the top speed, px: measured, or from the stated exposure, or from an exposure as long as the frame
/// time.
double likely_blur_px(const ClipCheck& clip);

std::vector<Finding> statement_findings(const Experiment& experiment, const RecordingCheck& check);

}  // namespace glidelab::core
