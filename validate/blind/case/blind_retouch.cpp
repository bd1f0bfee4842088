#include "validate/blind/case/blind_retouch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/files/staged_output.h"
#include "core/pictures/frames/open_frames.h"
#include "render/film/clip_set.h"
#include "render/video/video_writer.h"

namespace glidelab::validate {
namespace {

namespace fs = std::filesystem;

constexpr double kKnot_s = 1e-3;   // between states of a path, as the renderer's own (clip_motion.h)
constexpr double kSlope_m = 1e-6;  // over which the slope of a displacement is taken

using ShownAt = std::function<double(double x_m)>;

/// The body during a frame's exposure where it is shown.
render::FrameMotion moved_to(render::FrameMotion motion, const ShownAt& shown_at) {
  for (double& x : motion.x_m) x = shown_at(x);
  motion.middle.x_m = shown_at(motion.middle.x_m);
  if (motion.path.empty()) return motion;
  const double start_s = motion.path.start_s(), length_s = motion.path.end_s() - start_s;
  const auto pieces = static_cast<std::size_t>(std::max(1.0, std::ceil(length_s / kKnot_s)));
  const double step_s = length_s / static_cast<double>(pieces);
  std::vector<sim::State> knots;
  for (std::size_t k = 0; k <= pieces; ++k) {
    sim::State knot = motion.middle;
    knot.t_s = start_s + step_s * static_cast<double>(k);
    const double x = motion.path.x_m(knot.t_s);
    knot.x_m = shown_at(x);
    knot.v_m_s = motion.path.v_m_s(knot.t_s) * (shown_at(x + kSlope_m) - shown_at(x - kSlope_m)) / (2.0 * kSlope_m);
    knots.push_back(knot);
  }
  motion.path = render::MotionPath(start_s, step_s, std::move(knots));
  return motion;
}

/// The images of a clip, one after the other.
using Pictures = std::function<std::optional<cv::Mat>()>;

Pictures as_filed(const fs::path& clip, double rate_hz) {
  core::CameraSettings settings;
  settings.frame_rate_hz = rate_hz;
  const std::shared_ptr<core::FrameSource> source = core::open_frames(clip, settings, false, std::nullopt);
  return [source]() -> std::optional<cv::Mat> {
    const auto frame = source->next();
    if (!frame) return std::nullopt;
    return frame->grey.isContinuous() ? frame->grey : frame->grey.clone();
  };
}

Pictures drawn_anew(const std::shared_ptr<const render::ClipSet>& set, std::size_t c, const ShownAt& shown_at) {
  const auto stream = std::make_shared<render::ClipStream>(set, c, set->scenario().seed);
  return [set, stream, shown_at]() -> std::optional<cv::Mat> {
    const auto next = stream->next();
    if (!next) return std::nullopt;
    const render::Camera& camera = set->scenario().camera;
    cv::Mat picture(camera.height_px, camera.width_px, CV_8U);
    stream->read(moved_to(*next->shown, shown_at), render::PixelRect{0, 0, picture.cols, picture.rows},
                 std::span<std::uint8_t>(picture.ptr<std::uint8_t>(), picture.total()));
    return picture;
  };
}

void file_anew(const BlindScene& scene, std::size_t c, const Pictures& pictures, const fs::path& to) {
  const BlindRetouch& retouch = scene.retouch;
  render::VideoFormat format;
  format.width = scene.camera.width_px;
  format.height = scene.camera.height_px;
  format.frame_rate_hz = scene.camera.rate_hz;
  const auto writer = render::open_video(to, format);
  std::size_t filed = 0;
  for (std::size_t slot = 0; filed < scene.motion.clips[c].frames; ++slot) {
    const std::optional<cv::Mat> picture = pictures();
    if (!picture) break;
    if (!retouch.lost.empty() && slot < retouch.lost[c].size() && retouch.lost[c][slot] != 0) continue;
    writer->write(std::span<const std::uint8_t>(picture->ptr<std::uint8_t>(), picture->total()));
    ++filed;
  }
  writer->finish();
}

/// Replaces the whole line "key = …"; takes it out for an empty value.
void state(std::string& text, const BlindStated& stated) {
  const std::string key = "\n" + stated.key + " = ";
  const std::size_t at = text.find(key);
  if (at == std::string::npos) throw std::logic_error("experiment.toml has no line " + stated.key);
  const std::size_t end = text.find('\n', at + 1);
  text.replace(at, end - at, stated.value.empty() ? "" : key + stated.value);
}

}  // namespace

void retouch_folder(const BlindScene& scene, const render::Scenario& scenario, const fs::path& folder) {
  const fs::path file = folder / "experiment.toml";
  std::string text = base::read_file(file);
  for (const BlindStated& stated : scene.stated) state(text, stated);
  if (scene.retouch.rewritten) {
    const render::Codec codec = scene.camera.codec == "h264"    ? render::Codec::h264
                                : scene.camera.codec == "mjpeg" ? render::Codec::mjpeg
                                                                : render::Codec::ffv1;
    std::shared_ptr<const render::ClipSet> set;
    if (!scene.retouch.shown_at.empty()) set = std::make_shared<render::ClipSet>(scenario);
    for (std::size_t c = 0; c < scene.motion.clips.size(); ++c) {
      const std::string name = scene.motion.clips[c].name;
      const std::string old_name = render::file_name_of(codec, name),
                        new_name = render::file_name_of(render::Codec::ffv1, name);
      const fs::path anew = folder / "clips" / ("anew-" + new_name);
      file_anew(scene, c,
                set ? drawn_anew(set, c, scene.retouch.shown_at[c])
                    : as_filed(folder / "clips" / old_name, scene.camera.rate_hz),
                anew);
      fs::remove(folder / "clips" / old_name);
      fs::rename(anew, folder / "clips" / new_name);
      const std::string was = "clips/" + old_name;
      text.replace(text.find(was), was.size(), "clips/" + new_name);
    }
  }
  base::write_file(file, text);
}

}  // namespace glidelab::validate
