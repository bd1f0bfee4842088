#include "validate/study/requirement/requirement.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "tests/catch.h"
#include "tests/one_glider.h"
#include "tests/temp_dir.h"
#include "tests/validate/small_sweep.h"
#include "validate/film/film_studio.h"
#include "validate/made_tracks/made_tracks.h"
#include "validate/study/sweep/one_run.h"

using namespace glidelab;

namespace {

validate::Sweep grid(const tests::TempDir& dir, const std::string& vary) {
  return validate::read_sweep(tests::write_sweep(dir.path(), "", "[tracks]\nnoise_m = 1e-5\n" + vary));
}

const validate::Candidate& named(const validate::Requirement& requirement, const std::string& name) {
  const auto found = std::find_if(requirement.candidates.begin(), requirement.candidates.end(),
                                  [&](const auto& candidate) { return candidate.name == name; });
  REQUIRE(found != requirement.candidates.end());
  return *found;
}

}  // namespace

TEST_CASE("Where noise limits, the least sd goes as sigma / sqrt(frame rate), and runs find the same") {
  const tests::TempDir dir;
  const validate::Sweep sweep = grid(dir, R"(
[[vary]]
key = "camera.frame_rate_hz"
values = [100, 400]
[[vary]]
key = "tracks.noise_m"
values = [1e-5, 4e-5]
)");
  validate::RequirementOptions options;
  options.targets = {validate::parse_target("k_over_m_1_s:sd=0.02")};
  options.confirm = validate::Confirm::tracks;
  options.track_runs = 40;
  const validate::Requirement requirement = validate::find_requirement(sweep, options);
  REQUIRE(requirement.candidates.size() == 4);
  const auto bound = [&](const std::string& name) { return *named(requirement, name).results[0].bound; };
  const double reference = bound("camera.frame_rate_hz = 100, tracks.noise_m = 1e-05");
  CHECK(std::abs(bound("camera.frame_rate_hz = 100, tracks.noise_m = 4e-05") / reference - 4.0) < 1e-9);
  // What differs beyond sqrt(4): at 100 Hz the last frame is 7.5 ms of 1.2 s earlier than at 400, and the sd of K/m
  // falls with less than the fourth power of the time seen: 2.5 %.
  CHECK(std::abs(bound("camera.frame_rate_hz = 400, tracks.noise_m = 1e-05") / reference - 0.5) < 0.5 * 0.03);
  for (const validate::Candidate& candidate : requirement.candidates) {
    const validate::TargetResult& result = candidate.results[0];
    if (!result.found) continue;
    // The rms of 40 errors has a relative sd of 1/sqrt(80); four of it.
    CHECK(std::abs(*result.found / *result.bound - 1.0) < 4.0 / std::sqrt(80.0));
    CHECK(result.estimator == "trajectory");
  }
}

TEST_CASE("A target that the bound forbids is impossible, one with room needs no run, and what limits is said") {
  const tests::TempDir dir;
  const validate::Sweep sweep = grid(dir, R"(
[[vary]]
key = "tracks.noise_m"
values = [1e-7, 1e-2]
[[vary]]
key = "camera.frame_rate_hz"
values = [50, 125]
)");
  validate::RequirementOptions options;
  options.targets = {validate::parse_target("mu:sd=0.0005")};
  options.confirm = validate::Confirm::none;
  const validate::Requirement requirement = validate::find_requirement(sweep, options);
  CHECK(requirement.any_reached());
  CHECK_FALSE(requirement.by_price);
  const validate::Candidate& quiet = named(requirement, "tracks.noise_m = 1e-07, camera.frame_rate_hz = 50");
  CHECK(quiet.verdict == validate::Verdict::by_bound);
  const validate::Candidate& noisy = named(requirement, "tracks.noise_m = 0.01, camera.frame_rate_hz = 125");
  CHECK(noisy.verdict == validate::Verdict::impossible);
  REQUIRE(noisy.limits.size() == 1);
  CHECK(noisy.limits[0].what == validate::Limitation::frame_rate);
  // 1000 Hz in place of 125: sqrt(8), but for the frames at the ends (1/150)
  CHECK(std::abs(noisy.limits[0].gain - std::sqrt(8.0)) < 0.05);
  // cheapest first: by pixels a second
  CHECK(requirement.candidates.front().frame_rate_hz == 50.0);
  CHECK(requirement.candidates.back().frame_rate_hz == 125.0);
}

TEST_CASE("A target within the errors' uncertainty is undecided") {
  const tests::TempDir dir;
  const validate::Sweep sweep = grid(dir, "[[vary]]\nkey = \"tracks.noise_m\"\nvalues = [1e-5]\n");
  validate::RequirementOptions options;
  options.targets = {validate::parse_target("k_over_m_1_s:bias=1")};
  options.confirm = validate::Confirm::tracks;
  const validate::TargetResult found = validate::find_requirement(sweep, options).candidates.front().results[0];
  CHECK(found.runs == 200);
  CHECK(found.beyond == 0);
  const auto verdict_at = [&](double target) {
    options.targets.front().value = target;
    const validate::Candidate only = validate::find_requirement(sweep, options).candidates.front();
    CHECK(only.judged_by == validate::Confirm::tracks);
    return only.verdict;
  };
  CHECK(verdict_at(*found.found + 0.5 * found.found_sd) == validate::Verdict::undecided);
  CHECK(verdict_at(*found.found + 2.5 * found.found_sd) == validate::Verdict::reached);
  CHECK(verdict_at(std::max(1e-9, *found.found - 2.5 * found.found_sd)) != validate::Verdict::reached);
}

TEST_CASE("What would do in place of a setting that is much better than needed still reaches the target") {
  const tests::TempDir dir;
  const validate::Sweep sweep = grid(dir, "[[vary]]\nkey = \"tracks.noise_m\"\nvalues = [1e-6]\n");
  validate::RequirementOptions options;
  options.targets = {validate::parse_target("k_over_m_1_s=1")};
  options.confirm = validate::Confirm::tracks;
  options.track_runs = 60;
  options.targets[0].value = 40.0 * *validate::find_requirement(sweep, options).candidates[0].results[0].found;
  const validate::Requirement requirement = validate::find_requirement(sweep, options);
  REQUIRE(requirement.first_reached() != nullptr);
  REQUIRE(requirement.first_reached()->enough);
  const validate::Enough enough = *requirement.first_reached()->enough;
  CHECK(enough.times == Approx(40.0));
  REQUIRE(enough.noise_m);
  // The error goes with the noise: 32 times the noise keeps within 40 times the error, 64 times does not. The 95 %
  // error of 60 runs has a relative sd of some 12 %; 25 % are left on either side.
  CHECK(*enough.noise_m == Approx(32e-6));
}

TEST_CASE("Whoever wants to stop a search for cameras waits for one run, not for all of a camera") {
  const tests::TempDir dir;
  const validate::Sweep sweep = grid(dir, "[[vary]]\nkey = \"tracks.noise_m\"\nvalues = [1e-5]\n");
  validate::RequirementOptions options;
  options.targets = {validate::parse_target("k_over_m_1_s:sd=0.0001")};
  options.confirm = validate::Confirm::tracks;
  options.track_runs = 30;
  options.targets.front().value = 1.5 * *validate::find_requirement(sweep, options).candidates.front().results[0].bound;
  int runs = 0;
  options.before_run = [&] { ++runs; };
  struct Stopped {};
  const auto stop_after_three = [&](std::string_view, double) {
    if (runs > 3) throw Stopped{};
  };
  CHECK_THROWS_AS(validate::find_requirement(sweep, options, stop_after_three), Stopped);
  CHECK(runs == 4);
}

TEST_CASE("A clock that makes most of the error is named first, before what limits the bound more") {
  const tests::TempDir dir;
  const auto sweep_with = [&](double jitter_s) {
    base::write_file(dir / "scenario.toml", tests::kSweptScenario +
                                                "[calibration]\ninner_corners = [7, 4]\nsquare_m = 0.05\nviews = 6\n" +
                                                fmt::format("[clock]\njitter_s = {:.9f}\n", jitter_s));
    base::write_file(dir / "sweep.toml",
                     "format = 1\nname = \"clock\"\nscenario = \"scenario.toml\"\nlevel = \"clips\"\n"
                     "[[vary]]\nkey = \"camera.frame_rate_hz\"\nvalues = [60]\n");
    return validate::read_sweep(dir / "sweep.toml");
  };
  validate::RequirementOptions options;
  options.confirm = validate::Confirm::none;
  options.targets = {validate::parse_target("k_over_m_1_s:sd=1")};
  const validate::Candidate even = validate::find_requirement(sweep_with(0.0), options).candidates.front();
  options.confirm = validate::Confirm::tracks;
  options.track_runs = 40;
  options.targets.front().value = 1.2 * *even.results.front().bound;
  // At about 0.6 m/s the jitter moves a position by 2.5 times the noise: the error is 2.7 times the bound.
  const auto limits = [&](double jitter_s) {
    const validate::Candidate only = validate::find_requirement(sweep_with(jitter_s), options).candidates.front();
    REQUIRE(only.verdict == validate::Verdict::missed);
    REQUIRE(only.limits.size() > 1);
    return only.limits;
  };
  const std::vector<validate::Limit> uneven = limits(2.5 * even.noise_m / 0.6);
  CHECK(uneven[0].what == validate::Limitation::clock);
  CHECK(uneven[0].gain > std::sqrt(2.0));
  CHECK(uneven[1].gain > uneven[0].gain);
}

TEST_CASE("Targets are read with their measure, and anything else is refused") {
  CHECK(validate::parse_target("mu=0.0005").measure == validate::Target::Measure::error95);
  CHECK(validate::parse_target("mu:sd=0.0005").measure == validate::Target::Measure::sd);
  CHECK(validate::parse_target("alpha_deg:error95=0.1").measure == validate::Target::Measure::error95);
  CHECK(validate::parse_target("v_lim_m_s:bias=1e-3").value == 1e-3);
  const validate::Target spaced = validate::parse_target(" alpha_deg : sd = 0.01 ");
  CHECK(spaced.quantity == "alpha_deg");
  CHECK(spaced.measure == validate::Target::Measure::sd);
  CHECK(spaced.value == 0.01);
  CHECK_THROWS_WITH(validate::parse_target("alpha=0.01"), Catch::Matchers::EndsWith("did you mean \"alpha_deg\"?"));
  for (const char* wrong : {"mu", "mu=", "mu=x", "mu=0", "mu=-1", "mass=1", "mu:mean=1", "mu=1 m", ""}) {
    CHECK_THROWS_AS(validate::parse_target(wrong), base::InputError);
  }
}

TEST_CASE("The predicted noise of a position is that of rendered clips within a third") {
  const tests::TempDir dir;
  base::write_file(dir / "s.toml", R"(format = 1
name = "noise"
[camera]
width_px = 320
height_px = 200
frame_rate_hz = 100.0
exposure_s = 0.001
focal_px = [480.0, 480.0]
position_m = [0.0, 0.05, 2.0]
[sensor]
full_well_e = 8000.0
read_noise_e = 40.0
[calibration]
inner_corners = [7, 4]
square_m = 0.05
views = 6
[marker]
diameter_m = 0.04
)" + tests::one_glider(3.0, 1.5, 0.006, {{"m1-up", 0.4, -0.9, 1.2}}));
  const render::Scenario scenario = render::read_scenario(dir / "s.toml");
  const validate::MadeTracks made = validate::make_tracks(scenario, 1);
  const double predicted = validate::predicted_noise_m(scenario, made.truth).front();
  const double found = validate::analyze_tracks(validate::film_tracks(scenario, 3, 2), core::MotionOptions{})
                           .clips.front()
                           .position_noise_m;
  // The estimate from 120 positions has 10 %; the prediction takes one brightness of the wall, one distance and a
  // normal edge for a smear, and a bound where the analysis fits a disc: together within a third.
  CHECK(found / predicted > 0.75);
  CHECK(found / predicted < 4.0 / 3.0);
  // Without any limitation nothing is left.
  CHECK(validate::predicted_noise_m(scenario, made.truth,
                                    {.shot_noise = true, .camera_noise = true, .motion_blur = true, .finer = 1.0})
            .front() < 1e-3 * predicted);
}

TEST_CASE("Rendered runs say what shutter, codec, and lens and calibration cost, one at a time", "[slow]") {
  const tests::TempDir dir;
  base::write_file(dir / "scenario.toml", tests::kSweptScenario +
                                              "[calibration]\ninner_corners = [7, 4]\nsquare_m = 0.05\nviews = 6\n"
                                              "[shutter]\nkind = \"rolling\"\nline_readout_s = 6e-5\n"
                                              "[codec]\nname = \"mjpeg\"\nquality = 20\n");
  base::write_file(dir / "sweep.toml",
                   "format = 1\nname = \"limits\"\nscenario = \"scenario.toml\"\nlevel = \"clips\"\n"
                   "[[vary]]\nkey = \"camera.frame_rate_hz\"\nvalues = [60]\n");
  const validate::Sweep sweep = validate::read_sweep(dir / "sweep.toml");
  validate::RequirementOptions options;
  options.confirm = validate::Confirm::clips;
  options.runs = 4;
  // The bound, which knows no codec, says that this is just within reach; the runs must say that it is not.
  options.targets = {validate::parse_target("k_over_m_1_s:sd=1")};
  const double bound = *validate::find_requirement(sweep, options).candidates.front().results[0].bound;
  options.targets[0].value = 1.01 * bound;
  validate::ConfirmationSize size;
  options.before_rendering = [&](const validate::ConfirmationSize& told) { size = told; };
  const validate::Requirement requirement = validate::find_requirement(sweep, options);
  const validate::Candidate& only = requirement.candidates.front();
  REQUIRE(only.verdict == validate::Verdict::missed);
  CHECK(only.judged_by == validate::Confirm::clips);
  CHECK(size.close == 1);
  CHECK(size.points == 1);
  CHECK(size.recordings == 4);
  CHECK(size.seconds > 0.0);
  // On two threads the runs are the same.
  options.jobs = 2;
  const validate::Requirement again = validate::find_requirement(sweep, options);
  CHECK(again.candidates.front().results[0].found == only.results[0].found);
  REQUIRE(again.candidates.front().limits.size() == only.limits.size());
  for (std::size_t i = 0; i < only.limits.size(); ++i) {
    CHECK(again.candidates.front().limits[i].what == only.limits[i].what);
    CHECK(again.candidates.front().limits[i].gain == only.limits[i].gain);
  }
  // However easy the target is, images judge.
  options.targets[0].value = 1000.0 * bound;
  const validate::Requirement easy = validate::find_requirement(sweep, options);
  CHECK(easy.candidates.front().verdict == validate::Verdict::reached);
  CHECK(easy.candidates.front().judged_by == validate::Confirm::clips);
  CHECK(size.recordings == 4);
  CHECK(easy.candidates.front().results[0].runs == 4);  // all of them: it is the one to buy
  REQUIRE(easy.first_reached() != nullptr);
  CHECK(easy.first_reached()->mode.codec.kind == validate::CodecSetting::Kind::mjpeg);
  CHECK(easy.first_reached()->mode.codec.value == 20.0);
  // So much better than needed that fewer frames would do.
  REQUIRE(easy.first_reached()->enough);
  CHECK(easy.first_reached()->enough->times > validate::kMuchLess);
  CHECK(easy.first_reached()->enough->noise_m > easy.first_reached()->noise_m);
  const auto gain = [&](validate::Limitation what) {
    const auto found = std::find_if(only.limits.begin(), only.limits.end(),
                                    [&](const validate::Limit& limit) { return limit.what == what; });
    REQUIRE(found != only.limits.end());
    return found->gain;
  };
  using validate::Limitation;
  // Blocks of 8 pixels at quality 20 shift a marker of 8 pixels by more than the noise of a clean image; a shutter
  // whose line time is declared is corrected, and costs less.
  CHECK(gain(Limitation::codec) > 1.0);
  CHECK(gain(Limitation::rolling_shutter) < gain(Limitation::codec));
  CHECK(gain(Limitation::imaging) > 1.0);
  // A calibration from six views of 28 corners is no part of what a coarse codec spoils: hardly anything.
  CHECK(gain(Limitation::calibration) < gain(Limitation::codec));
}

TEST_CASE("The cheapest that reaches the target is filmed in full, and nothing more expensive") {
  const tests::TempDir dir;
  base::write_file(dir / "scenario.toml",
                   tests::kSweptScenario + "[calibration]\ninner_corners = [7, 4]\nsquare_m = 0.05\nviews = 6\n");
  base::write_file(dir / "sweep.toml",
                   "format = 1\nname = \"order\"\nscenario = \"scenario.toml\"\nlevel = \"clips\"\n"
                   "[[vary]]\nkey = \"camera.frame_rate_hz\"\nvalues = [120, 60, 90]\n");
  const validate::Sweep sweep = validate::read_sweep(dir / "sweep.toml");
  validate::RequirementOptions options;
  options.confirm = validate::Confirm::clips;
  options.runs = 4;
  options.track_runs = 60;
  options.targets = {validate::parse_target("k_over_m_1_s:sd=1000")};
  validate::ConfirmationSize size;
  options.before_rendering = [&](const validate::ConfirmationSize& told) { size = told; };
  const validate::Requirement requirement = validate::find_requirement(sweep, options);
  REQUIRE(requirement.candidates.size() == 3);
  CHECK(size.close == 3);
  CHECK(size.recordings == 4);
  const validate::Candidate& buy = requirement.candidates[0];
  CHECK(buy.frame_rate_hz == 60.0);  // the fewest pixels a second: there are no prices
  CHECK(buy.verdict == validate::Verdict::reached);
  CHECK(buy.judged_by == validate::Confirm::clips);
  CHECK(buy.results[0].runs == 4);
  CHECK(requirement.first_reached() == &buy);
  for (std::size_t i = 1; i < 3; ++i) {
    const validate::Candidate& other = requirement.candidates[i];
    CHECK(other.verdict == validate::Verdict::unconfirmed);
    CHECK(other.judged_by == validate::Confirm::tracks);
    CHECK(other.results[0].runs == 60);
    CHECK(other.limits.empty());
  }
}

TEST_CASE("A clock that tracks show to be too bad is named although a cheaper camera is the one to buy") {
  const tests::TempDir dir;
  base::write_file(dir / "scenario.toml",
                   tests::kSweptScenario + "[calibration]\ninner_corners = [7, 4]\nsquare_m = 0.05\nviews = 6\n");
  base::write_file(
      dir / "sweep.toml",
      "format = 1\nname = \"clock\"\nscenario = \"scenario.toml\"\nlevel = \"clips\"\n"
      "[[vary]]\nname = \"camera\"\nchoices = [{ \"camera.frame_rate_hz\" = 60, \"clock.jitter_s\" = 0.0 }, "
      "{ \"camera.frame_rate_hz\" = 90, \"clock.jitter_s\" = 0.0008 }]\n");
  const validate::Sweep sweep = validate::read_sweep(dir / "sweep.toml");
  validate::RequirementOptions options;
  options.confirm = validate::Confirm::none;
  options.targets = {validate::parse_target("k_over_m_1_s:sd=1")};
  const double bound = *validate::find_requirement(sweep, options).candidates[0].results[0].bound;
  options.confirm = validate::Confirm::clips;
  options.runs = 4;
  options.track_runs = 20;
  options.targets.front().value = 20.0 * bound;
  const validate::Requirement requirement = validate::find_requirement(sweep, options);
  REQUIRE(requirement.candidates[0].verdict == validate::Verdict::reached);
  const validate::Candidate& uneven = requirement.candidates[1];
  REQUIRE(uneven.verdict == validate::Verdict::missed);
  REQUIRE(uneven.judged_by == validate::Confirm::tracks);
  REQUIRE_FALSE(uneven.limits.empty());
  CHECK(uneven.limits.front().what == validate::Limitation::clock);
  // A perfect clock leaves the noise, 20 times less than the target that the clock misses.
  CHECK(uneven.limits.front().gain > 10.0);
}

TEST_CASE("Whoever wants to stop while a recording is made waits for an image or some frames, not for its end") {
  const tests::TempDir dir;
  base::write_file(dir / "s.toml",
                   tests::kSweptScenario + "[calibration]\ninner_corners = [7, 4]\nsquare_m = 0.05\nviews = 6\n");
  const render::Scenario scenario = render::read_scenario(dir / "s.toml");
  int calls = 0;
  struct Stopped {};
  validate::film_tracks(scenario, 1, 1, [&](std::string_view, double) { ++calls; });
  CHECK(calls >= 8 + 73 / 10);  // 7 views of the pattern and the empty track, and one in ten of the clip's 73 frames
  for (const int last : {3, calls - 2}) {
    int before = 0;
    const auto stop = [&](std::string_view, double) {
      if (++before == last) throw Stopped{};
    };
    CHECK_THROWS_AS(validate::film_tracks(scenario, 1, 1, stop), Stopped);
    CHECK(before == last);
  }
}
