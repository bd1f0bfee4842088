#include "teach/study/law_film.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/files/staged_output.h"
#include "base/files/temporary_folder.h"
#include "render/film/clip_set.h"
#include "render/scenario/scenario.h"
#include "render/scenario/scenario_sections.h"
#include "render/scenario/scene.h"
#include "render/video/video_writer.h"
#include "sim/motion/simulate.h"

namespace glidelab::teach {
namespace {

constexpr double kDistance = 3.0;      // m, of the camera
constexpr double kBesideGlider = 0.1;  // m, that is seen beyond the outermost glider's middle
constexpr double kAboveTrack = 0.06;   // m, above and below the line of motion: the glider, and the bar under it
constexpr int kLeastHalf = 8;          // px of a row's height, where motions go so far that gliders are dots
constexpr double kWhite =
    400.0;                     // code of white, so that the wall is of a middle grey; what is brighter than 255 is 255
constexpr double kCrf = 26.0;  // of H.264; the image stands still but for the gliders

std::vector<sim::State> states(const sim::ConfigurationSetup& configuration, const sim::MotionSetup& motion,
                               double rate_hz) {
  std::vector<double> times;
  for (std::size_t k = 0; static_cast<double>(k) <= motion.duration_s * rate_hz + 1e-9; ++k) {
    times.push_back(static_cast<double>(k) / rate_hz);
  }
  return sim::simulate(configuration.body, motion.x0_m, motion.v0_m_s, times).states;
}

/// The scenario before the film's camera. Every configuration is a set-up of its own, as its track is inclined.
render::Scenario before_camera(render::Scenario scenario, double farthest_m, int width_px) {
  double steepest = 0.0;
  for (sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    configuration.group = configuration.name;
    steepest = std::max(steepest, std::abs(configuration.body.incline_rad));
  }
  const double focal_px = 0.5 * width_px * kDistance / farthest_m;
  const double half_m = farthest_m * std::sin(steepest) + kAboveTrack;
  render::Camera camera;
  camera.width_px = width_px;
  camera.height_px = 2 * std::max(kLeastHalf, static_cast<int>(std::ceil(focal_px * half_m / kDistance)));
  camera.focal_px = {focal_px, focal_px};
  camera.center_px = {0.5 * (camera.width_px - 1), 0.5 * (camera.height_px - 1)};
  camera.X_WC = render::look_at({0.0, 0.0, kDistance}, {0.0, 0.0, 0.0}, 0.0);
  scenario.camera = camera;
  return render::ideal_of(scenario);
}

/// Draws one motion's frames into its row of the film's images, one after the other.
class Row {
 public:
  Row(const render::ClipSet& set, std::size_t clip, std::vector<sim::State> states)
      : renderer_(set.renderer(clip, 0)),
        states_(std::move(states)),
        code_per_e_(kWhite / render::electrons_of_white(set.scenario())) {}

  void draw(std::size_t k, std::span<std::uint8_t> codes) {
    render::FrameMotion frame;
    frame.frame = std::min(k, states_.size() - 1);
    frame.middle = states_[frame.frame];
    frame.start_s = frame.middle.t_s;
    frame.x_m = {frame.middle.x_m};
    const render::FloatPicture& expected_e = renderer_.expected(frame);
    for (std::size_t i = 0; i < codes.size(); ++i) {
      const double code = std::round(code_per_e_ * static_cast<double>(expected_e.values[i]));
      codes[i] = static_cast<std::uint8_t>(std::clamp(code, 0.0, 255.0));
    }
  }
  std::size_t frames() const { return states_.size(); }

 private:
  render::ClipRenderer renderer_;
  std::vector<sim::State> states_;
  double code_per_e_;
};

}  // namespace

LawFilm film_law(const std::filesystem::path& path, const LawFilmOptions& options) {
  const render::Scenario scenario = render::read_scenario(base::read_file(path), path, render::ScenarioChecks::values);
  LawFilm film;
  std::vector<std::vector<sim::State>> motions;
  double farthest_m = 0.5 * scenario.track.length_m;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      film.clips.push_back(motion.name);
      motions.push_back(states(configuration, motion, options.frame_rate_hz));
      for (const sim::State& state : motions.back()) farthest_m = std::max(farthest_m, std::abs(state.x_m));
      film.frames = std::max(film.frames, motions.back().size());
    }
  }
  const render::ClipSet set(before_camera(scenario, farthest_m + kBesideGlider, options.width_px), options.jobs);
  std::vector<Row> rows;
  for (std::size_t clip = 0; clip < set.size(); ++clip) rows.emplace_back(set, clip, std::move(motions[clip]));

  const render::Camera& camera = set.scenario().camera;
  film.frame_rate_hz = options.frame_rate_hz;
  film.width_px = camera.width_px;
  film.height_px = camera.height_px * static_cast<int>(rows.size());
  render::VideoFormat format;
  format.codec = render::Codec::h264;
  format.width = film.width_px;
  format.height = film.height_px;
  format.frame_rate_hz = options.frame_rate_hz;
  format.compression.crf = kCrf;
  format.compression.gop = static_cast<int>(film.frames);
  const base::TemporaryFolder folder("film");
  const auto writer = render::open_video(folder / "film.mp4", format);
  const std::size_t row_size = static_cast<std::size_t>(camera.width_px) * camera.height_px;
  std::vector<std::uint8_t> picture(row_size * rows.size());
  for (std::size_t k = 0; k < film.frames; ++k) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (k < rows[i].frames()) rows[i].draw(k, std::span(picture).subspan(i * row_size, row_size));
    }
    writer->write(std::span<const std::uint8_t>(picture));
  }
  writer->finish();
  film.mp4 = base::read_file(folder / "film.mp4");
  return film;
}

}  // namespace glidelab::teach
