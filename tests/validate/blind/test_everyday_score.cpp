#include "validate/blind/everyday_score.h"

#include <cmath>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/result/results.h"
#include "fit/outside/outside_estimator.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "validate/blind/run_blind.h"

using namespace glidelab;
using Catch::Matchers::Contains;
using validate::BlindOutcome;
using validate::EverydayClass;

namespace {

BlindOutcome made(EverydayClass kind, bool strong, const std::vector<std::pair<std::string, double>>& causes) {
  BlindOutcome outcome;
  outcome.everyday.emplace();
  outcome.everyday->kind = kind;
  outcome.everyday->strong = strong;
  outcome.everyday->remainder = 1.0;
  for (const auto& [id, share] : causes) {
    outcome.causes.push_back({id, 1.0, {}, "x_m", 0.0});
    outcome.everyday->shares.push_back(share);
    outcome.everyday->equals.emplace_back();
    outcome.everyday->remainder -= share;
  }
  outcome.verdict.verdict = diagnose::Verdict::unknown;
  outcome.verdict.unknown = 1.0;
  return outcome;
}

/// Names with shares; the first one with a probability. A claim.
void name(BlindOutcome& outcome, const std::vector<std::pair<std::string, double>>& names, double p,
          const std::vector<std::string>& equal = {}) {
  outcome.verdict.verdict = diagnose::Verdict::effect;
  outcome.verdict.unknown = 1.0 - p;
  for (const auto& [id, share] : names) {
    outcome.verdict.effects.push_back({id, p, outcome.verdict.effects.empty() ? equal : std::vector<std::string>{}, p});
    outcome.verdict.sequence.explained.push_back({id, share});
  }
}

}  // namespace

TEST_CASE("the main cause counts where it is claimed and comes first, by class and strength") {
  auto right = made(EverydayClass::one, true, {{"quadratic_drag", 0.9}});
  name(right, {{"quadratic_drag", 0.8}, {"track_bow", 0.1}}, 0.9);
  auto second = made(EverydayClass::one, true, {{"track_bow", 0.9}});
  name(second, {{"quadratic_drag", 0.6}, {"track_bow", 0.2}}, 0.9);
  auto alike = made(EverydayClass::one, false, {{"power_law_drag", 0.8}});
  name(alike, {{"eddy_rolloff", 0.7}}, 0.6, {"power_law_drag"});
  auto equal = made(EverydayClass::one, false, {{"scale_error", 0.8}});
  name(equal, {{"frame_rate_error", 0.8}}, 0.6);
  auto unclaimed = made(EverydayClass::one, false, {{"stribeck", 0.8}});
  unclaimed.verdict.sequence.explained = {{"stribeck", 0.4}};
  const auto score = validate::score_everyday({right, second, alike, equal, unclaimed});
  const auto& diagnosis = score.methods.front();
  CHECK(diagnosis.main_first.at("one").at("strong").yes == 1);
  CHECK(diagnosis.main_first.at("one").at("strong").of == 2);
  CHECK(diagnosis.main_first.at("one").at("moderate").yes == 1);
  CHECK(diagnosis.main_first.at("one").at("moderate").of == 3);
  CHECK(diagnosis.main_in_set.at("one").at("moderate").yes == 2);
  CHECK(score.main_helps.at("one").at("moderate").yes == 3);
  CHECK(validate::sum_of(diagnosis.main_first).yes == 2);
  CHECK(validate::sum_of(diagnosis.main_first, {"two"}).of == 0);
  // Named: 0.8 - 0.9, 0.2 - 0.9, 0.7 - 0.8, 0, 0.4 - 0.8.
  CHECK(diagnosis.share_error.of == 5);
  CHECK(diagnosis.share_error.rms() == Approx(std::sqrt((0.01 + 0.49 + 0.01 + 0.0 + 0.16) / 5.0)));
  CHECK(diagnosis.share_error.mean() == Approx(-(0.1 + 0.7 + 0.1 + 0.4) / 5.0));
}

TEST_CASE("both of two causes take two names, one for each") {
  auto both = made(EverydayClass::two, true, {{"quadratic_drag", 0.5}, {"track_bow", 0.4}});
  name(both, {{"track_bow", 0.5}, {"quadratic_drag", 0.3}}, 0.9);
  auto one_set = made(EverydayClass::two, true, {{"quadratic_drag", 0.5}, {"track_bow", 0.4}});
  name(one_set, {{"quadratic_drag", 0.5}}, 0.9, {"track_bow"});
  const auto score = validate::score_everyday({both, one_set});
  CHECK(score.methods.front().both.at("two").at("strong").yes == 1);
  CHECK(score.methods.front().both.at("two").at("strong").of == 2);
  CHECK(score.methods.front().main_first.at("two").at("strong").yes == 1);
  // 0.3 - 0.5, 0.5 - 0.4; 0.5 - 0.5, and the second one in the set of the first: 0.5 - 0.4.
  CHECK(score.methods.front().any_share_error.rms() == Approx(std::sqrt((0.04 + 0.01 + 0.0 + 0.01) / 4.0)));
}

TEST_CASE("with imperfections alone half of the excess is a false claim, off the list a wrong name above 0.8") {
  auto quiet = made(EverydayClass::imperfect, true, {});
  quiet.verdict.sequence.explained = {{"track_bow", 0.3}};
  auto half = made(EverydayClass::imperfect, true, {});
  half.verdict.sequence.explained = {{"track_bow", 0.5}};
  auto fair = made(EverydayClass::imperfect, false, {});
  fair.everyday->imperfections = {{"scattered_friction", 0.1, "1", 0.6, {"clip_scatter"}},
                                  {"draught", 0.1, "N", 0.4, {}}};
  name(fair, {{"clip_scatter", 0.7}}, 0.9);
  auto sure = made(EverydayClass::outside, true, {{"cogging", 0.9}});
  name(sure, {{"tether", 0.7}}, 0.9);
  auto unsure = made(EverydayClass::outside, true, {{"cogging", 0.9}});
  name(unsure, {{"tether", 0.7}}, 0.7);
  auto unknown = made(EverydayClass::outside, true, {{"cogging", 0.9}});
  const auto score = validate::score_everyday({quiet, half, fair, sure, unsure, unknown});
  CHECK(validate::sum_of(score.methods.front().false_claim).yes == 2);
  CHECK(validate::sum_of(score.methods.front().false_claim).of == 3);
  CHECK(score.fair_claim.yes == 1);
  CHECK(score.fair_claim.of == 2);
  CHECK(score.methods.front().wrong_name.at("outside").at("strong").yes == 1);
  CHECK(score.methods.front().wrong_name.at("outside").at("strong").of == 3);
  CHECK(validate::sum_of(score.unknown, {"outside"}).yes == 1);
}

TEST_CASE("calibration is that of each class: what is stated against what is right") {
  std::vector<BlindOutcome> outcomes;
  for (int i = 0; i < 4; ++i) {  // 0.95 stated, three of four right
    auto one = made(EverydayClass::one, true, {{"stribeck", 0.9}});
    name(one, {{i == 0 ? "tether" : "stribeck", 0.9}}, 0.95);
    outcomes.push_back(one);
  }
  auto imperfection = made(EverydayClass::imperfect, true, {});  // none and unknown together: right
  imperfection.verdict.none = 0.2;
  imperfection.verdict.unknown = 0.5;
  outcomes.push_back(imperfection);
  auto outside = made(EverydayClass::outside, true, {{"cogging", 0.9}});  // none is wrong
  outside.verdict.verdict = diagnose::Verdict::none;
  outside.verdict.none = 0.85;
  outcomes.push_back(outside);
  auto failed = made(EverydayClass::one, true, {{"stribeck", 0.9}});
  failed.verdict.verdict.reset();
  failed.seconds = 3.0;
  outcomes.front().seconds = 1.0;
  outcomes.push_back(failed);
  const auto score = validate::score_everyday(outcomes);
  CHECK(score.calibration.at("one").of == 4);
  CHECK(score.calibration.at("one").error == Approx(0.2));
  CHECK(score.calibration.at("dirt").error == Approx(0.3));
  CHECK(score.calibration.at("outside").error == Approx(0.85));
  // Bins of all: 0.9 to 1 holds the four (0.8 too much in sum), 0.7 the imperfections (0.3 too little), 0.8 the last
  // (0.85).
  CHECK(score.calibration.at("all").error == Approx((0.8 + 0.3 + 0.85) / 6.0));
  CHECK(score.by_verdict.at("effect").of == 4);
  CHECK(score.by_verdict.at("effect").error == Approx(0.2));
  CHECK(score.by_verdict.at("none").right == 0.0);
  CHECK(score.by_verdict.at("unknown").right == 1.0);
  CHECK(score.by_verdict.count("failed") == 0);
  CHECK(score.failed.at("one") == 1);
  CHECK(score.cases.at("one") == 5);
  CHECK(score.timed == 2);
  CHECK(score.mean_s == Approx(2.0));
  CHECK(score.most_s == Approx(3.0));
  CHECK(score.methods.front().main_first.at("one").at("strong").of == 5);
}

TEST_CASE("the error of a few honest probabilities is what chance makes of it") {
  const auto by_chance = [](const std::vector<double>& stated) {
    std::vector<BlindOutcome> outcomes;
    for (const double p : stated) {
      outcomes.push_back(made(EverydayClass::one, true, {{"stribeck", 0.9}}));
      name(outcomes.back(), {{"stribeck", 0.9}}, p);
    }
    return validate::score_everyday(outcomes).calibration.at("one").by_chance;
  };
  // Of one: right, 1 - p off, with p; wrong, p off, with 1 - p.
  CHECK(by_chance({0.9}) == Approx(2.0 * 0.9 * 0.1));
  CHECK(by_chance({0.9, 0.7}) == Approx((2.0 * 0.9 * 0.1 + 2.0 * 0.7 * 0.3) / 2.0));  // in bins of their own
  // Of two in one bin the sum is 1.7: both right, 0.3 off; one, 0.7; none, 1.7.
  CHECK(by_chance({0.86, 0.84}) ==
        Approx((0.86 * 0.84 * 0.3 + (0.86 * 0.16 + 0.14 * 0.84) * 0.7 + 0.14 * 0.16 * 1.7) / 2.0));
  // Of many a normal deviate: sqrt(2 p (1 - p) / (pi n)), to a part of 1/(10 n p (1 - p)).
  CHECK(by_chance(std::vector<double>(400, 0.75)) ==
        Approx(std::sqrt(2.0 * 0.75 * 0.25 / (std::acos(-1.0) * 400.0))).epsilon(0.01));
}

TEST_CASE("recovered intervals are compared with what is true of that configuration") {
  auto one = made(EverydayClass::one, true, {{"stribeck", 0.9}});
  one.everyday->configurations = {{"inclined", 0.3, 4.0, 2.0, 0.01, 3.9, 0.5},
                                  {"inclined", 0.5, 4.0, 1.2, 0.01, 3.9, {}}};
  one.verdict.sequence.recovered = {
      {"inclined", 0.3, 4.0, {{"k_over_m_1_s", {1.9, 2.1}}, {"mu", {0.011, 0.012}}, {"v_lim_m_s", {0.4, 0.6}}}},
      {"inclined", 0.5, 4.0, {{"k_over_m_1_s", {1.9, 2.1}}, {"v_lim_m_s", {0.4, 0.6}}}}};
  const auto score = validate::score_everyday({one});
  const auto& covered = score.covered.at("one");
  CHECK(covered.at("k_over_m_1_s").of == 2);
  CHECK(covered.at("k_over_m_1_s").yes == 1);
  CHECK(covered.at("mu").yes == 0);
  CHECK(covered.at("v_lim_m_s").yes == 1);  // the other has no terminal velocity
  CHECK(covered.at("v_lim_m_s").of == 2);
  one.verdict.sequence.recovered.front().mass_kg = 0.4;
  CHECK_THROWS_AS(validate::score_everyday({one}), base::InputError);
  one.everyday.reset();
  CHECK_THROWS_AS(validate::score_everyday({one}), std::logic_error);
}

TEST_CASE(
    "forward selection takes the least held-out gap, a second one that lowers it clearly, and claims from half on") {
  auto one = made(EverydayClass::two, true, {{"track_bow", 0.5}, {"tether", 0.4}});
  one.verdict.gap_before = 3.0;
  one.verdict.gap_error = 0.1;
  one.verdict.ranking = {{{"stribeck"}, 0.9, 99.0, 2.0, 2.5},
                         {{"track_bow"}, 0.0, 50.0, 1.0, 2.0},
                         {{"tether", "track_bow"}, 0.0, 60.0, 2.0, 1.5},
                         {{"tether", "stribeck"}, 0.0, 80.0, 2.0, 1.2}};
  const auto saying = validate::said_by_forward_selection(one.verdict);
  CHECK(saying.claims);
  REQUIRE(saying.names.size() == 2);
  CHECK(saying.names[0].id == "track_bow");
  CHECK(saying.names[0].share.value() == Approx((9.0 - 4.0) / 8.0));
  CHECK(saying.names[1].id == "tether");
  CHECK(saying.names[1].share.value() == Approx((4.0 - 2.25) / 8.0));
  CHECK(validate::score_everyday({one}).methods[1].both.at("two").at("strong").yes == 1);
  one.verdict.gap_error = 0.3;  // the second lowers it by less than two of these
  CHECK(validate::said_by_forward_selection(one.verdict).names.size() == 1);
  one.verdict.gap_error = 1.1;  // nothing above the floor
  CHECK(validate::said_by_forward_selection(one.verdict).names.empty());
}

TEST_CASE("keys of the sequence are read where they are there, and empty where they are not") {
  tests::TempDir temp;
  const std::string start = R"({"format": 1, "verdict": "effect", "points": 9, "ranking": [], "gap": null,
      "probability": {"none": 0, "unknown": 0.1}, "where": {"regions": []},
      "effects": [{"id": "tether", "probability": 0.6, "equivalent_to": ["end_stop"], "joint_probability": 0.9}])";
  base::write_file(temp / "old.json", start + "}");
  const auto old = validate::read_blind_verdict(temp / "old.json");
  CHECK(old.sequence.explained.empty());
  CHECK(!old.sequence.remainder);
  CHECK(old.effects.front().joint == 0.9);
  base::write_file(temp / "new.json", start + R"(, "explained": [{"id": "tether", "share": 0.7}],
      "remainder": {"share": 0.3, "gap": 1.4}, "traces": ["position_rounding"], "levels": {"clip": 1.1, "all": 2.0},
      "recovered": [{"group": "flat", "mass_kg": 0.3, "incline_deg": 2, "with": ["tether"], "mu": {"value": null, "why": "…"},
                     "k_over_m_1_s": {"value": 2, "sd": 0.1, "interval95": [1.8, 2.2]}}]})");
  const auto fresh = validate::read_blind_verdict(temp / "new.json").sequence;
  CHECK(fresh.explained.front().share == 0.7);
  CHECK(fresh.remainder.value() == 0.3);
  CHECK(fresh.traces == std::vector<std::string>{"position_rounding"});
  CHECK(fresh.levels.at("all") == 2.0);
  CHECK(fresh.recovered.front().interval95.size() == 1);
  CHECK(fresh.recovered.front().interval95.at("k_over_m_1_s").high == 2.2);
  base::write_file(temp / "bad.json", start + R"(, "explained": [{"id": "tether"}]})");
  CHECK_THROWS_AS(validate::read_blind_verdict(temp / "bad.json"), base::InputError);
}

TEST_CASE("an estimator's answers count where there is a true value, by class and quantity") {
  auto one = made(EverydayClass::one, true, {{"quadratic_drag", 0.9}});
  one.everyday->configurations = {{"level", 0.3, 0.0, 2.0, 0.01, 0.0, {}}, {"level", 0.4, 0.0, 1.5, 0.02, 0.0, {}}};
  one.estimate.emplace();
  const auto answer = [](double mass_kg, const std::optional<core::Estimate>& k) {
    core::ConfigurationResult result;
    result.mass_kg = mass_kg;
    result.k_over_m_1_s.estimate = k;
    result.v_lim_m_s.estimate = core::Estimate{1.0, 0.1, 0.8, 1.2};  // there is no true one
    return result;
  };
  // Off by +0.3 with an interval that holds 2.0, and by -0.4 with one that ends below 1.5.
  one.estimate->results.configurations = {answer(0.3, core::Estimate{2.3, 0.2, 1.9, 2.7}),
                                          answer(0.4, core::Estimate{1.1, 0.1, 0.9, 1.3})};
  auto failed = made(EverydayClass::outside, true, {{"cogging", 0.9}});
  failed.verdict.verdict.reset();  // the diagnosis failed, the estimator did not
  failed.everyday->configurations = {{"level", 0.3, 0.0, 2.0, 0.01, 0.0, 1.0}};
  failed.estimate.emplace();
  failed.estimate->results.configurations = {answer(0.3, {})};
  const auto score = validate::score_everyday({one, failed});
  const auto& k = score.answers.at("one").at("k_over_m_1_s");
  CHECK(k.answered.of == 2);
  CHECK(k.answered.yes == 2);
  CHECK(k.covered.of == 2);
  CHECK(k.covered.yes == 1);
  CHECK(k.error.rms() == Approx(std::sqrt((0.09 + 0.16) / 2.0)));
  CHECK(k.error.mean() == Approx(-0.05));
  CHECK(score.answers.at("one").at("mu").answered.of == 2);
  CHECK(score.answers.at("one").at("mu").answered.yes == 0);
  CHECK_FALSE(score.answers.at("one").contains("v_lim_m_s"));
  CHECK(score.answers.at("outside").at("k_over_m_1_s").answered.of == 1);
  CHECK(score.answers.at("outside").at("k_over_m_1_s").answered.yes == 0);
  CHECK(score.answers.at("outside").at("v_lim_m_s").covered.yes == 1);
  one.estimate->results.configurations[0].mass_kg = 0.35;
  CHECK_THROWS_AS(validate::score_everyday({one}), base::InputError);
}

TEST_CASE("an estimator is judged on everyday cases alone, for only they state true values") {
  validate::BlindOptions options;
  options.cases = 1;
  options.outside = fit::outside_estimator("sh -c 'exit 1' mine {folder} {out}", "mine");
  const tests::TempDir temp;
  const auto diagnose = [](const auto&, const auto&, const auto&) { return std::string("must not be called"); };
  CHECK_THROWS_WITH(validate::run_blind(options, temp / "out", diagnose), Contains("--estimator-command"));
  CHECK_FALSE(std::filesystem::exists(temp / "out"));
}
