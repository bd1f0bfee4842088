#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <string_view>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/motion_fit.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/verdict/diagnose.h"
#include "diagnose/verdict/verdict_details.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"
#include "tests/temp_dir.h"

using namespace glidelab;
using Catch::Matchers::Contains;

namespace {

constexpr double kC_kg_m = 0.0031;  // of a coffee filter

/// Stacks of one to ten coffee filters that fall for 0.7 s, seen at 50 Hz: a quadratic drag, no K, no track.
tests::MadeExperiment falls(double incline_deg, double incline_sd_deg, unsigned seed) {
  std::vector<tests::MadeLaunch> launches;
  for (int filters = 1; filters <= 10; ++filters) launches.push_back({1e-3 * filters, incline_deg, 0.0, 0.3});
  tests::MadeEffect drag;
  drag.force = [](double, double, double v, double) { return -kC_kg_m * v * std::abs(v); };
  return tests::made_experiment(launches, drag, seed, 5e-4, 36, 50.0, incline_sd_deg, 0.0, {.k_n_s_m = 0.0, .mu = 0.0});
}

/// chi² of x = x0 + u t + (v0 - u)(1 - exp(-k t))/k, u = g/k and k = K/m, at the best x0 and v0 of each motion: linear.
double chi2_of(const diagnose::TrackSet& set, double k_n_s_m, double driving_m_s2) {
  double chi2 = 0.0;
  for (const diagnose::TrackedMotion& motion : set.motions) {
    const double k = k_n_s_m / set.masses[motion.mass].mass_kg, u = driving_m_s2 / k;
    double s11 = 0.0, s12 = 0.0, s22 = 0.0, b1 = 0.0, b2 = 0.0, bb = 0.0;
    for (std::size_t p = 0; p < motion.t_s.size(); ++p) {
      if (motion.outlier[p]) continue;
      const double t = motion.t_s[p] - motion.t_s.front(), w = 1.0 / motion.sd_of(p);
      const double of_v0 = -std::expm1(-k * t) / k, y = w * (motion.x_m[p] - u * (t - of_v0));
      s11 += w * w;
      s12 += w * w * of_v0;
      s22 += w * w * of_v0 * of_v0;
      b1 += w * y;
      b2 += w * of_v0 * y;
      bb += y * y;
    }
    const double det = s11 * s22 - s12 * s12;
    chi2 += bb - (s22 * b1 * b1 - 2.0 * s12 * b1 * b2 + s11 * b2 * b2) / det;
  }
  return chi2;
}

}  // namespace

TEST_CASE("the nominal fit of falls has the K of a search over the closed form, from 80 to 90 degrees") {
  for (const double incline_deg : {80.0, 86.0, 90.0}) {
    CAPTURE(incline_deg);
    // The misfit of a viscous drag moves g to the edge of its range. As good as exact, so that the search need not know
    // about it.
    const tests::MadeExperiment made = falls(incline_deg, 1e-4, 5);
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    REQUIRE(set.motions.size() == 10);
    const diagnose::MotionFit fit = diagnose::fit_nominal(set);
    CHECK(fit.converged);
    const double normal = std::cos(set.groups[0].stated_rad), slope = std::sin(set.groups[0].stated_rad);
    const double gravity = diagnose::model_of(set, *fit.layout, fit.at, 0).gravity_m_s2;
    CHECK(std::abs(gravity - set.gravity_m_s2) < 3.0001 * set.gravity_sd_m_s2);
    const double driving = gravity * (slope - fit.at.global[1] * normal);
    double best = std::numeric_limits<double>::infinity(), k = 0.0;
    for (double tried = 1e-4; tried < 0.05; tried *= 1.0005) {
      const double chi2 = chi2_of(set, tried, driving);
      if (chi2 >= best) continue;
      best = chi2;
      k = tried;
    }
    // The grid's step, 0.05 %, and the integrator's error, far below the noise.
    CHECK(fit.at.global[0] == Approx(k).epsilon(1e-3));
    double held = 0.0;  // what the statements add to the fit's chi²
    for (const diagnose::FitStatement& s : fit.statements) {
      held += std::pow((s.value - fit.at.global[static_cast<Eigen::Index>(s.global)]) / s.sd, 2);
    }
    CHECK(fit.cost - held == Approx(best).epsilon(1e-4));
    if (incline_deg == 90.0) CHECK(std::abs(fit.at.global[1]) < 1e-6);  // nothing tells mu
  }
}

TEST_CASE(
    "of falling coffee filters quadratic drag is named, with its C, whether or not the inclination's error is stated") {
  for (const double sd_deg : {0.0, 0.5}) {
    CAPTURE(sd_deg);
    const tests::MadeExperiment made = falls(90.0, sd_deg, 8);
    const diagnose::Diagnosis diagnosis =
        diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
    CHECK(diagnosis.verdict == diagnose::Verdict::effect);
    // Beside it the scatter of single positions may be named: what it is read off is the nominal fit's, a hundred
    // deviations off.
    const auto drag = std::find_if(diagnosis.effects.begin(), diagnosis.effects.end(),
                                   [](const auto& effect) { return effect.id == "quadratic_drag"; });
    REQUIRE(drag != diagnosis.effects.end());
    REQUIRE_FALSE(drag->parameters.empty());
    const diagnose::DiagnosedParameter& c = drag->parameters.front();
    CHECK(c.key == "c_kg_m");
    CHECK(std::abs(c.value - kC_kg_m) < 3.0 * c.sd);
    CHECK(c.sd < 0.1 * kC_kg_m);
    const auto falls_only = [](const diagnose::Note& note) {
      return std::holds_alternative<diagnose::OnlyFalls>(note);
    };
    CHECK(std::any_of(diagnosis.notes.begin(), diagnosis.notes.end(), falls_only));
  }
}

TEST_CASE("a drag of falls whose mass nobody states is found for each kilogram, however light they are") {
  // Three coffee filters of 1 g and 0.0031 kg/m: 3.1 kg/m for each kilogram, more than air can do to 1 kg.
  std::vector<tests::MadeLaunch> launches(3, tests::MadeLaunch{1.0, 90.0, 0.0, 0.3});
  tests::MadeEffect drag;
  drag.force = [](double, double, double v, double) { return -1e3 * kC_kg_m * v * std::abs(v); };
  tests::MadeExperiment made =
      tests::made_experiment(launches, drag, 21, 5e-4, 36, 50.0, 0.0, 0.0, {.k_n_s_m = 0.0, .mu = 0.0});
  for (core::ClipSetup& setup : made.setups) setup.mass_assumed = true;
  const diagnose::Diagnosis diagnosis =
      diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  const auto has_note = std::any_of(diagnosis.notes.begin(), diagnosis.notes.end(), [](const diagnose::Note& note) {
    return std::holds_alternative<diagnose::NoMassStated>(note);
  });
  CHECK(has_note);
  REQUIRE_FALSE(diagnosis.effects.empty());
  CHECK(diagnosis.effects.front().id == "quadratic_drag");
  const diagnose::DiagnosedParameter& c = diagnosis.effects.front().parameters.front();
  CHECK(std::abs(c.value - 1e3 * kC_kg_m) < 3.0 * c.sd);
  CHECK(c.sd < 0.1 * 1e3 * kC_kg_m);
}

TEST_CASE("a size at the end of its range is said to be there, and one at which an effect is absent is not") {
  std::vector<tests::MadeLaunch> launches(3, tests::MadeLaunch{1.0, 0.0, 0.0, 2.5});
  const std::size_t effect = diagnose::effect_index("quadratic_drag");
  const auto at_end = [&](double c_kg_m) {
    tests::MadeEffect drag;
    drag.force = [c_kg_m](double, double, double v, double) { return -c_kg_m * v * std::abs(v); };
    const tests::MadeExperiment made =
        tests::made_experiment(launches, drag, 21, 5e-4, 36, 50.0, 0.0, 0.0, {.k_n_s_m = 0.0, .mu = 0.0});
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
    const diagnose::MotionFit fit = diagnose::fit_with_effect(
        set, nominal, effect, diagnose::with_effect(set, nominal, effect, {std::clamp(c_kg_m, 0.0, 1.0)}, {}));
    return diagnose::fitted_parameters(set, fit, effect, 0.0).at(0).at_end;
  };
  CHECK(at_end(3.1));  // a stated kilogram may have up to 1 kg/m
  CHECK_FALSE(at_end(0.31));
  CHECK_FALSE(at_end(-0.3));  // a drive: the drag that fits best is 0, and 0 is no size
}

TEST_CASE("a height of a table needs the inclination before it is diagnosed") {
  const tests::TempDir temp;
  std::ofstream out(temp / "cups.csv");
  out << "t (s),y (m)\n";
  for (int i = 0; i < 60; ++i) {
    const double t = i / 60.0;
    out << fmt::format("{:.4f},{:.4f}\n", t, 1.5 - 1.3 * 1.3 / 9.81 * std::log(std::cosh(9.81 * t / 1.3)));
  }
  out.close();
  CHECK_THROWS_WITH(diagnose::diagnose({temp / "cups.csv"}, diagnose::DiagnoseOptions{}),
                    Contains("--incline") && Contains("\"y (m)\", a height") && Contains("90 for a fall"));
  // The file that has the height is named, and nothing is analysed first.
  std::ofstream(temp / "cart.csv") << "t_s,x_m\n0,0\n0.1,0.1\n0.2,0.2\n0.3,0.3\n0.4,0.4\n0.5,0.5\n0.6,0.6\n0.7,0.7\n";
  bool begun = false;
  const auto both = [&] {
    return diagnose::diagnose({temp / "cart.csv", temp / "cups.csv"}, diagnose::DiagnoseOptions{},
                              [&](std::string_view, double) { begun = true; });
  };
  CHECK_THROWS_WITH(both(), Contains("cups.csv") && !Contains("cart.csv"));
  CHECK_FALSE(begun);
  diagnose::DiagnoseOptions stated;
  stated.bare.incline_deg = 90.0;
  CHECK_NOTHROW(diagnose::diagnose({temp / "cups.csv"}, stated));
}

TEST_CASE("a bead that a liquid brakes within a frame has the K of its speed") {
  // x = x0 + u t from the first frame on, so that K/m = g/u whatever the start. The line through all positions has the
  // standard deviation of u, sigma sqrt(12/n)/T.
  struct Bead {
    double u_m_s, noise_m, frame_s;
    std::size_t positions;
  };
  for (const Bead& bead : {Bead{6e-3, 5e-5, 0.05, 160}, Bead{0.01, 1e-4, 1.0 / 30.0, 240}, Bead{0.02, 1e-4, 0.05, 160},
                           Bead{3e-3, 5e-5, 0.1, 200}}) {
    CAPTURE(bead.u_m_s);
    const double rate = 9.80665 / bead.u_m_s, n = static_cast<double>(bead.positions);
    const auto made = tests::made_experiment({{3e-4, 90.0, 0.0, bead.u_m_s}}, {}, 7, bead.noise_m, bead.positions,
                                             1.0 / bead.frame_s, 0.0, 0.0, {.k_n_s_m = 3e-4 * rate, .mu = 0.0});
    const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
    const diagnose::MotionFit fit = diagnose::fit_nominal(set);
    CHECK(fit.converged);
    const double of_line = bead.noise_m * std::sqrt(12.0 / n) / (n * bead.frame_s) / bead.u_m_s;
    CHECK(fit.at.global[0] / 3e-4 == Approx(rate).epsilon(5.0 * of_line + 0.003));  // g is known to 0.0015
  }
}
