/// Clips drawn in memory and tracked, with a camera calibrated from drawn stills.
#pragma once

#include <opencv2/core.hpp>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "base/files/file_io.h"
#include "base/long_work.h"
#include "core/pictures/camera/camera_model.h"
#include "core/pictures/camera/restitution.h"
#include "core/pictures/frames/frame_source.h"
#include "render/film/clip_renderer.h"
#include "render/scenario/scenario.h"
#include "validate/made_tracks/made_tracks.h"

namespace glidelab::validate {

/// A frame's pixels and the region that is drawn; the rest is 0.
struct Canvas {
  cv::Mat image;
  std::vector<cv::Rect> drawn;

  /// Resets all pixels to 0.
  void clear();
};

/// Whether the caller, who holds this pointer, is the only one that refers to the canvas or its pixels.
bool is_free(const std::shared_ptr<Canvas>& canvas);

/// Images in memory on which frames are drawn, reused by later frames and clips: allocating a new one costs as much as
/// the drawing. Shared between clips, also on different threads. All canvases have one size and depth; no others are
/// kept.
class CanvasPool {
 public:
  /// A clear canvas.
  std::shared_ptr<Canvas> take(cv::Size size, int type);

  /// Takes back a canvas that only the caller refers to.
  void give(std::shared_ptr<Canvas> canvas);

 private:
  std::mutex mutex_;
  std::vector<std::shared_ptr<Canvas>> all_;
};

/// The frames of one clip of the set, from the renderer in memory, in place of the analysis' file: the codes are the
/// same. If colour is requested they are grey in all three channels, as from a grey file. Frames are drawn on canvases
/// of the pool. InputError for a lossy codec, whose file contains other codes.
std::unique_ptr<core::FrameSource> rendered_frames(std::shared_ptr<const render::ClipSet> set, std::size_t clip,
                                                   std::uint64_t seed, bool with_color = false,
                                                   std::shared_ptr<CanvasPool> pool = std::make_shared<CanvasPool>());

/// The same for an analysis (core/analysis/analyze.h): a clip's frames by the name of its file in the experiment
/// folder.
core::FrameOpener rendered_opener(std::shared_ptr<const render::ClipSet> set, std::uint64_t seed,
                                  std::shared_ptr<CanvasPool> pool = std::make_shared<CanvasPool>());

/// What gives a filmed experiment its metres.
enum class LengthFrom {
  pattern,  ///< the calibration from drawn stills
  scale     ///< one number of pixels per metre, without error: no still is drawn
};

/// A camera with its calibration, for any number of recordings: of scenarios whose stills are those of the first
/// one (the same camera, light, pattern, track and groups; motions, clock, shutter and codec may differ). Stills stay
/// in memory; experiment.toml and everything that needs a file lie in a separate folder below the system's temporary
/// folder, which is removed with the object. Threads that film at the same time wait for each other.
class FilmStudio {
 public:
  /// Draws the stills with the noise of this seed, and calibrates. The stage of another studio for the same scene may
  /// be given. With a scale nothing is drawn. `progress` is called with every image and, in film(), every few frames,
  /// from any thread.
  FilmStudio(const render::Scenario& scenario, std::uint64_t seed, int jobs,
             std::shared_ptr<const render::Stage> stage = nullptr, base::Progress progress = base::no_progress,
             LengthFrom length = LengthFrom::pattern);

  /// The scenario's clips with the noise of this seed, tracked, with the truth of the scenario. A lossy codec's clips
  /// are written and read back. The truth's positions are relative to the track's reference point, the tracks' to the
  /// pattern. With `lens`, that camera replaces the calibrated one, as if it were known without error; the position of
  /// the plane is still found from the drawn pattern. With a scale the tracks' positions count from the image's corner,
  /// and `lens` is not used. A scenario that differs from that of the stills in its marker has a `stage` of its own.
  MadeTracks film(const render::Scenario& scenario, std::uint64_t seed, int jobs,
                  const std::optional<core::CameraModel>& lens = std::nullopt,
                  const std::shared_ptr<const render::Stage>& stage = nullptr);

  const std::shared_ptr<const render::Stage>& stage() const { return stage_; }

 private:
  base::TemporaryFolder folder_;
  base::Progress progress_;
  std::shared_ptr<const render::Stage> stage_;
  std::shared_ptr<CanvasPool> canvases_ = std::make_shared<CanvasPool>();
  LengthFrom length_;
  core::SeenPattern pattern_;
  std::mutex filming_;
};

/// The scenario's camera in the analysis' form; empty for a rational lens, which that form does not include.
std::optional<core::CameraModel> true_camera(const render::Camera& camera);

/// One recording with its own calibration; the stage of another for the same scene may be given.
MadeTracks film_tracks(const render::Scenario& scenario, std::uint64_t seed, int jobs,
                       const base::Progress& progress = base::no_progress,
                       std::shared_ptr<const render::Stage> stage = nullptr);

}  // namespace glidelab::validate
