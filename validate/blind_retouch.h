/// What is done to a rendered experiment folder before it is a filmed blind case: lines of experiment.toml that say
/// something else, frames that are lost, pictures that are pulled along the track, clips filed anew without loss.
#pragma once

#include <filesystem>

#include "validate/blind_scene.h"

namespace glidelab::validate {

/// Changes the folder in place. A line of experiment.toml that is to be changed and is not there: std::logic_error.
void retouch_folder(const BlindScene& scene, const std::filesystem::path& folder);

}  // namespace glidelab::validate
