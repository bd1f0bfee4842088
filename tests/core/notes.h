/// Notes of an analysis by their kind.
#pragma once

#include <variant>
#include <vector>

#include "core/result/analysis_note.h"

namespace glidelab::tests {

/// The first note of this kind; null if there is none. The notes outlive it.
template <class Kind>
const Kind* note_of(const std::vector<core::Note>& notes) {
  for (const core::Note& note : notes) {
    if (const auto* const found = std::get_if<Kind>(&note)) return found;
  }
  return nullptr;
}

}  // namespace glidelab::tests
