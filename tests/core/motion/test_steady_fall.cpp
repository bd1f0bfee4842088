#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <variant>
#include <vector>

#include "core/motion/configurations.h"
#include "tests/catch.h"
#include "tests/core/simulated_track.h"

using namespace glidelab;
using namespace glidelab::core;
using tests::kGravity;

namespace {

struct Fall {
  double terminal_m_s = 0.85;
  double since_s = 3.0;  ///< how long it has been falling when it is first seen
  double spread = 0.0;   ///< every other clip falls faster, and the others slower, by this part
  double incline_deg = 90.0;
  double noise_m = 5e-4;
  int points = 60;
  int seen_of_each_20 = 20;  ///< the first positions of each third of a second
};

/// Three clips at 60 Hz, with a drag in proportion to v.
ConfigurationResult analysed(const Fall& fall, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, fall.noise_m);
  std::vector<ClipSetup> setups;
  std::vector<TrackData> tracks;
  for (int clip = 0; clip < 3; ++clip) {
    ClipSetup setup;
    setup.name = "clip " + std::to_string(clip);
    setup.mass_kg = 2e-3;
    setup.incline_rad = fall.incline_deg * std::acos(-1.0) / 180.0;
    setups.push_back(setup);
    TrackData track;
    track.frame_rate_hz = 60.0;
    const double terminal = fall.terminal_m_s * (1.0 + (clip % 2 == 0 ? fall.spread : -fall.spread));
    const double rate = kGravity / terminal;
    for (int i = 0; i < fall.points; ++i) {
      if (i % 20 >= fall.seen_of_each_20) continue;
      const double t_s = i / 60.0, u = t_s + fall.since_s;
      track.frame.push_back(track.t_s.size());
      track.t_s.push_back(t_s);
      track.x_m.push_back(terminal * (u - (1.0 - std::exp(-rate * u)) / rate) + normal(random));
    }
    track.frame_t_s = track.t_s;
    tracks.push_back(track);
  }
  const AnalysisResults results = analyze_tracks(setups, tracks, kGravity, {}, 1);
  REQUIRE(results.configurations.size() == 1);
  return results.configurations.front();
}

bool is_steady(const ConfigurationResult& result) {
  return std::any_of(result.notes.begin(), result.notes.end(),
                     [](const Note& note) { return std::holds_alternative<SteadyFall>(note); });
}

}  // namespace

TEST_CASE("a body that falls at its terminal velocity from the first position on has that velocity") {
  double chi2 = 0.0;
  constexpr unsigned kFalls = 40;
  for (unsigned seed = 1; seed <= kFalls; ++seed) {
    CAPTURE(seed);
    const ConfigurationResult result = analysed({}, seed);
    REQUIRE(result.v_lim_m_s.estimate);
    REQUIRE(is_steady(result));
    const Estimate& v = *result.v_lim_m_s.estimate;
    chi2 += std::pow((v.value - 0.85) / v.sd, 2) / kFalls;
    CHECK(v.sd < 2e-3);
  }
  // A mean of 40 squares of normal numbers: 1 with a standard deviation of 0.22.
  CHECK(chi2 > 0.4);
  CHECK(chi2 < 1.8);
}

TEST_CASE("a steady fall of few positions, or with long gaps, has the terminal velocity that all its positions give") {
  // Half a second, or bursts of six positions: kernels reach over an end or a gap nearly everywhere.
  for (const Fall& fall : {Fall{.terminal_m_s = 2.5, .noise_m = 2.5e-3, .points = 32},
                           Fall{.terminal_m_s = 2.5, .noise_m = 2.5e-3, .points = 46, .seen_of_each_20 = 6}}) {
    CAPTURE(fall.points);
    double chi2 = 0.0;
    constexpr unsigned kFalls = 40;
    for (unsigned seed = 1; seed <= kFalls; ++seed) {
      CAPTURE(seed);
      const ConfigurationResult result = analysed(fall, seed);
      REQUIRE(result.v_lim_m_s.estimate);
      REQUIRE(is_steady(result));
      const Estimate& v = *result.v_lim_m_s.estimate;
      chi2 += std::pow((v.value - fall.terminal_m_s) / v.sd, 2) / kFalls;
      CHECK(v.sd < 0.03);
    }
    // As above.
    CHECK(chi2 > 0.4);
    CHECK(chi2 < 1.8);
  }
}

TEST_CASE("a fall that still gains a little has a terminal velocity above its mean speed") {
  // The line has no slope above its noise, and 2 % of v_lim are missing at the first position.
  const ConfigurationResult result = analysed({.terminal_m_s = 4.0, .since_s = 1.6, .noise_m = 3e-3}, 3);
  REQUIRE(result.v_lim_m_s.estimate);
  CHECK(std::abs(result.v_lim_m_s.estimate->value - 4.0) < 4.0 * result.v_lim_m_s.estimate->sd);
}

TEST_CASE("clips that fall at different speeds give a wider terminal velocity") {
  const ConfigurationResult alike = analysed({}, 5), different = analysed({.spread = 0.02}, 5);
  REQUIRE((alike.v_lim_m_s.estimate && different.v_lim_m_s.estimate));
  // Speeds of 1.02, 0.98 and 1.02 times 0.85: the mean has a standard deviation of 0.0113.
  CHECK(different.v_lim_m_s.estimate->sd == Approx(0.0113).epsilon(0.1));
  CHECK(alike.v_lim_m_s.estimate->sd < 2e-3);
}

namespace {

/// A bead that sinks in a liquid at x' = 0.04 (1 + part exp(-t)) m/s for a second.
ConfigurationResult bead_that_slows(double part) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal(0.0, 2e-5);
  ClipSetup setup;
  setup.name = "bead";
  setup.mass_kg = 1e-4;
  setup.incline_rad = 0.5 * std::acos(-1.0);
  TrackData track;
  track.frame_rate_hz = 60.0;
  for (int i = 0; i < 60; ++i) {
    const double t_s = i / 60.0;
    track.frame.push_back(track.t_s.size());
    track.t_s.push_back(t_s);
    track.x_m.push_back(0.04 * (t_s + part * (1.0 - std::exp(-t_s))) + normal(random));
  }
  track.frame_t_s = track.t_s;
  const AnalysisResults results = analyze_tracks({setup}, {track}, kGravity, {}, 1);
  REQUIRE(results.configurations.size() == 1);
  return results.configurations.front();
}

}  // namespace

TEST_CASE("a bead in a liquid whose speed falls by a third is at no constant speed, however small its acceleration") {
  CHECK_FALSE(is_steady(bead_that_slows(1.0)));  // a is 0.4 % of g at most
}

TEST_CASE("a speed that drifts for longer than any approach lasts is uncertain by half of its drift") {
  // Of 0.04 m/s a tenth decays over a second, to 0.037 of it: the speed drifts by 0.0025 m/s, and v/g is 4 ms.
  const ConfigurationResult result = bead_that_slows(0.1);
  REQUIRE(is_steady(result));
  CHECK(result.v_lim_m_s.estimate->sd == Approx(0.5 * 0.04 * 0.1 * (1.0 - std::exp(-1.0))).epsilon(0.15));
}

TEST_CASE("a glider at a constant speed, and a fall that speeds up, have no such terminal velocity") {
  CHECK_FALSE(is_steady(analysed({.incline_deg = 4.0}, 1)));
  CHECK_FALSE(is_steady(analysed({.terminal_m_s = 20.0, .since_s = 0.0}, 1)));
}
