/// The notes on how a camera's images were taken (core/characterize/camera_note.h) as sentences.
#pragma once

#include <string>
#include <vector>

#include "core/characterize/camera_note.h"

namespace glidelab::report {

std::string note_words(const core::CameraNote& note);

std::vector<std::string> notes_words(const std::vector<core::CameraNote>& notes);

}  // namespace glidelab::report
