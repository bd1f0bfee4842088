#include "core/result/analysis_note.h"

namespace glidelab::core {

Note::Note(const Note&) = default;
Note::Note(Note&&) noexcept = default;
Note& Note::operator=(const Note&) = default;
Note& Note::operator=(Note&&) noexcept = default;
Note::~Note() = default;

bool is_of_reading(const Note& note) {
  if (const auto* const no_run = std::get_if<NoRun>(&note)) return no_run->at_rest;
  return std::holds_alternative<PositionsUnseen>(note) || std::holds_alternative<PositionsAstray>(note) ||
         std::holds_alternative<ColumnsGuessed>(note) || std::holds_alternative<PathBends>(note) ||
         std::holds_alternative<OtherAxisUnused>(note) || std::holds_alternative<RepeatsLeftOut>(note) ||
         std::holds_alternative<InterlacedFilm>(note) || std::holds_alternative<TimesRepeated>(note) ||
         std::holds_alternative<ValuesHeld>(note);
}

}  // namespace glidelab::core
