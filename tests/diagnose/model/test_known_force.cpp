#include <cmath>
#include <string_view>
#include <vector>

#include "diagnose/fit/nominal_fit.h"
#include "diagnose/model/track_model.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/tracks/tracked_motions.h"
#include "diagnose/verdict/diagnose.h"
#include "diagnose/weigh/hypothesis.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

/// A motor that pulls to and fro, recorded with the positions; the four launches are those of one level set-up.
double pull_n(double t) {
  return 0.25 * std::sin(7.0 * t) + 0.15 * std::sin(17.0 * t);
}

diagnose::Diagnosis diagnosed(const tests::MadeEffect& effect) {
  const auto made = tests::made_experiment(tests::made_launches(), effect, 5, 2e-5, 200, 200.0);
  return diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
}

}  // namespace

TEST_CASE("a force that is recorded as a line moves the glider as the closed form says") {
  // m v' = F0 + F1 t - K v, v(0) = v0: v = c exp(-k t) + a + b t with b = F1/K, a = (F0 - m b)/K, c = v0 - a.
  diagnose::TrackModel model;
  model.mass_kg = 0.4;
  model.k_n_s_m = 0.8;
  model.v0_m_s = 0.3;
  model.x0_m = -0.1;
  const double f0 = 0.2, f1 = 0.5, k = model.k_n_s_m / model.mass_kg;
  diagnose::KnownForce known;
  for (int i = 0; i <= 7; ++i) {  // samples of another rate than the frames
    const double t = 0.13 * i;
    known.t_s.push_back(t);
    known.force_n.push_back(f0 + f1 * t);
  }
  model.known = &known;
  std::vector<double> times;
  for (int i = 0; i < 60; ++i) times.push_back(0.015 * i);
  const diagnose::Moved moved = diagnose::move(model, times);
  const double b = f1 / model.k_n_s_m, a = (f0 - model.mass_kg * b) / model.k_n_s_m, c = model.v0_m_s - a;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double t = times[i], e = std::exp(-k * t);
    CHECK(moved.v_m_s[i] == Approx(c * e + a + b * t).margin(1e-8));
    CHECK(moved.x_m[i] == Approx(model.x0_m + c / k * (1.0 - e) + a * t + 0.5 * b * t * t).margin(1e-8));
  }
}

TEST_CASE("a recorded force is no gap, and another effect beside it keeps its name") {
  const diagnose::Diagnosis nothing = diagnosed({.recorded = pull_n});
  CHECK(nothing.verdict == diagnose::Verdict::none);
  REQUIRE(nothing.gap);
  CHECK(nothing.gap->before == Approx(1.0).margin(0.1));
  const diagnose::Diagnosis drag = diagnosed(
      {.force = [](double, double, double v, double) { return -0.15 * v * std::abs(v); }, .recorded = pull_n});
  REQUIRE(drag.verdict == diagnose::Verdict::effect);
  CHECK(drag.effects.front().id == "quadratic_drag");
  CHECK(drag.effects.front().parameters.front().value == Approx(0.15).epsilon(0.1));
}

TEST_CASE("the same force is a gap where nobody recorded it") {
  const diagnose::Diagnosis hidden = diagnosed({.force = [](double, double, double, double t) { return pull_n(t); }});
  CHECK(hidden.verdict != diagnose::Verdict::none);
}

TEST_CASE("of very many positions some are weighed, spread over every motion") {
  diagnose::TrackSet set;
  set.motions.resize(2);
  for (diagnose::TrackedMotion& motion : set.motions) {
    for (int i = 0; i < 36000; ++i) {
      motion.t_s.push_back(1e-3 * i);
      motion.x_m.push_back(2e-3 * i);
      motion.outlier.push_back(0);
      motion.wider.push_back(1.0 + i);
    }
  }
  diagnose::thin_out(set, 12);
  REQUIRE(set.motions.size() == 2);
  CHECK(set.notes.size() == 1);
  for (const diagnose::TrackedMotion& motion : set.motions) {
    REQUIRE(motion.t_s.size() == 12000);
    for (std::size_t i = 0; i < motion.t_s.size(); ++i) {
      CHECK(motion.t_s[i] == Approx(3e-3 * static_cast<double>(i)));
      CHECK(motion.sd_of(i) == Approx(motion.sd_m * (1.0 + 3.0 * static_cast<double>(i))));
    }
  }
}

TEST_CASE("a wrong mass and a wrong scale of the force are one cause, and a drag is another") {
  // m (1 + e) v' = F - K v and m v' = F/(1 + e) - K' v are one law, with K' = K/(1 + e); with one mass on a level track
  // (m + m_w) v' = F - K v is the same again.
  const std::vector<tests::MadeLaunch> launches = {{0.4, 0.0, -0.2, 0.2}, {0.4, 0.0, -0.2, 0.5}};
  const tests::MadeEffect pulled{.recorded = [](double t) { return 0.3 + 0.15 * std::sin(9.0 * t); }};
  const auto made = tests::made_experiment(launches, pulled, 5, 2e-5, 150, 200.0);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const diagnose::ScoreSpace space(set, nominal);
  const std::vector<std::size_t> alike = diagnose::alike_in(space, diagnose::scan_effects(space, {}, 2));
  const auto first = [&](std::string_view id) { return alike[diagnose::effect_index(id)]; };
  CHECK(first("mass_error") == first("force_gain"));
  CHECK(first("rotational_inertia") == first("force_gain"));
  CHECK(first("quadratic_drag") != first("force_gain"));
}
