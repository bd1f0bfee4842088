#include "validate/blind/case/blind_filmed_case.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/experiment/experiment.h"
#include "core/pictures/frames/frame_source.h"
#include "core/pictures/marker/marker_fit.h"
#include "diagnose/effects/effect_library.h"
#include "render/film/render_experiment.h"
#include "render/scenario/scene.h"
#include "sim/motion/simulate.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "validate/blind/case/blind_filmed_effects.h"
#include "validate/blind/case/blind_strength.h"
#include "validate/blind/run_blind.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

/// Renders in this process: what is written is the same.
std::string render_here(const fs::path& scenario, const fs::path& folder) {
  const fs::path truth = folder.string() + ".truth";
  fs::create_directories(folder);
  fs::create_directories(truth);
  const render::Scenario read = render::read_scenario(scenario);
  render::render_experiment(read, folder, truth, {.seed = read.seed, .jobs = 2, .ideal = false, .clips = true});
  return "";
}

std::size_t frames_in(const fs::path& folder, const core::Experiment& experiment, std::size_t c) {
  const auto source =
      core::open_frames(folder / "clips" / (experiment.clips[c].name + ".mkv"), *experiment.camera, false, {});
  std::size_t frames = 0;
  while (source->next()) ++frames;
  return frames;
}

}  // namespace

TEST_CASE("a filmed case is the same for the same seed and index, and another for another one") {
  for (const std::string& id : validate::filmed_effects()) {
    const auto one = validate::make_filmed_case(7, 1, {id}), again = validate::make_filmed_case(7, 1, {id});
    CHECK(validate::filmed_truth_json(one) == validate::filmed_truth_json(again));
    CHECK(one.scenario() != validate::make_filmed_case(7, 2, {id}).scenario());
    REQUIRE(one.causes.size() == 1);
    CHECK(one.causes.front().id == id);
    CHECK(one.causes.front().gain > 0.6 * 8.0);  // what is drawn at least, less what a camera cannot do
    CHECK(one.scene.motion.clips.size() >= 2);
    CHECK(one.scene.motion.clips.size() <= 6);
  }
}

TEST_CASE("what a calibration leaves open is no strength of an effect, and a codec's errors make it weaker") {
  validate::BlindRandom random(3);
  validate::BlindScene scene = validate::draw_scene(random, true);
  REQUIRE(scene.motion.calibration.bend_sd_1_m > 0.0);
  const validate::BlindEffect perspective = validate::draw_effect("perspective_error", scene.motion, random);
  const double size = 0.01;
  validate::BlindDesign design = scene.motion;
  const auto gain = [&] { return validate::BlindDetection(design).gain(perspective, size); };
  const double open = gain();
  design.calibration = {};
  const double sure = gain();
  design.calibration = {1.0, 1.0, 1.0};
  // x/(1 + p x) is x - p x² + p² x³ to 1e-6 of its first part: what a calibration that knows none of these takes up.
  CHECK(gain() < 1e-3 * sure);
  CHECK(open < sure);
  design.calibration = {};
  design.noise_sd_m *= 3.0;
  CHECK(std::abs(gain() / sure - 1.0 / 9.0) < 0.01);  // the square of the noise, but for what is stated of inclinations

  bool any = false;
  for (int k = 0; k < 40; ++k) {
    scene = validate::draw_scene(random, false);
    const double noise_px = scene.motion.noise_sd_m * scene.camera.px_per_m();
    CHECK(noise_px > 0.001);  // of PRNU and the place between pixels
    CHECK((scene.camera.codec == "h264") == (noise_px > 0.05));
    any = any || scene.camera.codec == "h264";
  }
  CHECK(any);
}

TEST_CASE("a friction of each direction is no effect where no inclination is stated, whichever glider comes to rest") {
  // It is the same force as an inclination's, up to cos(alpha): beside 0.35 rad a stated one would have to be known.
  validate::BlindDesign design;
  design.groups = {{"level", 0.0, 0.0, {}}, {"inclined", 0.0506, 0.0506, {}}};
  design.masses = {{0.341, 0.341, 0.0}};
  design.k_n_s_m = 0.541;
  design.mu = 0.0127;
  design.noise_sd_m = 7e-6;
  const double starts[][2] = {{0.34, -0.77}, {-0.4, 0.62}, {0.35, -0.95}, {-0.38, 0.5}};
  for (std::size_t c = 0; c < 4; ++c) {
    design.clips.push_back({"", c / 2, 0, starts[c][0], starts[c][1], 120.0, 150});
  }
  bool rests = false;
  for (const double size : {0.2, 0.35, 0.5}) {
    validate::BlindEffect effect;
    effect.put = [](double d, std::size_t, validate::BlindFilm& film) {
      film.law.changes.push_back([=](double, double v, double, validate::BlindTerms& f) {
        f.friction_n *= 1.0 + d * (v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0);
      });
    };
    CHECK(validate::BlindDetection(design).gain(effect, size) < 5.0);
    for (const validate::BlindClip& clip : design.clips) {
      validate::BlindFilm film = validate::nominal_film(design, clip);
      effect.put(size, 0, film);
      for (const double x : validate::seen_positions(clip, film)) rests = rests || std::isnan(x);
    }
  }
  CHECK(rests);
}

TEST_CASE("every scenario of a filmed case is one that the renderer takes") {
  tests::TempDir temp;
  for (const auto* list : {&validate::filmed_effects(), &validate::filmed_outside_effects()}) {
    for (const std::string& id : *list) {
      for (const std::size_t index : {0, 1, 2, 3}) {
        const auto one = validate::make_filmed_case(11, index, {id});
        INFO(one.scenario());
        const render::Scenario read = render::read_scenario(one.scenario(), temp / "scenario.toml");
        CHECK(read.motion.configurations.size() == one.scene.motion.clips.size());
      }
    }
  }
}

TEST_CASE("a shutter that is open for nearly the whole frame time has no room for uneven times") {
  // Case 97 of this seed had a jitter below zero, which no renderer takes.
  for (const std::size_t index : {96, 97, 98}) CHECK(validate::make_filmed_case(17000, index).scene.jitter_s >= 0.0);
  for (std::size_t index = 0; index < 40; ++index) {
    const validate::FilmedCase one = validate::make_filmed_case(17000, index, {.only = "timestamp_jitter"});
    const validate::BlindCamera& camera = one.scene.camera;
    const double dark_s = 1.0 / camera.rate_hz - camera.exposure_s - camera.line_s * camera.height_px;
    CHECK(one.scene.jitter_s > 0.0);
    CHECK(one.scene.jitter_s <= dark_s / 12.0);
  }
}

TEST_CASE("what a filmed case may have is in the diagnosis' list, and what is outside is not") {
  std::set<std::string> known;
  for (const auto& info : diagnose::effect_list()) known.insert(std::string(info.id));
  for (const std::string& id : validate::filmed_effects()) CHECK(known.contains(id));
  for (const std::string& id : validate::filmed_outside_effects()) CHECK(!known.contains(id));
}

TEST_CASE("a law of the renderer gives the motion that the effect gives the tracks of a blind case") {
  // Two independent integrators, one by the scenario's laws, one by the alteration of forces; both to 1e-9 m or so.
  for (const char* id : {"quadratic_drag", "eddy_rolloff", "power_law_drag", "stribeck", "load_independent_friction",
                         "direction_asymmetry", "rotational_inertia"}) {
    for (const std::size_t index : {0, 1, 2}) {
      const auto one = validate::make_filmed_case(3, index, {id});
      const auto& design = one.scene.motion;
      const auto& cause = one.causes.front();
      const render::Scenario read = render::read_scenario(one.scenario(), "scenario.toml");
      for (std::size_t c = 0; c < design.clips.size(); ++c) {
        auto film = validate::nominal_film(design, design.clips[c]);
        const auto& group = design.groups[design.clips[c].group];
        const double m = design.masses[design.clips[c].mass].true_kg, n = m * 9.80665 * std::cos(group.true_rad);
        const auto p = [&](const char* key) { return cause.parameters.at(key); };
        film.law.changes.push_back([&](double, double v, double, validate::BlindTerms& f) {
          const std::string is(id);
          const double sign = v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0;
          if (is == "quadratic_drag") f.drag_n += p("c_kg_m") * v * std::abs(v);
          if (is == "eddy_rolloff") f.drag_n /= 1.0 + v * v / (p("v_c_m_s") * p("v_c_m_s"));
          if (is == "power_law_drag" && v != 0.0) f.drag_n *= std::pow(std::abs(v), p("n") - 1.0);
          if (is == "stribeck") {
            f.friction_n += design.mu * n * (p("s") - 1.0) * std::exp(-v * v / (p("v_s_m_s") * p("v_s_m_s")));
          }
          if (is == "load_independent_friction") f.friction_n += p("force_n");
          if (is == "direction_asymmetry") f.friction_n *= 1.0 + p("d") * sign;
          if (is == "rotational_inertia") f.inertia_kg += p("mass_kg");
        });
        const auto moved =
            validate::blind_motion(film.law, design.clips[c].x0_m, design.clips[c].v0_m_s, film.true_t_s);
        const auto& setup = read.motion.configurations[c];
        const auto simulated = sim::simulate(setup.body, setup.motions[0].x0_m, setup.motions[0].v0_m_s, film.true_t_s);
        for (std::size_t k = 0; k < moved.size(); ++k) {
          if (moved[k].v_m_s == 0.0) break;  // what holds at rest is not what acts in motion
          INFO(id << " clip " << c << " frame " << k);
          // Nine digits of each number in the scenario.
          REQUIRE(std::abs(moved[k].x_m - simulated.states[k].x_m) < 1e-7);
        }
      }
    }
  }
}

TEST_CASE("a filmed case's folder says nothing of what it withholds, and scratch is gone before the diagnosis") {
  tests::TempDir temp;
  validate::BlindOptions options;
  options.seed = 4;
  options.cases = 1;
  options.images = true;
  options.only = "rolling_shutter";
  std::size_t calls = 0;
  const validate::Diagnoser diagnoser = [&](const fs::path& folder, const fs::path&, const auto&) -> std::string {
    ++calls;
    for (const auto& entry : fs::recursive_directory_iterator(temp / "out")) {
      const std::string path = entry.path().string();
      CHECK(path.find("truth") == std::string::npos);
      CHECK(path.find("making") == std::string::npos);
      CHECK(path.find("scenario") == std::string::npos);
    }
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (!entry.is_regular_file()) continue;
      const std::string bytes = base::read_file(entry.path());
      for (const char* word : {"rolling", "line_readout", "making", "withheld", "blind"}) {
        INFO(entry.path());
        CHECK(bytes.find(word) == std::string::npos);
      }
    }
    const core::Experiment experiment = core::read_experiment(folder);
    CHECK(experiment.camera->shutter == core::Shutter::global);
    return "not diagnosed here";
  };
  const auto outcomes = validate::run_blind(options, temp / "out", diagnoser, base::no_progress, render_here);
  CHECK(calls == 1);
  CHECK(outcomes.front().filmed);
  CHECK(outcomes.front().causes.front().id == "rolling_shutter");
  CHECK(fs::exists(temp / "out" / "truth" / "0000.json"));
  // Goes on where it stopped, and is not mixed with tracks of the same seed.
  validate::run_blind(options, temp / "out", diagnoser, base::no_progress, render_here);
  CHECK(calls == 1);
  options.images = false;
  options.only.clear();
  CHECK_THROWS_AS(validate::run_blind(options, temp / "out", diagnoser), base::InputError);
  options.images = true;
  options.only = "tether";  // of tracks, not of films
  CHECK_THROWS_AS(validate::run_blind(options, temp / "out2", diagnoser), base::InputError);
}

TEST_CASE("frames that a filmed case loses are gone from its clips, and the file does not tell") {
  tests::TempDir temp;
  const auto one = validate::make_filmed_case(6, 0, {"dropped_frames"});
  validate::film_blind_folder(one, temp / "case", temp / "scratch", render_here);
  CHECK(!fs::exists(temp / "scratch"));
  const core::Experiment experiment = core::read_experiment(temp / "case");
  std::size_t lost = 0;
  for (std::size_t c = 0; c < experiment.clips.size(); ++c) {
    const auto& slots = one.scene.retouch.lost[c];
    const auto of_clip = static_cast<std::size_t>(std::count(slots.begin(), slots.end(), 1));
    lost += of_clip;
    CHECK(slots.size() == one.scene.motion.clips[c].frames + of_clip);
    CHECK(frames_in(temp / "case", experiment, c) == one.scene.motion.clips[c].frames);
  }
  CHECK(lost > 0);
  CHECK(base::read_file(temp / "case" / "experiment.toml").find("container") == std::string::npos);
}

TEST_CASE("a glider that a filmed case shows elsewhere is seen there, to what the tracker errs by") {
  tests::TempDir temp;
  const auto one = validate::make_filmed_case(8000, 16, {"lens_distortion"});
  REQUIRE(one.scene.camera.tone == "linear");
  REQUIRE(one.scene.camera.line_s == 0.0);
  validate::film_blind_folder(one, temp / "case", temp / "scratch", render_here);
  const render::Scenario scenario = render::read_scenario(one.scenario(), "scenario.toml");
  const core::Experiment experiment = core::read_experiment(temp / "case");
  const auto& design = one.scene.motion;
  // On the marker's line, by the renderer's camera; half the frames of one clip, the marker's rim within the image.
  const auto source =
      core::open_frames(temp / "case" / "clips" / (experiment.clips[0].name + ".mkv"), *experiment.camera, false, {});
  const double incline = design.groups[design.clips[0].group].true_rad;
  const sim::Trajectory true_motion = [&] {
    const auto& setup = scenario.motion.configurations[0];
    std::vector<double> t_s;
    for (std::size_t k = 0; k < design.clips[0].frames; ++k)
      t_s.push_back(static_cast<double>(k) / one.scene.camera.rate_hz + 0.5 * one.scene.camera.exposure_s);
    return sim::simulate(setup.body, setup.motions[0].x0_m, setup.motions[0].v0_m_s, t_s);
  }();
  double most_px = 0.0, most_moved_px = 0.0;
  for (std::size_t k = 0; const auto frame = source->next(); ++k) {
    const double x = true_motion.states[k].x_m, shown = one.scene.retouch.shown_at[0](x);
    const auto at = [&](double place) {
      return *render::project(scenario.camera, render::marker_position_W(scenario, incline, place));
    };
    const Eigen::Vector2d expected = at(shown);
    const auto found =
        core::fit_marker({frame->grey}, {{expected.x(), expected.y()}, 0.01 * one.scene.camera.px_per_m(), 0.5, {}},
                         core::Surface::uniform);
    REQUIRE(found);
    most_px = std::max(most_px, std::hypot(found->centre.x - expected.x(), found->centre.y - expected.y()));
    most_moved_px = std::max(most_moved_px, std::abs(at(x).x() - expected.x()));
  }
  CHECK(most_moved_px > 0.2);
  // Noise of 0.003 px, five times that of the farthest of 150; the ellipse's centre is off the disc's by less than
  // r² / (px of distance) = 36 / 1e5.
  CHECK(most_px < 0.02);
}

TEST_CASE("a renderer that fails is an error that names the case") {
  tests::TempDir temp;
  const auto one = validate::make_filmed_case(6, 0);
  const auto fails = [](const fs::path&, const fs::path&) -> std::string { return "no graphics"; };
  CHECK_THROWS_WITH(validate::film_blind_folder(one, temp / "case", temp / "scratch", fails),
                    "rendering blind case 0 of seed 6: no graphics");
}
