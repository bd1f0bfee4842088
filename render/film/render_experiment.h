/// A scenario rendered to an experiment folder, with the poses in which the chessboard is held before the camera, and
/// its truth to the folder beside it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "base/long_work.h"
#include "render/scenario/scenario.h"
#include "render/scenario/scene.h"

namespace glidelab::render {

/// The boards of the calibration views: poses that fill different parts of the image, tilted up to 35 degrees, jittered
/// by `seed`, each wholly visible with its white border. NumericalError where no such pose is found.
std::vector<Chessboard> calibration_boards(const Scenario& scenario, std::uint64_t seed);

struct RenderOptions {
  std::uint64_t seed = 1;
  int jobs = 1;        ///< clips rendered at the same time; every pixel is the same for any number
  bool ideal = false;  ///< write ideal frames to the truth folder besides (truth_files.h)
  bool clips = true;   ///< false: empty files in their place, for who draws them in memory, and no trajectories
  bool stills = true;  ///< false: those that lie there from another time stay
};

struct RenderSummary {
  std::size_t clips = 0;
  std::size_t frames = 0;
};

/// Writes `experiment_dir` (experiment.toml, clips/, calibration/, plumb.png) and `truth_dir` (truth.json,
/// `trajectory-<clip>.csv`, `marker-<clip>.csv`), two folders that exist and are empty (but for stills, where these
/// are not asked for). EnvironmentError where a file cannot be written.
RenderSummary render_experiment(const Scenario& scenario, const std::filesystem::path& experiment_dir,
                                const std::filesystem::path& truth_dir, const RenderOptions& options,
                                const base::Progress& progress = base::no_progress);

}  // namespace glidelab::render
