/// Sentences about rows of a table that an analysis leaves out.
#pragma once

#include <string>

#include "core/result/analysis_note.h"

namespace glidelab::report {

std::string row_words(const core::RowsIncomplete& of);
std::string row_words(const core::TimesRepeated& of);
std::string row_words(const core::ValuesHeld& of);
std::string row_words(const core::UnlikelyLeftOut& of);

}  // namespace glidelab::report
