/// Notes of an analysis, and reasons for missing quantities, by their kind.
#pragma once

#include <variant>
#include <vector>

#include "core/result/analysis_note.h"
#include "core/result/results.h"

namespace glidelab::tests {

/// The first note of this kind; null if there is none. The notes outlive it.
template <class Kind>
const Kind* note_of(const std::vector<core::Note>& notes) {
  for (const core::Note& note : notes) {
    if (const auto* const found = std::get_if<Kind>(&note)) return found;
  }
  return nullptr;
}

/// The reason that the quantity has no estimate, if it is of this kind; null otherwise. The quantity outlives it.
template <class Kind>
const Kind* reason_of(const core::Quantity& quantity) {
  return quantity.why ? std::get_if<Kind>(&quantity.why->reason) : nullptr;
}

}  // namespace glidelab::tests
