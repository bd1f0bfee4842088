/// In words: how a number of a measured camera was found, or why there is none, and the notes on how its images were
/// taken (core/characterize/camera_measurement.h).
#pragma once

#include <string>
#include <vector>

#include "core/characterize/camera_measurement.h"

namespace glidelab::report {

/// "from the dark frames"; empty if there is only one way.
std::string how_words(const core::Measured& measured);

/// "hidden by the quantisation: less than 0.31 e-"; empty if there is a value.
std::string why_words(const core::Measured& measured);

/// A sentence.
std::string note_words(const core::CameraNote& note);
std::vector<std::string> notes_words(const std::vector<core::CameraNote>& notes);

}  // namespace glidelab::report
