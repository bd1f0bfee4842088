#include "core/motion/speed_motion.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "base/errors.h"
#include "core/motion/configurations.h"
#include "core/track/bare_track.h"
#include "core/track/track_data.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

constexpr double kGravity = 9.81, kDrag_1_s = 0.12, kMu = 0.004, kAlpha_deg = 1.0, kStep_s = 0.02;
constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kPoints = 500;

/// The closed form of v' = g sin(alpha) - sign(v) mu g cos(alpha) - k v with v(0) = -0.8 m/s: up, a turn, down.
double true_speed(double t_s) {
  const double drive = kGravity * std::sin(kAlpha_deg * kPi / 180.0),
               friction = kMu * kGravity * std::cos(kAlpha_deg * kPi / 180.0);
  const double up = (drive + friction) / kDrag_1_s, down = (drive - friction) / kDrag_1_s;
  const double turn_s = std::log1p(0.8 / up) / kDrag_1_s;
  if (t_s < turn_s) return up - (up + 0.8) * std::exp(-kDrag_1_s * t_s);
  return -down * std::expm1(-kDrag_1_s * (t_s - turn_s));
}

core::TrackData made_speeds(unsigned seed, double sd_m_s) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, sd_m_s);
  core::TrackData track;
  for (std::size_t i = 0; i < kPoints; ++i) {
    track.t_s.push_back(kStep_s * static_cast<double>(i));
    track.v_m_s.push_back(true_speed(track.t_s.back()) + (sd_m_s > 0.0 ? noise(random) : 0.0));
  }
  core::take_rows_as_frames(track);
  return track;
}

core::ClipSetup setup() {
  core::ClipSetup clip;
  clip.name = "run";
  clip.mass_kg = 0.2;
  clip.launched = core::Launched::unknown;
  clip.group = "all";
  return clip;
}

core::AnalysisResults analyzed(const core::TrackData& track, const core::MotionOptions& options = {},
                               const core::ClipSetup& clip = setup()) {
  return core::analyze_tracks({clip}, {track}, kGravity, options, 1, base::no_progress);
}

struct Truth {
  const char* name;
  core::Quantity core::ConfigurationResult::*quantity;
  double value;
};
const std::vector<Truth> kTruths = {
    {"K/m", &core::ConfigurationResult::k_over_m_1_s, kDrag_1_s},
    {"mu", &core::ConfigurationResult::mu, kMu},
    {"alpha", &core::ConfigurationResult::alpha_deg, kAlpha_deg},
    {"v_lim", &core::ConfigurationResult::v_lim_m_s,
     kGravity*(std::sin(kAlpha_deg* kPi / 180.0) - kMu * std::cos(kAlpha_deg * kPi / 180.0)) / kDrag_1_s}};

/// How many of the intervals contain the truth.
std::vector<int> covered(int runs, const std::function<core::TrackData(unsigned)>& track) {
  std::vector<int> held(kTruths.size(), 0);
  for (int run = 0; run < runs; ++run) {
    const core::AnalysisResults results = analyzed(track(static_cast<unsigned>(run)));
    for (std::size_t q = 0; q < kTruths.size(); ++q) {
      const auto& estimate = (results.configurations.at(0).*kTruths[q].quantity).estimate;
      held[q] += estimate && estimate->low95 <= kTruths[q].value && kTruths[q].value <= estimate->high95;
    }
  }
  return held;
}

constexpr std::size_t kPushed = 25, kHit = 470;

core::TrackData pushed_and_stopped() {
  core::TrackData track = made_speeds(3, 0.002);
  for (std::size_t i = 0; i < kPushed; ++i) {
    track.v_m_s[i] -= 0.8 * static_cast<double>(i) / kPushed - 0.8;  // from rest to the launch in half a second
  }
  for (std::size_t i = kHit; i < kPoints; ++i) track.v_m_s[i] *= 1.0 - static_cast<double>(i - kHit) / (kPoints - kHit);
  return track;
}

}  // namespace

TEST_CASE("speeds without noise give the law that they follow") {
  const core::AnalysisResults results = analyzed(made_speeds(0, 0.0));
  REQUIRE(results.clips[0].segments.size() == 2);
  // The kernel's bias, (k h)^4 / 8 of a with k h below 0.1, is below 2e-5 of the lines.
  for (const Truth& truth : kTruths) {
    INFO(truth.name);
    const auto& estimate = (results.configurations.at(0).*truth.quantity).estimate;
    REQUIRE(estimate);
    CHECK(estimate->value == Approx(truth.value).epsilon(1e-4));
  }
}

TEST_CASE("intervals from speeds hold in 95 of 100 made experiments, and the noise is that of the speeds") {
  constexpr int kRuns = 200;
  // Binomial of 200 and 0.95: 190 ± 3.1. Below 180 (3.2 standard deviations) with a probability of 1e-3.
  const std::vector<int> held = covered(kRuns, [](unsigned seed) { return made_speeds(seed, 0.005); });
  for (std::size_t q = 0; q < kTruths.size(); ++q) {
    INFO(kTruths[q].name << ": " << held[q] << " of " << kRuns);
    CHECK(held[q] >= 180);
  }
  const core::ClipResult clip = analyzed(made_speeds(1, 0.005)).clips[0];
  REQUIRE(clip.speed_noise_m_s);
  CHECK(*clip.speed_noise_m_s == Approx(0.005).epsilon(0.15));  // of 500 residuals: 3 % is one standard deviation
  CHECK(clip.blocks.empty());
}

TEST_CASE("the standard deviations stated for speeds are those of the estimates from run to run") {
  constexpr int kRuns = 100;
  std::vector<double> sum(kTruths.size(), 0.0), squares = sum, stated = sum;
  for (int run = 0; run < kRuns; ++run) {
    const core::AnalysisResults results = analyzed(made_speeds(1000u + static_cast<unsigned>(run), 0.005));
    for (std::size_t q = 0; q < kTruths.size(); ++q) {
      const auto& estimate = (results.configurations.at(0).*kTruths[q].quantity).estimate;
      REQUIRE(estimate);
      const double off = estimate->value - kTruths[q].value;
      sum[q] += off / kRuns;
      squares[q] += off * off / kRuns;
      stated[q] += estimate->sd * estimate->sd / kRuns;
    }
  }
  for (std::size_t q = 0; q < kTruths.size(); ++q) {
    const double scatter = std::sqrt(squares[q] - sum[q] * sum[q]), ratio = scatter / std::sqrt(stated[q]);
    INFO(kTruths[q].name << ": scatter " << scatter << ", stated " << std::sqrt(stated[q]) << ", mean error "
                         << sum[q]);
    // A standard deviation from 100 runs is known to 1 / sqrt(200) = 7 %: four of these.
    CHECK(std::abs(ratio - 1.0) < 0.28);
    CHECK(std::abs(sum[q]) < 4.0 * scatter / std::sqrt(kRuns));
  }
}

TEST_CASE("a push at the start and a bumper at the end do not count as free motion of speeds") {
  const core::AnalysisResults results = analyzed(pushed_and_stopped());
  for (const core::Stretch& stretch : results.clips[0].stretches) {
    CHECK(stretch.from_s >= kStep_s * kPushed);
    CHECK(stretch.to_s <= kStep_s * kHit);
  }
  for (const Truth& truth : kTruths) {
    INFO(truth.name);
    const auto& estimate = (results.configurations.at(0).*truth.quantity).estimate;
    REQUIRE(estimate);
    CHECK(std::abs(estimate->value - truth.value) < 4.0 * estimate->sd);
  }
}

TEST_CASE("a stated start or end of speeds is used as it stands, each without the other") {
  const core::TrackData track = pushed_and_stopped();
  core::ClipSetup starts = setup(), ends = setup();
  starts.start_s = 0.2;  // in the middle of the push
  ends.end_s = 9.8;      // in the middle of the bumper
  const auto from_start = analyzed(track, {}, starts).clips[0].stretches,
             to_end = analyzed(track, {}, ends).clips[0].stretches;
  REQUIRE_FALSE(from_start.empty());
  CHECK(from_start.front().from_s == Approx(0.2));
  CHECK(from_start.back().to_s <= kStep_s * kHit);
  REQUIRE_FALSE(to_end.empty());
  CHECK(to_end.front().from_s >= kStep_s * kPushed);
  CHECK(to_end.back().to_s == Approx(9.8));

  // Upward motion before the launch down is a backswing, unless the start is stated.
  core::ClipSetup launched = setup();
  launched.launched = core::Launched::down;
  CHECK(analyzed(made_speeds(3, 0.002), {}, launched).clips[0].segments.size() == 1);
  launched.start_s = 0.0;
  CHECK(analyzed(made_speeds(3, 0.002), {}, launched).clips[0].segments.size() == 2);
}

TEST_CASE("many speeds at irregular times with a wide kernel give the law, with few rows of weights") {
  constexpr std::size_t kMany = 10000;
  constexpr double kEvery_s = 0.001;
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, 0.005);
  std::uniform_real_distribution<double> jitter(-0.3 * kEvery_s, 0.3 * kEvery_s);
  core::TrackData track;
  for (std::size_t i = 0; i < kMany; ++i) {
    track.t_s.push_back(kEvery_s * static_cast<double>(i) + jitter(random));
    track.v_m_s.push_back(true_speed(track.t_s.back()) + noise(random));
  }
  core::take_rows_as_frames(track);
  core::MotionOptions wide;
  wide.bandwidth_s = 0.4;  // 400 steps: 4800 weights in a row
  const core::AnalysisResults results = analyzed(track, wide);
  std::size_t of_lines = 0, used = 0;
  for (const core::LineFit& line : results.clips[0].segments) of_lines += line.points;
  for (const core::Stretch& stretch : results.clips[0].stretches) used += stretch.points;
  CHECK(of_lines < kMany / 100);  // every 133rd
  CHECK(used > kMany / 3);        // without turn and margins of 2.5 bandwidths at four ends: about half
  for (const Truth& truth : kTruths) {
    INFO(truth.name);
    const auto& estimate = (results.configurations.at(0).*truth.quantity).estimate;
    REQUIRE(estimate);
    CHECK(std::abs(estimate->value - truth.value) < 4.0 * estimate->sd);
  }
}

TEST_CASE("what needs positions is refused for speeds") {
  const core::TrackData track = made_speeds(0, 0.005);
  core::MotionOptions lines, smoother, rule, wide;
  lines.lines = core::LineMethod::generalised;
  smoother.smoother = "kalman";
  rule.bandwidth_rule = "rsc";
  wide.bandwidth_s = 60.0;
  CHECK_THROWS_WITH(analyzed(track, lines), Contains("phase-diagram-gls for speeds without positions"));
  CHECK_THROWS_WITH(analyzed(track, smoother), Contains("\"kalman\" for speeds") && Contains("local-polynomial"));
  CHECK_THROWS_WITH(analyzed(track, rule), Contains("\"rsc\" for speeds"));
  CHECK_THROWS_WITH(analyzed(track, wide), Contains("at most 9.98 s"));
}

TEST_CASE("tables of speeds are read in their unit, where they are taken") {
  const tests::TempDir folder;
  const auto read = [&](const std::string& header, double scale, const std::string& column = "",
                        core::SpeedsAlone speeds = core::SpeedsAlone::taken) {
    const auto file = folder / "encoder.csv";
    std::ofstream out(file);
    out << header << '\n';
    for (int i = 0; i < 12; ++i) out << fmt::format("{},{}\n", 0.1 * i, scale * (0.5 + 0.01 * i));
    out.close();
    return core::read_track(file, {}, column, speeds);
  };
  for (const auto& [header, scale] :
       std::vector<std::pair<std::string, double>>{{"t (s),v (m/s)", 1.0},
                                                   {"t_s,v_m_s", 1.0},
                                                   {"Time (s),Velocity (cm/s)", 100.0},
                                                   {"Zeit (s),Geschwindigkeit (mm/s)", 1000.0},
                                                   {"t (s),speed (km/h)", 3.6}}) {
    INFO(header);
    const core::TrackData track = read(header, scale);
    REQUIRE(track.v_m_s.size() == 12);
    CHECK(track.x_m.empty());
    CHECK(track.v_m_s[3] == Approx(0.53));
    CHECK_THROWS_WITH(read(header, scale, "", core::SpeedsAlone::refused),
                      Contains("speeds without positions") && Contains("`glidelab analyze` without --with"));
  }
  CHECK(read("t_s,v_m_s", 1.0, "v_m_s").v_m_s.at(3) == Approx(0.53));
  CHECK_THROWS_WITH(read("t (s),speed (mph)", 1.0), Contains("\"mph\"") && Contains("km/h"));
  CHECK(read("t (s),x (m)", 1.0).v_m_s.empty());
}

TEST_CASE("a force beside speeds is told as unused") {
  const tests::TempDir folder;
  const auto file = folder / "encoder.csv";
  std::ofstream out(file);
  out << "t (s),v (m/s),F (N)\n";
  for (int i = 0; i < 12; ++i) out << fmt::format("{},{},0.1\n", 0.1 * i, 0.5 + 0.01 * i);
  out.close();
  const core::TrackData track = core::read_track(file, {}, "", core::SpeedsAlone::taken);
  const auto* const unused = tests::note_of<core::ForceUnused>(track.notes);
  REQUIRE(unused != nullptr);
  CHECK(unused->column == "F (N)");
}
