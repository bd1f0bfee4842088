#include <string>

#include "base/files/file_io.h"
#include "render/scenario/scenario.h"
#include "report/text/why_words.h"
#include "tests/catch.h"
#include "tests/small_scenario.h"
#include "tests/temp_dir.h"
#include "validate/film/run_validation.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

struct Lens {
  std::string name;
  std::string camera;  ///< instead of the small scenario's focal length and place
};

// Fields of 1.6 to 2 m. The fisheye is that of an action camera, 55 degrees off the axis in the corners; the rational
// lens one that five coefficients do not hold exactly.
const Lens kFisheye{"fisheye",
                    "focal_px = [225.0, 225.0]\nlens = \"fisheye\"\n"
                    "distortion = { k1 = 0.045, k2 = 0.012, k3 = -0.009, k4 = 0.001 }\n"
                    "position_m = [0.05, 0.08, 0.95]\n"};
const Lens kRational{"rational",
                     "focal_px = [400.0, 400.0]\nlens = \"rational\"\n"
                     "distortion = { k1 = 0.3, k2 = 0.05, k3 = 0.0, k4 = 0.62, k5 = 0.12, k6 = 0.01 }\n"
                     "position_m = [0.05, 0.08, 1.60]\n"};

std::string scenario_with(const Lens& lens) {
  return with(tests::kSmallScenario, "focal_px = [600.0, 600.0]\nposition_m = [0.05, 0.08, 2.40]\n", lens.camera);
}

}  // namespace

TEST_CASE("a fisheye and a rational lens are calibrated to the paper's figure for the restitution") {
  for (const Lens& lens : {kFisheye, kRational}) {
    const tests::TempDir temp;
    base::write_file(temp / "scenario.toml", scenario_with(lens));
    fs::create_directory(temp / "e");
    fs::create_directory(temp / "e.truth");
    const validate::ValidationResult result = validate::run_validation(render::read_scenario(temp / "scenario.toml"),
                                                                       temp / "e", temp / "e.truth", {{5, 2}, {{}, 2}});
    const validate::Comparison& comparison = result.comparison;
    CAPTURE(lens.name, comparison.restitution.rms_m, comparison.restitution.max_m, comparison.restitution.field_m);
    CHECK(comparison.detected == comparison.frames);
    // 0.1 % of the field of view (section 2.2 of the paper), of 1.6 m.
    CHECK(comparison.restitution.max_m < 1e-3 * 1.6);
    // What the camera's uncertainty does to the fit of the whole motion. (The phase diagram's intervals are tested with
    // the nominal lens; here they are too narrow: alpha is off by 4.9 of its standard deviations with the fisheye.)
    for (const validate::QuantityComparison& quantity : comparison.quantities) {
      if (quantity.estimator != "trajectory") continue;
      CAPTURE(quantity.quantity, quantity.estimator, report::why_words(quantity.why));
      REQUIRE(quantity.error);
      // Fixed seed; four standard deviations of a normal error are exceeded once in 16,000 draws.
      CHECK(std::abs(*quantity.error) < 4.0 * *quantity.sd);
    }
  }
}
