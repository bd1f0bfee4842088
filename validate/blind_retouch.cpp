#include "validate/blind_retouch.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "base/staged_output.h"
#include "core/frame_source.h"
#include "render/scenario.h"
#include "render/scene.h"
#include "render/video_writer.h"

namespace glidelab::validate {
namespace {

namespace fs = std::filesystem;

/// So that a point of the marker's line at x stands where shown_at(x) would. Exact on that line (lens, camera and slope
/// as rendered), and the same above it.
ColumnSources sources_of(const render::Scenario& scenario, double incline_rad,
                         const std::function<double(double)>& shown_at) {
  constexpr double kFarthest_m = 0.8, kStep_m = 2e-4;  // an eighth of a pixel; linear between
  const int width = scenario.camera.width_px;
  ColumnSources from{cv::Mat_<double>(1, width), cv::Mat_<double>(1, width, 0.0)};
  for (int u = 0; u < width; ++u) from.column(0, u) = u;
  const auto seen = [&](double x_m) {
    return render::project(scenario.camera, render::marker_position_W(scenario, incline_rad, x_m));
  };
  struct Pair {
    Eigen::Vector2d to = Eigen::Vector2d::Zero(), from = Eigen::Vector2d::Zero();
    bool known = false;
  } last;
  for (double x_m = -kFarthest_m; x_m < kFarthest_m; x_m += kStep_m) {
    const auto to = seen(shown_at(x_m)), of = seen(x_m);
    if (to && of && last.known) {
      const double low = std::min(last.to.x(), to->x()), high = std::max(last.to.x(), to->x());
      for (int u = std::max(0, static_cast<int>(std::ceil(low))); u <= high && u < width; ++u) {
        const double part = (u - last.to.x()) / (to->x() - last.to.x());
        const Eigen::Vector2d source = last.from + part * (*of - last.from);
        const Eigen::Vector2d place = last.to + part * (*to - last.to);
        from.column(0, u) = source.x();
        from.down(0, u) = source.y() - place.y();
      }
    }
    last.known = to && of;
    if (last.known) last = {*to, *of, true};
  }
  return from;
}

constexpr int kTaps = 8;

/// Lanczos' weights of the pixels from floor(place) - 3 on, with their sum made 1.
std::array<double, kTaps> weights_at(double place) {
  const double part = place - std::floor(place);
  std::array<double, kTaps> weights{};
  double sum = 0.0;
  for (int i = 0; i < kTaps; ++i) {
    const double z = std::numbers::pi * (part + 3.0 - i);
    weights[i] = std::abs(z) < 1e-9 ? 1.0 : std::sin(z) * std::sin(0.25 * z) / (0.25 * z * z);
    sum += weights[i];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

}  // namespace

/// cv::remap knows places to 1/32 pixel only, which would be a staircase of tens of micrometres.
cv::Mat pulled(const cv::Mat& grey, const ColumnSources& sources) {
  cv::Mat out(grey.size(), CV_8U);
  std::vector<double> column(static_cast<std::size_t>(grey.rows));
  for (int u = 0; u < grey.cols; ++u) {
    const double from = sources.column(0, u), down = sources.down(0, u);
    const std::array<double, kTaps> along = weights_at(from), across = weights_at(down);
    const int first = static_cast<int>(std::floor(from)) - 3, above = static_cast<int>(std::floor(down)) - 3;
    for (int v = 0; v < grey.rows; ++v) {
      double sum = 0.0;
      for (int i = 0; i < kTaps; ++i) {
        sum += along[i] * grey.at<std::uint8_t>(v, std::clamp(first + i, 0, grey.cols - 1));
      }
      column[static_cast<std::size_t>(v)] = sum;
    }
    for (int v = 0; v < grey.rows; ++v) {
      double sum = 0.0;
      for (int i = 0; i < kTaps; ++i) {
        sum += across[i] * column[static_cast<std::size_t>(std::clamp(v + above + i, 0, grey.rows - 1))];
      }
      out.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(sum);
    }
  }
  return out;
}

namespace {

void file_anew(const BlindScene& scene, const render::Scenario& scenario, std::size_t c, const fs::path& from,
               const fs::path& to) {
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
  std::optional<ColumnSources> sources;
  if (!retouch.shown_at.empty()) {
    const double incline_rad = scene.motion.groups[scene.motion.clips[c].group].true_rad;
    sources = sources_of(scenario, incline_rad, retouch.shown_at[c]);
  }
  std::size_t filed = 0;
  while (const auto frame = source->next()) {
    if (filed == scene.motion.clips[c].frames) break;
    if (!retouch.lost.empty() && frame->index < retouch.lost[c].size() && retouch.lost[c][frame->index] != 0) continue;
    cv::Mat picture = frame->grey;
    if (sources) picture = pulled(frame->grey, *sources);
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
    const render::Scenario scenario = render::read_scenario(scenario_text(scene, "retouched", 1), "scenario.toml");
    for (std::size_t c = 0; c < scene.motion.clips.size(); ++c) {
      const std::string name = scene.motion.clips[c].name;
      const std::string old_name = render::file_name_of(codec, name),
                        new_name = render::file_name_of(render::Codec::ffv1, name);
      const fs::path anew = folder / "clips" / ("anew-" + new_name);
      file_anew(scene, scenario, c, folder / "clips" / old_name, anew);
      fs::remove(folder / "clips" / old_name);
      fs::rename(anew, folder / "clips" / new_name);
      const std::string was = "clips/" + old_name;
      text.replace(text.find(was), was.size(), "clips/" + new_name);
    }
  }
  base::write_file(file, text);
}

}  // namespace glidelab::validate
