/// A motion that was tracked elsewhere, from whatever file holds it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/experiment/clip_setup.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// Of a Tracker project (is_tracker_project()) read_tracker_project(), of any other file read_track_csv(). `column` is
/// the point mass of the one and the column of the other. A table has no Y: `downhill` along Y is an InputError there,
/// and nothing means that its x is positive downhill.
TrackData read_track(const std::filesystem::path& file, std::optional<Downhill> downhill, const std::string& column);

}  // namespace glidelab::core
