#include "validate/made_tracks/made_tracks.h"

#include <cmath>
#include <numbers>

#include "fit/trajectory/trajectory_results.h"
#include "render/scenario/clip_motion.h"
#include "report/text/why_words.h"
#include "sim/oracle/closed_forms.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/core/notes.h"
#include "tests/small_scenario.h"
#include "validate/film/film_studio.h"
#include "validate/truth/comparison.h"

using namespace glidelab;
using namespace glidelab::validate;

namespace {

render::Scenario paper() {
  return render::read_scenario(std::string(tests::kSourceDir) + "/scenarios/paper/inclined.toml");
}

}  // namespace

TEST_CASE("made tracks follow the closed form of their motion at the times of the frames") {
  const render::Scenario scenario = paper();
  const MadeTracks made = make_tracks(scenario, 1);
  REQUIRE(made.tracks.size() == 6);
  std::size_t c = 0;
  for (const sim::ConfigurationSetup& configuration : scenario.motion.configurations) {
    const TrueConfiguration& truth = made.truth.configurations[c / configuration.motions.size()];
    REQUIRE((truth.k_over_m_1_s && truth.mu));
    const sim::DryTrack track = sim::dry_track(configuration.body.incline_rad, *truth.mu, *truth.mu, made.gravity_m_s2);
    for (const sim::MotionSetup& motion : configuration.motions) {
      const core::TrackData& data = made.tracks[c];
      REQUIRE(data.x_m.size() == render::frame_count(scenario.recording, motion));
      for (std::size_t j = 0; j < data.x_m.size(); j += 37) {
        const double t_s = static_cast<double>(j) / scenario.recording.frame_rate_hz;
        CHECK(std::abs(data.t_s[j] - t_s) < 1e-12);
        const sim::State state =
            sim::viscous_coulomb_motion(track, *truth.k_over_m_1_s, motion.x0_m, motion.v0_m_s, t_s);
        CHECK(std::abs(data.x_m[j] - state.x_m) < 1e-9);  // what sim/motion/simulate.h promises
      }
      ++c;
    }
  }
}

TEST_CASE("noise has the standard deviation asked for, differs between clips and seeds, and repeats with the seed") {
  const MadeTracks clean = make_tracks(paper(), 1);
  const double sd = 4e-5;
  const MadeTracks noisy = with_noise(clean, sd, 7);
  double sum = 0.0, count = 0.0;
  for (std::size_t c = 0; c < clean.tracks.size(); ++c) {
    for (std::size_t i = 0; i < clean.tracks[c].x_m.size(); ++i, ++count)
      sum += std::pow(noisy.tracks[c].x_m[i] - clean.tracks[c].x_m[i], 2);
  }
  // A variance of n deviates is known to sqrt(2 / n); five of its standard deviations.
  CHECK(std::abs(sum / count / (sd * sd) - 1.0) < 5.0 * std::sqrt(2.0 / count));
  const auto first = [&](const MadeTracks& made, std::size_t c) {
    return made.tracks[c].x_m[0] - clean.tracks[c].x_m[0];
  };
  CHECK(first(noisy, 0) != first(noisy, 1));
  CHECK(first(noisy, 0) != first(with_noise(clean, sd, 8), 0));
  CHECK(first(noisy, 0) == first(with_noise(clean, sd, 7), 0));
}

TEST_CASE("a clock that runs fast, and frames that are dropped and duplicated, are in the tracks") {
  render::Scenario scenario = paper();
  scenario.recording.clock.rate_error_ppm = 1e4;
  scenario.recording.clock.dropped_fraction = 0.05;
  scenario.recording.clock.duplicated_fraction = 0.05;
  const MadeTracks made = make_tracks(scenario, 3);
  const MadeTracks noisy = with_noise(made, 1e-5, 3);
  const core::TrackData& track = made.tracks[0];
  const TrueClip& truth = made.truth.clips[0];
  std::size_t repeated = 0;
  for (std::size_t j = 1; j < track.x_m.size(); ++j) {
    CHECK(std::abs(track.t_s[j] - static_cast<double>(j) / 200.0) < 1e-12);
    const bool again = truth.t_s[j] == truth.t_s[j - 1];
    repeated += again ? 1 : 0;
    if (again) CHECK(noisy.tracks[0].x_m[j] == noisy.tracks[0].x_m[j - 1]);
    // True times are multiples of the true frame time, 1/(200 * 1.01) s.
    const double slot = truth.t_s[j] * 202.0;
    CHECK(std::abs(slot - std::round(slot)) < 1e-6);
  }
  CHECK(repeated > 0);
  CHECK(truth.t_s.back() * 202.0 > static_cast<double>(truth.t_s.size() - 1) + 0.5);  // some were dropped
}

TEST_CASE("frames whose rounded stamps an analysis makes even have the same times in made tracks as in a film") {
  struct Case {
    const char *rate, *sections;
  };
  // A phone's ticks in MP4, two and a half a frame; whole milliseconds in Matroska, eight and a third a frame.
  for (const Case& one : {Case{"100.0", "[clock]\nvariable = true\nstamp_tick_s = 0.004\n[codec]\nname = \"h264\"\n"},
                          Case{"120.0", "[clock]\nvariable = true\ndropped_fraction = 0.02\n"}}) {
    CAPTURE(one.sections);
    std::string text = std::string(tests::kSmallScenario) + one.sections;
    text.replace(text.find("frame_rate_hz = 100.0"), 21, std::string("frame_rate_hz = ") + one.rate);
    const render::Scenario scenario = render::read_scenario(text, "s.toml");
    const MadeTracks filmed =
                         FilmStudio(scenario, 3, 1, nullptr, base::no_progress, LengthFrom::scale).film(scenario, 3, 1),
                     made = make_tracks(scenario, 3);
    REQUIRE(filmed.tracks.size() == made.tracks.size());
    for (std::size_t c = 0; c < made.tracks.size(); ++c) {
      REQUIRE(made.tracks[c].t_s.size() == filmed.tracks[c].frame_t_s.size());
      for (std::size_t i = 0; i < made.tracks[c].t_s.size(); ++i) {
        CHECK(std::abs(made.tracks[c].t_s[i] - filmed.tracks[c].frame_t_s[i]) < 2e-6);  // libav's microseconds
      }
      // Even but for the jitter, which is none here: taken literally, the stamps are off by up to half a tick.
      const auto off_s = [&](std::size_t i) { return made.tracks[c].t_s[i] - made.truth.clips[c].t_s[i]; };
      double low_s = off_s(0), high_s = low_s;
      for (std::size_t i = 1; i < made.tracks[c].t_s.size(); ++i) {
        low_s = std::min(low_s, off_s(i));
        high_s = std::max(high_s, off_s(i));
      }
      CHECK(high_s - low_s < 1e-4);
      CHECK(tests::note_of<core::EvenStamps>(made.tracks[c].notes) != nullptr);
    }
  }
}

TEST_CASE("the noise of a phone's positions is that stated, though its stamps are rounded") {
  const render::Scenario phone =
      render::read_scenario(std::string(tests::kSourceDir) + "/scenarios/rehearsals/phone-240.toml");
  REQUIRE(phone.recording.clock.stamp_tick_s > 0.0);
  const double sd_m = 1e-5;
  for (const core::ClipResult& clip :
       analyze_tracks(with_noise(make_tracks(phone, 1), sd_m, 1), std::nullopt, 1).clips) {
    // A standard deviation of 480 deviates is known to 1 / sqrt(2 n) = 3.2 %; the analysis uses their differences,
    // which know it less well. Stamps taken literally make 190 µm of it.
    CHECK(clip.position_noise_m == Approx(sd_m).epsilon(0.2));
  }
}

TEST_CASE("both estimators recover the truth of made tracks, and the whole motion's sd is near the least there is") {
  const MadeTracks clean = make_tracks(paper(), 1);
  // So much that the clock's 20 ppm, which every stated sd holds and no bound does, are little beside it: 40 ppm of
  // 4.3 degrees are 0.00017 degrees, and this noise leaves alpha ten times as uncertain.
  const double sd = 2e-4;
  const core::AnalysisResults lines = analyze_tracks(with_noise(clean, sd, 11), std::nullopt, 2);
  const core::AnalysisResults whole = fit::with_trajectory_fits(lines);
  const auto bounds = least_sds(clean.truth, std::vector<double>(clean.tracks.size(), sd), clean.gravity_m_s2);
  const auto quantities = with_bounds(
      join_estimators(compare_quantities(lines, clean.truth), compare_quantities(whole, clean.truth)), bounds);
  REQUIRE(quantities.size() == 24);
  for (const QuantityComparison& quantity : quantities) {
    INFO(quantity.configuration << " " << quantity.estimator << " " << quantity.quantity << ": "
                                << report::why_words(quantity.why));
    REQUIRE((quantity.error && quantity.efficiency));
    CHECK(std::abs(*quantity.error) < 4.5 * *quantity.sd);  // 24 numbers, fixed seed
    // The noise's variance is estimated from 600 to 1000 points: to 5 %, three of these are allowed.
    CHECK(*quantity.efficiency < 1.15);
    if (quantity.estimator == "trajectory") CHECK(*quantity.efficiency > 0.8);
  }
}
