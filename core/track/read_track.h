/// Reads a motion that was tracked elsewhere, from any supported file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/experiment/clip_setup.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// For a Tracker project (is_tracker_project()) read_tracker_project(), for any other file read_track_csv(). `column`
/// is the point mass in the former case and the column in the latter. A table has no Y: `downhill` along Y is an
/// InputError there, and an empty value means that its x is positive downhill.
TrackData read_track(const std::filesystem::path& file, std::optional<Downhill> downhill, const std::string& column);

}  // namespace glidelab::core
