#include "validate/blind_retouch.h"

#include <fmt/format.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "base/staged_output.h"
#include "core/frame_source.h"
#include "render/video_writer.h"

namespace glidelab::validate {
namespace {

namespace fs = std::filesystem;

/// Where the columns' pixels are taken from, so that a point at x stands where shown_at(x) would.
cv::Mat_<float> columns_from(const BlindScene& scene, const std::function<double(double)>& shown_at) {
  const BlindCamera& camera = scene.camera;
  cv::Mat_<float> from(1, camera.width_px);
  const double middle_px = 0.5 * (camera.width_px - 1), px_per_m = camera.px_per_m();
  // The reference point is x_m to the left of the camera, which is turned towards it: it stands in the middle.
  for (int u = 0; u < camera.width_px; ++u) {
    const double seen_m = (u - middle_px) / px_per_m;
    double x_m = seen_m;
    for (int i = 0; i < 8; ++i) x_m = seen_m - (shown_at(x_m) - x_m);
    from(0, u) = static_cast<float>(middle_px + px_per_m * x_m);
  }
  return from;
}

void file_anew(const BlindScene& scene, std::size_t c, const fs::path& from, const fs::path& to) {
  const BlindCamera& camera = scene.camera;
  const BlindRetouch& retouch = scene.retouch;
  core::CameraSettings settings;
  settings.frame_rate_hz = camera.rate_hz;
  const auto source = core::open_frames(from, settings, false, std::nullopt);
  render::VideoFormat format;
  format.width = camera.width_px;
  format.height = camera.height_px;
  format.frame_rate_hz = camera.rate_hz;
  const auto writer = render::open_video(to, format);
  cv::Mat map_u, map_v(camera.height_px, camera.width_px, CV_32F);
  if (!retouch.shown_at.empty()) {
    cv::repeat(columns_from(scene, retouch.shown_at[c]), camera.height_px, 1, map_u);
    for (int v = 0; v < camera.height_px; ++v) map_v.row(v).setTo(static_cast<float>(v));
  }
  std::size_t filed = 0;
  while (const auto frame = source->next()) {
    if (filed == scene.motion.clips[c].frames) break;
    if (!retouch.lost.empty() && frame->index < retouch.lost[c].size() && retouch.lost[c][frame->index] != 0) continue;
    cv::Mat picture = frame->grey;
    if (!map_u.empty()) cv::remap(frame->grey, picture, map_u, map_v, cv::INTER_LANCZOS4, cv::BORDER_REPLICATE);
    if (!picture.isContinuous()) picture = picture.clone();
    writer->write(std::span<const std::uint8_t>(picture.ptr<std::uint8_t>(), picture.total()));
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

void retouch_folder(const BlindScene& scene, const fs::path& folder) {
  const fs::path file = folder / "experiment.toml";
  std::string text = base::read_file(file);
  for (const BlindStated& stated : scene.stated) state(text, stated);
  if (scene.retouch.rewritten) {
    const render::Codec codec = scene.camera.codec == "h264"    ? render::Codec::h264
                                : scene.camera.codec == "mjpeg" ? render::Codec::mjpeg
                                                                : render::Codec::ffv1;
    for (std::size_t c = 0; c < scene.motion.clips.size(); ++c) {
      const std::string name = scene.motion.clips[c].name;
      const std::string old_name = render::file_name_of(codec, name),
                        new_name = render::file_name_of(render::Codec::ffv1, name);
      const fs::path anew = folder / "clips" / ("anew-" + new_name);
      file_anew(scene, c, folder / "clips" / old_name, anew);
      fs::remove(folder / "clips" / old_name);
      fs::rename(anew, folder / "clips" / new_name);
      const std::string was = "clips/" + old_name;
      text.replace(text.find(was), was.size(), "clips/" + new_name);
    }
  }
  base::write_file(file, text);
}

}  // namespace glidelab::validate
