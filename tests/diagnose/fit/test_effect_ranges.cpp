#include "diagnose/fit/fit_model.h"

#include <array>
#include <cmath>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/scan/effect_scan.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

diagnose::TrackSet set_with(const tests::MadeEffect& effect, unsigned seed) {
  const auto made = tests::made_experiment(tests::made_launches(), effect, seed, 2e-5, 150, 100.0);
  return diagnose::track_set(made.results, made.setups, true);
}

}  // namespace

TEST_CASE("a lens that is fitted to a pattern off its plane has its axis at the edge, and no farther") {
  // x/(1 + p x) = x - p x² + ...: the lens k x (x - x_c)² with -2 k x_c = -p, a scale taken up, the better the smaller
  // k.
  const diagnose::TrackSet set = set_with({.seen = [](double x, double) { return x / (1.0 + 0.02 * x); }}, 3);
  const std::size_t lens = diagnose::effect_index("lens_distortion");
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const diagnose::ScoreSpace space(set, nominal);
  const diagnose::EffectScan scan = diagnose::scan_effect(space, lens);
  const diagnose::MotionFit fit =
      diagnose::fit_motions(set, {lens}, diagnose::with_effect(set, nominal, lens, scan.values, {}));
  const auto at = static_cast<Eigen::Index>(fit.layout->first_of(lens)) + 1;
  const diagnose::ParameterRange range = diagnose::range_of_places(set);
  CHECK((fit.at.global[at] == range.low || fit.at.global[at] == range.high));
  // The others go on to their best: no step of theirs lowers chi² any more.
  CHECK(fit.converged);
  CHECK(fit.cost < nominal.cost);
  for (Eigen::Index g = 0; g < at; ++g) {
    double slope = 0.0, square = 0.0;
    for (const diagnose::FitMotion& motion : fit.motions) {
      slope += motion.global.col(g).dot(motion.residual);
      square += motion.global.col(g).squaredNorm();
    }
    for (const diagnose::FitStatement& s : fit.statements) {
      if (static_cast<Eigen::Index>(s.global) != g) continue;
      slope += (s.value - fit.at.global[g]) / (s.sd * s.sd);
      square += 1.0 / (s.sd * s.sd);
    }
    CHECK(std::abs(slope) < 0.1 * std::sqrt(square));  // of a standard deviation, the others held
  }
}

TEST_CASE("a wide-angle lens near the track is within reach of the fit") {
  constexpr double k = -0.8;  // 1/m²: the ends of a range of 0.9 m shift by 0.16 of their distance from the middle
  const diagnose::TrackSet set = set_with({.seen = [](double x, double) { return x * (1.0 + k * x * x); }}, 4);
  const std::size_t lens = diagnose::effect_index("lens_distortion");
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const diagnose::EffectScan scan = diagnose::scan_effect(diagnose::ScoreSpace(set, nominal), lens);
  const diagnose::MotionFit fit =
      diagnose::fit_motions(set, {lens}, diagnose::with_effect(set, nominal, lens, scan.values, {}));
  const auto at = static_cast<Eigen::Index>(fit.layout->first_of(lens));
  CHECK(fit.converged);
  // 600 positions of 0.02 mm in a shift of 60 mm know k to well below 1 %.
  CHECK(fit.at.global[at] == Approx(k).epsilon(0.01));
}

TEST_CASE("a lens' size reaches to a shift of a quarter at the ends of the positions, and to 0.5 1/m² at least") {
  diagnose::TrackSet set = set_with({}, 1);
  const auto& size = diagnose::effect_list()[diagnose::effect_index("lens_distortion")].parameters[0];
  const diagnose::ParameterRange x = diagnose::range_of_places(set);
  const double half_m = 0.5 * (x.high - x.low);
  REQUIRE(half_m < std::sqrt(0.5));
  CHECK(diagnose::range_of(set, size).high * half_m * half_m == Approx(0.25).epsilon(1e-12));
  CHECK(diagnose::range_of(set, size).low == -diagnose::range_of(set, size).high);
  for (diagnose::TrackedMotion& motion : set.motions) {
    for (double& place : motion.x_m) place *= 10.0;
  }
  CHECK(diagnose::range_of(set, size).high == 0.5);
}

TEST_CASE("a release is after four frames and within two fifths and half a second, a lens' axis among the positions") {
  const diagnose::TrackSet set = set_with({}, 1);
  const auto range = [&](const char* id, std::size_t parameter) {
    return diagnose::range_of(set, diagnose::effect_list()[diagnose::effect_index(id)].parameters[parameter]);
  };
  CHECK(range("late_release", 0).low == Approx(4.0 / 100.0).epsilon(1e-12));  // four frames at 100 Hz
  CHECK(range("late_release", 0).high == 0.5);                                // two fifths of 1.49 s are more
  const diagnose::ParameterRange x = diagnose::range_of_places(set);
  CHECK(range("lens_distortion", 1).low == x.low);
  CHECK(range("lens_distortion", 1).high == x.high);
  CHECK(x.low < -0.4);
  CHECK(x.high > 0.4);
}

TEST_CASE("where a codec may hold a slow marker no friction of that speed is looked for") {
  diagnose::TrackSet set = set_with({}, 1);
  const std::size_t stribeck = diagnose::effect_index("stribeck");
  const auto slowest = [&] { return diagnose::range_of(set, diagnose::effect_list()[stribeck].parameters[1]).low; };
  CHECK(slowest() == 0.003);
  set.held_m_s = 0.02;
  CHECK(slowest() == 0.02);
  for (const std::vector<double>& shape : diagnose::effect_shapes(set, stribeck)) CHECK(shape.at(0) >= 0.02);
}

TEST_CASE("pushes along the motions are those of a hand, and the same pushes with mixed signs are so more seldom") {
  // In the linear neighbourhood the two differ by signs alone: what the data show of each push is the same.
  const auto evidence = [](const std::array<double, 8>& directions, double size) {
    std::size_t clip = 0;
    double last = -1.0;
    const tests::MadeEffect push{.force = [&](double m, double, double, double t) {
      if (t < last - 0.1) ++clip;
      last = t;
      return t < 0.2 ? size * m * directions[clip] : 0.0;
    }};
    const diagnose::TrackSet set = set_with(push, 5);
    const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
    const diagnose::ScoreSpace space(set, nominal);
    const auto scan = diagnose::scan_effect(space, diagnose::effect_index("late_release"));
    return scan.log_evidence - scan.gain;
  };
  // Launches go up, down, up, down. All of one sign has 2 chances in 256 where signs are free: log 128 = 4.9.
  const std::array<double, 8> along = {-1, 1, -1, 1, -1, 1, -1, 1}, mixed = {1, 1, -1, -1, -1, 1, 1, -1};
  CHECK(evidence(along, 0.08) > evidence(mixed, 0.08) + 4.0);
  // However plainly they show: log 128 of the signs, one in ten, seven more that are like the first to half their size,
  // in all 13; twice that. If pushes had to have one direction, it would be hundreds.
  CHECK(evidence(mixed, 0.8) > evidence(along, 0.8) - 26.0);
  // A hand that holds back what it lets go is one in ten of those that do all alike.
  std::array<double, 8> against = {};
  for (std::size_t k = 0; k < against.size(); ++k) against[k] = -along[k];
  CHECK(evidence(along, 0.3) - evidence(against, 0.3) == Approx(std::log(9.0)).margin(1.0));
}
