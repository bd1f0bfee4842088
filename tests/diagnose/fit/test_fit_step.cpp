#include "diagnose/fit/fit_step.h"

#include <cmath>
#include <cstddef>

#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/tracked_motions.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

/// A bead that sinks at its final speed of 74 mm/s from the first frame on; its
/// first positions are seen too far down, by 5 mm and falling.
diagnose::TrackSet sinking_bead() {
  tests::MadeGlider bead{.k_n_s_m = 0.05 * 133.0, .mu = 0.0};
  const auto made = tests::made_experiment({{0.05, 90.0, 0.0, 9.80665 / 133.0}},
                                           {.seen = [](double x, double t) { return x + 5e-3 * std::exp(-t / 0.2); }},
                                           1, 1e-4, 70, 20.0, 1.0, 0.0, bead);
  return diagnose::track_set(made.results, made.setups, true);
}

}  // namespace

TEST_CASE("a start whose speed stops at its limit does not end the fit") {
  const diagnose::TrackSet set = sinking_bead();
  REQUIRE(set.motions.size() == 1);
  const diagnose::MotionFit fit = diagnose::fit_nominal(set);
  CHECK(fit.converged);
  CHECK(std::abs(fit.at.own[0][diagnose::kStartSpeed]) <= diagnose::fastest_start(set.motions[0]));
  // The mean speed of the last two thirds, where 5 mm have fallen below 0.04 mm, is that of the balance.
  const auto& motion = set.motions[0];
  const std::size_t from = motion.t_s.size() / 3, to = motion.t_s.size() - 1;
  const double v = (motion.x_m[to] - motion.x_m[from]) / (motion.t_s[to] - motion.t_s[from]);
  CHECK(fit.at.global[0] / 0.05 == Approx(9.80665 / v).epsilon(0.03));
}

TEST_CASE("a step stays within the limits, and all else takes the best step beside a start that stops") {
  const diagnose::TrackSet set = sinking_bead();
  diagnose::MotionFit fit = diagnose::fit_nominal(set);
  // One motion, so that its start can be held by hand: at the limit, with a column of derivatives of no effect.
  const double most = diagnose::fastest_start(set.motions[0]);
  fit.at.own[0][diagnose::kStartSpeed] = most;
  fit.motions[0].residual += 1e3 * fit.motions[0].own.col(diagnose::kStartSpeed);  // pulls the start beyond its limit
  const diagnose::FitPoint free = diagnose::step_from(set, fit, 1e-6);
  CHECK(free.own[0][diagnose::kStartSpeed] == most);
  fit.motions[0].own.col(diagnose::kStartSpeed).setZero();
  const diagnose::FitPoint held = diagnose::step_from(set, fit, 1e-6);
  for (Eigen::Index g = 0; g < held.global.size(); ++g) {
    CHECK(free.global[g] == Approx(held.global[g]).epsilon(1e-9).margin(1e-12));
  }
  CHECK(free.own[0][0] == Approx(held.own[0][0]).epsilon(1e-9));
}
