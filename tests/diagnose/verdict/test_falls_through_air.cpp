#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/drag_of_air.h"
#include "diagnose/fit/motion_fit.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/verdict/diagnose.h"
#include "diagnose/verdict/fit_given_causes.h"
#include "diagnose/weigh/air_odds.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

/// Falls from rest, at 90 degrees: forces per clip, mass by mass, and added inertia over the mass.
struct Fall {
  double gravity_m_s2 = 9.80665;
  double k_n_s_m = 0.0, c_kg_m = 0.0, added_kg = 0.0;
  std::vector<double> masses_kg = {0.05};
  double noise_m = 5e-4, rate_hz = 120.0;
  std::size_t frames = 60;
  double uneven = 0.0;  ///< every other mass has a drag larger, and the others one smaller, by this part
  double sway_m = 0.0;  ///< of the camera, with a period of 0.45 s
  double wave_m = 0.0;  ///< of the positions, with 0.4 m from crest to crest: an uneven scale
};

tests::MadeExperiment fallen(const Fall& fall, unsigned seed) {
  std::vector<tests::MadeLaunch> launches;
  for (const double mass : fall.masses_kg) {
    launches.push_back({mass, 90.0, 0.0, 0.02, 0.0, 0.0, 1.0 + fall.added_kg / mass});
  }
  tests::MadeEffect drag;
  drag.force = [&fall](double mass, double, double v, double) {
    const auto at = std::find(fall.masses_kg.begin(), fall.masses_kg.end(), mass) - fall.masses_kg.begin();
    return -fall.c_kg_m * (1.0 + (at % 2 == 0 ? fall.uneven : -fall.uneven)) * v * std::abs(v);
  };
  drag.seen = [&fall](double x, double t) {
    return x + fall.wave_m * std::sin(2.0 * std::numbers::pi * x / 0.4) +
           fall.sway_m * std::sin(2.0 * std::numbers::pi * t / 0.45);
  };
  tests::MadeExperiment made =
      tests::made_experiment(launches, drag, seed, fall.noise_m, fall.frames, fall.rate_hz, 0.0, 0.0,
                             {.k_n_s_m = fall.k_n_s_m, .mu = 0.0, .gravity_m_s2 = fall.gravity_m_s2});
  const core::Gravity assumed = core::stated_gravity({});  // as where none is stated
  made.results.gravity_m_s2 = assumed.m_s2;
  made.results.gravity_sd_m_s2 = assumed.sd_m_s2;
  return made;
}

diagnose::Diagnosis diagnosed(const tests::MadeExperiment& made) {
  return diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
}

std::vector<std::string> names(const diagnose::Diagnosis& diagnosis) {
  std::vector<std::string> ids;
  for (const auto& effect : diagnosis.effects) ids.push_back(effect.id);
  return ids;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("the local gravity alone is no effect, from the equator to the poles") {
  for (const double gravity : {9.78, 9.79, 9.81, 9.832}) {
    CAPTURE(gravity);
    Fall fall;
    fall.gravity_m_s2 = gravity;
    fall.masses_kg = {0.05, 0.05, 0.05, 0.12};
    fall.noise_m = 1e-4;
    const diagnose::Diagnosis diagnosis = diagnosed(fallen(fall, 11));
    CHECK(diagnosis.verdict == diagnose::Verdict::none);
    CHECK(names(diagnosis) == Names{});
  }
}

TEST_CASE("at another gravity than the standard one a fall's quadratic drag is named alone") {
  for (const double gravity : {9.78, 9.832}) {
    CAPTURE(gravity);
    Fall fall;
    fall.gravity_m_s2 = gravity;
    fall.c_kg_m = 0.004;
    fall.masses_kg = {0.05, 0.05, 0.12};
    fall.noise_m = 2e-4;
    const Names named = names(diagnosed(fallen(fall, 12)));
    REQUIRE_FALSE(named.empty());
    CHECK(named.front() == "quadratic_drag");
    // What single positions scatter is read off the nominal fit, which is far off.
    if (named.size() > 1) CHECK(named == Names{"quadratic_drag", "heavy_tailed_noise"});
  }
}

TEST_CASE("a fall that is braked harder than air can is judged as any other motion: a viscous drag is none") {
  Fall fall;
  fall.k_n_s_m = 1.5;  // 0.3 kg: a terminal velocity of 2 m/s, and a quadratic drag of 0.8 kg/m for the same force
  fall.masses_kg = {0.3, 0.3};
  CHECK(diagnosed(fallen(fall, 4)).verdict == diagnose::Verdict::none);
}

TEST_CASE("what runs down a track of 85 degrees does not fall freely") {
  Fall fall;
  fall.k_n_s_m = 0.3;
  fall.masses_kg = {0.05, 0.05};
  tests::MadeExperiment made = fallen(fall, 4);
  const auto is_through_air = [&] { return diagnose::track_set(made.results, made.setups, true).through_air; };
  CHECK(is_through_air());
  for (core::ClipSetup& setup : made.setups) setup.incline_rad = 85.0 * std::numbers::pi / 180.0;
  CHECK_FALSE(is_through_air());
}

TEST_CASE("a fall is faster than viscous drag allows only by more than its noise") {
  Fall fall;
  fall.masses_kg = {1e-3};
  fall.k_n_s_m = 1e-3 * 9.80665 / 0.45;  // 0.45 m/s at most; a quarter of the motion has a noise of 0.19 m/s
  fall.noise_m = 8e-3;
  fall.rate_hz = 50.0;
  fall.frames = 14;
  for (unsigned seed = 20; seed < 30; ++seed) {
    CAPTURE(seed);
    const tests::MadeExperiment made = fallen(fall, seed);
    CHECK_FALSE(diagnose::track_set(made.results, made.setups, true).through_air);
  }
}

TEST_CASE("the inertia of a pulley or of a Maxwell wheel is no air, and is named") {
  for (const double times : {3.0, 9.0, 40.0}) {
    CAPTURE(times);
    Fall fall;
    fall.masses_kg = {0.06, 0.06, 0.1};
    fall.added_kg = times * 0.06;  // the same pulley
    fall.noise_m = 5e-4;
    fall.rate_hz = 60.0;
    fall.frames = 60;
    const diagnose::Diagnosis diagnosis = diagnosed(fallen(fall, 21));
    REQUIRE(names(diagnosis) == Names{"rotational_inertia"});
    const diagnose::DiagnosedParameter& found = diagnosis.effects.front().parameters.front();
    CHECK(std::abs(found.value - fall.added_kg) < 4.0 * found.sd);
  }
}

TEST_CASE("a wheel's inertia beside a quadratic drag is a second cause, the inertia of air is not") {
  const auto odds = [](double added_kg) {
    Fall fall;
    fall.masses_kg = {0.06, 0.1};
    fall.c_kg_m = 0.05;
    fall.added_kg = added_kg;
    fall.noise_m = 2e-4;
    fall.rate_hz = 60.0;
    fall.frames = 90;
    const tests::MadeExperiment made = fallen(fall, 24);
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    REQUIRE(set.through_air);
    const std::size_t drag = diagnose::effect_index(diagnose::ids::quadratic_drag),
                      inertia = diagnose::effect_index(diagnose::ids::rotational_inertia);
    const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
    const diagnose::MotionFit turning =
        diagnose::fit_with_effect(set, nominal, inertia, diagnose::with_effect(set, nominal, inertia, {added_kg}, {}));
    const diagnose::MotionFit both =
        diagnose::fit_with_effect(set, turning, drag, diagnose::with_effect(set, turning, drag, {fall.c_kg_m}, {}));
    return diagnose::log_odds_without_air(set, both);
  };
  CHECK(odds(0.003) == 0.0);
  CHECK(odds(0.2) < -2.0);
}

TEST_CASE("a fall with a buoyancy is a wrong scale, and a note says which densities would do the same") {
  Fall fall;
  fall.masses_kg = {2e-3, 2e-3, 4e-3};
  fall.gravity_m_s2 = 0.84 * 9.80665;  // glass in glycerine would be 0.5
  fall.k_n_s_m = 2e-3 * fall.gravity_m_s2 / 0.2;
  fall.noise_m = 1e-4;
  fall.rate_hz = 120.0;
  fall.frames = 60;
  const diagnose::Diagnosis diagnosis = diagnosed(fallen(fall, 22));
  REQUIRE_FALSE(diagnosis.effects.empty());
  CHECK((diagnosis.effects.front().id == "scale_error" || diagnosis.effects.front().id == "frame_rate_error"));
  double ratio = 0.0;
  for (const diagnose::Note& note : diagnosis.notes) {
    if (const auto* of = std::get_if<diagnose::BuoyancyLooksAlike>(&note)) ratio = of->density_ratio;
  }
  CHECK(std::abs(ratio - 0.16) < 0.02);  // the fit may put up to 0.005 of it into g, and has noise
}

TEST_CASE("a fall in a liquid of nearly its own density is an inertia without weight, and a note says so") {
  Fall fall;
  fall.masses_kg = {2e-3, 2e-3, 2e-3};
  fall.gravity_m_s2 = 0.1 * 9.80665;
  fall.k_n_s_m = 2e-3 * fall.gravity_m_s2 / 0.2;
  fall.noise_m = 1e-4;
  fall.rate_hz = 60.0;
  fall.frames = 80;
  const diagnose::Diagnosis diagnosis = diagnosed(fallen(fall, 23));
  CAPTURE(names(diagnosis));
  const diagnose::BuoyancyLooksAlike* of = nullptr;
  for (const diagnose::Note& note : diagnosis.notes) {
    if (of == nullptr) of = std::get_if<diagnose::BuoyancyLooksAlike>(&note);
  }
  REQUIRE(of != nullptr);
  CHECK(of->as_inertia);
  CHECK(std::abs(of->density_ratio - 0.9) < 0.03);
}

TEST_CASE("the g of a drag-free fall is that of a parabola and the spread over the Earth") {
  Fall fall;
  fall.gravity_m_s2 = 9.83;
  const tests::MadeExperiment made = fallen(fall, 3);
  const diagnose::TrackSet set = diagnose::without_drag(diagnose::track_set(made.results, made.setups, true));
  REQUIRE(set.motions.size() == 1);
  const diagnose::TrackedMotion& motion = set.motions.front();
  // x = x0 + v0 t + g t²/2 by weighted least squares, with g = 9.80665 +- 0.015 as one more datum.
  Eigen::MatrixXd design(static_cast<Eigen::Index>(motion.t_s.size()) + 1, 3);
  Eigen::VectorXd x(design.rows());
  for (Eigen::Index i = 0; i + 1 < design.rows(); ++i) {
    const auto p = static_cast<std::size_t>(i);
    const double t = motion.t_s[p] - motion.t_s.front(), w = 1.0 / motion.sd_of(p);
    design.row(i) << w, w * t, 0.5 * w * t * t;
    x[i] = w * motion.x_m[p];
  }
  design.bottomRows(1) << 0.0, 0.0, 1.0 / 0.015;
  x[design.rows() - 1] = 9.80665 / 0.015;
  const Eigen::Vector3d parabola = (design.transpose() * design).ldlt().solve(design.transpose() * x);
  const diagnose::MotionFit fit = diagnose::fit_nominal(set);
  const double g = diagnose::model_of(set, *fit.layout, fit.at, 0).gravity_m_s2;
  // The inclination is known to a degree: g (1 - sin(89°)) = 1.5e-3.
  CHECK(std::abs(g - parabola[2]) < 3e-3);
  CHECK(std::abs(g - 9.80665) > 5e-3);  // the prior alone does not make it
}

TEST_CASE("of coffee filters the quadratic drag comes first and the air that moves along second") {
  Fall fall;
  fall.c_kg_m = 0.0075;
  fall.added_kg = 1.2e-3;
  fall.masses_kg = {1e-3, 1e-3, 2e-3, 3e-3};
  fall.noise_m = 1e-3;
  fall.rate_hz = 60.0;
  fall.frames = 45;
  const diagnose::Diagnosis diagnosis = diagnosed(fallen(fall, 5));
  CHECK(names(diagnosis) == Names{"quadratic_drag", "rotational_inertia"});
  REQUIRE(diagnosis.explained.size() >= 2);
  CHECK(diagnosis.explained[0].id == "quadratic_drag");
  CHECK(diagnosis.explained[0].share > 0.5);  // of what a fall without any drag would leave
  const auto note = std::ranges::find_if(
      diagnosis.notes, [](const auto& one) { return std::holds_alternative<diagnose::FallsThroughAir>(one); });
  REQUIRE(note != diagnosis.notes.end());
  const auto gaps = std::get<diagnose::FallsThroughAir>(*note).gaps;
  REQUIRE(gaps);
  REQUIRE(diagnosis.remainder);
  CHECK(gaps->named == diagnosis.remainder->gap);
  CHECK(gaps->viscous > gaps->named);  // the made drag is quadratic
  REQUIRE(diagnosis.recovered.size() == 3);
  for (const auto& one : diagnosis.recovered) {
    CHECK_FALSE(one.k_over_m_1_s.estimate);
    REQUIRE(one.v_lim_m_s.estimate);
    const double terminal = std::sqrt(one.mass_kg * 9.80665 / fall.c_kg_m);
    CHECK(std::abs(one.v_lim_m_s.estimate->value - terminal) < 4.0 * one.v_lim_m_s.estimate->sd);
  }
}

TEST_CASE("of fifteen positions of a paper cup the drag is quadratic, since no other is") {
  Fall fall;
  fall.masses_kg = {2e-3};
  fall.c_kg_m = 2e-3 * 9.80665 / (2.2 * 2.2);
  fall.noise_m = 2e-3;
  fall.rate_hz = 25.0;
  fall.frames = 15;
  const diagnose::Diagnosis diagnosis = diagnosed(fallen(fall, 9));
  CHECK(names(diagnosis) == Names{"quadratic_drag"});
  CHECK(diagnosis.points == 15);
}

TEST_CASE("a bead in oil has a viscous drag, and nothing is missing") {
  Fall fall;
  fall.masses_kg = {1e-3, 1e-3, 3e-3};
  fall.k_n_s_m = 1e-3 * 9.80665 / 0.06;
  fall.noise_m = 3e-4;
  fall.rate_hz = 60.0;
  fall.frames = 120;
  const tests::MadeExperiment made = fallen(fall, 6);
  CHECK_FALSE(diagnose::track_set(made.results, made.setups, true).through_air);
  const diagnose::Diagnosis diagnosis = diagnosed(made);
  CHECK(diagnosis.verdict == diagnose::Verdict::none);
  REQUIRE(diagnosis.recovered.front().k_over_m_1_s.estimate);
}

TEST_CASE("a fast fall whose drag is viscous beyond doubt, as that of a magnet in a pipe, keeps its K") {
  Fall fall;
  fall.masses_kg = {0.01, 0.01, 0.02};
  fall.k_n_s_m = 0.01 * 9.80665 / 1.5;
  fall.noise_m = 5e-4;
  const tests::MadeExperiment made = fallen(fall, 7);
  CHECK(diagnose::track_set(made.results, made.setups, true).through_air);
  const diagnose::Diagnosis diagnosis = diagnosed(made);
  CHECK(diagnosis.verdict == diagnose::Verdict::none);
  REQUIRE(diagnosis.recovered.front().k_over_m_1_s.estimate);
  const core::Estimate& k = *diagnosis.recovered.front().k_over_m_1_s.estimate;
  CHECK(std::abs(k.value - 9.80665 / 1.5) < 4.0 * k.sd);
}

TEST_CASE("a fall without visible drag lacks nothing") {
  Fall fall;
  fall.masses_kg = {0.2, 0.2};
  fall.noise_m = 2e-3;
  fall.rate_hz = 30.0;
  fall.frames = 14;
  CHECK(diagnosed(fallen(fall, 8)).verdict == diagnose::Verdict::none);
}

namespace {

/// Four cups of paper, seen a few times a second, whose drags and positions are off by a little each.
Fall cups(double rate_hz, double uneven, double wave_m) {
  Fall fall;
  fall.c_kg_m = 0.005;
  fall.added_kg = 0.4e-3;
  fall.masses_kg = {0.55e-3, 1.1e-3, 1.65e-3, 2.2e-3};
  fall.noise_m = 1e-3;
  fall.rate_hz = rate_hz;
  fall.frames = static_cast<std::size_t>(std::lround(1.3 * rate_hz));
  fall.uneven = uneven;
  fall.wave_m = wave_m;
  return fall;
}

}  // namespace

TEST_CASE("no fall begins far faster than it was ever seen, however soon it would be braked") {
  for (const double uneven : {0.05, 0.1}) {
    const tests::MadeExperiment made = fallen(cups(10.0, uneven, 0.0), 1);
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
    const std::size_t drag = diagnose::effect_index("quadratic_drag");
    const diagnose::MotionFit with_drag =
        diagnose::fit_with_effect(set, nominal, drag, diagnose::with_effect(set, nominal, drag, {0.005}, {}));
    REQUIRE(nominal.at.own.size() == 4);
    REQUIRE(with_drag.at.own.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
      double fastest = 0.0;  // the mean speed between two positions
      const diagnose::TrackedMotion& motion = set.motions[i];
      for (std::size_t p = 1; p < motion.x_m.size(); ++p) {
        fastest = std::max(fastest, (motion.x_m[p] - motion.x_m[p - 1]) / (motion.t_s[p] - motion.t_s[p - 1]));
      }
      // The noise of two positions 0.1 s apart adds a tenth or so to the fastest.
      CHECK(std::abs(nominal.at.own[i][1]) < 4.0 * fastest);
      CHECK(std::abs(with_drag.at.own[i][1]) < 4.0 * fastest);
    }
  }
}

// A diagnosis finds other causes beside the drag, and drops them where they take no part of the gap.
TEST_CASE("the size of the one cause that is named is that of a fit with this cause alone") {
  int alone = 0;
  for (Fall fall : {cups(10.0, 0.0, 2e-3), cups(15.0, 0.0, 2e-3), cups(15.0, 0.0, 3e-3)}) {
    fall.added_kg = 0.0;  // no air that moves along
    for (const unsigned seed : {1u, 2u}) {
      const tests::MadeExperiment made = fallen(fall, seed);
      const diagnose::Diagnosis diagnosis = diagnosed(made);
      if (names(diagnosis) != Names{"quadratic_drag"}) continue;
      const diagnose::GivenCauses given = diagnose::fit_given_causes(
          made.results, made.setups, std::vector<std::optional<core::CameraSettings>>(made.setups.size()),
          {"quadratic_drag"}, "--with");
      const auto &stated = diagnosis.effects.at(0).parameters.at(0), &fitted = given.causes.at(0).parameters.at(0);
      // The same model of the same positions, reached from another start: the remainder's sizes differ by a step of
      // their search, which is 1.4.
      CHECK(std::abs(stated.value - fitted.value) < 0.5 * fitted.sd);
      CHECK(stated.sd < 1.5 * fitted.sd);
      CHECK(fitted.sd < 1.5 * stated.sd);
      ++alone;
    }
  }
  CHECK(alone >= 2);
}

// A fall that a magnet brakes, seen by a camera that sways: air cannot brake like that, and other causes hide it.
TEST_CASE("a drag of air is not named where a viscous one leaves far less of the gap") {
  Fall fall;
  fall.k_n_s_m = 0.1;
  fall.masses_kg = {0.1};
  fall.noise_m = 2e-4;
  fall.rate_hz = 60.0;
  fall.frames = 52;
  for (const auto& [sway_m, seed] : {std::pair(1e-3, 3u), std::pair(4e-3, 1u), std::pair(1e-3, 2u)}) {
    CAPTURE(sway_m, seed);
    fall.sway_m = sway_m;
    const std::vector<std::string> named = names(diagnosed(fallen(fall, seed)));
    CHECK(std::find(named.begin(), named.end(), diagnose::ids::quadratic_drag) == named.end());
  }
}

// As seen with a scale or a clock that is off: the fall is slower than gravity allows, and nothing brakes it.
TEST_CASE("a drag of no certain size is not named beside a wrong scale or clock") {
  for (const double gravity_m_s2 : {8.4, 8.7}) {
    for (const std::size_t clips : {1u, 2u}) {
      Fall fall;
      fall.gravity_m_s2 = gravity_m_s2;
      fall.masses_kg.assign(clips, 0.01);
      fall.noise_m = 2e-4;
      fall.rate_hz = 30.0;
      fall.frames = 24;
      fall.wave_m = 4e-3;
      const diagnose::Diagnosis diagnosis = diagnosed(fallen(fall, 3));
      REQUIRE(diagnosis.effects.size() == 1);
      const diagnose::DiagnosedEffect& effect = diagnosis.effects.front();
      // A clock that runs wrong by e shows g (1 + e)^2, a scale g (1 + e).
      const double seen = gravity_m_s2 / 9.80665;
      const double e = effect.id == "frame_rate_error" ? std::sqrt(seen) - 1.0 : seen - 1.0;
      CHECK((effect.id == "frame_rate_error" || effect.id == "scale_error"));
      REQUIRE(effect.parameters.size() == 1);
      CHECK(std::abs(effect.parameters[0].value - e) < 3.0 * effect.parameters[0].sd);
    }
  }
}

TEST_CASE(
    "a magnet that sinks through a tube at one speed has the drag that stops it at first, and nothing is missing") {
  Fall fall;
  fall.masses_kg = {0.012, 0.014, 0.016};
  fall.k_n_s_m = 0.012 * fall.gravity_m_s2 / 0.142;  // 0.142 m/s of the lightest, within 15 ms
  fall.noise_m = 4e-4;
  fall.rate_hz = 240.0;
  fall.frames = 300;
  tests::MadeExperiment made = fallen(fall, 29);
  // As the analysis of such falls has it: no line with a slope.
  core::LineFit line;
  line.direction = 1;
  line.a0_m_s2 = core::estimate(-0.03, 0.02, 100.0);
  core::ConfigurationResult falls;
  falls.incline_deg = 90.0;
  falls.lines = {line};
  made.results.configurations = {falls};
  const diagnose::Diagnosis diagnosis = diagnosed(made);
  CAPTURE(names(diagnosis));
  CHECK(diagnosis.verdict == diagnose::Verdict::none);
  REQUIRE(diagnosis.recovered.size() == 3);
  for (const diagnose::RecoveredConfiguration& one : diagnosis.recovered) {
    CAPTURE(one.mass_kg);
    const double rate = fall.k_n_s_m / one.mass_kg;
    REQUIRE((one.k_over_m_1_s.estimate && one.v_lim_m_s.estimate));
    const core::Estimate& k = *one.k_over_m_1_s.estimate;  // by the first 15 ms: a liquid may bear part of the weight
    CHECK(std::abs(k.value - rate) < 3.0 * k.sd);
    CHECK(k.sd < 0.3 * rate);
    CHECK(one.v_lim_m_s.estimate->value == Approx(fall.gravity_m_s2 / rate).epsilon(0.01));
  }
}
