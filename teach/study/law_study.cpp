#include "teach/study/law_study.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <sstream>

#include "base/files/file_io.h"
#include "render/film/clip_renderer.h"
#include "render/scenario/scenario.h"
#include "render/scenario/scenario_sections.h"
#include "render/scenario/scene.h"
#include "render/video/video_writer.h"
#include "sim/motion/motion_scenario.h"
#include "sim/motion/simulate.h"

namespace glidelab::teach {
namespace {

constexpr double kSlowest = 1e-9;  // m/s
constexpr int kPerDecade = 256;

/// The force that drives a glider on side s of v = 0 away from v = 0.
double outward_n(const sim::Body& body, int s, double speed) {
  return s * sim::net_force_n(body, s * speed, s);
}

std::optional<Equilibrium> at_rest(const sim::Body& body) {
  const double up = outward_n(body, -1, kSlowest), down = outward_n(body, 1, kSlowest);
  if (sim::mode_at_rest(body) != sim::Mode::stick || (up == 0.0 && down == 0.0)) return std::nullopt;
  bool stops = outward_n(body, -1, 0.0) < 0.0 && outward_n(body, 1, 0.0) < 0.0;
  for (const auto& force : body.forces) stops = stops || force->exponent_at_rest() < 1.0;
  const bool stable = up < 0.0 && down < 0.0;
  return Equilibrium{0.0, stable, stable && stops};
}

void add_moving(const sim::Body& body, int s, double fastest, std::vector<Equilibrium>& found) {
  double low = kSlowest;
  bool was_outward = outward_n(body, s, low) > 0.0;
  for (int i = 1; low < fastest; ++i) {
    const double high = std::min(fastest, kSlowest * std::pow(10.0, static_cast<double>(i) / kPerDecade));
    const bool outward = outward_n(body, s, high) > 0.0;
    if (outward != was_outward) {
      double below = low, above = high;
      for (double middle = 0.5 * (below + above); middle > below && middle < above; middle = 0.5 * (below + above)) {
        ((outward_n(body, s, middle) > 0.0) == was_outward ? below : above) = middle;
      }
      found.push_back({s * above, was_outward, false});
    }
    low = high;
    was_outward = outward;
  }
}

}  // namespace

std::vector<Equilibrium> equilibria(const sim::Body& body, double lowest_m_s, double highest_m_s) {
  std::vector<Equilibrium> found;
  add_moving(body, -1, -lowest_m_s, found);
  if (const auto rest = at_rest(body); rest && lowest_m_s <= 0.0 && highest_m_s >= 0.0) found.push_back(*rest);
  add_moving(body, 1, highest_m_s, found);
  std::ranges::sort(found, {}, &Equilibrium::v_m_s);
  return found;
}

namespace {

std::string leading_comment(const std::string& toml) {
  std::istringstream lines(toml);
  std::string text;
  for (std::string line; std::getline(lines, line) && line.starts_with('#');) {
    const std::size_t from = line.find_first_not_of("# ");
    if (from == std::string::npos) continue;
    if (line.find("glidelab ") == from) break;  // how to run it
    if (!text.empty()) text += ' ';
    text.append(line, from);
  }
  return text;
}

LawMotion motion_of(const sim::ConfigurationSetup& configuration, const sim::MotionSetup& motion) {
  LawMotion result;
  result.clip = motion.name;
  result.configuration = configuration.name;
  const auto steps = static_cast<std::size_t>(std::floor(motion.duration_s * kFramesPerSecond + 1e-9));
  for (std::size_t i = 0; i <= steps; ++i) result.t_s.push_back(static_cast<double>(i) / kFramesPerSecond);
  for (const sim::State& state : sim::simulate(configuration.body, motion.x0_m, motion.v0_m_s, result.t_s).states) {
    result.x_m.push_back(state.x_m);
    result.v_m_s.push_back(state.v_m_s);
    result.a_m_s2.push_back(state.a_m_s2);
  }
  return result;
}

double acceleration(const sim::Body& body, double v_m_s, int direction) {
  return sim::net_force_n(body, v_m_s, direction) / body.mass_kg;
}

LawCurve curve_of(const sim::ConfigurationSetup& configuration, double lowest, double highest) {
  constexpr int kPoints = 200;
  LawCurve curve;
  curve.configuration = configuration.name;
  curve.incline_deg = configuration.body.incline_rad * 180.0 / std::numbers::pi;
  if (const auto v_lim = sim::limit_speed_m_s(configuration.body)) highest = std::max(highest, 1.05 * *v_lim);
  // Denser near v = 0, where the laws differ.
  for (int i = 0; i <= kPoints; ++i) {
    const double part = static_cast<double>(i) / kPoints, dense = part * part;
    if (lowest < 0.0) {
      const double v = lowest * (1.0 - part) * (1.0 - part);
      curve.up_v_m_s.push_back(v);
      curve.up_a_m_s2.push_back(acceleration(configuration.body, v, -1));
    }
    if (highest > 0.0) {
      curve.down_v_m_s.push_back(highest * dense);
      curve.down_a_m_s2.push_back(acceleration(configuration.body, highest * dense, 1));
    }
  }
  curve.equilibria = equilibria(configuration.body, lowest, highest);
  curve.body = configuration.body;
  return curve;
}

double at(const std::vector<double>& x, const std::vector<double>& y, double where) {
  const auto above = std::lower_bound(x.begin(), x.end(), where);
  if (above == x.begin()) return y.front();
  if (above == x.end()) return y.back();
  const auto i = static_cast<std::size_t>(above - x.begin());
  const double part = (where - x[i - 1]) / (x[i] - x[i - 1]);
  return y[i - 1] + part * (y[i] - y[i - 1]);
}

double largest_difference(const std::vector<double>& x1, const std::vector<double>& y1, const std::vector<double>& x2,
                          const std::vector<double>& y2) {
  double largest = 0.0;
  for (std::size_t i = 0; i < x1.size(); ++i) largest = std::max(largest, std::abs(y1[i] - at(x2, y2, x1[i])));
  return largest;
}

}  // namespace

LawStudy study_law(const std::filesystem::path& path) {
  const std::string toml = base::read_file(path);
  const render::Scenario scenario = render::read_scenario(toml, path, render::ScenarioChecks::values);
  LawStudy study;
  study.name = scenario.motion.name;
  study.text = leading_comment(toml);
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    std::vector<std::size_t> motions;
    double lowest = 0.0, highest = 0.0;
    for (const sim::MotionSetup& motion : configuration.motions) {
      motions.push_back(study.motions.size());
      study.motions.push_back(motion_of(configuration, motion));
      const std::vector<double>& v = study.motions.back().v_m_s;
      lowest = std::min(lowest, *std::min_element(v.begin(), v.end()));
      highest = std::max(highest, *std::max_element(v.begin(), v.end()));
    }
    study.curves.push_back(curve_of(configuration, lowest, highest));
    study.curves.back().motions = motions;
  }
  const std::vector<LawMotion>& two = study.motions;
  if (two.size() == 2 && study.curves.size() == 2 && two[0].t_s == two[1].t_s) {
    study.x_apart_m = largest_difference(two[0].t_s, two[0].x_m, two[1].t_s, two[1].x_m);
    const LawCurve &a = study.curves[0], &b = study.curves[1];
    if (!a.down_v_m_s.empty() && !b.down_v_m_s.empty()) {
      // Over the range that both cover.
      const double end = std::min(a.down_v_m_s.back(), b.down_v_m_s.back());
      double apart = 0.0;
      for (std::size_t i = 0; i < a.down_v_m_s.size() && a.down_v_m_s[i] <= end; ++i) {
        apart = std::max(apart, std::abs(a.down_a_m_s2[i] - at(b.down_v_m_s, b.down_a_m_s2, a.down_v_m_s[i])));
      }
      study.a_apart_m_s2 = apart;
    }
  }
  return study;
}

namespace {

constexpr double kDistance = 3.0;      // m, of the camera
constexpr double kBesideGlider = 0.1;  // m, visible beyond the outermost glider's middle
constexpr double kAboveTrack = 0.06;   // m, above and below the line of motion: the glider, and the bar under it
constexpr int kLeastHalf = 8;          // px, half of a row's height, for motions so long that gliders are dots
constexpr double kWhite = 400.0;       // code of white, so that the wall is medium grey; codes above 255 become 255
constexpr double kCrf = 26.0;          // of H.264; only the gliders move in the image

std::vector<sim::State> states(const sim::ConfigurationSetup& configuration, const sim::MotionSetup& motion,
                               double rate_hz) {
  std::vector<double> times;
  for (std::size_t k = 0; static_cast<double>(k) <= motion.duration_s * rate_hz + 1e-9; ++k) {
    times.push_back(static_cast<double>(k) / rate_hz);
  }
  return sim::simulate(configuration.body, motion.x0_m, motion.v0_m_s, times).states;
}

/// The scenario as seen by the film's camera. Every configuration is a set-up of its own, because its track is
/// inclined.
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

/// Draws one motion's frames into its row of the film's images, one after another.
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
    const render::FloatImage& expected_e = renderer_.expected(frame);
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
  std::vector<std::uint8_t> image(row_size * rows.size());
  for (std::size_t k = 0; k < film.frames; ++k) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (k < rows[i].frames()) rows[i].draw(k, std::span(image).subspan(i * row_size, row_size));
    }
    writer->write(std::span<const std::uint8_t>(image));
  }
  writer->finish();
  film.mp4 = base::read_file(folder / "film.mp4");
  return film;
}

}  // namespace glidelab::teach
