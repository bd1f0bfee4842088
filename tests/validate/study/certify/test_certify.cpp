#include "validate/study/certify/certify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/motion/lines/line_fit.h"
#include "core/result/quantity.h"
#include "core/result/why_unknown.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/twin/twin.h"
#include "diagnose/verdict/diagnose.h"
#include "sim/force/law_list.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "validate/made_tracks/made_tracks.h"
#include "validate/made_tracks/outside_runs.h"

using namespace glidelab;
using namespace glidelab::validate;

namespace {

constexpr double kNoise_m = 5e-5;

/// The first mass of the paper's inclined track: one clip up, which turns, and one down.
render::Scenario one_mass() {
  render::Scenario scenario = render::read_scenario(std::string(tests::kSourceDir) + "/scenarios/paper/inclined.toml");
  scenario.motion.configurations.resize(1);
  return scenario;
}

/// One recording of the scenario's motions, as a folder of tracks.
void record(const render::Scenario& scenario, const std::filesystem::path& folder, double noise_m = kNoise_m) {
  write_track_folder(with_noise(make_tracks(scenario, 3), noise_m, 3), folder);
}

struct Direct {
  std::size_t covered = 0, answered = 0;
  double square = 0.0;
  double share() const { return static_cast<double>(covered) / static_cast<double>(answered); }
  double rms() const { return std::sqrt(square / static_cast<double>(answered)); }
};

/// What an estimator does in recordings of the true scenario, quantity by quantity.
std::vector<Direct> direct(const render::Scenario& scenario, std::size_t runs, double noise_m = kNoise_m) {
  std::vector<Direct> all(core::kQuantities.size());
  std::mt19937_64 engine(77);
  std::normal_distribution<double> deviate;
  for (std::size_t r = 0; r < runs; ++r) {
    render::Scenario one = scenario;
    one.recording.clock.rate_error_ppm = 1e6 * core::kClockSdRelative * deviate(engine);
    const MadeTracks made = with_noise(make_tracks(one, 5000 + r), noise_m, 5000 + r);
    const core::AnalysisResults results = fit::default_estimator().estimate(
        analyze_tracks(made, core::MotionOptions{.lines = fit::default_estimator().lines}), {});
    for (std::size_t q = 0; q < all.size(); ++q) {
      const core::QuantityName& name = core::kQuantities[q];
      const double truth = *core::value_of(made.truth.configurations.front(), name.which);
      const std::optional<core::Estimate>& found = core::value_of(results.configurations.front(), name.which).estimate;
      if (!found) continue;
      ++all[q].answered;
      all[q].covered += found->low95 <= truth && truth <= found->high95 ? 1 : 0;
      all[q].square += std::pow(found->value - truth, 2);
    }
  }
  return all;
}

}  // namespace

TEST_CASE("twins of a track predict the errors and the coverage of the scenario that it comes from") {
  constexpr std::size_t kRuns = 80;
  const tests::TempDir temp;
  record(one_mass(), temp / "made");
  const Certificate certificate = certify({temp / "made"}, {.runs = kRuns, .seed = 4, .jobs = 2});
  CHECK_FALSE(certificate.filmed);
  CHECK(certificate.clips == 2);
  CHECK(certificate.holds());
  CHECK(certificate.causes.empty());
  const std::vector<Direct> truly = direct(one_mass(), kRuns);
  REQUIRE(certificate.quantities.size() == truly.size());
  for (std::size_t q = 0; q < truly.size(); ++q) {
    const CertifiedQuantity& predicted = certificate.quantities[q];
    INFO(predicted.quantity);
    CHECK(predicted.quantity == core::kQuantities[q].key);
    CHECK(predicted.asked == kRuns);
    REQUIRE(predicted.failed == 0);
    // The logarithm of a root mean square of 80 normal numbers has the sd 1 / sqrt(160) = 0.08, that of two 0.11; the
    // twins' noise is that of one recording, whose 600 positions know it to 0.03. Four of those together.
    CHECK(std::abs(std::log(predicted.rms / truly[q].rms())) < 0.46);
    // The sd of the difference of two shares of 0.95 in 80 is 0.034; four of those.
    CHECK(std::abs(predicted.coverage.share - truly[q].share()) < 0.14);
    CHECK(predicted.coverage.low <= predicted.coverage.share);
    CHECK(predicted.coverage.share <= predicted.coverage.high);
  }
}

TEST_CASE("twins repeat every flight of a cart that bounces, and so have values of mu and alpha") {
  // dv/dt = g sin α - K/m v - sign(v) µ g cos α, in steps of 0.1 ms; at the stop the cart keeps 0.8 of its speed.
  const double alpha = 2.0 * std::numbers::pi / 180.0, g = 9.80665, mu = 0.003, k_over_m = 0.1, stop_m = 0.9;
  std::mt19937_64 engine(5);
  std::normal_distribution<double> noise(0.0, 2e-4);
  std::string table = "t_s,x_m\n";
  double x = 0.0, v = 0.0;
  for (int step = 0; step <= 120000; ++step) {
    if (step % 100 == 0) table += fmt::format("{:.2f},{:.7f}\n", 3.0 + 1e-4 * step, x + noise(engine));
    v += 1e-4 * (g * std::sin(alpha) - k_over_m * v - (v < 0.0 ? -1.0 : 1.0) * mu * g * std::cos(alpha));
    x += 1e-4 * v;
    if (x > stop_m && v > 0.0) v *= -0.8;
  }
  const tests::TempDir temp;
  base::write_file(temp / "cart.csv", table);
  CertifyOptions options{.runs = 20, .seed = 4, .jobs = 2, .changes = false};
  options.bare.mass_kg = 0.5;
  options.bare.incline_deg = 2.0;
  const Certificate certificate = certify({temp / "cart.csv"}, options);
  CHECK(certificate.clips == 1);
  CHECK(certificate.motions >= 3);  // 2.3 s down, then flights of 3.7 s, 3 s, …: twelve seconds
  std::size_t known = 0;
  for (const CertifiedQuantity& quantity : certificate.quantities) {
    INFO(quantity.quantity);
    if (quantity.quantity == "v_lim_m_s") continue;
    CHECK(quantity.answered() >= 18);
    ++known;
  }
  CHECK(known == 3);
}

namespace {

/// A cup that falls from rest for a second, twice.
render::Scenario falls() {
  render::Scenario fall = one_mass();
  sim::ConfigurationSetup& cup = fall.motion.configurations.front();
  cup.body.incline_rad = cup.stated_incline_rad = 0.5 * std::numbers::pi;
  cup.stated_incline_sd_rad = 0.02;
  cup.body.forces = {sim::laws::viscous().with({5.0 * cup.body.mass_kg})};
  for (sim::MotionSetup& motion : cup.motions) {
    motion.x0_m = motion.v0_m_s = 0.0;
    motion.launched = sim::Launched::released;
    motion.duration_s = 1.0;
  }
  return fall;
}

}  // namespace

TEST_CASE("a recording of falls is certified: twins of it fall") {
  const tests::TempDir temp;
  record(falls(), temp / "made", 1e-4);
  constexpr std::size_t kRuns = 20;
  const Certificate certificate = certify({temp / "made"}, {.runs = kRuns, .seed = 4, .jobs = 2, .changes = false});
  REQUIRE_FALSE(certificate.quantities.empty());
  const CertifiedQuantity& drag = certificate.quantities.front();
  CHECK(drag.quantity == "k_over_m_1_s");
  CHECK(drag.failed == 0);
  CHECK(drag.coverage.share > 0.7);  // 0.95 has the standard deviation 0.05 in 20 twins; five of those
}

TEST_CASE("the twin of a fall is a scenario, on whichever side of the vertical the fit of its inclination ends") {
  const MadeTracks made = with_noise(make_tracks(falls(), 3), 1e-4, 3);
  const diagnose::TrackSet set = diagnose::track_set(analyze_tracks(made, core::MotionOptions{}), made.setups, true);
  const diagnose::MotionFit fit = diagnose::fit_nominal(set);
  constexpr double kDegree = std::numbers::pi / 180.0;
  // sin(180° - alpha) = sin(alpha)
  for (const auto& [fitted_deg, twin_deg] : std::vector<std::pair<double, double>>{
           {89.0, 89.0}, {90.0, 90.0}, {90.3, 89.7}, {91.0, 89.0}, {-89.0, -89.0}, {-91.0, -89.0}}) {
    INFO(fitted_deg);
    diagnose::MotionFit ends = fit;
    std::size_t inclinations = 0;
    const auto& globals = ends.layout->globals();
    for (std::size_t g = 0; g < globals.size(); ++g) {
      if (globals[g].kind != diagnose::ParameterLayout::Global::Kind::alpha) continue;
      ends.at.global[static_cast<Eigen::Index>(g)] = fitted_deg * kDegree;
      ++inclinations;
    }
    REQUIRE(inclinations == 1);
    const render::Scenario twin = render::read_scenario(diagnose::twin_of(set, ends, {}, false, {}).toml, "twin.toml",
                                                        render::ScenarioChecks::values);
    const double read_deg = twin.motion.configurations.front().body.incline_rad / kDegree;
    CHECK(std::abs(read_deg - twin_deg) < 1e-9);  // twelve digits in the file
  }
}

TEST_CASE("half the noise halves the errors of a track, and the certificate says that this would help most") {
  const tests::TempDir temp;
  record(one_mass(), temp / "made");
  // The next best change, twice the frame rate, gains 1 - 1/sqrt(2) = 0.29. Its deviates are others, so that it is
  // known to 0.71 / sqrt(120) = 0.06 with 120 twins: 0.5 is more than three of those away.
  const Certificate certificate = certify({temp / "made"}, {.runs = 120, .seed = 4, .jobs = 2});
  REQUIRE_FALSE(certificate.changes.empty());
  const ChangedTwin& first = certificate.changes.front();
  CHECK(first.limit == TwinLimit::position_noise);
  CHECK(first.stands_out);
  REQUIRE(first.together);
  // The same deviates at half their size: errors are half as large where they are linear in the noise and nothing else
  // matters. The clock adds 20 ppm, and the bandwidth follows the noise.
  CHECK(first.together->value > 0.35);
  CHECK(first.together->value < 0.6);
  CHECK(std::is_sorted(certificate.changes.begin(), certificate.changes.end(),
                       [](const auto& a, const auto& b) { return a.together->value > b.together->value; }));
}

TEST_CASE("changes of a filmed recording are filmed five times, and ten times only where that leaves them open") {
  RecordingTwin twin;
  twin.scenario = render::read_scenario(std::string(tests::kSourceDir) + "/scenarios/rehearsals/filmed.toml");
  twin.scenario.motion.configurations.resize(1);
  twin.scenario.pattern.views = 4;
  twin.filmed = true;
  const Certificate certificate = certify_twin(twin, {.runs = 20, .jobs = 2});
  CHECK(certificate.runs == 20);
  REQUIRE(certificate.changes.size() == 4);  // noise, marker, calibration, every clip twice
  std::size_t decided = 0;
  for (const ChangedTwin& change : certificate.changes) {
    INFO(static_cast<int>(change.limit) << ": " << change.runs);
    REQUIRE(change.together);
    if (change.runs == 5) {
      ++decided;
      CHECK((change.stands_out || change.together->high < 0.1));
    } else {
      CHECK(change.runs == 10);
    }
  }
  CHECK(decided > 0);
}

TEST_CASE("intervals of lines that leave out a drag are said not to hold") {
  const render::Scenario scenario = render::read_scenario(std::string(tests::kSourceDir) + "/scenarios/tutorial.toml");
  const tests::TempDir temp;
  record(scenario, temp / "made", 2e-5);
  const Certificate certificate = certify({temp / "made"}, {.runs = 20, .seed = 1, .jobs = 2});
  CHECK(certificate.causes == std::vector<std::string>{"quadratic_drag"});
  CHECK_FALSE(certificate.holds());
  CHECK(certificate.together.high < 0.95);
  const auto drag = std::find_if(certificate.quantities.begin(), certificate.quantities.end(),
                                 [](const CertifiedQuantity& one) { return one.quantity == "k_over_m_1_s"; });
  REQUIRE(drag != certificate.quantities.end());
  CHECK(drag->too_narrow());
  CHECK(std::abs(drag->bias_sds.value) > 3.0);
}

TEST_CASE("a certificate does not depend on the number of threads") {
  const tests::TempDir temp;
  record(one_mass(), temp / "made");
  const Certificate one = certify({temp / "made"}, {.runs = 20, .seed = 9, .jobs = 1});
  const Certificate two = certify({temp / "made"}, {.runs = 20, .seed = 9, .jobs = 3});
  REQUIRE(one.quantities.size() == two.quantities.size());
  for (std::size_t q = 0; q < one.quantities.size(); ++q) {
    CHECK(one.quantities[q].rms == two.quantities[q].rms);
    CHECK(one.quantities[q].bias_sds.value == two.quantities[q].bias_sds.value);
    CHECK(one.quantities[q].coverage.holds == two.quantities[q].coverage.holds);
  }
  REQUIRE(one.changes.size() == two.changes.size());
  for (std::size_t i = 0; i < one.changes.size(); ++i) {
    CHECK(one.changes[i].limit == two.changes[i].limit);
    CHECK(one.changes[i].together->value == two.changes[i].together->value);
  }
}

namespace {

/// A recording of tracks of one mass, thirty positions a second.
RecordingTwin coarse_tracks() {
  RecordingTwin twin;
  twin.scenario = one_mass();
  for (const sim::MotionSetup& motion : twin.scenario.motion.configurations.front().motions) {
    ClipNoise& clip = twin.clips.emplace_back();
    clip.white_m = kNoise_m;
    for (int i = 0; i < 30.0 * motion.duration_s; ++i) clip.frame_s.push_back(i / 30.0);
  }
  return twin;
}

std::vector<TwinLimit> limits_of(const Certificate& certificate) {
  std::vector<TwinLimit> limits;
  for (const ChangedTwin& change : certificate.changes) limits.push_back(change.limit);
  std::sort(limits.begin(), limits.end());
  return limits;
}

}  // namespace

TEST_CASE("each limitation that a recording has is taken away in turn, and none that it has not") {
  RecordingTwin twin = coarse_tracks();
  const Certificate plain = certify_twin(twin, {.runs = 20, .jobs = 2});
  CHECK(limits_of(plain) ==
        std::vector<TwinLimit>{TwinLimit::position_noise, TwinLimit::frame_rate, TwinLimit::few_clips});
  REQUIRE(plain.setups.size() == 1);
  const sim::ConfigurationSetup& only = twin.scenario.motion.configurations.front();
  CHECK(plain.setups.front().name == only.name);
  CHECK(plain.setups.front().mass_kg == only.body.mass_kg);
  CHECK(plain.setups.front().incline_rad == only.stated_incline_rad);
  CHECK(plain.configurations.empty());  // one is all
  for (const CertifiedQuantity& quantity : plain.quantities) CHECK_FALSE(quantity.setup);

  twin.scale_sd_relative = 0.01;
  twin.clips.front().rounding_m = 1e-4;
  twin.causes = {"quadratic_drag"};
  TwinExplanation drag{twin.scenario.motion.configurations, 1.0, twin.causes};
  drag.configurations.front().body.forces.push_back(sim::laws::quadratic().with({0.05}));
  drag.force_m_s2 = 1e-3;
  twin.explanations = {drag};
  const Certificate full = certify_twin(twin, {.runs = 20, .jobs = 2});
  CHECK(limits_of(full) == std::vector<TwinLimit>{TwinLimit::position_noise, TwinLimit::frame_rate, TwinLimit::scale,
                                                  TwinLimit::rounding, TwinLimit::cause, TwinLimit::clip_scatter,
                                                  TwinLimit::few_clips});
  for (const ChangedTwin& change : full.changes)
    CHECK(change.causes == (change.limit == TwinLimit::cause ? twin.causes : std::vector<std::string>{}));
}

TEST_CASE("a quantity that no twin answers has the reason of the analysis") {
  RecordingTwin twin = coarse_tracks();
  for (ClipNoise& clip : twin.clips) clip.frame_s.resize(2);
  const Certificate short_clips = certify_twin(twin, {.runs = 20, .jobs = 2, .changes = false});
  CHECK(short_clips.empty());
  REQUIRE_FALSE(short_clips.quantities.empty());
  CHECK(short_clips.quantities.front().answered() == 0);
  REQUIRE(short_clips.quantities.front().why);
}

TEST_CASE("a table of lines and too few twins are refused, each with one error") {
  const tests::TempDir temp;
  base::write_file(temp / "lines.csv",
                   "mass_kg,incline_deg,direction,k_over_m_1_s,k_sd_1_s,a0_m_s2,a0_sd_m_s2\n"
                   "0.3,0,up,2.7,0.01,0.07,0.001\n");
  CHECK_THROWS_WITH(certify({temp / "lines.csv"}, {}), Catch::Contains("a table of lines"));
  record(one_mass(), temp / "made");
  CHECK_THROWS_WITH(certify({temp / "made"}, {.runs = 5}), Catch::Contains("20 to 200"));
}

TEST_CASE("over thirty recordings of tracks the predicted coverage is what it then is", "[slow]") {
  // One mass of the paper's inclined track each, launched at 0.8 to 1.2 of its speeds, with
  // noise of 10 to 200 µm and, in every third recording, a second clip each way.
  constexpr std::size_t kRecordings = 30, kRuns = 40;
  const render::Scenario paper =
      render::read_scenario(std::string(tests::kSourceDir) + "/scenarios/paper/inclined.toml");
  std::mt19937_64 engine(31);
  std::uniform_real_distribution<double> uniform;
  double predicted = 0.0, actual = 0.0, values = 0.0, logarithms = 0.0, logarithm_squares = 0.0;
  for (std::size_t i = 0; i < kRecordings; ++i) {
    render::Scenario scenario = paper;
    scenario.motion.configurations = {paper.motion.configurations[i % 3]};
    sim::ConfigurationSetup& setup = scenario.motion.configurations.front();
    for (sim::MotionSetup& motion : setup.motions) motion.v0_m_s *= 0.8 + 0.4 * uniform(engine);
    if (i % 3 == 0) {
      const std::vector<sim::MotionSetup> once = setup.motions;
      for (sim::MotionSetup motion : once) {
        motion.name += "b";
        motion.v0_m_s *= 0.95;
        setup.motions.push_back(motion);
      }
    }
    const double noise_m = 1e-5 * std::pow(20.0, uniform(engine));
    const tests::TempDir temp;
    record(scenario, temp / "made", noise_m);
    const Certificate certificate =
        certify({temp / "made"}, {.runs = kRuns, .seed = 100 + i, .jobs = 2, .changes = false});
    const std::vector<Direct> truly = direct(scenario, kRuns, noise_m);
    for (std::size_t q = 0; q < truly.size(); ++q) {
      const CertifiedQuantity& one = certificate.quantities[q];
      if (one.answered() == 0 || truly[q].answered == 0) continue;
      predicted += one.coverage.share;
      actual += truly[q].share();
      const double logarithm = std::log(one.rms / truly[q].rms());
      logarithms += logarithm;
      logarithm_squares += logarithm * logarithm;
      values += 1.0;
    }
  }
  const double mean = logarithms / values;
  WARN(values << " quantities: predicted coverage " << predicted / values << ", actual " << actual / values
              << "; ln(predicted rms / actual rms): mean " << mean << ", sd "
              << std::sqrt(logarithm_squares / values - mean * mean));
  // Each share of 40 has an sd of 0.034, the mean over 30 recordings (quantities of one go together) of the difference
  // 0.034 sqrt(2 / 30) = 0.009: three of those.
  CHECK(std::abs(predicted - actual) / values < 0.027);
}
