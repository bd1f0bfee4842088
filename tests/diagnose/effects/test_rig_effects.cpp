// Effects of test rigs: each law against an independent integration.
#include <cmath>
#include <numbers>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/model/track_model.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

using tests::MadeEffect;
using tests::MadeLaunch;
constexpr tests::MadeGlider kGlider;

double sign_of(double v) {
  return v < 0.0 ? -1.0 : 1.0;
}

/// The force of a motor that pulls back and forth.
double pull_n(double t) {
  return 0.25 * std::sin(7.0 * t) + 0.15 * std::sin(17.0 * t);
}

/// Samples of a force, a hundred times as dense as the frames. Linear interpolation errs by (17/s)² (1e-4 s)²/8 of the
/// force.
diagnose::KnownForce samples_of(double (*force)(double)) {
  diagnose::KnownForce known;
  for (int i = -3000; i <= 20000; ++i) {
    known.t_s.push_back(1e-4 * i);
    known.force_n.push_back(force(known.t_s.back()));
  }
  return known;
}

diagnose::TrackModel model_of(const MadeLaunch& launch, const diagnose::KnownForce* known = nullptr) {
  diagnose::TrackModel model;
  model.mass_kg = launch.mass_kg;
  model.gravity_m_s2 = kGlider.gravity_m_s2;
  model.k_n_s_m = kGlider.k_n_s_m;
  model.mu = kGlider.mu;
  model.alpha_rad = launch.incline_deg * std::numbers::pi / 180.0;
  model.x0_m = launch.x0_m;
  model.v0_m_s = launch.v0_m_s;
  model.x_low_m = -0.8;
  model.x_high_m = 0.9;
  model.known = known;
  return model;
}

/// The largest distance between the two motions over 1.5 s at 100 frames per second.
double apart_m(const diagnose::TrackModel& model, const MadeLaunch& launch, const MadeEffect& effect) {
  std::vector<double> t;
  for (int i = 0; i < 150; ++i) t.push_back(0.01 * i);
  const std::vector<double> x = diagnose::move(model, t).x_m,
                            made = tests::made_motion(kGlider, launch, effect, 150, 100.0);
  double most = 0.0;
  for (std::size_t i = 0; i < t.size(); ++i) most = std::max(most, std::abs(x[i] - made[i]));
  return most;
}

// With steps of 10 ms, the error of the method is below 1e-7 m (tests of the track model). The generator finds v = 0 to
// a (0.2 ms)²/8, about 1e-8 m.
constexpr double kSmooth_m = 2e-7;

}  // namespace

TEST_CASE("a drag that depends on the direction, an end stop and a wrong mass move the glider as an integration says") {
  using diagnose::slot_of;
  namespace ids = diagnose::ids;
  for (const MadeLaunch& launch : tests::made_launches()) {
    INFO(launch.mass_kg << " kg, " << launch.incline_deg << " deg, " << launch.v0_m_s << " m/s");
    diagnose::TrackModel directed = model_of(launch);
    directed.effects[slot_of(ids::direction_dependent_drag)] = 0.2;
    CHECK(apart_m(directed, launch, {.force = [](double, double, double v, double) {
                    return -0.2 * kGlider.k_n_s_m * std::abs(v);
                  }}) < kSmooth_m);
    // The force has a corner at x_b. Simpson's rule over a corner errs by at most J h²/24 in speed, with J = k v/m and
    // h = 12.6 ms, once on the way in and once on the way out, and by m/K times as much in position.
    constexpr double kStop_n_m = 8.0, kFastest_m_s = 1.3, kStep_s = 0.0126;
    constexpr double kCorner_m = 2.0 * kStop_n_m * kFastest_m_s * kStep_s * kStep_s / 24.0 / kGlider.k_n_s_m;
    for (const double stop : {-0.45, 0.35}) {
      diagnose::TrackModel stopped = model_of(launch);
      stopped.effects[slot_of(ids::end_stop, 0)] = kStop_n_m;
      stopped.effects[slot_of(ids::end_stop, 1)] = stop;
      CHECK(apart_m(stopped, launch, {.force = [=](double, double x, double, double) {
                      const bool touches = stop > 0.0 ? x > stop : x < stop;
                      return touches ? -kStop_n_m * (x - stop) : 0.0;
                    }}) < kSmooth_m + kCorner_m);
    }
  }
}

TEST_CASE("a recorded force that is late, too small, or moves another mass acts as an integration says") {
  using diagnose::slot_of;
  namespace ids = diagnose::ids;
  const diagnose::KnownForce known = samples_of(pull_n);
  for (const MadeLaunch& launch : tests::made_launches()) {
    INFO(launch.mass_kg << " kg, " << launch.incline_deg << " deg, " << launch.v0_m_s << " m/s");
    diagnose::TrackModel late = model_of(launch, &known), small = late, heavy = late;
    late.effects[slot_of(ids::force_delay)] = 0.03;
    CHECK(apart_m(late, launch, {.recorded = [](double t) { return pull_n(t - 0.03); }}) < 5.0 * kSmooth_m);
    small.effects[slot_of(ids::force_gain)] = 0.2;
    CHECK(apart_m(small, launch, {.recorded = [](double t) { return 1.2 * pull_n(t); }}) < 5.0 * kSmooth_m);
    heavy.effects[slot_of(ids::mass_error)] = 0.25;
    MadeLaunch inert = launch;
    inert.inertia = 1.25;
    CHECK(apart_m(heavy, inert, {.recorded = pull_n}) < 5.0 * kSmooth_m);
    heavy.known = nullptr;  // nothing drives it
    CHECK(apart_m(heavy, launch, {}) < kSmooth_m);
  }
}

TEST_CASE("friction and drag of a configuration, of a clip and of a clip's number are those of the launch") {
  using diagnose::slot_of;
  namespace ids = diagnose::ids;
  for (MadeLaunch launch : tests::made_launches()) {
    INFO(launch.mass_kg << " kg, " << launch.incline_deg << " deg, " << launch.v0_m_s << " m/s");
    const diagnose::TrackModel nominal = model_of(launch);
    launch.mu_more = 0.002;
    diagnose::TrackModel configured = nominal, scattered = nominal, drifting = nominal;
    configured.effects[slot_of(ids::configuration_friction)] = 0.002;
    CHECK(apart_m(configured, launch, {}) < kSmooth_m);
    drifting.effects[slot_of(ids::friction_drift)] = 0.002 / (4.0 * kGlider.mu);
    drifting.clip = 4;
    CHECK(apart_m(drifting, launch, {}) < kSmooth_m);
    launch.k_more_n_s_m = 0.1;
    configured.effects[slot_of(ids::configuration_drag)] = 0.1 / kGlider.k_n_s_m;
    CHECK(apart_m(configured, launch, {}) < kSmooth_m);
    scattered.effects[slot_of(ids::clip_scatter, 0)] = 0.002;
    scattered.effects[slot_of(ids::clip_scatter, 1)] = 0.1 / kGlider.k_n_s_m;
    CHECK(apart_m(scattered, launch, {}) < kSmooth_m);
    launch.mu_more = 0.0;  // one of the two deviations may be 0
    scattered.effects[slot_of(ids::clip_scatter, 0)] = 0.0;
    CHECK(apart_m(scattered, launch, {}) < kSmooth_m);
  }
}

TEST_CASE("friction along the track is a sum of bumps less their means over the track") {
  // The means by a sum over the track, which is five bump widths long.
  const std::vector<double> sizes = {0.3, -0.2, 0.4, 0.0, -0.5, 0.1};
  const double low = -0.8, high = 0.9;
  const auto bumps = [&](double x) {
    double sum = 0.0;
    for (std::size_t j = 0; j < sizes.size(); ++j) {
      const double u = 5.0 * (x - low) / (high - low) - static_cast<double>(j);
      sum += sizes[j] * std::exp(-0.5 * u * u);
    }
    return sum;
  };
  double mean = 0.0;
  for (int i = 0; i < 20000; ++i) mean += bumps(low + (high - low) * (i + 0.5) / 20000.0) / 20000.0;
  for (const MadeLaunch& launch : tests::made_launches()) {
    INFO(launch.mass_kg << " kg, " << launch.incline_deg << " deg, " << launch.v0_m_s << " m/s");
    diagnose::TrackModel model = model_of(launch);
    for (std::size_t j = 0; j < sizes.size(); ++j) model.effects[diagnose::slot_of("place_friction", j)] = sizes[j];
    const double cos_alpha = std::cos(model.alpha_rad);
    CHECK(apart_m(model, launch, {.force = [&](double m, double x, double v, double) {
                    return -sign_of(v) * kGlider.mu * (bumps(x) - mean) * m * kGlider.gravity_m_s2 * cos_alpha;
                  }}) < kSmooth_m);
  }
}
