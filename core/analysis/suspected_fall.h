/// Clips that look like a fall though nobody states one.
#pragma once

#include <optional>

#include "core/result/analysis_note.h"
#include "core/result/results.h"

namespace glidelab::core {

/// The longest run of positions taken for those in a hand, if the body speeds up there as it falls: in its first third
/// by 0.5 g to 1.05 g, from rest or nearly so. None if the body slows down by a tenth or more as it goes on: so does a
/// cart after a push, and no fall before it meets the floor.
std::optional<MayBeAFall> suspected_fall(const ClipResult& clip);

}  // namespace glidelab::core
