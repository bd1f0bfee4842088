#include "core/track/read_track.h"

#include <fmt/format.h>

#include "base/errors.h"
#include "core/track/tracker_project.h"

namespace glidelab::core {

TrackData read_track(const std::filesystem::path& file, std::optional<Downhill> downhill, const std::string& column) {
  if (is_tracker_project(file)) return read_tracker_project(file, downhill, column);
  if (downhill && is_along_y(*downhill)) {
    throw base::InputError(base::Issue{file.string(), 0, "downhill",
                                       fmt::format("\"{}\" for a table of positions", name_of(*downhill)),
                                       "\"+X\" or \"-X\": x is the column that `column` names, whatever it is called"});
  }
  return read_track_csv(file, downhill ? std::optional(sign_of(*downhill)) : std::nullopt, column);
}

}  // namespace glidelab::core
