/// The commonest mistake in positions: x that rises uphill.
#pragma once

#include "core/result/analysis_note.h"

namespace glidelab::core {

/// Whether a gross contradiction would be none if the stated inclination had the other sign.
bool seems_uphill(const InclineContradiction& contradiction);

}  // namespace glidelab::core
