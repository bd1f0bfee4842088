#include "diagnose/result/note.h"

namespace glidelab::diagnose {

bool FallsThroughAir::viscous_leaves_less() const {
  constexpr double kClearly = 0.9;
  return gaps && gaps->viscous < kClearly * gaps->named;
}

Note::Note(const Note&) = default;
Note::Note(Note&&) noexcept = default;
Note& Note::operator=(const Note&) = default;
Note& Note::operator=(Note&&) noexcept = default;
Note::~Note() = default;

}  // namespace glidelab::diagnose
