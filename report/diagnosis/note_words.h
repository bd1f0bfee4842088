/// Notes of a diagnosis (diagnose/result/note.h) as sentences.
#pragma once

#include <string>
#include <vector>

#include "diagnose/result/note.h"

namespace glidelab::report {

std::string note_words(const diagnose::Note& note);

std::vector<std::string> notes_words(const std::vector<diagnose::Note>& notes);

}  // namespace glidelab::report
