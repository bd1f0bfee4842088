#include "diagnose/gap/domain_gaps.h"

#include <algorithm>
#include <cmath>

#include "diagnose/fit/nominal_fit.h"
#include "diagnose/tracks/whitening.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

diagnose::TrackSet set_of(const tests::MadeExperiment& made) {
  return diagnose::track_set(made.results, made.setups, true);
}

const diagnose::PhaseGap& all_of(const std::vector<diagnose::PhaseGap>& gaps) {
  REQUIRE(!gaps.empty());
  REQUIRE_FALSE(gaps.front().mass_kg);
  return gaps.front();
}

}  // namespace

TEST_CASE("measured less modelled acceleration and the model's own make up the true law, for each mass") {
  // Level, one way and the other: a = -K v/m - sign(v) mu g - C v |v|/m is known at every v; the nominal model's a is
  // -K^ v/m - sign(v) mu^ g.
  constexpr double kDrag = 0.05;
  const tests::MadeEffect effect{.force = [](double, double, double v, double) { return -kDrag * v * std::abs(v); }};
  std::vector<tests::MadeLaunch> launches;
  for (const double m : {0.335, 0.535}) {
    for (const double v : {-1.3, -0.8, 1.3, 0.8}) launches.push_back({m, 0.0, v < 0.0 ? 0.6 : -0.6, v});
  }
  const auto set = set_of(tests::made_experiment(launches, effect, 3, 3e-6));
  const auto nominal = diagnose::fit_nominal(set);
  const auto with =
      diagnose::fit_motions(set, {diagnose::effect_index("quadratic_drag")},
                            diagnose::with_effect(set, nominal, diagnose::effect_index("quadratic_drag"), {0.01}, {}));
  const auto gaps = diagnose::phase_gaps(set, nominal, with);
  REQUIRE(gaps.size() == 3);
  const tests::MadeGlider true_glider;
  double most = 0.0;
  for (const diagnose::PhaseGap& gap : gaps) {
    if (!gap.mass_kg) continue;
    for (const diagnose::PhaseBin& bin : gap.bins) {
      const double v = bin.v_m_s, sign = v > 0.0 ? 1.0 : -1.0, m = *gap.mass_kg;
      // Mean of v |v| over a stretch of width w is that at its mean to w²/12, C/m times this: 0.0006 m/s² at most. At
      // the lowest speeds, within the smoothing's reach of a turn, sign(v) is both.
      if (bin.from_m_s * bin.to_m_s <= 0.0) continue;
      const double less_drag = (true_glider.k_n_s_m - nominal.at.global[0]) / m;
      const double less_friction = (true_glider.mu - nominal.at.global[1]) * true_glider.gravity_m_s2;
      const double missing = -less_drag * v - sign * less_friction - kDrag * v * std::abs(v) / m;
      INFO("m " << m << ", v " << v);
      // Held-out K^ and mu^ differ from those of all clips, which is in the band; the law's curvature is not: 0.002.
      CHECK(std::abs(bin.before.value - missing) < 5.0 * bin.before.sd + 0.002);
      CHECK(std::abs(bin.after.value) < 5.0 * bin.after.sd);
      most = std::max(most, std::abs(bin.before.value) / bin.before.sd);
    }
  }
  CHECK(most > 20.0);  // what was missing was there to be seen
}

TEST_CASE("a band of the phase plane's gap is as wide as the differences scatter where nothing is missing") {
  // 24 experiments: z of each stretch of speeds has mean square 1. Neighbouring stretches share noise, and with them at
  // most a third of some 24 x 30 are independent: one standard error is sqrt(2/240) = 0.09.
  double squares = 0.0, count = 0.0, narrow = 0.0;
  for (unsigned seed = 1; seed <= 24; ++seed) {
    const auto set = set_of(tests::made_experiment(tests::made_launches(), {}, seed, 3e-5, 120));
    const auto nominal = diagnose::fit_nominal(set);
    const auto gaps = diagnose::phase_gaps(set, nominal, nominal);
    for (const diagnose::PhaseGap& gap : gaps) {
      if (!gap.mass_kg) continue;
      for (const diagnose::PhaseBin& bin : gap.bins) {
        squares += std::pow(bin.before.value / bin.before.sd, 2);
        count += 1.0;
        narrow += bin.before.value == bin.after.value && bin.before.sd == bin.after.sd ? 0.0 : 1.0;
      }
    }
  }
  INFO(count << " stretches");
  CHECK(squares / count == Approx(1.0).margin(0.3));
  CHECK(narrow == 0.0);  // the same fit before and after
}

TEST_CASE("the band counts neighbouring accelerations as what they are, not as independent") {
  // One long motion and its double: d of a stretch that lies within the kernel's reach hardly gets surer with more
  // frames' worth of the same smoothed noise. The sd of a mean of n points of white a would be sd_a/sqrt(n); by the
  // kernel's weights it is that of the noise of positions alone, which does not know how many points were averaged:
  // at twice the frame rate it falls by sqrt(2) and not by 2.
  std::vector<double> sds;
  for (const double rate : {100.0, 200.0}) {
    auto set = set_of(
        tests::made_experiment(tests::made_launches({0.4}), {}, 5, 3e-5, static_cast<std::size_t>(1.5 * rate), rate));
    for (auto& clip : set.clips) clip.bandwidth_s = 0.04;
    for (auto& motion : set.motions) motion.sd_m = 3e-5;
    const auto nominal = diagnose::fit_nominal(set);
    const diagnose::PhaseGap gap = all_of(diagnose::phase_gaps(set, nominal, nominal));
    double sum = 0.0;
    for (const diagnose::PhaseBin& bin : gap.bins) sum += bin.before.sd * bin.before.sd;
    sds.push_back(std::sqrt(sum / static_cast<double>(gap.bins.size())));
  }
  CHECK(sds[0] / sds[1] == Approx(std::sqrt(2.0)).epsilon(0.1));
}

TEST_CASE("weights over coloured noise are those over the white noise that it is made of") {
  diagnose::TrackedMotion motion;
  motion.t_s.resize(5);
  Eigen::MatrixXd by = Eigen::MatrixXd::Zero(3, 3);
  by << 1.0, 0.0, 0.0, -0.4, 1.2, 0.0, 0.1, -0.3, 0.9;
  Eigen::MatrixXd other = Eigen::MatrixXd::Zero(2, 2);
  other << 0.8, 0.0, 0.5, 1.1;
  motion.whitening = {by, other};
  Eigen::VectorXd weights(5), white(5);
  weights << 0.3, -1.0, 2.0, 0.7, -0.2;
  white << 1.0, 0.5, -0.25, 2.0, 1.5;
  const Eigen::VectorXd of_white = diagnose::weights_of_white(motion, weights);
  CHECK(of_white.dot(white) == Approx(weights.dot(diagnose::coloured(motion, white))).epsilon(1e-12));
}
