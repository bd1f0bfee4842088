#include <algorithm>
#include <cmath>
#include <string>

#include "base/files/file_io.h"
#include "diagnose/verdict/diagnose.h"
#include "render/film/render_experiment.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "validate/film/twin_motions.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

/// The first place where `what` stands.
void replace(std::string& text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  text.replace(at, what.size(), by);
}

/// scenarios/rehearsals/filmed.toml with a section more, of which experiment.toml tells nothing.
diagnose::Diagnosis film(const std::string& section, std::uint64_t seed) {
  const tests::TempDir temp;
  std::string text = base::read_file(fs::path(tests::kSourceDir) / "scenarios" / "rehearsals" / "filmed.toml");
  replace(text, "[calibration]\n", section + "\n[calibration]\n");
  base::write_file(temp / "scenario.toml", text);
  fs::create_directory(temp / "experiment");
  fs::create_directory(temp / "truth");
  render::render_experiment(render::read_scenario(temp / "scenario.toml"), temp / "experiment", temp / "truth",
                            {.seed = seed, .jobs = 2, .ideal = false, .clips = true});
  std::string stated = base::read_file(temp / "experiment" / "experiment.toml");
  if (const std::size_t at = stated.find("shutter = \"rolling\""); at != std::string::npos) {
    replace(stated, "shutter = \"rolling\"", "shutter = \"global\"");
    const std::size_t line = stated.find("line_readout_s");
    stated.erase(line, stated.find('\n', line) + 1 - line);
    base::write_file(temp / "experiment" / "experiment.toml", stated);
  }
  return diagnose::diagnose({temp / "experiment"}, {.without = {}, .jobs = 2, .twin = true});
}

diagnose::DiagnosedParameter size(const diagnose::Diagnosis& diagnosis, const std::string& id, const std::string& key) {
  for (const diagnose::DiagnosedEffect& effect : diagnosis.effects) {
    for (const diagnose::DiagnosedParameter& parameter : effect.parameters) {
      if (effect.id == id && parameter.key == key) return parameter;
    }
  }
  FAIL("no " << id << "." << key);
  return {};
}

/// The camera of filmed.toml, as the twin has it.
void check_camera(const render::Scenario& twin) {
  CHECK(twin.camera.width_px == 640);
  CHECK(twin.camera.height_px == 240);
  // Eight small views of a board of 24 corners know the focal length to 0.2 to 0.5 %, and with it the distance.
  CHECK(std::abs(twin.camera.focal_px.x() / 760.0 - 1.0) < 0.02);
  CHECK(std::abs(twin.camera.X_WC.translation().z() / 1.30 - 1.0) < 0.02);
  CHECK(std::abs(twin.camera.X_WC.translation().y() - 0.06) < 0.02);
  // What counts: a metre of the track has as many pixels.
  CHECK(std::abs(twin.camera.focal_px.x() / twin.camera.X_WC.translation().z() / (760.0 / 1.30) - 1.0) < 2e-3);
  CHECK(twin.pattern.inner_columns == 7);
  CHECK(twin.pattern.square_m == 0.04);
  CHECK(twin.recording.frame_rate_hz == 120.0);
}

}  // namespace

TEST_CASE("a twin of a film has the line time that was withheld, before the camera that filmed", "[slow]") {
  const auto diagnosis = film("[shutter]\nkind = \"rolling\"\nline_readout_s = 3e-5\n", 3);
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  CHECK(diagnosis.twin_lacks.empty());
  const render::Scenario twin = render::read_scenario(diagnosis.twin, "twin.toml");  // with all checks
  const diagnose::DiagnosedParameter line = size(diagnosis, "rolling_shutter", "line_s");
  REQUIRE(twin.recording.shutter.rolling);
  CHECK(std::abs(twin.recording.shutter.line_readout_s - 3e-5) < 4.0 * line.sd);  // 6e-5 by chance
  CHECK_FALSE(twin.recording.shutter.bottom_first);
  check_camera(twin);
}

TEST_CASE("a twin of a film has the flicker that was withheld, and moves as the film does", "[slow]") {
  const auto diagnosis = film("[light]\nflicker_depth = 0.05\nflicker_hz = 100.0\n", 22);
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  CHECK(diagnosis.twin_lacks.empty());
  const render::Scenario twin = render::read_scenario(diagnosis.twin, "twin.toml");
  CHECK(twin.light.flicker_depth ==
        Approx(size(diagnosis, "light_flicker", "depth").value).epsilon(1e-5));  // six digits
  // The patches' mean passes some percent less than the light's own depth.
  CHECK(std::abs(twin.light.flicker_depth - 0.05) < 0.003);
  CHECK(std::abs(twin.light.flicker_hz - 100.0) < 1e-9);
  check_camera(twin);
  double square = 0.0, noise = 0.0;
  for (const validate::TwinMotion& motion : validate::twin_motions(diagnosis, 1)) {
    REQUIRE(motion.t_s.size() > 80);
    for (const double x : motion.rest_m) square += x * x;
    for (const double x : motion.noise_m) noise += x * x;
  }
  // Errors by the place between pixels last over frames, and count as noise of the data.
  CHECK(std::sqrt(square / noise) < 2.0);
}
