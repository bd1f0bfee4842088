#include "validate/film/film_studio.h"

#include <filesystem>

#include "core/analysis/clip_to_track.h"
#include "core/experiment/experiment.h"
#include "core/pictures/camera/calibrate_fisheye.h"
#include "render/film/clip_set.h"
#include "render/film/render_experiment.h"
#include "validate/film/rendered_frames.h"

namespace glidelab::validate {
namespace {

namespace fs = std::filesystem;

core::Experiment rendered(const render::Scenario& scenario, const fs::path& folder,
                          const render::RenderOptions& options, const base::Progress& progress) {
  const fs::path pictures = folder / "e", truth = folder / "t";
  fs::create_directories(pictures);
  fs::remove_all(pictures / "clips");
  fs::remove_all(truth);
  fs::create_directory(truth);
  render::render_experiment(scenario, pictures, truth, options, progress);
  core::Experiment experiment = core::read_experiment(pictures, core::OutsideFiles::refused);
  experiment.plumb.reset();  // tracks have no use for it
  for (core::GroupSetup& group : experiment.groups) group.plumb.reset();
  return experiment;
}

}  // namespace

FilmStudio::FilmStudio(const render::Scenario& scenario, std::uint64_t seed, int jobs,
                       std::shared_ptr<const render::Stage> stage, base::Progress progress)
    : folder_("run"), progress_(std::move(progress)), stage_(std::move(stage)) {
  const core::Experiment experiment =
      rendered(scenario, folder_.path(), {.seed = seed, .jobs = jobs, .ideal = false, .clips = false}, progress_);
  const core::CalibrationSetup& setup = *experiment.calibration;
  pattern_.boards = core::find_board_views(core::pattern_files(experiment),
                                           cv::Size(setup.inner_corners.columns, setup.inner_corners.rows), jobs);
  pattern_.calibration = core::calibrate_any_lens(pattern_.boards, setup.square_m);
}

std::optional<core::CameraModel> true_camera(const render::Camera& camera) {
  const render::Lens& lens = camera.lens;
  if (lens.model == render::LensModel::rational) return std::nullopt;
  const bool fisheye = lens.model == render::LensModel::fisheye;
  core::CameraModel model;
  model.fx = camera.focal_px.x();
  model.fy = camera.focal_px.y();
  model.cx = camera.center_px.x();
  model.cy = camera.center_px.y();
  model.distortion = fisheye ? std::array{lens.k1, lens.k2, lens.k3, lens.k4, 0.0}
                             : std::array{lens.k1, lens.k2, lens.p1, lens.p2, lens.k3};
  model.size = {camera.width_px, camera.height_px};
  model.lens = fisheye ? core::LensKind::fisheye : core::LensKind::brown_conrady;
  return model;
}

MadeTracks FilmStudio::film(const render::Scenario& scenario, std::uint64_t seed, int jobs,
                            const std::optional<core::CameraModel>& lens) {
  core::SeenPattern pattern = pattern_;
  if (lens) {
    pattern.calibration.camera = *lens;
    pattern.calibration.covariance.setZero();
  }
  const bool lossy = render::lossy(scenario.codec);
  const core::Experiment experiment =
      rendered(scenario, folder_.path(), {.seed = seed, .jobs = jobs, .ideal = false, .clips = lossy, .stills = false},
               progress_);
  core::FrameOpener open = core::open_frames;
  if (!lossy) {
    if (!stage_) stage_ = render::set_stage(scenario, jobs, [this] { progress_("stage", 0.0); });
    open = rendered_opener(std::make_shared<const render::ClipSet>(scenario, stage_), seed, canvases_);
  }
  MadeTracks made = make_tracks(scenario, seed);
  made.setups = experiment.clips;
  made.tracks = core::tracks_of(experiment, jobs, progress_, open, false, &pattern).tracks;
  return made;
}

MadeTracks film_tracks(const render::Scenario& scenario, std::uint64_t seed, int jobs, const base::Progress& progress) {
  return FilmStudio(scenario, seed, jobs, nullptr, progress).film(scenario, seed, jobs);
}

}  // namespace glidelab::validate
