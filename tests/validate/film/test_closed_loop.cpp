/// The closed loop: a scenario is filmed, the images alone are analysed, and the truth comes back.
#include <cmath>

#include "base/files/file_io.h"
#include "render/scenario/scenario.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "validate/film/run_validation.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

/// One mass of the paper's inclined track (Tables 3 and 4, m1), launched both ways, as its camera would film it.
constexpr const char* kOneMass = R"(format = 1
name = "one mass of the paper, inclined"
gravity_m_s2 = 9.80665
seed = 1

[camera]
width_px = 800
height_px = 600
frame_rate_hz = 200.0
exposure_s = 0.001
focal_px = [1200.0, 1200.0]
center_px = [404.2, 296.3]
position_m = [0.14, 0.12, 2.40]
target_m = [0.0, 0.0, 0.0]
roll_deg = 0.7
distortion = { k1 = -0.12, k2 = 0.06, p1 = 0.0004, p2 = -0.0003 }

[calibration]
inner_corners = [9, 6]
square_m = 0.04
views = 12
plane_rotation_deg = 1.5

[[configuration]]
name = "m1"
mass_kg = 0.335
incline_deg = 4.3110
stated_incline_deg = 4.0
stated_incline_sd_deg = 0.3
group = "m1"
[[configuration.force]]
law = "viscous"
k_over_m_1_s = 2.7680
[[configuration.force]]
law = "coulomb"
mu = 0.0071
[[configuration.clip]]
name = "m1-up"
launched = "up"
x0_m = 0.2
v0_m_s = -1.3
duration_s = 1.7
[[configuration.clip]]
name = "m1-down"
launched = "down"
x0_m = -0.45
v0_m_s = 1.2
duration_s = 1.7
)";

const validate::QuantityComparison& find(const validate::Comparison& comparison, const std::string& quantity) {
  for (const validate::QuantityComparison& compared : comparison.quantities) {
    if (compared.quantity == quantity) return compared;
  }
  throw std::runtime_error("no " + quantity);
}

}  // namespace

TEST_CASE("from images of one mass of the paper, K/m, mu, alpha and v_lim come back within the project's targets",
          "[slow]") {
  const tests::TempDir temp;
  base::write_file(temp / "scenario.toml", kOneMass);
  fs::create_directory(temp / "experiment");
  fs::create_directory(temp / "truth");
  validate::ValidationOptions options;
  options.render.jobs = options.analysis.jobs = 2;
  const validate::ValidationResult result = validate::run_validation(render::read_scenario(temp / "scenario.toml"),
                                                                     temp / "experiment", temp / "truth", options);
  const validate::Comparison& comparison = result.comparison;

  // The targets of the project, which are those of the paper's own figures (tables 1 to 4, section 2.2); about ten of
  // the analysis' standard deviations, so that no honest draw of the noise fails.
  CHECK(std::abs(*find(comparison, "k_over_m_1_s").error) < 0.01 * 2.768);
  CHECK(std::abs(*find(comparison, "mu").error) < 0.0005);
  CHECK(std::abs(*find(comparison, "alpha_deg").error) < 0.02);
  CHECK(std::abs(*find(comparison, "v_lim_m_s").error) < 0.01 * *find(comparison, "v_lim_m_s").truth);
  REQUIRE(comparison.lines.size() == 3);  // up: v < 0 and v > 0; down: v > 0
  for (const validate::LineComparison& line : comparison.lines) {
    INFO(line.clip << " " << line.direction);
    CHECK(line.r2 >= 0.9996);
  }
  CHECK(comparison.restitution.field_m > 0.5);
  CHECK(comparison.restitution.max_m < 1e-3 * comparison.restitution.field_m);
  CHECK(comparison.frames == 680);
  CHECK(comparison.detected == 680);
  CHECK(comparison.wall_s > 0.0);
}
