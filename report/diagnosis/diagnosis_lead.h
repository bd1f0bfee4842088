/// What stands first on the page of a diagnosis, of clips and of lines alike: tiles, and what they mean in words.
#pragma once

#include <string>

#include "diagnose/result/diagnosis.h"

namespace glidelab::report {

/// Three decimals, "> 0.999" and "< 0.001" beyond them.
std::string probability_text(double probability);

/// True where nothing is missing, so that there is the nominal model alone and no second one to lay beside it: what
/// pages show of before and after is then shown once.
bool one_model(const diagnose::Diagnosis& diagnosis);
inline constexpr const char* kNominalModel = "nominal model";  ///< as plots then call it

/// Tiles for nothing, for something without a name, and for the gap, which is called `gap_words`; HTML.
std::string common_tiles(const diagnose::Diagnosis& diagnosis, const std::string& gap_words);

/// "What this means": the summary, what follows for the numbers of an analysis, what to record next, limits. HTML.
std::string diagnosis_meaning(const diagnose::Diagnosis& diagnosis);

}  // namespace glidelab::report
