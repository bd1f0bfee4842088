/// A scenario rendered to an experiment folder, and its truth to the folder next to it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "base/long_work.h"
#include "render/film/clip_renderer.h"
#include "render/scenario/scenario.h"

namespace glidelab::render {

struct RenderOptions {
  std::uint64_t seed = 1;
  int jobs = 1;        ///< clips rendered at the same time; every pixel is the same for any number
  bool ideal = false;  ///< also write ideal frames to the truth folder (truth_files.h)
  bool clips = true;   ///< false: empty files instead, for callers that draw them in memory, and no trajectories
  bool stills = true;  ///< false: existing ones from an earlier run stay
};

struct RenderSummary {
  std::size_t clips = 0;
  std::size_t frames = 0;
};

/// Writes `experiment_dir` (experiment.toml, clips/, calibration/, plumb.png) and `truth_dir` (truth.json,
/// `trajectory-<clip>.csv`, `marker-<clip>.csv`), two folders that exist and are empty (except for stills, if these are
/// not requested). EnvironmentError if a file cannot be written. The stage of another rendering of the same scene may
/// be given; otherwise it is made.
RenderSummary render_experiment(const Scenario& scenario, const std::filesystem::path& experiment_dir,
                                const std::filesystem::path& truth_dir, const RenderOptions& options,
                                const base::Progress& progress = base::no_progress,
                                std::shared_ptr<const Stage> stage = nullptr);

}  // namespace glidelab::render
