/// The notes of an analysis (core/result/analysis_note.h) as sentences.
#pragma once

#include <string>
#include <vector>
#include "core/result/analysis_note.h"
#include "core/result/results.h"

namespace glidelab::report {

std::string note_words(const core::Note& note);

std::vector<std::string> notes_words(const std::vector<core::Note>& notes);

/// "distortion: k1, k2 (χ² of each term tested, and the threshold to keep it: k3: 1.2 of 9; …)", "fisheye: k1, k2"
std::string lens_words(const core::LensTerms& lens);

/// How a bandwidth, or the strength of a smoother, was chosen (core/result/strength.h), in one line.
/// Empty if the choice is not stated.
std::string strength_words(const core::StrengthChoice& choice);

}  // namespace glidelab::report
