#include "render/film/clip_renderer.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "base/long_work.h"
#include "render/paint/frame_background.h"
#include "render/paint/static_painter.h"

namespace glidelab::render {
namespace {

/// Number of samples of the lens: enough that neighbours are a quarter of a pixel apart along any line through the
/// blur.
std::size_t sample_count(double disc_radius_px, double core_sigma_px) {
  const double across = 2.0 * disc_radius_px + 4.0 * core_sigma_px;
  return 2 * static_cast<std::size_t>(std::clamp(std::ceil(4.0 * across), 8.0, 64.0));
}

/// Largest motion of the image from one pose to the next.
constexpr double kPoseStep = 0.02;  // px
constexpr double kMostPoses = 64.0;

}  // namespace

ClipRenderer::ClipRenderer(const Scenario& scenario, const sim::ConfigurationSetup& configuration,
                           const StaticScene& scene, const RayTable& rays, const FloatImage& background_e,
                           std::uint64_t seed, std::uint32_t stream, const FineImage* fine)
    : scenario_(scenario),
      configuration_(configuration),
      scene_(scene),
      rays_(rays),
      background_e_(background_e),
      fine_(fine),
      expected_e_(background_e),
      white_e_(electrons_of_white(scenario)),
      readout_(scenario.sensor, scenario.recording.exposure_s, seed, scenario.camera.width_px,
               scenario.camera.height_px),
      stream_(stream) {
  // At the reference point at which the camera looks; half a pixel there.
  const double depth =
      (scenario.camera.X_WC.inverse() * marker_position_W(scenario, configuration.body.incline_rad, 0.0)).z();
  longest_step_m_ = 0.5 * std::max(depth, 0.1) / scenario.camera.focal_px.maxCoeff();
  if (scenario.focus) {
    samples_ = focus_samples(sample_count(disc_radius_px(*scenario.focus, scenario.camera, std::max(depth, 0.1)),
                                          core_sigma_px(*scenario.focus, scenario.camera)));
  }
  if (scenario.light.flickers()) lit_e_ = background_e;
}

MotionDetail ClipRenderer::detail() const {
  const bool simple = !scenario_.focus && !scenario_.light.flickers() && !scenario_.mount.moves();
  return simple ? MotionDetail::parts : MotionDetail::path;
}

const FloatImage& ClipRenderer::expected(const FrameMotion& frame) {
  return expected(frame, {0, 0, background_e_.width, background_e_.height});
}

const FloatImage& ClipRenderer::expected(const FrameMotion& frame, const PixelRect& within) {
  background_of(frame, within);
  add_reflections(frame, false, within);
  const MovingBody body = glider(scenario_, scene_, configuration_.body, frame.middle.x_m);
  const MovingLayer layer = layer_of(frame, body, within);
  put_over(layer, static_cast<float>(white_e_), expected_e_);
  changed_ = united(changed_, layer.rect);
  add_reflections(frame, true, within);
  if (!scenario_.light.flickers()) return expected_e_;
  const Recording& recording = scenario_.recording;
  for (int y = within.y; y < within.y + within.height; ++y) {
    const double start_s = frame.start_s + recording.shutter.delay_s(y);
    const auto factor = static_cast<float>(mean_flicker(scenario_.light, start_s, recording.exposure_s));
    const std::span<const float> from = expected_e_.row(y, within.x, within.width);
    const std::span<float> to = lit_e_.row(y, within.x, within.width);
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = factor * from[i];
  }
  return lit_e_;
}

void ClipRenderer::background_of(const FrameMotion& frame, const PixelRect& within) {
  if (!scenario_.mount.moves()) {
    for (int y = changed_.y; y < changed_.y + changed_.height; ++y) {
      const std::span<const float> from = background_e_.row(y, changed_.x, changed_.width);
      std::copy(from.begin(), from.end(), expected_e_.row(y, changed_.x, changed_.width).begin());
    }
    changed_ = {};
    return;
  }
  add_views(frame);
  const std::size_t samples = std::max<std::size_t>(samples_.size(), 1);
  const Recording& recording = scenario_.recording;
  for (int y = within.y; y < within.y + within.height; ++y) {
    const std::span<float> row = expected_e_.row(y, within.x, within.width);
    std::fill(row.begin(), row.end(), 0.0f);
    // The poses during this row's exposure, each weighted by its share; the fine image includes the blur of the lens.
    instants_of(frame, frame.start_s + recording.shutter.delay_s(y));
    std::vector<double> share(poses_, 0.0);
    for (const Instant& instant : instants_) share[instant.view / samples] += instant.weight;
    for (std::size_t pose = 0; pose < poses_; ++pose) {
      if (share[pose] == 0.0) continue;
      add_row(*fine_, mount_at(scenario_.mount, pose_time_s(frame, pose)), y, within.x,
              static_cast<float>(share[pose] * white_e_), row);
    }
    if (rays_.gain.empty()) continue;
    const float* const gain = rays_.gain.data() + static_cast<std::size_t>(y) * rays_.width + within.x;
    for (std::size_t i = 0; i < row.size(); ++i) row[i] *= gain[i];
  }
}

double ClipRenderer::pose_time_s(const FrameMotion& frame, std::size_t pose) const {
  const Recording& recording = scenario_.recording;
  const double open_s = recording.exposure_s + recording.shutter.readout_s();
  return frame.start_s + (static_cast<double>(pose) + 0.5) / static_cast<double>(poses_) * open_s;
}

void ClipRenderer::add_views(const FrameMotion& frame) {
  const Camera& camera = scenario_.camera;
  poses_ = 1;
  if (scenario_.mount.moves()) {
    const double open_s = scenario_.recording.exposure_s + scenario_.recording.shutter.readout_s();
    double path_px = 0.0;
    constexpr int kSteps = 32;
    Eigen::Isometry3d before = mount_at(scenario_.mount, frame.start_s);
    for (int i = 1; i <= kSteps; ++i) {
      const Eigen::Isometry3d after = mount_at(scenario_.mount, frame.start_s + open_s * i / kSteps);
      path_px += image_shift_px(camera, before.inverse() * after);
      before = after;
    }
    poses_ = static_cast<std::size_t>(std::clamp(std::ceil(path_px / kPoseStep), 1.0, kMostPoses));
  }
  views_.clear();
  for (std::size_t pose = 0; pose < poses_; ++pose) {
    Eigen::Affine3d X_CW(camera.X_WC.inverse());
    if (scenario_.mount.moves()) {
      X_CW = Eigen::Affine3d((camera.X_WC * mount_at(scenario_.mount, pose_time_s(frame, pose))).inverse());
    }
    if (samples_.empty()) {
      views_.push_back(X_CW);
      continue;
    }
    const double aperture_m = aperture_radius_m(*scenario_.focus, camera);
    const double core = core_sigma_px(*scenario_.focus, camera);
    for (const FocusSample& sample : samples_) {
      // p - a (1 - Z/d) + g Z: from the point a of the aperture, displaced by g in undistorted coordinates.
      const Eigen::Vector2d a = aperture_m * sample.aperture;
      const Eigen::Vector2d g = core * sample.core.cwiseQuotient(camera.focal_px);
      Eigen::Affine3d seen = Eigen::Affine3d::Identity();
      seen.linear().col(2).head<2>() = a / scenario_.focus->focus_distance_m + g;
      seen.translation().head<2>() = -a;
      views_.push_back(seen * X_CW);
    }
  }
}

void ClipRenderer::instants_of(const FrameMotion& frame, double start_s) {
  const Recording& recording = scenario_.recording;
  const double length_m = std::abs(frame.path.v_m_s(start_s + 0.5 * recording.exposure_s)) * recording.exposure_s;
  std::size_t n = exposure_instants(length_m, longest_step_m_);
  n = std::max(n, samples_.size());
  if (poses_ > 1) n = std::max<std::size_t>(n, 8);
  if (scenario_.light.flickers()) n = std::max<std::size_t>(n, 4);
  const double open_s = recording.exposure_s + recording.shutter.readout_s();
  const std::size_t samples = std::max<std::size_t>(samples_.size(), 1);
  instants_.clear();
  double sum = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const double t_s = start_s + exposure_instant(k, n) * recording.exposure_s;
    const double part = (t_s - frame.start_s) / open_s * static_cast<double>(poses_);
    const auto pose = static_cast<std::size_t>(std::clamp(std::floor(part), 0.0, static_cast<double>(poses_ - 1)));
    const double weight = scenario_.light.flickers() ? std::max(flicker_at(scenario_.light, t_s), 0.0) : 1.0;
    instants_.push_back({pose * samples + k % samples, frame.path.x_m(t_s), weight});
    sum += weight;
  }
  // All light may be off for a whole exposure; then the choice of instants for the mean does not matter.
  for (Instant& instant : instants_) {
    instant.weight = sum > 0.0 ? instant.weight / sum : 1.0 / static_cast<double>(n);
  }
}

MovingLayer ClipRenderer::layer_of(const FrameMotion& frame, const MovingBody& body, const PixelRect& within) {
  if (frame.path.empty()) return paint(scenario_.camera, rays_, body, frame.x_m, within);
  const Recording& recording = scenario_.recording;
  add_views(frame);
  Looks looks;
  looks.views = views_;
  looks.first_x_m = frame.path.least_x_m();
  looks.last_x_m = frame.path.largest_x_m();
  if (!recording.shutter.rolling) instants_of(frame, frame.start_s);
  looks.of_row = [&](int row) -> std::span<const Instant> {
    if (recording.shutter.rolling) instants_of(frame, frame.start_s + recording.shutter.delay_s(row));
    return instants_;
  };
  return paint(rays_, body, looks, within);
}

void ClipRenderer::add_reflections(const FrameMotion& frame, bool in_front, const PixelRect& within) {
  if (scenario_.light.reflections.empty()) return;
  for (const Reflection& reflection : scenario_.light.reflections) {
    if (reflection.in_front != in_front) continue;
    changed_ = united(changed_, add_reflection(scenario_, rays_, configuration_.body, reflection, frame, white_e_,
                                               within, expected_e_));
  }
}

void ClipRenderer::read(const FrameMotion& frame, const PixelRect& rect, std::span<std::uint8_t> codes) {
  readout_.read(expected(frame, readout_.seen_by(rect)), stream_, static_cast<std::uint32_t>(frame.frame), rect, codes);
}
void ClipRenderer::read(const FrameMotion& frame, const PixelRect& rect, std::span<std::uint16_t> codes) {
  readout_.read(expected(frame, readout_.seen_by(rect)), stream_, static_cast<std::uint32_t>(frame.frame), rect, codes);
}

namespace {

FloatImage scaled(FloatImage image, double factor) {
  for (float& value : image.values) value = static_cast<float>(static_cast<double>(value) * factor);
  return image;
}

/// The stills were taken before the focus changed, with the first configuration's track, by a camera at rest.
void set_stills(const Scenario& scenario, Stage& stage) {
  const sim::ConfigurationSetup& first = scenario.motion.configurations.front();
  if (scenario.mount.focal_change == 0.0) {
    stage.behind_stills_e = stage.set_ups.at(first.group).background_e;
    return;
  }
  stage.still_rays = make_ray_table(scenario.camera, scenario.vignetting);
  StaticPainter painter(scenario.camera, *stage.still_rays, scenario.focus);
  stage.behind_stills_e =
      scaled(painter.paint(empty_track(scenario, first.body.incline_rad)), electrons_of_white(scenario));
}

}  // namespace

std::shared_ptr<const Stage> set_stage(const Scenario& before, int jobs, const std::function<void()>& drawn) {
  const Scenario scenario = as_in_clips(before);
  const auto stage = std::make_shared<Stage>();
  stage->rays = make_ray_table(scenario.camera, scenario.vignetting);
  double longest_s = 0.0;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    Stage::SetUp& set_up = stage->set_ups[configuration.group];
    if (set_up.scene.boxes.empty()) set_up.scene = empty_track(scenario, configuration.body.incline_rad);
    for (const sim::MotionSetup& motion : configuration.motions) longest_s = std::max(longest_s, motion.duration_s);
  }
  std::vector<Stage::SetUp*> set_ups;
  for (auto& [name, set_up] : stage->set_ups) set_ups.push_back(&set_up);
  const double white_e = electrons_of_white(scenario);
  base::in_parallel(jobs, set_ups.size(), [&](const auto& next) {
    StaticPainter painter(scenario.camera, stage->rays, scenario.focus);
    for (std::size_t i = next(); i < set_ups.size(); i = next()) {
      Stage::SetUp& set_up = *set_ups[i];
      set_up.background_e = scaled(painter.paint(set_up.scene), white_e);
      if (scenario.mount.moves()) {
        set_up.fine = fine_image(scenario.camera, scenario.mount, scenario.focus, set_up.scene, longest_s);
      }
      if (drawn) drawn();
    }
  });
  set_stills(before, *stage);
  return stage;
}

ClipSet::ClipSet(const Scenario& scenario, int jobs, const std::function<void()>& drawn)
    : ClipSet(scenario, set_stage(scenario, jobs, drawn)) {}

ClipSet::ClipSet(const Scenario& scenario, std::shared_ptr<const Stage> stage)
    : scenario_(as_in_clips(scenario)), stage_(std::move(stage)) {
  for (const sim::ConfigurationSetup& configuration : scenario_.motion.configurations) {
    const auto found = stage_->set_ups.find(configuration.group);
    if (found == stage_->set_ups.end()) throw std::logic_error("the stage has no group " + configuration.group);
    for (const sim::MotionSetup& motion : configuration.motions) {
      clips_.push_back({&configuration, &motion, &found->second});
    }
  }
}

ClipRenderer ClipSet::renderer(std::size_t clip, std::uint64_t seed) const {
  const Clip& one = clips_.at(clip);
  return ClipRenderer(scenario_, *one.configuration, one.set_up->scene, stage_->rays, one.set_up->background_e, seed,
                      static_cast<std::uint32_t>(clip), one.set_up->fine ? &*one.set_up->fine : nullptr);
}

ClipCount count_clips(const Scenario& scenario, std::uint64_t seed) {
  ClipCount count;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      const FrameClock clock(scenario.recording.clock, scenario.recording.frame_rate_hz, seed,
                             static_cast<std::uint32_t>(count.clips++));
      count.frames += clock.frames_of(frame_count(scenario.recording, motion));
    }
  }
  return count;
}

std::size_t count_set_ups(const Scenario& scenario) {
  std::set<std::string> groups;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations)
    groups.insert(configuration.group);
  return groups.size();
}

FrameClock ClipSet::clock(std::size_t clip, std::uint64_t seed) const {
  return FrameClock(scenario_.recording.clock, scenario_.recording.frame_rate_hz, seed,
                    static_cast<std::uint32_t>(clip));
}

ClipStream::ClipStream(std::shared_ptr<const ClipSet> set, std::size_t clip, std::uint64_t seed)
    : set_(std::move(set)),
      renderer_(set_->renderer(clip, seed)),
      clock_(set_->clock(clip, seed)),
      motions_(set_->configuration(clip).body, set_->motion(clip), set_->scenario().recording, clock_,
               renderer_.longest_step_m(), renderer_.detail()) {}

std::optional<ClipStream::Next> ClipStream::next() {
  while (std::optional<FrameMotion> slot = motions_.next()) {
    const std::size_t number = slot->frame;
    const FrameFate fate = clock_.fate(number);
    if (fate == FrameFate::dropped) continue;
    const double stamp_s = clock_.stamp_s(number);
    const bool repeated = fate == FrameFate::duplicated;
    if (!repeated) shown_ = std::make_shared<const FrameMotion>(std::move(*slot));
    return Next{shown_, number, repeated, stamp_s};
  }
  return std::nullopt;
}

}  // namespace glidelab::render
