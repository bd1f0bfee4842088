#include "validate/film/film_studio.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/analysis/clip_to_track.h"
#include "core/experiment/experiment.h"
#include "core/pictures/camera/calibrate.h"
#include "render/film/clip_renderer.h"
#include "render/film/render_experiment.h"
#include "render/film/stills.h"
#include "render/scenario/scene.h"

namespace glidelab::validate {

void Canvas::clear() {
  for (const cv::Rect& rect : drawn) image(rect).setTo(0);
  drawn.clear();
}

bool is_free(const std::shared_ptr<Canvas>& canvas) {
  return canvas.use_count() == 1 && canvas->image.u->refcount == 1;
}

std::shared_ptr<Canvas> CanvasPool::take(cv::Size size, int type) {
  std::shared_ptr<Canvas> canvas;
  {
    const std::lock_guard lock(mutex_);
    if (!all_.empty()) {
      canvas = std::move(all_.back());
      all_.pop_back();
    }
  }
  if (!canvas || canvas->image.size() != size || canvas->image.type() != type) {
    return std::make_shared<Canvas>(Canvas{cv::Mat::zeros(size, type), {}});
  }
  canvas->clear();
  return canvas;
}

void CanvasPool::give(std::shared_ptr<Canvas> canvas) {
  if (!is_free(canvas)) return;
  const std::lock_guard lock(mutex_);
  all_.push_back(std::move(canvas));
}

namespace {

/// The canvases of one clip: those no longer in use are drawn on again.
class Canvases {
 public:
  Canvases(std::shared_ptr<CanvasPool> pool, cv::Size size, int type)
      : pool_(std::move(pool)), size_(size), type_(type) {}
  Canvases(const Canvases&) = delete;
  Canvases& operator=(const Canvases&) = delete;
  ~Canvases() {
    for (std::shared_ptr<Canvas>& canvas : all_) pool_->give(std::move(canvas));
  }

  std::shared_ptr<Canvas> clear_one() {
    for (const std::shared_ptr<Canvas>& canvas : all_) {
      if (!is_free(canvas)) continue;
      canvas->clear();
      return canvas;
    }
    all_.push_back(pool_->take(size_, type_));
    return all_.back();
  }

 private:
  std::shared_ptr<CanvasPool> pool_;
  cv::Size size_;
  int type_;
  std::vector<std::shared_ptr<Canvas>> all_;
};

class RenderedFrames : public core::FrameSource {
 public:
  RenderedFrames(std::shared_ptr<const render::ClipSet> set, std::size_t clip, std::uint64_t seed, bool with_color,
                 std::shared_ptr<CanvasPool> pool)
      : set_(std::move(set)),
        stream_(set_, clip, seed),
        frames_(set_->frames(clip, seed)),
        with_color_(with_color),
        deep_(set_->scenario().sensor.bit_depth > 8),
        canvases_(std::move(pool), {set_->scenario().camera.width_px, set_->scenario().camera.height_px},
                  deep_ ? CV_16U : CV_8U) {}

  std::optional<core::Frame> next() override {
    std::optional<core::Frame> frame = next_in_parts();
    if (!frame || !frame->draw) return frame;
    frame->draw(cv::Rect({}, frame->grey.size()));
    frame->draw = {};
    return frame;
  }

  std::optional<core::Frame> next_in_parts() override {
    const std::optional<render::ClipStream::Next> now = stream_.next();
    if (!now) return std::nullopt;
    core::Frame frame;
    const std::shared_ptr<Canvas> canvas = canvases_.clear_one();
    frame.grey = canvas->image;
    frame.index = index_++;
    const render::Scenario& scenario = set_->scenario();
    const render::Recording& recording = scenario.recording;
    frame.t_s = recording.clock.variable ? render::stored_stamp_s(now->stamp_s, scenario.codec, scenario.compression)
                                         : static_cast<double>(frame.index) / recording.frame_rate_hz;
    // Copies of the frame share the canvas.
    frame.draw = [this, canvas, shown = now->shown](const cv::Rect& part) {
      cv::Mat& image = canvas->image;
      if (std::ranges::any_of(canvas->drawn, [&](const cv::Rect& known) { return (known & part) == part; })) return;
      canvas->drawn.push_back(part);
      cv::Mat target = image(part);
      if (image.depth() == CV_16U) {
        read<std::uint16_t>(*shown, part, target);
      } else {
        read<std::uint8_t>(*shown, part, target);
      }
    };
    if (!with_color_) return frame;
    frame.draw(cv::Rect({}, frame.grey.size()));
    frame.draw = {};
    cv::Mat shallow = frame.grey;
    if (deep_) frame.grey.convertTo(shallow, CV_8U, 255.0 / set_->scenario().sensor.largest_code());
    cv::cvtColor(shallow, frame.color, cv::COLOR_GRAY2BGR);
    return frame;
  }
  std::size_t stated_frames() const override { return frames_; }
  std::vector<core::Note> notes() const override { return {}; }

 private:
  template <typename Code>
  void read(const render::FrameMotion& shown, const cv::Rect& rect, cv::Mat& target) {
    const render::PixelRect part{rect.x, rect.y, rect.width, rect.height};
    if (target.isContinuous()) {
      stream_.read(shown, part, std::span<Code>(target.ptr<Code>(), target.total()));
      return;
    }
    cv::Mat codes(rect.size(), target.type());
    stream_.read(shown, part, std::span<Code>(codes.ptr<Code>(), codes.total()));
    codes.copyTo(target);
  }

  std::shared_ptr<const render::ClipSet> set_;
  render::ClipStream stream_;
  std::size_t frames_;
  bool with_color_;
  bool deep_;
  Canvases canvases_;
  std::size_t index_ = 0;
};

}  // namespace

std::unique_ptr<core::FrameSource> rendered_frames(std::shared_ptr<const render::ClipSet> set, std::size_t clip,
                                                   std::uint64_t seed, bool with_color,
                                                   std::shared_ptr<CanvasPool> pool) {
  if (render::lossy(set->scenario().codec)) {
    throw base::InputError(base::Issue{set->motion(clip).name, 0, "codec.name", "a codec that loses part of the image",
                                       "one without loss, or the clip's file: in memory frames are as the sensor gives "
                                       "them"});
  }
  return std::make_unique<RenderedFrames>(std::move(set), clip, seed, with_color, std::move(pool));
}

core::FrameOpener rendered_opener(std::shared_ptr<const render::ClipSet> set, std::uint64_t seed,
                                  std::shared_ptr<CanvasPool> pool) {
  return [set, seed, pool](const std::filesystem::path& file, const core::CameraSettings&, bool with_color,
                           std::optional<cv::Size>) -> std::unique_ptr<core::FrameSource> {
    for (std::size_t clip = 0; clip < set->size(); ++clip) {
      if (file.stem() == set->motion(clip).name || file.filename() == set->motion(clip).name) {
        return rendered_frames(set, clip, seed, with_color, pool);
      }
    }
    throw base::InputError(base::Issue{file.string(), 0, "clip", "no such clip in the scenario", "one of its clips"});
  };
}

namespace {

namespace fs = std::filesystem;

/// Files of the experiment and its truth; with `clips` also the clips, otherwise empty files in their place, as for
/// stills.
core::Experiment rendered(const render::Scenario& scenario, const fs::path& folder, std::uint64_t seed, int jobs,
                          bool clips, const std::shared_ptr<const render::Stage>& stage,
                          const base::Progress& progress) {
  const fs::path images = folder / "e", truth = folder / "t";
  fs::create_directories(images);
  fs::remove_all(images / "clips");
  fs::remove_all(truth);
  fs::create_directory(truth);
  render::render_experiment(scenario, images, truth,
                            {.seed = seed, .jobs = jobs, .ideal = false, .clips = clips, .stills = false}, progress,
                            stage);
  return core::read_experiment(images);
}

/// States, in place of the pattern, how many pixels a metre of the track has in the image, and where downhill is.
void state_scale(const render::Scenario& scenario, core::Experiment& experiment) {
  constexpr double kStep_m = 1e-3;
  const double incline_rad = scenario.motion.configurations.front().body.incline_rad;
  const auto seen = [&](double x_m) {
    return render::project(scenario.camera, render::marker_position_W(scenario, incline_rad, x_m));
  };
  const auto from = seen(-kStep_m), to = seen(kStep_m);
  if (!from || !to) throw base::NumericalError("a scale: the camera does not see the track's reference point");
  const Eigen::Vector2d along = *to - *from;
  experiment.calibration.reset();
  experiment.scale = core::ScaleSetup{along.norm() / (2.0 * kStep_m), 0.0};
  experiment.groups.clear();
  const bool across = std::abs(along.y()) > std::abs(along.x());
  experiment.track.downhill = across ? (along.y() > 0.0 ? core::Downhill::plus_y : core::Downhill::minus_y)
                                     : (along.x() > 0.0 ? core::Downhill::plus_x : core::Downhill::minus_x);
}

/// Tracks do not use a plumb line.
render::Scenario without_plumb(render::Scenario scenario) {
  scenario.plumb.reset();
  return scenario;
}

}  // namespace

FilmStudio::FilmStudio(const render::Scenario& with_plumb, std::uint64_t seed, int jobs,
                       std::shared_ptr<const render::Stage> stage, base::Progress progress, LengthFrom length)
    : folder_("run"), progress_(std::move(progress)), stage_(std::move(stage)), length_(length) {
  const render::Scenario scenario = without_plumb(with_plumb);
  if (!stage_) stage_ = render::set_stage(scenario, jobs, [this] { progress_("stage", 0.0); });
  // The images stay in memory; empty files stand in for them.
  const fs::path images = folder_.path() / "e";
  std::map<fs::path, cv::Mat> stills;
  std::mutex mutex;
  fs::create_directories(images / "calibration");
  if (length_ == LengthFrom::scale) {
    for (const std::string& name : render::still_names(scenario)) base::write_file(images / name, "");
    return;
  }
  render::take_stills(scenario, *stage_, seed, jobs, [&](const std::string& name, const cv::Mat& codes) {
    progress_("rendering", 0.0);
    base::write_file(images / name, "");
    const std::lock_guard lock(mutex);
    stills[images / name] = codes.clone();
  });
  const core::Experiment experiment = rendered(scenario, folder_.path(), seed, jobs, false, stage_, progress_);
  const core::CalibrationSetup& setup = *experiment.calibration;
  const core::GreyReader read = [&](const fs::path& file) { return stills.at(file); };
  pattern_.boards = core::find_board_views(core::pattern_files(experiment),
                                           cv::Size(setup.inner_corners.columns, setup.inner_corners.rows), jobs, read);
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

MadeTracks FilmStudio::film(const render::Scenario& with_plumb, std::uint64_t seed, int jobs,
                            const std::optional<core::CameraModel>& lens,
                            const std::shared_ptr<const render::Stage>& stage) {
  const std::lock_guard lock(filming_);
  const std::shared_ptr<const render::Stage>& set = stage ? stage : stage_;
  const render::Scenario scenario = without_plumb(with_plumb);
  core::SeenPattern pattern = pattern_;
  if (lens) {
    pattern.calibration.camera = *lens;
    pattern.calibration.covariance.setZero();
  }
  const bool lossy = render::lossy(scenario.codec);
  core::Experiment experiment = rendered(scenario, folder_.path(), seed, jobs, lossy, set, progress_);
  if (length_ == LengthFrom::scale) state_scale(scenario, experiment);
  const core::FrameOpener open =
      lossy ? core::FrameOpener(core::open_frames)
            : rendered_opener(std::make_shared<const render::ClipSet>(scenario, set), seed, canvases_);
  MadeTracks made = make_tracks(scenario, seed);
  made.setups = experiment.clips;
  made.tracks =
      core::tracks_of(experiment, jobs, progress_, open, false, length_ == LengthFrom::scale ? nullptr : &pattern)
          .tracks;
  return made;
}

MadeTracks film_tracks(const render::Scenario& scenario, std::uint64_t seed, int jobs, const base::Progress& progress,
                       std::shared_ptr<const render::Stage> stage) {
  return FilmStudio(scenario, seed, jobs, std::move(stage), progress).film(scenario, seed, jobs);
}

}  // namespace glidelab::validate
