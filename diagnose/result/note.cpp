#include "diagnose/result/note.h"

namespace glidelab::diagnose {

Note::Note(const Note&) = default;
Note::Note(Note&&) noexcept = default;
Note& Note::operator=(const Note&) = default;
Note& Note::operator=(Note&&) noexcept = default;
Note::~Note() = default;

}  // namespace glidelab::diagnose
