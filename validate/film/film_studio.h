/// Clips drawn in memory and tracked, before a camera that is calibrated from drawn stills.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "base/files/temporary_folder.h"
#include "base/progress.h"
#include "core/pictures/camera/camera_and_planes.h"
#include "core/pictures/camera/camera_model.h"
#include "render/film/clip_set.h"
#include "render/scenario/scenario.h"
#include "validate/film/canvas_pool.h"
#include "validate/tracks/made_tracks.h"

namespace glidelab::validate {

/// A camera with its calibration, for any number of recordings: of scenarios whose stills are those of the first
/// one (the same camera, light, pattern, track and groups; motions, clock, shutter and codec may differ). Stills and
/// experiment.toml lie in a folder of its own under the system's folder for temporary files, which goes with it. One
/// thread at a time.
class FilmStudio {
 public:
  /// Draws the stills with the noise of this seed, and calibrates. The stage of another studio before the same scene
  /// may be given. `progress` is called with every image and, in film(), every few frames, from any thread.
  FilmStudio(const render::Scenario& scenario, std::uint64_t seed, int jobs,
             std::shared_ptr<const render::Stage> stage = nullptr, base::Progress progress = base::no_progress);

  /// The scenario's clips with the noise of this seed, tracked, with the truth of the scenario. A lossy codec's clips
  /// are written and read back. The truth's positions count from the track's reference point, the tracks' from the
  /// pattern.
  /// With `lens`, that camera stands in place of the calibrated one, as if it were known without error; where the plane
  /// lies is still found from the drawn pattern.
  MadeTracks film(const render::Scenario& scenario, std::uint64_t seed, int jobs,
                  const std::optional<core::CameraModel>& lens = std::nullopt);

  /// Nothing before the first recording without a lossy codec.
  const std::shared_ptr<const render::Stage>& stage() const { return stage_; }

 private:
  base::TemporaryFolder folder_;
  base::Progress progress_;
  std::shared_ptr<const render::Stage> stage_;
  std::shared_ptr<CanvasPool> canvases_ = std::make_shared<CanvasPool>();
  core::SeenPattern pattern_;
};

/// The scenario's camera in the analysis' form; nothing for a rational lens, which that form does not have.
std::optional<core::CameraModel> true_camera(const render::Camera& camera);

/// One recording with a calibration of its own.
MadeTracks film_tracks(const render::Scenario& scenario, std::uint64_t seed, int jobs,
                       const base::Progress& progress = base::no_progress);

}  // namespace glidelab::validate
