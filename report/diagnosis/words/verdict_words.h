/// The verdict in plain words, for clips and for published lines, and the first elements of the page of either: tiles,
/// and their meaning in words.
#pragma once

#include <string>
#include <string_view>

#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

/// The question answered by a diagnosis page.
inline constexpr std::string_view kDiagnosisQuestion = "What does the simple law leave out?";

/// The verdict for clips or published lines in plain words: a paragraph for a reader who knows the experiment but no
/// statistics.
std::string verdict_words(const diagnose::Diagnosis& diagnosis);

/// Why a gap has no interval over clips; empty if there are enough clips.
std::string too_few_words(const diagnose::GapIntervals& intervals);

/// Three decimals, "> 0.999" and "< 0.001" beyond them.
std::string probability_text(double probability);

/// True if nothing is missing, so that there is only the nominal model and no second one to compare: pages then show
/// "before" and "after" once.
bool one_model(const diagnose::Diagnosis& diagnosis);
inline constexpr const char* kNominalModel = "nominal model";  ///< its name in plots

/// Tiles for no cause, for an unnamed cause, and for the gap, which is called `gap_words`; HTML.
std::string common_tiles(const diagnose::Diagnosis& diagnosis, const std::string& gap_words);

/// "What this means": the summary, with its answer in bold if it is a sequence of causes, and the consequences for the
/// numbers of an analysis. HTML.
std::string diagnosis_meaning(const diagnose::Diagnosis& diagnosis);

/// What to record next, in a box. HTML.
std::string next_step_note(const diagnose::Diagnosis& diagnosis);

/// Each note as a paragraph. HTML.
std::string note_paragraphs(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
