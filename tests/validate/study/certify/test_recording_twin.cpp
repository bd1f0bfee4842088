#include "validate/study/certify/recording_twin.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "sim/force/law_list.h"
#include "test_paths.h"
#include "tests/app/tiny_scenario.h"
#include "tests/catch.h"

using namespace glidelab;
using namespace glidelab::validate;

namespace {

/// Tracks of the tiny scenario's clip, of ten seconds at 1000 frames a second.
RecordingTwin tracks() {
  RecordingTwin twin;
  twin.scenario = render::read_scenario(tests::tiny_scenario(), "tiny.toml", render::ScenarioChecks::values);
  twin.clips.resize(1);
  for (int i = 0; i < 10000; ++i) twin.clips[0].frame_s.push_back(i / 1000.0);
  return twin;
}

MadeTracks record(const RecordingTwin& twin, const TwinChange& change, std::uint64_t seed) {
  TwinStudios studios(0);
  return record_twin(twin, change, seed, studios);
}

std::vector<double> errors_of(const MadeTracks& made) {
  std::vector<double> errors;
  for (std::size_t i = 0; i < made.tracks[0].x_m.size(); ++i)
    errors.push_back(made.tracks[0].x_m[i] - made.truth.clips[0].x_m[i]);
  return errors;
}

/// Mean product of errors that far apart.
double covariance(const std::vector<double>& errors, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = lag; i < errors.size(); ++i) sum += errors[i] * errors[i - lag];
  return sum / static_cast<double>(errors.size() - lag);
}

}  // namespace

TEST_CASE("the positions of a twin scatter with the variance and the autocovariance that are asked for") {
  RecordingTwin twin = tracks();
  twin.clips[0].white_m = 3e-5;
  twin.clips[0].lasting_m = 2e-5;
  twin.clips[0].rho = 0.6;
  const std::vector<double> errors = errors_of(record(twin, {}, 5));
  REQUIRE(errors.size() == 10000);
  // 10,000 values, of which about a quarter count where they last: a variance to 1.4 to 2.8 %; four of those.
  CHECK(std::abs(covariance(errors, 0) / 13e-10 - 1.0) < 0.1);
  CHECK(std::abs(covariance(errors, 1) / (4e-10 * 0.6) - 1.0) < 0.25);
  CHECK(std::abs(covariance(errors, 2) / (4e-10 * 0.36) - 1.0) < 0.4);
  const std::vector<double> half = errors_of(record(twin, {.noise = 0.5}, 5));
  for (const std::size_t i : {0u, 17u, 9999u}) CHECK(std::abs(half[i] - 0.5 * errors[i]) < 1e-15);
}

TEST_CASE("a twin has the recording's frame times, gaps among them, and positions of whole steps where those have") {
  RecordingTwin twin = tracks();
  twin.clips[0].frame_s.erase(twin.clips[0].frame_s.begin() + 100, twin.clips[0].frame_s.begin() + 140);
  twin.clips[0].rounding_m = 1e-3;
  const MadeTracks made = record(twin, {}, 5);
  CHECK(made.tracks[0].t_s == twin.clips[0].frame_s);
  for (const double x_m : made.tracks[0].x_m) CHECK(std::abs(x_m / 1e-3 - std::round(x_m / 1e-3)) < 1e-9);
  const std::vector<double> all = errors_of(record(twin, {.unrounded = true}, 5));
  CHECK(*std::max_element(all.begin(), all.end()) < 1e-12);
  CHECK(record(twin, {.double_rate = true}, 5).tracks[0].t_s.size() == 2 * twin.clips[0].frame_s.size() - 1);
}

TEST_CASE("a scale that is known to a part in a hundred differs from twin to twin, and is right where it is known") {
  RecordingTwin twin = tracks();
  twin.clips[0].frame_s.resize(300);
  twin.scale_sd_relative = 0.01;
  double square = 0.0;
  constexpr int kTwins = 200;
  for (int seed = 0; seed < kTwins; ++seed) {
    const MadeTracks made = record(twin, {}, static_cast<std::uint64_t>(seed));
    CHECK(made.tracks[0].scale_sd_relative == 0.01);
    square += std::pow(made.tracks[0].x_m[0] / made.truth.clips[0].x_m[0] - 1.0, 2) / kTwins;
  }
  // A root mean square of 200 normal numbers is known to 5 %: four of those.
  CHECK(std::abs(std::sqrt(square) / 0.01 - 1.0) < 0.2);
  const MadeTracks known = record(twin, {.camera_known = true}, 1);
  CHECK(known.tracks[0].scale_sd_relative == 0.0);
  CHECK(std::abs(errors_of(known)[0]) < 1e-12);
}

TEST_CASE("every clip twice are clips of the same configuration with noise of their own") {
  RecordingTwin twin = tracks();
  twin.clips[0].white_m = 1e-5;
  const MadeTracks made = record(twin, {.twice = true}, 5);
  REQUIRE(made.tracks.size() == 2);
  CHECK(made.truth.clips[0].x_m == made.truth.clips[1].x_m);
  CHECK(made.tracks[0].x_m != made.tracks[1].x_m);
  CHECK(made.truth.configurations.size() == 1);
  CHECK(made.truth.configurations[0].clips.size() == 2);
}

TEST_CASE("twins follow each explanation as often as it is probable, and their truth is that explanation's") {
  RecordingTwin twin = tracks();
  twin.clips[0].frame_s.resize(200);
  TwinExplanation nominal{twin.scenario.motion.configurations, 0.75, {}}, other = nominal;
  other.probability = 0.25;
  other.configurations[0].body.forces.push_back(sim::laws::quadratic().with({0.3}));
  twin.explanations = {nominal, other};
  int others = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) others += explanation_of(twin, seed) == 1 ? 1 : 0;
  CHECK(std::abs(others - 100) < 4 * 9);  // four times sqrt(400 * 0.25 * 0.75)
  CHECK(truth_of(twin, 0).configurations[0].v_lim_m_s != truth_of(twin, 1).configurations[0].v_lim_m_s);
  CHECK(truth_of(twin, 0).configurations[0].k_over_m_1_s == truth_of(twin, 1).configurations[0].k_over_m_1_s);
  CHECK(truth_of(twin, 0).configurations[0].v_lim_m_s == truth_of(twin, 1, true).configurations[0].v_lim_m_s);
  std::uint64_t first = 0, second = 0;
  while (explanation_of(twin, first) != 0) ++first;
  while (explanation_of(twin, second) != 1) ++second;
  RecordingTwin plain = twin;
  plain.explanations.clear();
  CHECK(record(twin, {}, first).tracks[0].x_m == record(plain, {}, first).tracks[0].x_m);
  CHECK(record(twin, {}, second).tracks[0].x_m != record(plain, {}, second).tracks[0].x_m);
  CHECK(record(twin, {.nominal = true}, second).tracks[0].x_m == record(plain, {}, second).tracks[0].x_m);
}

TEST_CASE("what an explanation leaves displaces a clip by as much as its accelerations make") {
  RecordingTwin twin = tracks();
  twin.clips[0].frame_s.resize(101);  // 0.1 s, in which the drag takes little
  const RecordingTwin plain = twin;
  const TwinExplanation leaves{twin.scenario.motion.configurations, 1.0, {}};
  double scattered = 0.0, wandered = 0.0;
  constexpr int kTwins = 300;
  for (int r = 0; r < kTwins; ++r) {
    const auto seed = static_cast<std::uint64_t>(r);
    const double straight = record(plain, {}, seed).tracks[0].x_m.back();
    twin.explanations = {leaves};
    twin.explanations[0].force_m_s2 = 1e-3;
    CHECK(record(twin, {.alike = true}, seed).tracks[0].x_m.back() == straight);
    scattered += std::pow(record(twin, {}, seed).tracks[0].x_m.back() - straight, 2) / kTwins;
    twin.explanations[0].force_m_s2 = 0.0;
    twin.explanations[0].q_m2_s3 = 1e-6;
    wandered += std::pow(record(twin, {}, seed).tracks[0].x_m.back() - straight, 2) / kTwins;
  }
  // Inclination and friction, each of 1e-3 m/s²: sqrt(2) * 1e-3 * t² / 2. White acceleration: sqrt(q t³ / 3). Drag of
  // K/m below 3/s takes up to K/m t / 3 = 10 %; a root mean square of 300 normal numbers is known to 4 %, four of
  // those.
  CHECK(std::abs(std::sqrt(scattered) / (std::sqrt(2.0) * 1e-3 * 0.005) - 1.0) < 0.26);
  CHECK(std::abs(std::sqrt(wandered) / std::sqrt(1e-6 * 1e-3 / 3.0) - 1.0) < 0.26);
}

TEST_CASE("what an explanation leaves displaces a fall by as much as its accelerations make, up to the vertical") {
  for (const double deg : {85.0, 88.0, 90.0}) {
    INFO(deg);
    RecordingTwin twin = tracks();
    twin.clips[0].frame_s.resize(101);  // 0.1 s
    sim::ConfigurationSetup& cup = twin.scenario.motion.configurations.front();
    cup.body.incline_rad = cup.stated_incline_rad = deg * std::numbers::pi / 180.0;
    cup.body.forces = {sim::laws::viscous().with({0.5 * cup.body.mass_kg})};
    cup.motions.front().v0_m_s = 0.5;  // downhill throughout
    const RecordingTwin plain = twin;
    twin.explanations = {{twin.scenario.motion.configurations, 1.0, {}}};
    twin.explanations[0].force_m_s2 = 0.2;
    double scattered = 0.0, mean = 0.0;
    constexpr int kTwins = 300;
    for (std::uint64_t seed = 0; seed < kTwins; ++seed) {
      const double off_m = record(twin, {}, seed).tracks[0].x_m.back() - record(plain, {}, seed).tracks[0].x_m.back();
      scattered += off_m * off_m / kTwins;
      mean += off_m / kTwins;
    }
    // As above: sqrt(2) * 0.2 * t² / 2, known to 4 %, less the 2 % that the drag takes. The mean of 300 is 0 to within
    // a seventeenth of that; four of each.
    const double wanted = std::sqrt(2.0) * 0.2 * 0.005;
    CHECK(std::abs(std::sqrt(scattered) / wanted - 1.0) < 0.18);
    CHECK(std::abs(mean) < 4.0 * wanted / std::sqrt(300.0));
  }
}

TEST_CASE("half the noise of a sensor leaves its codes as they are") {
  render::Sensor sensor;
  const render::Sensor before = sensor;
  scale_noise(sensor, 0.5);
  CHECK(std::abs(sensor.gain_dn_per_e * sensor.full_well_e - before.gain_dn_per_e * before.full_well_e) < 1e-9);
  // Shot noise of a code c in codes is sqrt(gain c), read noise gain times its electrons.
  CHECK(std::abs(std::sqrt(sensor.gain_dn_per_e / before.gain_dn_per_e) - 0.5) < 1e-12);
  CHECK(std::abs(sensor.gain_dn_per_e * sensor.read_noise_e / (before.gain_dn_per_e * before.read_noise_e) - 0.5) <
        1e-12);
}

TEST_CASE("a filmed twin is the same with a calibration and a stage that were kept as with its own") {
  RecordingTwin twin;
  twin.scenario = render::read_scenario(std::string(tests::kSourceDir) + "/scenarios/rehearsals/filmed.toml");
  twin.scenario.motion.configurations.resize(1);
  twin.scenario.motion.configurations.front().motions.resize(1);
  twin.scenario.motion.configurations.front().motions.front().duration_s = 0.2;
  twin.filmed = true;
  const MadeTracks own = record(twin, {.camera_known = true}, 7);
  const MadeTracks own_marker = record(twin, {.marker = 2.0}, 7), own_noise = record(twin, {.noise = 0.5}, 7);
  TwinStudios studios(2);
  const MadeTracks first = record_twin(twin, {}, 7, studios);
  const MadeTracks kept = record_twin(twin, {.camera_known = true}, 7, studios);
  REQUIRE(own.tracks.size() == 1);
  CHECK(kept.tracks[0].x_m == own.tracks[0].x_m);
  CHECK(kept.tracks[0].t_s == own.tracks[0].t_s);
  CHECK(first.tracks[0].x_m != own.tracks[0].x_m);  // by the calibration
  CHECK(record_twin(twin, {.marker = 2.0}, 7, studios).tracks[0].x_m == own_marker.tracks[0].x_m);
  CHECK(record_twin(twin, {.noise = 0.5}, 7, studios).tracks[0].x_m == own_noise.tracks[0].x_m);
  CHECK(own_marker.tracks[0].x_m != first.tracks[0].x_m);
  CHECK(record_twin(twin, {}, 8, studios).tracks[0].x_m != first.tracks[0].x_m);
}

namespace {

/// Results and diagnosis of one clip that was filmed, and its folder.
struct Filmed {
  core::AnalysisResults results;
  diagnose::Diagnosis diagnosis;
  core::Experiment folder;

  explicit Filmed(const std::string& toml) {
    diagnosis.twin = toml;
    core::ClipResult clip;
    clip.name = "up";
    clip.position_noise_m = 2e-5;
    clip.sightings.resize(20);
    clip.images = std::make_shared<core::ImageRecord>();
    results.clips = {clip};
    diagnose::MeasuredMotion& measured = diagnosis.measured.emplace_back();
    measured.clip = clip.name;
    measured.t_s = {0.0, 1.0};
    folder.camera.emplace();
    folder.marker.emplace();
    folder.clips.resize(1);
  }
};

}  // namespace

TEST_CASE("what no scenario can express is missing in the twins, with the diagnosis's reason, and no cause of theirs") {
  Filmed filmed(tests::tiny_scenario());
  filmed.diagnosis.effects.resize(2);
  filmed.diagnosis.effects[0].id = "track_bow";
  filmed.diagnosis.effects[1].id = "quadratic_drag";
  filmed.diagnosis.twin_lacks = {{"track_bow", "no law"}};
  const RecordingTwin twin = twin_of_recording(filmed.results, filmed.diagnosis, {filmed.folder});
  CHECK(twin.filmed);
  CHECK(twin.causes == std::vector<std::string>{"quadratic_drag"});
  REQUIRE(twin.without.size() == 1);
  const auto* const lack = std::get_if<lacking::Inexpressible>(&twin.without.front());
  REQUIRE(lack != nullptr);
  CHECK(lack->what == "track_bow");
  CHECK(lack->why == "no law");
}

TEST_CASE("filmed twins have no scatter from clip to clip, and say so only where the diagnosis leaves some") {
  Filmed filmed(tests::tiny_scenario());
  filmed.diagnosis.likely_twins.resize(1);
  filmed.diagnosis.likely_twins[0].toml = filmed.diagnosis.twin;
  CHECK(twin_of_recording(filmed.results, filmed.diagnosis, {filmed.folder}).without.empty());
  filmed.diagnosis.likely_twins[0].q_m2_s3 = 1e-7;
  const RecordingTwin twin = twin_of_recording(filmed.results, filmed.diagnosis, {filmed.folder});
  REQUIRE(twin.without.size() == 1);
  CHECK(std::holds_alternative<lacking::ClipScatter>(twin.without.front()));
  CHECK(twin.explanations.front().leaves_nothing());
}

TEST_CASE("a recording whose camera would not see enough is simulated as tracks, with the scenario's error as reason") {
  std::string toml = tests::tiny_scenario();
  const std::string at = "position_m = [0.0, 0.1, 2.4]";
  toml.replace(toml.find(at), at.size(), "position_m = [0.0, 0.1, 0.3]");  // the track is wider than the image
  const Filmed filmed(toml);
  const RecordingTwin twin = twin_of_recording(filmed.results, filmed.diagnosis, {filmed.folder});
  CHECK_FALSE(twin.filmed);
  REQUIRE(twin.without.size() == 1);
  const auto* const images = std::get_if<lacking::Images>(&twin.without.front());
  REQUIRE(images != nullptr);
  CHECK(images->error.find("twin of the recording") != std::string::npos);
}

TEST_CASE("a folder that states a scale has filmed twins, though a pattern would not be in their images") {
  std::string toml = tests::tiny_scenario();
  const std::string at = "[calibration]\n";
  REQUIRE(toml.find(at) != std::string::npos);
  toml.replace(toml.find(at), at.size(), "[calibration]\nplane_x_m = [5.0]\n");
  Filmed filmed(toml);
  CHECK_FALSE(twin_of_recording(filmed.results, filmed.diagnosis, {filmed.folder}).filmed);
  filmed.folder.scale = core::ScaleSetup{180.0, 2.0};
  const RecordingTwin twin = twin_of_recording(filmed.results, filmed.diagnosis, {filmed.folder});
  CHECK(twin.filmed);
  CHECK(twin.by_scale);
  CHECK(twin.without.empty());
}

TEST_CASE("of a folder with a pattern beside one with a scale the twins are by scale, and say what they lack") {
  Filmed filmed(tests::tiny_scenario());
  filmed.results.clips.push_back(filmed.results.clips.front());
  core::Experiment by_pattern = filmed.folder, by_scale = filmed.folder;
  by_pattern.calibration.emplace();
  by_scale.scale = core::ScaleSetup{180.0, 2.0};
  const RecordingTwin twin = twin_of_recording(filmed.results, filmed.diagnosis, {by_pattern, by_scale});
  CHECK(twin.filmed);
  CHECK(twin.by_scale);
  REQUIRE(twin.without.size() == 1);
  CHECK(std::holds_alternative<lacking::Pattern>(twin.without.front()));
  CHECK(twin_of_recording(filmed.results, filmed.diagnosis, {by_pattern, by_pattern}).without.empty());
}

TEST_CASE("a twin by a scale is filmed without a pattern, and its positions are the truth's times the scale's error") {
  RecordingTwin twin;
  twin.scenario = render::read_scenario(tests::tiny_scenario(), "tiny.toml", render::ScenarioChecks::values);
  twin.scenario.motion.configurations.front().motions.front().duration_s = 0.5;
  twin.scenario.marker.diameter_m = 0.06;   // 6 px
  twin.scenario.pattern.plane_x_m = {5.0};  // far outside the image: it must not be looked for
  twin.filmed = twin.by_scale = true;
  const auto path_over_truth = [&](const TwinChange& change) {
    const MadeTracks made = record(twin, change, 7);
    const core::TrackData& track = made.tracks.at(0);
    REQUIRE(track.x_m.size() > 20);
    CHECK(track.shared_m.empty());
    const std::vector<double>& truth = made.truth.clips.at(0).x_m;
    return (track.x_m.back() - track.x_m.front()) / (truth.at(track.frame.back()) - truth.at(track.frame.front()));
  };
  // The camera looks down by 0.1 m in 2.4 m: a metre of the track is shorter by less than a part in a thousand where
  // its middle is seen, and by perspective at its ends; noise of a tenth of a pixel in some fifty.
  const double exact = path_over_truth({});
  CHECK(exact == Approx(1.0).margin(1e-2));
  twin.scale_sd_relative = 0.05;
  const double stated = path_over_truth({});
  CHECK(std::abs(stated / exact - 1.0) > 1e-3);  // one normal deviate of 5 %, drawn with this seed
  CHECK(path_over_truth({.camera_known = true}) == Approx(exact).margin(1e-12));
}
