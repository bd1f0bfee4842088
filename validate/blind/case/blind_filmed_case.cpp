#include "validate/blind/case/blind_filmed_case.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "base/text/json_text.h"
#include "core/pictures/frames/frame_source.h"
#include "diagnose/effects/effect_list.h"
#include "render/film/clip_renderer.h"
#include "render/video/video_writer.h"
#include "validate/blind/case/blind_filmed_effects.h"
#include "validate/random_use.h"

namespace glidelab::validate {
namespace {

namespace fs = std::filesystem;

constexpr double kKnot_s = 1e-3;   // between states of a path, as in the renderer (clip_motion.h)
constexpr double kSlope_m = 1e-6;  // interval for the slope of a displacement

using ShownAt = std::function<double(double x_m)>;

/// The body during a frame's exposure, at the position where it is shown.
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

/// The images of a clip, one after another.
using Images = std::function<std::optional<cv::Mat>()>;

Images as_filed(const fs::path& clip, double rate_hz) {
  core::CameraSettings settings;
  settings.frame_rate_hz = rate_hz;
  const std::shared_ptr<core::FrameSource> source = core::open_frames(clip, settings, false, std::nullopt);
  return [source]() -> std::optional<cv::Mat> {
    const auto frame = source->next();
    if (!frame) return std::nullopt;
    return frame->grey.isContinuous() ? frame->grey : frame->grey.clone();
  };
}

Images drawn_anew(const std::shared_ptr<const render::ClipSet>& set, std::size_t c, const ShownAt& shown_at) {
  const auto stream = std::make_shared<render::ClipStream>(set, c, set->scenario().seed);
  return [set, stream, shown_at]() -> std::optional<cv::Mat> {
    const auto next = stream->next();
    if (!next) return std::nullopt;
    const render::Camera& camera = set->scenario().camera;
    cv::Mat image(camera.height_px, camera.width_px, CV_8U);
    stream->read(moved_to(*next->shown, shown_at), render::PixelRect{0, 0, image.cols, image.rows},
                 std::span<std::uint8_t>(image.ptr<std::uint8_t>(), image.total()));
    return image;
  };
}

void file_anew(const BlindScene& scene, std::size_t c, const Images& images, const fs::path& to) {
  const BlindRetouch& retouch = scene.retouch;
  render::VideoFormat format;
  format.width = scene.camera.width_px;
  format.height = scene.camera.height_px;
  format.frame_rate_hz = scene.camera.rate_hz;
  const auto writer = render::open_video(to, format);
  std::size_t filed = 0;
  for (std::size_t slot = 0; filed < scene.motion.clips[c].frames; ++slot) {
    const std::optional<cv::Mat> image = images();
    if (!image) break;
    if (!retouch.lost.empty() && slot < retouch.lost[c].size() && retouch.lost[c][slot] != 0) continue;
    writer->write(std::span<const std::uint8_t>(image->ptr<std::uint8_t>(), image->total()));
    ++filed;
  }
  writer->finish();
}

/// Replaces the whole line "key = …"; removes it for an empty value.
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
                                                                : render::Codec::magicyuv;
    std::shared_ptr<const render::ClipSet> set;
    if (!scene.retouch.shown_at.empty()) set = std::make_shared<render::ClipSet>(scenario);
    for (std::size_t c = 0; c < scene.motion.clips.size(); ++c) {
      const std::string name = scene.motion.clips[c].name;
      const std::string old_name = render::file_name_of(codec, name),
                        new_name = render::file_name_of(render::Codec::magicyuv, name);
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

namespace {

namespace fs = std::filesystem;

constexpr double kFilmedNone = 0.25, kFilmedSingle = 0.82;
constexpr double kFilmedLeastGain = 8.0, kFilmedMostGain = 1500.0;
constexpr int kMostScenes = 400;

bool outside(const std::string& id) {
  const auto& ids = filmed_outside_effects();
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

}  // namespace

std::string FilmedCase::scenario() const {
  return scenario_text(scene, fmt::format("case {}", index), derived_seed(seed, index + 1));
}

FilmedCase make_filmed_case(std::uint64_t seed, std::size_t index, const BlindDraw& draw) {
  BlindRandom random = random_engine(RandomUse::filmed_case, seed, index);
  FilmedCase one;
  one.seed = seed;
  one.index = index;
  const double lot = uniform(random, 0.0, 1.0);
  if (!draw.only.empty()) {
    one.kind = outside(draw.only) ? BlindKind::outside : BlindKind::single;
  } else {
    one.kind = lot < kFilmedNone ? BlindKind::none : lot < kFilmedSingle ? BlindKind::single : BlindKind::outside;
  }
  for (int attempt = 0; attempt < kMostScenes; ++attempt) {
    if (draw.look) draw.look();
    const auto& ids = one.kind == BlindKind::outside ? filmed_outside_effects() : filmed_effects();
    const std::string id = one.kind == BlindKind::none ? "" : draw.only.empty() ? one_of(ids, random) : draw.only;
    const double wanted = log_uniform(random, kFilmedLeastGain, kFilmedMostGain);
    one.scene = draw_scene(random, needs_lossless(id));
    one.told.clear();
    if (one.scene.camera.lossy()) one.told.emplace_back(diagnose::ids::compression);
    if (id.empty()) return one;
    const auto cause = put_filmed_effect(id, wanted, one.scene, random);
    if (!cause) continue;
    one.causes = {*cause};
    return one;
  }
  throw base::NumericalError(
      fmt::format("filmed case {} of seed {}: none of {} scenes shows the effect", index, seed, kMostScenes));
}

void film_blind_folder(const FilmedCase& one, const fs::path& folder, const fs::path& scratch,
                       const FilmRenderer& render) {
  fs::remove_all(scratch);
  fs::create_directories(scratch);
  fs::create_directories(folder.parent_path());
  base::write_file(scratch / "scenario.toml", one.scenario());
  const std::string failure = render(scratch / "scenario.toml", scratch / "case");
  if (!failure.empty()) {
    throw base::EnvironmentError(fmt::format("rendering blind case {} of seed {}: {}", one.index, one.seed, failure));
  }
  retouch_folder(one.scene, render::read_scenario(scratch / "scenario.toml"), scratch / "case");
  fs::rename(scratch / "case", folder);
  fs::remove_all(scratch);
}

std::string filmed_truth_json(const FilmedCase& one) {
  nlohmann::ordered_json truth = truth_of(one);
  truth["told"] = one.told;
  truth["noise_m"] = one.scene.motion.noise_sd_m;
  truth["stated"] = nlohmann::ordered_json::object();
  for (const BlindStated& stated : one.scene.stated) truth["stated"][stated.key] = stated.value;
  truth["filed_anew"] = one.scene.retouch.rewritten;
  truth["scenario"] = one.scenario();
  return base::json_text(truth) + "\n";
}

}  // namespace glidelab::validate
