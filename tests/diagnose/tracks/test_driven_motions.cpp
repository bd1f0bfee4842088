#include "diagnose/tracks/tracked_motions.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/model/track_model.h"
#include "diagnose/verdict/diagnose.h"
#include "diagnose/verdict/verdict_details.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

constexpr double kTurn = 2.9;  // rad/s of the force: a turn every 1.08 s

/// One long clip of a glider that a motor pulls to and fro, in which it stops and leaves again at every turn.
tests::MadeExperiment to_and_fro(double force_n, const tests::MadeEffect& other = {}) {
  tests::MadeEffect effect = other;
  effect.recorded = [force_n](double t) { return force_n * std::sin(kTurn * t); };
  return tests::made_experiment({{0.4, 0.0, 0.0, 0.05}}, effect, 11, 2e-5, 4000, 100.0);
}

diagnose::TrackedMotion swinging(double seconds, double rate_hz) {
  diagnose::TrackedMotion motion;
  motion.sd_m = 1e-5;
  for (int i = 0; i < seconds * rate_hz; ++i) {
    const double t = i / rate_hz;
    motion.t_s.push_back(t);
    motion.x_m.push_back(0.1 * std::sin(2.0 * std::acos(-1.0) * t));
    motion.outlier.push_back(0);
    motion.known.t_s.push_back(t);
    motion.known.force_n.push_back(1.0 + t);
  }
  return motion;
}

}  // namespace

TEST_CASE("a glider at rest leaves at the instant at which a rising force passes its friction") {
  // F = r t between samples 0.5 s apart; friction f holds until t* = f / r, then m x'' = r (t - t*): x = r (t - t*)³ /
  // (6 m).
  diagnose::TrackModel model;
  model.mass_kg = 0.5;
  model.mu = 0.02;
  const double r = 0.31, friction = model.mu * model.mass_kg * model.gravity_m_s2, leaves = friction / r;
  diagnose::KnownForce known;
  for (int i = 0; i <= 3; ++i) {
    known.t_s.push_back(0.5 * i);
    known.force_n.push_back(-r * known.t_s.back());  // the other way: uphill
  }
  model.known = &known;
  const std::vector<double> times = {0.0, 0.2, 0.45, 0.8, 1.2, 1.4};
  const diagnose::Moved moved = diagnose::move(model, times);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double since = std::max(0.0, times[i] - leaves);
    CHECK(moved.x_m[i] == Approx(-r * std::pow(since, 3) / (6.0 * model.mass_kg)).margin(1e-12));  // exact but for eps
  }
}

TEST_CASE("a glider that friction holds either way stays, whatever way the force would take it") {
  // An unnamed friction more: it turns with the motion. At rest it cannot set anything going.
  diagnose::TrackModel model;
  model.mass_kg = 0.5;
  model.mu = 0.01;
  const double friction = model.mu * model.mass_kg * model.gravity_m_s2;
  const diagnose::UnnamedForce more = [](double, double v, double) { return v < 0.0 ? 0.02 : -0.02; };
  model.unnamed = &more;
  const diagnose::KnownForce known{{0.0, 1.0}, {friction + 0.01, friction + 0.01}};
  model.known = &known;
  for (const double x : diagnose::move(model, std::vector<double>{0.0, 0.3, 0.6, 1.0}).x_m) CHECK(x == 0.0);
}

TEST_CASE("turns are where a motion comes back from") {
  const diagnose::TrackedMotion motion = swinging(3.0, 200.0);
  const std::vector<std::size_t> turns = diagnose::turns_of(motion);
  REQUIRE(turns.size() == 6);
  for (std::size_t k = 0; k < turns.size(); ++k) CHECK(turns[k] == 50 + 100 * k);
}

TEST_CASE("a motion that turns many times is cut between turns, each piece with its force") {
  diagnose::TrackSet set;
  set.clips.push_back({"only", 200.0, 30.0, 6000, 0.01});
  set.motions.push_back(swinging(30.0, 200.0));
  diagnose::cut_driven_motions(set, 12);
  REQUIRE(set.motions.size() == 30);
  CHECK(set.clips.size() == 30);
  double before = -1.0;
  for (const diagnose::TrackedMotion& piece : set.motions) {
    CHECK(diagnose::turns_of(piece).size() == 2);
    CHECK(piece.t_s.front() == Approx(before < 0.0 ? 0.0 : before + 0.005));
    before = piece.t_s.back();
    CHECK(piece.known.t_s.front() <= piece.t_s.front());
    CHECK(piece.known.t_s.back() >= piece.t_s.back() - 1e-12);
    CHECK(piece.known.force_n.front() == Approx(1.0 + piece.known.t_s.front()));
  }
  diagnose::TrackSet few;
  few.clips = {{"only", 200.0, 2.0, 400, 0.01}};
  few.motions.push_back(swinging(2.0, 200.0));
  diagnose::cut_driven_motions(few, 12);
  CHECK(few.motions.size() == 1);
  CHECK(few.notes.empty());
}

TEST_CASE("of very many pieces 40 are weighed, from beginning to end") {
  diagnose::TrackSet set;
  for (int c = 0; c < 3; ++c) {
    set.clips.push_back({"clip", 200.0, 60.0, 12000, 0.01});
    set.motions.push_back(swinging(60.0, 200.0));
    set.motions.back().clip = static_cast<std::size_t>(c);
  }
  diagnose::cut_driven_motions(set, 12);
  REQUIRE(set.motions.size() == 40);
  CHECK(set.notes.size() == 3);  // pieces, how many of them, how many positions
  for (std::size_t c = 0; c < 3; ++c) {
    const auto of_clip = std::count_if(set.motions.begin(), set.motions.end(),
                                       [c](const diagnose::TrackedMotion& motion) { return motion.clip == c; });
    CHECK(of_clip >= 13);
    CHECK(of_clip <= 14);
  }
}

TEST_CASE("a long motion that stops and starts at every turn lacks nothing where nothing is missing") {
  const auto made = to_and_fro(0.06);
  const diagnose::Diagnosis diagnosis = diagnose::diagnose_results(made.results, made.setups, {});
  CHECK(diagnosis.verdict == diagnose::Verdict::none);
  REQUIRE(diagnosis.gap);
  CHECK(diagnosis.gap->before == Approx(1.0).margin(0.1));
  CHECK(diagnosis.gap->held_out.size() > 10);
}

TEST_CASE("a drag beside a force that turns the glider dozens of times keeps its name and size") {
  const auto made =
      to_and_fro(0.5, {.force = [](double, double, double v, double) { return -0.15 * v * std::abs(v); }});
  const diagnose::Diagnosis diagnosis = diagnose::diagnose_results(made.results, made.setups, {});
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  CHECK(diagnosis.effects.front().id == "quadratic_drag");
  CHECK(diagnosis.effects.front().parameters.front().value == Approx(0.15).epsilon(0.1));
}

TEST_CASE("a motion whose first positions are all set aside is fitted from those behind") {
  const auto made = tests::made_experiment(tests::made_launches(), {}, 5);
  diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  std::fill_n(set.motions.front().outlier.begin(), 30, char{1});
  const diagnose::MotionFit fit = diagnose::fit_nominal(set);
  double points = 0.0;
  for (const diagnose::TrackedMotion& motion : set.motions) points += static_cast<double>(motion.t_s.size());
  CHECK(fit.cost < 1.3 * points);
}

TEST_CASE("the force that a model lacks is seen in the accelerations") {
  // A push of 0.1 N from 0.6 to 0.9 s that the nominal model has not: the fit spreads some of it, and noise of 1 um
  // adds 0.4 kg 0.11 1 um / (10 ms)² = 0.5 mN.
  const auto made = tests::made_experiment(
      tests::made_launches(),
      {.force = [](double, double, double, double t) { return t > 0.6 && t < 0.9 ? 0.1 : 0.0; }}, 3, 1e-6, 150, 100.0);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  const double lacking = diagnose::most_lacking(set, diagnose::fit_nominal(set)).force_n;
  CHECK(lacking > 0.05);
  CHECK(lacking < 0.2);
  const auto whole = tests::made_experiment(tests::made_launches(), {}, 3, 1e-6, 150, 100.0);
  const diagnose::TrackSet nothing = diagnose::track_set(whole.results, whole.setups, true);
  CHECK(diagnose::most_lacking(nothing, diagnose::fit_nominal(nothing)).force_n < 0.005);
}
