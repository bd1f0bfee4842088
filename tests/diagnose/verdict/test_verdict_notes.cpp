#include "diagnose/verdict/verdict_notes.h"

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

diagnose::DiagnosedEffect effect(const char* id, const char* key, double value) {
  diagnose::DiagnosedEffect of;
  of.id = id;
  of.parameters = {{key, value, 0.01 * value}};
  return of;
}

}  // namespace

TEST_CASE("scatter of single positions that is certain is a trace, once, unless it is named") {
  diagnose::Comparison comparison;
  diagnose::FrameEffect tails, jitter;
  tails.effect = diagnose::effect_index(diagnose::ids::heavy_tailed_noise);
  tails.log_evidence = 1000.0;
  jitter.effect = diagnose::effect_index(diagnose::ids::timestamp_jitter);
  jitter.log_evidence = 3.0;
  comparison.frames = {tails, jitter};
  diagnose::Diagnosis diagnosis;
  diagnose::add_clear_scatter(comparison, diagnosis);
  diagnose::add_clear_scatter(comparison, diagnosis);
  CHECK(diagnosis.traces == std::vector<std::string>{"heavy_tailed_noise"});
  diagnosis.traces.clear();
  diagnosis.effects = {effect("heavy_tailed_noise", "fraction", 0.03)};
  diagnose::add_clear_scatter(comparison, diagnosis);
  CHECK(diagnosis.traces.empty());
}

TEST_CASE("the ratio of densities is that of a buoyancy that lowers g as the named effect does") {
  diagnose::TrackSet set;
  set.masses = {{0.003}, {0.002}};
  const auto ratio = [&](std::vector<diagnose::DiagnosedEffect> effects) {
    diagnose::Diagnosis diagnosis;
    diagnosis.effects = std::move(effects);
    const auto found = diagnose::buoyancy_like(set, diagnosis);
    return found ? found->density_ratio : 0.0;
  };
  CHECK(ratio({effect("scale_error", "e", -0.16)}) == Approx(0.16));
  CHECK(ratio({effect("frame_rate_error", "e", -0.1)}) == Approx(1.0 - 0.81));
  CHECK(ratio({effect("rotational_inertia", "mass_kg", 0.018)}) == Approx(0.9));  // nine times the lightest
  CHECK(ratio({effect("scale_error", "e", 0.1)}) == 0.0);                         // faster
  CHECK(ratio({effect("scale_error", "e", -0.005)}) == 0.0);                      // air
  CHECK(ratio({effect("quadratic_drag", "c_kg_m", 0.005), effect("rotational_inertia", "mass_kg", 0.0015)}) == 0.0);
  CHECK(ratio({}) == 0.0);
}

namespace {

bool names(const diagnose::Diagnosis& diagnosis, const std::string& id) {
  bool named = false;
  for (const diagnose::DiagnosedEffect& one : diagnosis.effects) {
    named = named || one.id == id;
    for (const std::string& same : one.equivalent_to) named = named || same == id;
  }
  return named;
}

}  // namespace

TEST_CASE("a friction that scatters a little hides no inclination that is stated wrongly by a wrong scale") {
  // From no scatter to one that shows clearly: in between it shows, and makes no gap.
  tests::MadeEffect seen;
  seen.seen = [](double x_m, double) { return 1.07 * x_m; };
  const std::vector<double> scatter = {0.6, -1.1, 0.9, -0.4};
  for (const double dose : {0.0, 1e-5, 2e-5, 4e-5, 1e-4}) {
    std::vector<tests::MadeLaunch> launches;
    for (std::size_t i = 0; i < scatter.size(); ++i) {
      launches.push_back({0.4, 6.0, 0.6, -1.3 + 0.1 * static_cast<double>(i), dose * scatter[i]});
    }
    const tests::MadeExperiment made = tests::made_experiment(launches, seen, 6, 2e-4, 120, 60.0, 0.05);
    const diagnose::Diagnosis diagnosis =
        diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
    INFO("dose " << dose << ": unknown " << diagnosis.unknown);
    CHECK(diagnosis.verdict == diagnose::Verdict::effect);
    CHECK(names(diagnosis, "scale_error"));
  }
}

TEST_CASE("rounded positions hide no inclination that is stated wrongly by a wrong scale") {
  // Lengths 15 % too long, written to 2 mm: the positions follow a glider on a slope of 8 degrees times 1.15.
  tests::MadeEffect seen;
  seen.seen = [](double x_m, double) { return 2e-3 * std::round(1.15 * x_m / 2e-3); };
  std::vector<tests::MadeLaunch> launches;
  for (const double v0_m_s : {-1.3, -1.2, -1.1, -1.0}) launches.push_back({0.4, 8.0, 0.6, v0_m_s});
  const tests::MadeExperiment made = tests::made_experiment(launches, seen, 5, 1e-5, 60, 60.0, 0.05);
  const diagnose::Diagnosis diagnosis =
      diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
  CHECK(diagnosis.verdict == diagnose::Verdict::effect);
  CHECK(diagnosis.none < 0.05);
  CHECK(names(diagnosis, "scale_error"));
}
