/// The verdict in plain words, of clips and of published lines, and what stands first on the page of either: tiles, and
/// what they mean in words.
#pragma once

#include <string>
#include <string_view>

#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

/// What a page of a diagnosis answers.
inline constexpr std::string_view kDiagnosisQuestion = "What does the simple law leave out?";

/// What a table of lines says, in plain words: a paragraph for somebody who knows the experiment and no statistics.
/// `diagnosis.lines` is there.
std::string line_words(const diagnose::Diagnosis& diagnosis);

/// "a separate µ for each mass", of each form; empty where an explanation has none.
std::string forms_words(const diagnose::LineCandidate& candidate);

/// Why an explanation was not weighed: "force would have to be -3.1 mN, and it cannot be below zero".
std::string impossible_words(const diagnose::ImpossibleSize& size);

/// The verdict of clips or of published lines in plain words: a paragraph for somebody who knows the experiment and no
/// statistics.
std::string verdict_words(const diagnose::Diagnosis& diagnosis);

/// Why a gap has no interval over clips; empty where clips are not too few.
std::string too_few_words(const diagnose::GapIntervals& intervals);

/// Three decimals, "> 0.999" and "< 0.001" beyond them.
std::string probability_text(double probability);

/// True where nothing is missing, so that there is the nominal model alone and no second one to lay beside it: what
/// pages show of before and after is then shown once.
bool one_model(const diagnose::Diagnosis& diagnosis);
inline constexpr const char* kNominalModel = "nominal model";  ///< as plots then call it

/// Tiles for nothing, for an unnamed cause, and for the gap, which is called `gap_words`; HTML.
std::string common_tiles(const diagnose::Diagnosis& diagnosis, const std::string& gap_words);

/// "What this means": the summary, its answer in bold where it is a sequence of causes, and what follows for the
/// numbers of an analysis. HTML.
std::string diagnosis_meaning(const diagnose::Diagnosis& diagnosis);

/// What to record next, in a box. HTML.
std::string next_step_note(const diagnose::Diagnosis& diagnosis);

/// Each note as a paragraph. HTML.
std::string note_paragraphs(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
