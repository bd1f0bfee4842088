#include "core/experiment/bare_track.h"

#include <numbers>

namespace glidelab::core {

bool is_bare_track(const std::filesystem::path& path) {
  std::error_code ignored;  // what cannot be looked at is none
  return std::filesystem::is_regular_file(path, ignored) && path.filename() != "experiment.toml";
}

Experiment read_input(const std::filesystem::path& path, const BareTrackOptions& options) {
  if (!is_bare_track(path)) return read_experiment(path, options.outside);
  Experiment experiment;
  experiment.folder = path.parent_path();
  experiment.file = path;
  experiment.name = path.stem().string();
  ClipSetup clip;
  clip.name = experiment.name;
  clip.track = path;
  clip.column = options.column;
  clip.mass_kg = options.mass_kg.value_or(1.0);
  clip.incline_rad = options.incline_deg.value_or(0.0) * std::numbers::pi / 180.0;
  clip.launched = Launched::unknown;
  clip.group = "all";
  experiment.clips.push_back(clip);
  return experiment;
}

}  // namespace glidelab::core
