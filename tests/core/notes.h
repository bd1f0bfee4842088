/// Notes of an analysis by their kind.
#pragma once

#include <algorithm>
#include <string>
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

/// Whether the reader of a file says so.
inline bool says_of_file(const std::vector<core::Note>& notes, const std::string& part) {
  return std::any_of(notes.begin(), notes.end(), [&](const core::Note& note) {
    const auto* const said = std::get_if<core::AboutFile>(&note);
    return said != nullptr && said->text.find(part) != std::string::npos;
  });
}

}  // namespace glidelab::tests
