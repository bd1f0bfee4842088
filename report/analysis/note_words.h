/// The notes of an analysis (core/result/analysis_note.h) as sentences.
#pragma once

#include <string>
#include <vector>

#include "core/result/analysis_note.h"

namespace glidelab::report {

std::string note_words(const core::Note& note);

std::vector<std::string> notes_words(const std::vector<core::Note>& notes);

/// "the acceleration makes the inclination 0.42 ± 0.13°, incline_deg says 4.3 ± 0.3°"
std::string contradiction_words(const core::InclineContradiction& contradiction);

}  // namespace glidelab::report
