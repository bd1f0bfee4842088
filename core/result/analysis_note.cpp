#include "core/result/analysis_note.h"

namespace glidelab::core {

Note::Note(const Note&) = default;
Note::Note(Note&&) noexcept = default;
Note& Note::operator=(const Note&) = default;
Note& Note::operator=(Note&&) noexcept = default;
Note::~Note() = default;

}  // namespace glidelab::core
