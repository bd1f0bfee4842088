#include <algorithm>
#include <cmath>
#include <string>

#include "base/files/file_io.h"
#include "diagnose/verdict/diagnose.h"
#include "render/film/render_experiment.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "validate/truth/truth_folder.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

constexpr double kRateHz = 120.0;  // of scenarios/rehearsals/filmed.toml

struct Kind {
  const char* name;
  const char* exposure;  // a line of [camera]
  const char* sections;  // of the camera, besides
  double readout_s;      // of a whole image
};

const Kind kIndustrial{"industrial, raw", "", "[sensor]\nfull_well_e = 10000\nread_noise_e = 12\nprnu = 0.01\n", 0.0};
const Kind kWebcam{"webcam, MJPEG", "exposure_s = 0.004\n",
                   "[sensor]\nfull_well_e = 10000\nread_noise_e = 10\ntone = \"gamma\"\ngamma = 2.2\n"
                   "[shutter]\nkind = \"rolling\"\nline_readout_s = 1.5e-5\n[codec]\nname = \"mjpeg\"\nquality = 85\n",
                   240 * 1.5e-5};
const Kind kPhone{"phone, H.264", "",
                  "[sensor]\nfull_well_e = 12000\nread_noise_e = 8\n[codec]\nname = \"h264\"\ncrf = 18\n", 0.0};

void replace(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
}

struct Filmed {
  validate::Truth truth;
  diagnose::Diagnosis diagnosis;
};

/// scenarios/rehearsals/filmed.toml before such a camera, with these forces besides.
Filmed film(const Kind& kind, const std::string& forces, std::uint64_t seed) {
  const tests::TempDir temp;
  std::string text = base::read_file(fs::path(tests::kSourceDir) / "scenarios" / "rehearsals" / "filmed.toml");
  replace(text, "[camera]\n", std::string("[camera]\n") + kind.exposure);
  replace(text, "[calibration]\n", std::string(kind.sections) + "\n[calibration]\n");
  replace(text, "[[configuration.force]]\nlaw = \"coulomb\"\n",
          forces + "[[configuration.force]]\nlaw = \"coulomb\"\n");
  base::write_file(temp / "scenario.toml", text);
  fs::create_directory(temp / "experiment");
  fs::create_directory(temp / "truth");
  render::render_experiment(render::read_scenario(temp / "scenario.toml"), temp / "experiment", temp / "truth",
                            {.seed = seed, .jobs = 2, .ideal = false, .clips = true});
  diagnose::DiagnoseOptions options;
  options.jobs = 2;
  return {validate::read_truth(temp / "truth"), diagnose::diagnose({temp / "experiment"}, options)};
}

/// Whether the truth holds what the nominal model says, and no more: one K and one mu for all masses.
bool usual(const validate::Truth& truth) {
  return std::all_of(truth.configurations.begin(), truth.configurations.end(), [&](const auto& c) {
    const auto& first = truth.configurations.front();
    return c.k_over_m_1_s && c.mu &&
           std::abs(*c.k_over_m_1_s * c.mass_kg / (*first.k_over_m_1_s * first.mass_kg) - 1.0) < 1e-4 &&
           *c.mu == *first.mu;
  });
}

/// The farthest that a fitted speed is from the true one.
double off_m_s(const Filmed& filmed) {
  double most = 0.0;
  for (const diagnose::ResidualCurve& curve : filmed.diagnosis.residuals) {
    const auto clip = std::find_if(filmed.truth.clips.begin(), filmed.truth.clips.end(),
                                   [&](const auto& one) { return one.name == curve.clip; });
    REQUIRE(clip != filmed.truth.clips.end());
    for (std::size_t p = 0; p < curve.t_s.size(); ++p) {
      const auto row = std::lround(curve.t_s[p] * kRateHz);
      most = std::max(most, std::abs(curve.v_m_s[p] - clip->v_m_s.at(static_cast<std::size_t>(row))));
    }
  }
  return most;
}

}  // namespace

TEST_CASE("a film with nothing wrong is found to lack nothing, whatever the camera, and one with an air drag has it",
          "[slow]") {
  for (const Kind& kind : {kIndustrial, kWebcam, kPhone}) {
    INFO(kind.name);
    const Filmed clean = film(kind, "", 51);
    REQUIRE(usual(clean.truth));
    INFO("none " << clean.diagnosis.none << ", unknown " << clean.diagnosis.unknown);
    // What a file says of itself withholds nothing.
    const bool told = clean.diagnosis.verdict == diagnose::Verdict::effect && clean.diagnosis.effects.size() == 1 &&
                      clean.diagnosis.effects.front().id == "compression";
    CHECK((clean.diagnosis.verdict == diagnose::Verdict::none || told));
    // Lengths are known to 1.5e-4 of 1.2 m/s; a second of H.264's positions, 0.03 px of 600 a metre that last for five
    // frames, give a speed to 0.1 mm/s. Five of both together. The marker's row is read by up to
    // half a readout off the middle row's time, which the truth counts from; it slows down by 4 m/s² at most.
    CHECK(off_m_s(clean) < 1e-3 + 0.5 * kind.readout_s * 4.0);
  }
  // 0.03 kg/m takes 0.04 N of 1.1 N at 1.2 m/s: thousands of standard deviations without loss.
  const Filmed dragged = film(kIndustrial, "[[configuration.force]]\nlaw = \"quadratic\"\nc_kg_m = 0.03\n", 52);
  CHECK(!usual(dragged.truth));
  REQUIRE(dragged.diagnosis.verdict == diagnose::Verdict::effect);
  CHECK(dragged.diagnosis.effects.front().id == "quadratic_drag");
}
