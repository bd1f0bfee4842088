#include "diagnose/lines/line_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>

#include "base/errors.h"
#include "diagnose/lines/line_diagnosis.h"
#include "test_paths.h"
#include "tests/catch.h"
#include "tests/diagnose/made_lines.h"

using namespace glidelab;
using tests::kLineGravity;
using tests::kSixMasses;
using tests::kThreeMasses;
using tests::lines_with;

namespace {

diagnose::Diagnosis diagnosed(const tests::LineCauses& causes, unsigned seed,
                              const std::vector<double>& masses = kSixMasses,
                              const std::vector<std::string>& without = {}) {
  return diagnose::diagnose_lines(lines_with(causes, seed, masses), kLineGravity, without);
}

const diagnose::LineCandidate& candidate(const diagnose::Diagnosis& diagnosis, const diagnose::Explanation& of) {
  const auto& all = diagnosis.lines->candidates;
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& c) { return c.explanation == of; });
  REQUIRE(found != all.end());
  return *found;
}

bool among(const std::vector<std::string>& ids, const std::string& id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

/// How many of so many tables, seeds 1 and up, have the verdict.
template <typename Causes>
int count(diagnose::Verdict verdict, unsigned tables, const std::vector<double>& masses, const Causes& causes) {
  int found = 0;
  for (unsigned seed = 1; seed <= tables; ++seed) {
    std::mt19937_64 random(1000 + seed);
    found += diagnosed(causes(random), seed, masses).verdict == verdict ? 1 : 0;
  }
  return found;
}

double normal(std::mt19937_64& random, double sd) {
  return std::normal_distribution<double>(0.0, sd)(random);
}

}  // namespace

TEST_CASE("published lines: one cause is found, with its size") {
  const auto check = [](const tests::LineCauses& causes, const std::string& id, const std::string& key, double size) {
    for (const unsigned seed : {1u, 2u, 3u}) {
      INFO(id << ", seed " << seed);
      const diagnose::Diagnosis diagnosis = diagnosed(causes, seed);
      REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
      REQUIRE(diagnosis.effects.size() == 1);
      CHECK(diagnosis.effects.front().id == id);
      const auto& found = diagnosis.effects.front().parameters.front();
      CHECK(found.key == key);
      CHECK(std::abs(found.value - size) < 4.0 * found.sd);
      CHECK(found.sd < 0.1 * size);
      CHECK(diagnosis.lines->either_of.empty());
      REQUIRE(diagnosis.gap);
      CHECK(diagnosis.gap->after < 1.0 + 4.0 * diagnosis.gap->standard_error);
    }
  };
  check({.friction_n = 0.03}, "load_independent_friction", "force_n", 0.03);
  check({.bias_s2_m_s2 = 0.005}, "smoothing_bias", "intercept_s2_m_s2", 0.005);
}

TEST_CASE("published lines: two causes at once are found where the masses differ enough") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const diagnose::Diagnosis diagnosis = diagnosed({.friction_n = 0.024, .bias_s2_m_s2 = 0.005}, seed);
    REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
    const diagnose::Explanation two{{"load_independent_friction", "smoothing_bias"}};
    CHECK(diagnosis.ranking.front().explanation == two);
    const diagnose::LineCandidate& both = candidate(diagnosis, two);
    REQUIRE(both.sizes.size() == 2);
    CHECK(std::abs(both.sizes[0].value - 0.024) < 4.0 * both.sizes[0].sd);
    CHECK(std::abs(both.sizes[1].value - 0.005) < 4.0 * both.sizes[1].sd);
  }
}

TEST_CASE("published lines: each named cause has its share of the gap of held-out lines, the larger one first") {
  const diagnose::Diagnosis one = diagnosed({.friction_n = 0.03}, 1);
  REQUIRE(one.gap);
  REQUIRE(one.explained.size() == 1);
  CHECK(one.explained[0].id == "load_independent_friction");
  CHECK(one.explained[0].gap_after == Approx(one.gap->after).epsilon(1e-9));
  const double excess = one.gap->before * one.gap->before - 1.0, left = one.gap->after * one.gap->after - 1.0;
  CHECK(one.explained[0].share == Approx(1.0 - left / excess).epsilon(1e-9));
  CHECK(one.explained[0].share > 0.9);  // it alone acts
  REQUIRE(one.explained[0].share_interval95);
  CHECK(one.explained[0].share_interval95->low < one.explained[0].share);
  CHECK(one.explained[0].share < one.explained[0].share_interval95->high);

  const diagnose::Diagnosis two = diagnosed({.friction_n = 0.024, .bias_s2_m_s2 = 0.005}, 1);
  REQUIRE(two.explained.size() == 2);
  CHECK(two.explained[0].share > two.explained[1].share);
  CHECK(two.explained[1].share > 0.0);
  // The shares of both and what is left make all of the excess.
  const double after = two.explained[1].gap_after, before = two.gap->before;
  CHECK(two.explained[0].share + two.explained[1].share + (after * after - 1.0) / (before * before - 1.0) ==
        Approx(1.0).epsilon(1e-9));
  CHECK(after == Approx(two.gap->after).epsilon(1e-9));

  CHECK(diagnosed({}, 1).explained.empty());  // nothing acts
}

TEST_CASE("published lines: a cause of less than a hundredth of the gap is a trace, however certain") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    CAPTURE(seed);
    std::vector<diagnose::TableLine> lines = lines_with({.friction_n = 0.05}, seed);
    for (diagnose::TableLine& line : lines) line.k_over_m_1_s *= 1.0 + 0.004 * line.direction;  // 4 sd of each line
    const diagnose::Diagnosis little = diagnose::diagnose_lines(lines, kLineGravity, {});
    REQUIRE(little.verdict == diagnose::Verdict::effect);
    REQUIRE(little.effects.size() == 1);
    CHECK(little.effects.front().id == "load_independent_friction");
    CHECK(little.traces == std::vector<std::string>{"direction_dependent_drag"});
    CHECK(little.explained.size() == 1);
  }
}

TEST_CASE("published lines whose mu differs between configurations: that is the verdict, with the mu of each") {
  tests::LineCauses causes;
  causes.friction = [](std::size_t mass, std::size_t setup) { return (mass + setup) % 2 == 0 ? 0.02 : -0.02; };
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    const diagnose::Diagnosis diagnosis = diagnosed(causes, seed);
    REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
    REQUIRE(diagnosis.effects.size() == 1);
    const diagnose::DiagnosedEffect& effect = diagnosis.effects.front();
    CHECK(effect.id == "configuration_friction");
    CHECK(effect.probability > 0.9);
    REQUIRE(effect.parameters.size() == 13);  // the spread, and six masses on two set-ups
    // mu g cos(alpha) is 0.006 g cos(alpha) and 0.02 m/s² more or less.
    for (std::size_t i = 0; i < 6; ++i) {
      for (const std::size_t setup : {0u, 1u}) {
        const std::string name = fmt::format("mu.{:g} g, {}°", 1e3 * kSixMasses[i], setup == 0 ? 0 : 4);
        const auto found = std::find_if(effect.parameters.begin(), effect.parameters.end(),
                                        [&](const auto& one) { return one.key == name; });
        REQUIRE(found != effect.parameters.end());
        const double normal_m_s2 = kLineGravity * std::cos(setup == 0 ? 0.0 : 4.0 * std::numbers::pi / 180.0);
        const double expected = tests::kLineMu + causes.friction(i, setup) / normal_m_s2;
        CHECK(std::abs(found->value - expected) < 5.5 * found->sd);  // 48 of them, of ten degrees of freedom
        CHECK(found->sd < 4e-4);                                     // 1 mm/s² of two lines, over g, is 7e-5
      }
    }
    CHECK(effect.parameters.front().key == "sd");
    CHECK(effect.parameters.front().value == Approx(0.02 / 9.81 * std::sqrt(12.0 / 11.0)).epsilon(0.05));
    REQUIRE(diagnosis.levels);
    CHECK(diagnosis.levels->holds_within);
    CHECK(diagnosis.levels->all == Approx(diagnosis.gap->before).epsilon(1e-12));
    REQUIRE(diagnosis.levels->configuration);
    CHECK(*diagnosis.levels->configuration < 1.0 + 4.0 * diagnosis.gap->standard_error);
    CHECK_FALSE(diagnosis.levels->clip);
    REQUIRE(diagnosis.explained.size() == 1);
    CHECK(diagnosis.explained.front().share > 0.9);
  }
  CHECK_FALSE(diagnosed({}, 1).levels->holds_within);  // it holds across them too
}

TEST_CASE("published lines whose drag differs between masses, or between directions: those are the verdicts") {
  tests::LineCauses causes;
  causes.drag = [](std::size_t mass) { return mass % 2 == 0 ? 0.01 : -0.01; };
  const diagnose::Diagnosis masses = diagnosed(causes, 1);
  REQUIRE(masses.verdict == diagnose::Verdict::effect);
  CHECK(masses.effects.front().id == "configuration_drag");
  const auto& own = masses.effects.front().parameters;
  const auto lightest =
      std::find_if(own.begin(), own.end(), [](const auto& one) { return one.key == "k_n_s_m.200 g"; });
  REQUIRE(lightest != own.end());  // the form with the fewest sizes
  CHECK(std::abs(lightest->value - 1.01 * tests::kLineDrag) < 4.0 * lightest->sd);

  std::vector<diagnose::TableLine> lines = lines_with({}, 2);
  for (diagnose::TableLine& line : lines) line.k_over_m_1_s *= 1.0 + 0.02 * line.direction;
  const diagnose::Diagnosis directions = diagnose::diagnose_lines(lines, kLineGravity, {});
  REQUIRE(directions.verdict == diagnose::Verdict::effect);
  CHECK(directions.effects.front().id == "direction_dependent_drag");
  const diagnose::DiagnosedParameter& d = directions.effects.front().parameters.front();
  CHECK(std::abs(d.value - 0.02) < 4.0 * d.sd + 2e-4);  // to first order in d
}

TEST_CASE("published lines of three masses like each other: either of two, each with its size") {
  // The columns 1/m and 1/m² of these masses have a cosine of 0.99: what one does the other does to 12 %.
  const diagnose::Diagnosis diagnosis = diagnosed({.bias_s2_m_s2 = 0.005, .scatter = 3.0}, 3, kThreeMasses);
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  CHECK(among(diagnosis.lines->either_of, "smoothing_bias"));
  CHECK(among(diagnosis.lines->either_of, "load_independent_friction"));
  const diagnose::LineCandidate& bias = candidate(diagnosis, {{"smoothing_bias"}});
  CHECK(std::abs(bias.sizes.front().value - 0.005) < 4.0 * bias.sizes.front().sd);
  // A drag that rolls off has the lines of a friction force, whichever of the two comes first.
  CHECK(among(diagnosis.effects.front().equivalent_to, "eddy_rolloff"));
  const double single = bias.probability + candidate(diagnosis, {{"load_independent_friction"}}).probability;
  CHECK(diagnosis.lines->either_probability >= single);
  CHECK(diagnosis.lines->either_probability <= 1.0 - diagnosis.none - diagnosis.unknown + 1e-9);
}

TEST_CASE("published lines with nothing wrong: nothing is missing, also where they are few") {
  const auto nothing = [](std::mt19937_64&) { return tests::LineCauses{}; };
  // One in twenty is allowed; three standard errors of these.
  CHECK(200 - count(diagnose::Verdict::none, 200, kSixMasses, nothing) <= 10 + 9);
  CHECK(200 - count(diagnose::Verdict::none, 200, kThreeMasses, nothing) <= 10 + 9);
}

TEST_CASE("published lines that were calculated and rounded tell no more than their digits: nothing is missing") {
  tests::LineCauses exact;
  exact.scatter = 0.0;
  // Lines of one mass have the same K/m, rounded alike: to the last digit they scatter between masses and not within.
  for (const double digit : {1e-2, 1e-3, 1e-4}) {
    std::vector<diagnose::TableLine> lines = lines_with(exact, 1);
    for (diagnose::TableLine& line : lines) {
      line.a0_m_s2 = digit * std::round(line.a0_m_s2 / digit);
      line.k_over_m_1_s = digit * std::round(line.k_over_m_1_s / digit);
      line.a0_digit_m_s2 = line.k_digit_1_s = digit;
    }
    CHECK(diagnose::diagnose_lines(lines, kLineGravity, {}).verdict == diagnose::Verdict::none);
    for (diagnose::TableLine& line : lines) line.a0_digit_m_s2 = line.k_digit_1_s = 0.0;
    CHECK(diagnose::diagnose_lines(lines, kLineGravity, {}).verdict !=
          diagnose::Verdict::none);  // as if measured to the last bit
  }
}

TEST_CASE("published lines whose friction or drag follows no law of the mass: each configuration has its own") {
  // 85 % is wanted; three standard errors of 40 tables less.
  constexpr int kWanted = 34 - 7;
  const auto names = [](const std::vector<double>& masses, const auto& causes, const char* id) {
    int found = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
      std::mt19937_64 random(1000 + seed);
      const diagnose::Diagnosis diagnosis = diagnosed(causes(random), seed, masses);
      found += std::any_of(diagnosis.effects.begin(), diagnosis.effects.end(),
                           [&](const auto& effect) { return effect.id == id; });
    }
    return found;
  };
  const auto friction_of_each = [](std::mt19937_64& random) {
    std::vector<double> more;
    for (int i = 0; i < 12; ++i) more.push_back(normal(random, 0.01));
    return tests::LineCauses{
        .friction = [more](std::size_t mass, std::size_t setup) { return more[2 * mass + setup]; }};
  };
  CHECK(names(kThreeMasses, friction_of_each, "configuration_friction") >= kWanted);
  CHECK(names(kSixMasses, friction_of_each, "configuration_friction") >= kWanted);
  const auto beside_a_force = [](std::mt19937_64& random) {
    std::vector<double> more;
    for (int i = 0; i < 6; ++i) more.push_back(normal(random, 0.01));
    return tests::LineCauses{.friction_n = 0.024, .drag = [more](std::size_t mass) { return more[mass]; }};
  };
  CHECK(names(kThreeMasses, beside_a_force, "configuration_drag") >= kWanted);
  CHECK(names(kSixMasses, beside_a_force, "configuration_drag") >= kWanted);
  CHECK(names(kSixMasses, beside_a_force, "load_independent_friction") >= kWanted);
}

TEST_CASE("published lines say where they are off, by how much") {
  // Over both set-ups mu takes the mean of F/m (cos 4° is 1 to 0.3 %): of the lightest, F/m less that mean is left.
  constexpr double kForce = 0.03;
  const diagnose::Diagnosis diagnosis = diagnosed({.friction_n = kForce}, 5);
  double mean = 0.0;
  for (const double mass : kSixMasses) mean += kForce / mass / static_cast<double>(kSixMasses.size());
  const double expected = kForce / kSixMasses.front() - mean;
  int found = 0;
  for (const diagnose::GapRegion& region : diagnosis.regions) {
    if (region.variable != diagnose::GapVariable::mass || region.from != kSixMasses.front() || region.direction == 0)
      continue;
    ++found;
    REQUIRE(region.size_sd);
    CHECK(region.unit == "m/s²");
    // Own scatter is known to 10 degrees of freedom and taken as it is.
    CHECK(std::abs(region.size + region.direction * expected) < 4.0 * *region.size_sd + 0.003 * mean);
    CHECK(std::abs(region.excess - std::abs(region.size) / *region.size_sd) < 1e-9 * region.excess);
  }
  CHECK(found == 2);
  CHECK(diagnosed({}, 4).regions.empty());
}

TEST_CASE("published lines: how alike two effects are is the correlation of 1/m and 1/m² where slopes are exact") {
  std::vector<diagnose::TableLine> lines = lines_with({.friction_n = 0.03, .scatter = 0.0}, 1);
  std::erase_if(lines, [](const diagnose::TableLine& line) { return line.incline_deg != 0.0; });
  for (std::size_t i = 0; i < lines.size(); ++i) lines[i].a0_m_s2 += i % 4 < 2 ? 1e-3 : -1e-3;
  for (std::size_t i = 0; i < lines.size(); i += 2) lines[i].k_over_m_1_s *= 1.0 + 1e-9;
  const diagnose::Diagnosis diagnosis =
      diagnose::diagnose_lines(lines, kLineGravity, {"rotational_inertia", "direction_dependent_drag"});
  double a = 0.0, b = 0.0, aa = 0.0, bb = 0.0, ab = 0.0;
  const auto n = static_cast<double>(kSixMasses.size());
  for (const double mass : kSixMasses) {
    const double x = 1.0 / mass, y = x * x;
    a += x / n;
    b += y / n;
    aa += x * x / n;
    bb += y * y / n;
    ab += x * y / n;
  }
  const double correlation = (ab - a * b) / std::sqrt((aa - a * a) * (bb - b * b));
  REQUIRE(diagnosis.isolability.ids.size() == 2);
  CHECK(std::abs(diagnosis.isolability.cosine[0][1] - correlation) < 1e-6);
  CHECK(std::abs(diagnosis.isolability.cosine[0][0] - 1.0) < 1e-12);
}

TEST_CASE("published lines: chi² and log likelihood of every explanation are those of its residuals") {
  const std::vector<diagnose::TableLine> lines = lines_with({.friction_n = 0.03}, 2);
  const diagnose::Diagnosis diagnosis = diagnose::diagnose_lines(lines, kLineGravity);
  const diagnose::LineCandidate &none = candidate(diagnosis, {}),
                                &force = candidate(diagnosis, {{"load_independent_friction"}});
  REQUIRE(force.chi2);
  // chi²_a = RSS_a / s²; slopes are fitted alike, so that the gain is n/2 ln(RSS_0 / RSS) of the intercepts alone.
  double slopes = 0.0, mean = 0.0;
  for (const auto& line : lines) mean += std::log(line.k_over_m_1_s * line.mass_kg) / static_cast<double>(lines.size());
  for (const auto& line : lines) slopes += std::pow(std::log(line.k_over_m_1_s * line.mass_kg) - mean, 2);
  slopes /= std::pow(diagnosis.lines->slope_sd, 2);
  const double gain =
      0.5 * static_cast<double>(lines.size()) * std::log((*none.chi2 - slopes) / (*force.chi2 - slopes));
  CHECK(std::abs(force.log_likelihood_gain - gain) < 1e-6 * gain);
  CHECK(std::abs(diagnosis.ranking.front().log_likelihood_gain - gain) < 1e-6 * gain);
}

TEST_CASE("published lines: an effect whose size would be impossible is said not to be weighed") {
  const diagnose::Diagnosis diagnosis = diagnosed({.wheels_kg = -0.01}, 1);
  const auto ranked = std::find_if(diagnosis.ranking.begin(), diagnosis.ranking.end(), [](const auto& r) {
    return r.explanation == diagnose::Explanation{{"rotational_inertia"}};
  });
  REQUIRE(ranked != diagnosis.ranking.end());
  CHECK(ranked->probability == 0.0);
  REQUIRE(ranked->left_out);
  CHECK(ranked->left_out->key == "mass_kg");
  CHECK(ranked->left_out->value < 0.0);
  CHECK_FALSE(ranked->left_out->largest);
}

TEST_CASE("published lines: an effect that is left out is nowhere, and a word that is none is an error") {
  const diagnose::Diagnosis diagnosis =
      diagnosed({.friction_n = 0.03}, 1, kSixMasses, {"load_independent_friction", "eddy_rolloff"});
  for (const auto& ranked : diagnosis.ranking) CHECK_FALSE(ranked.explanation.holds("load_independent_friction"));
  for (const auto& effect : diagnosis.effects) CHECK_FALSE(among(effect.equivalent_to, "eddy_rolloff"));
  CHECK_NOTHROW(diagnosed({}, 1, kSixMasses, {"smoothing_bias", "stribeck"}));
  CHECK_THROWS_AS(diagnosed({}, 1, kSixMasses, {"load_independent"}), base::InputError);
}

TEST_CASE("the evidence of lines has the closed forms that it must have") {
  // Without terms and nothing explained the prior integrates to 1. Two terms that explain nothing: E[1 / (1 + g)] is
  // 1 - sqrt(pi b) exp(b) erfc(sqrt(b)), b = n/2, since 1/g has a Gamma distribution (1/2, rate b).
  CHECK(std::abs(diagnose::log_bayes_factor(1.0, 1.0, 12.0, 3.0, 0.0)) < 1e-6);
  const double b = 6.0;
  const double expected = 1.0 - std::sqrt(std::numbers::pi * b) * std::exp(b) * std::erfc(std::sqrt(b));
  CHECK(std::abs(diagnose::log_bayes_factor(1.0, 1.0, 12.0, 3.0, 2.0) - std::log(expected)) < 1e-6);
  CHECK(diagnose::log_bayes_factor(0.1, 1.0, 12.0, 11.0, 1.0) == 0.0);
  // It grows without bound where nothing is left; with g fixed it would end at (n - p0 - p) / 2 ln(1 + n).
  CHECK(diagnose::log_bayes_factor(1e-4, 1.0, 12.0, 3.0, 5.0) > 2.0 * std::log(13.0) + 5.0);
}

TEST_CASE("published lines tell of no accelerations") {
  const diagnose::Diagnosis diagnosis = diagnosed({}, 4);
  REQUIRE(diagnosis.gap);
  CHECK_FALSE(diagnosis.gap->acceleration_before);
  CHECK_FALSE(diagnosis.gap->acceleration_after);
}

TEST_CASE("a handful of published lines carries no verdict") {
  std::vector<diagnose::TableLine> few = lines_with({}, 1);
  few.resize(5);
  CHECK_THROWS_AS(diagnose::diagnose_lines(few, kLineGravity), base::InputError);
}

TEST_CASE("the paper's twelve lines: the law holds within each configuration, and mu differs between them") {
  const std::filesystem::path file = std::filesystem::path(tests::kSourceDir) / "../shared/paper/lines.csv";
  if (!std::filesystem::exists(file)) {
    WARN("skipped: no table in " << file.lexically_normal());
    return;
  }
  const std::vector<diagnose::TableLine> lines = diagnose::read_lines(file);
  const diagnose::Diagnosis diagnosis = diagnose::diagnose_lines(lines, kLineGravity);
  REQUIRE(diagnosis.verdict == diagnose::Verdict::effect);
  REQUIRE(diagnosis.effects.size() == 1);
  const diagnose::DiagnosedEffect& effect = diagnosis.effects.front();
  CHECK(effect.id == "configuration_friction");
  REQUIRE(diagnosis.levels);
  CHECK(diagnosis.levels->holds_within);
  // Half the difference of the two intercepts of 335 g at 0 degrees, over g.
  double half = 0.0;
  for (const diagnose::TableLine& line : lines) {
    if (line.mass_kg == 0.335 && line.incline_deg == 0.0) half -= 0.5 * line.direction * line.a0_m_s2;
  }
  const auto lightest = std::find_if(effect.parameters.begin(), effect.parameters.end(),
                                     [](const auto& one) { return one.key == "mu.335 g, 0°"; });
  REQUIRE(lightest != effect.parameters.end());
  CHECK(std::abs(lightest->value - half / kLineGravity) < 1e-9);
  // Its rivals: a look by hand with 3 mm/s² for an intercept: chi² falls from 271 to 111 with either, by 160.
  const diagnose::LineCandidate &force = candidate(diagnosis, {{"load_independent_friction"}}),
                                &bias = candidate(diagnosis, {{"smoothing_bias"}}), &none = candidate(diagnosis, {});
  CHECK(std::abs(force.probability - bias.probability) < 0.01);
  REQUIRE(none.chi2);
  const double scale = std::pow(diagnosis.lines->intercept_sd_m_s2 / 3e-3, 2);
  CHECK(std::abs(scale * (*none.chi2 - *force.chi2) - 160.0) < 1.0);
  CHECK(std::abs(scale * (*none.chi2 - *bias.chi2) - 160.0) < 1.0);
  REQUIRE(force.gap);
  CHECK(*force.gap > 3.0);
}

TEST_CASE("published lines that are steeper than gravity state no inclination, and a note says why") {
  std::vector<diagnose::TableLine> lines = tests::lines_with({}, 3);
  for (diagnose::TableLine& line : lines) {
    if (line.incline_deg > 0.0) line.a0_m_s2 += 12.0;
  }
  const diagnose::Diagnosis diagnosis = diagnose::diagnose_lines(lines, tests::kLineGravity);
  REQUIRE(diagnosis.gap);
  std::size_t level = 0, steep = 0;
  for (const diagnose::GapOfParameter& of : diagnosis.gap->parameters) {
    if (of.group == "0 deg") level += of.z_before.has_value();
    if (of.group == "4 deg") steep += !of.z_before && !of.z_after;
  }
  CHECK(level == 1);
  CHECK(steep == 1);
  CHECK(std::any_of(diagnosis.notes.begin(), diagnosis.notes.end(), [](const diagnose::Note& note) {
    const auto* beyond = std::get_if<diagnose::BeyondGravity>(&note);
    return beyond != nullptr && beyond->stated_deg == 4.0 && std::abs(beyond->intercept_m_s2 - 12.7) < 0.05;
  }));
}
