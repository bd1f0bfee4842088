#include <algorithm>
#include <cmath>
#include <set>

#include "base/errors.h"
#include "base/files/file_io.h"
#include "core/experiment/experiment.h"
#include "diagnose/effects/effect_library.h"
#include "tests/catch.h"
#include "tests/temp_dir.h"
#include "validate/blind/case/blind_effects.h"
#include "validate/blind/case/blind_strength.h"
#include "validate/blind/case/everyday_case.h"
#include "validate/blind/case/everyday_causes.h"
#include "validate/blind/run_blind.h"

using namespace glidelab;
namespace fs = std::filesystem;

namespace {

std::vector<double> times(std::size_t n, double step) {
  std::vector<double> t;
  for (std::size_t k = 0; k < n; ++k) t.push_back(step * static_cast<double>(k));
  return t;
}

/// A diagnosis.json that names what it is told to.
std::string diagnosis_text(const std::string& verdict, const std::string& id, double p,
                           const std::vector<std::string>& regions = {}) {
  std::string where;
  for (const std::string& variable : regions) {
    if (!where.empty()) where += ", ";
    where += R"({"variable": ")" + variable + R"("})";
  }
  const std::string effect =
      id.empty() ? "" : R"({"id": ")" + id + R"(", "probability": )" + std::to_string(p) + R"(, "equivalent_to": []})";
  const std::string ranked = id.empty()
                                 ? ""
                                 : R"({"id": ")" + id + R"(", "probability": )" + std::to_string(p) +
                                       R"(, "log_evidence_gain": 9, "log_likelihood_gain": 20, "parameters": 1})";
  const double none = verdict == "none" ? p : 0.0, unknown = verdict == "unknown" ? p : 0.0;
  return R"({"format": 1, "verdict": ")" + verdict + R"(", "points": 1000, "effects": [)" + effect +
         R"(], "probability": {"none": )" + std::to_string(none) + R"(, "unknown": )" + std::to_string(unknown) +
         R"(}, "ranking": [)" + ranked + R"(], "where": {"regions": [)" + where + R"(]}, "gap": null})";
}

validate::BlindOutcome outcome(validate::BlindKind kind, const std::string& truth, double gain,
                               const std::string& verdict, const std::string& named, double p,
                               const std::vector<std::string>& regions = {}) {
  tests::TempDir temp;
  base::write_file(temp / "diagnosis.json", diagnosis_text(verdict, named, p, regions));
  validate::BlindOutcome one;
  one.kind = kind;
  if (!truth.empty()) one.causes.push_back({truth, 1.0, {}, "x_m", gain});
  if (verdict != "failed") one.verdict = validate::read_blind_verdict(temp / "diagnosis.json");
  return one;
}

}  // namespace

TEST_CASE("a blind motion up a slope and back is the closed form on both branches, and the turn lies between") {
  validate::BlindLaw law{0.4, 0.9, 0.01, 0.07, 9.8, {}};
  const double k = 0.9 / 0.4, push = 9.8 * std::sin(0.07), drag = 0.01 * 9.8 * std::cos(0.07), v0 = -1.1;
  // v = v_inf + (v0 - v_inf) exp(-k t) with v_inf = (push + drag)/k going up, (push - drag)/k coming down.
  const double up = (push + drag) / k, down = (push - drag) / k;
  const double turn = std::log((v0 - up) / -up) / k;
  const double x_turn = up * turn + (v0 - up) * (1.0 - std::exp(-k * turn)) / k;
  const std::vector<double> t = times(200, 0.01);
  const auto motion = validate::blind_motion(law, 0.0, v0, t);
  REQUIRE(turn < t.back());
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double after = t[i] - turn;
    const double x = after < 0.0 ? up * t[i] + (v0 - up) * (1.0 - std::exp(-k * t[i])) / k
                                 : x_turn + down * after - down * (1.0 - std::exp(-k * after)) / k;
    // Tolerance 1e-11 a step, some thousand steps, and the bisection's rounding.
    CHECK(std::abs(motion[i].x_m - x) < 1e-8);
  }
}

TEST_CASE("a blind motion on the level stops for good, at v0/(mu g) without drag") {
  validate::BlindLaw law{0.3, 0.0, 0.02, 0.0, 9.8, {}};
  const auto motion = validate::blind_motion(law, 0.1, 0.2, times(300, 0.01));
  // It stops after v0/(mu g) = 1.02 s and v0²/(2 mu g).
  CHECK(std::abs(motion.back().x_m - (0.1 + 0.04 / (2.0 * 0.02 * 9.8))) < 1e-9);
  CHECK(motion.back().v_m_s == 0.0);
}

TEST_CASE("a glider whose friction holds it in the direction in which it would leave stays, and costs nothing") {
  // Up the slope the friction is a tenth, down it nearly twice as much and more than the slope pulls. That of neither
  // direction would let it go: it would set off, stop at once, and so on.
  validate::BlindLaw law{0.3, 0.0, 0.03, 0.05, 9.8, {}};
  law.changes.push_back([](double, double v, double, validate::BlindTerms& f) {
    f.friction_n *= v == 0.0 ? 1.0 : v > 0.0 ? 1.9 : 0.1;
  });
  std::size_t steps = 0;
  const auto motion = validate::blind_motion(law, 0.0, -0.4, times(300, 0.01), &steps);
  // It stops after v0²/(2 (g sin(alpha) + 0.1 mu g cos(alpha))), within 0.8 s.
  const double brake = 9.8 * (std::sin(0.05) + 0.1 * 0.03 * std::cos(0.05));
  CHECK(std::abs(motion.back().x_m + 0.4 * 0.4 / (2.0 * brake)) < 1e-9);
  CHECK(motion.back().v_m_s == 0.0);
  // 3 s: steps of 2 ms on the way and of 0.2 ms at rest, a new start at each frame, and one stop.
  CHECK(steps < 20'000);
}

TEST_CASE("a blind motion that would take billions of steps ends, and says that it is lost") {
  // 1 N s/m on a microgram: a rate of 1e9 a second, of which an explicit step takes a few.
  const validate::BlindLaw law{1e-9, 1.0, 0.0, 0.3, 9.8, {}};
  const auto motion = validate::blind_motion(law, 0.0, 1.0, times(100, 0.01));
  CHECK(motion.front().x_m == 0.0);
  CHECK(std::isnan(motion.back().x_m));
}

TEST_CASE("inertia that one glider's drag and friction take up has no strength, however large it is") {
  // (1 + s) m dv/dt = -K v - mu m g sign(v) is the law of a drag K/(1 + s) and a friction mu/(1 + s).
  validate::BlindDesign design;
  design.k_n_s_m = 0.54;
  design.mu = 0.0019;
  design.noise_sd_m = 1e-4;
  design.groups.push_back({"level", 0.0, 0.0, 9e-4});
  design.masses.push_back({0.366, 0.366, 0.0});
  for (const double v0 : {-1.1, 1.4, -0.55, 1.0})
    design.clips.push_back({"", 0, 0, v0 < 0.0 ? 0.4 : -0.4, v0, 100.0, 189});
  validate::BlindRandom random(1);
  const validate::BlindEffect wheels = validate::draw_effect("rotational_inertia", design, random);
  const validate::BlindDetection detection(design);
  for (const double size : {0.1, 0.2, 0.3, 0.4}) CHECK(detection.gain(wheels, size) < 0.01);
  CHECK_FALSE(validate::size_for(detection, wheels, 30.0).has_value());
}

TEST_CASE("who waits for a blind case is asked often, and may stop it at any time") {
  // Each derivative asks: of the drag, the friction, and a start's two numbers at least, in each of two steps or more.
  constexpr std::size_t kLeast = 8;
  const auto made = [](bool everyday, const std::function<void()>& look) {
    if (everyday) return validate::make_everyday_case(1, 0, {"", look}).x_m;
    return validate::make_blind_case(5, 3, {"track_bow", look}).x_m;
  };
  for (const bool everyday : {false, true}) {
    std::size_t looks = 0;
    const auto whole = made(everyday, [&] { ++looks; });
    CHECK(looks > kLeast);
    CHECK(whole == made(everyday, {}));
    std::size_t left = looks / 2;
    CHECK_THROWS_AS(made(everyday,
                         [&] {
                           if (left-- == 0) throw base::Interrupted();
                         }),
                    base::Interrupted);
  }
}

TEST_CASE("a blind case is the same for the same seed and index, and its folder holds no word of its truth") {
  const auto one = validate::make_blind_case(5, 3, {"track_bow"}),
             again = validate::make_blind_case(5, 3, {"track_bow"});
  CHECK(one.x_m == again.x_m);
  CHECK(validate::make_blind_case(5, 4, {"track_bow"}).x_m != one.x_m);
  REQUIRE(one.causes.size() == 1);
  CHECK(one.causes.front().gain > 0.9 * 8.0);  // what is drawn at least, and the tenth that may be missing
  tests::TempDir temp;
  validate::write_blind_folder(one, temp / "case");
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(temp / "case")) {
    if (!entry.is_regular_file()) continue;
    ++files;
    CHECK(base::read_file(entry.path()).find("bow") == std::string::npos);
  }
  CHECK(files == 1 + one.design.clips.size());
  const core::Experiment read = core::read_experiment(temp / "case");
  CHECK(read.clips.size() == one.design.clips.size());
  CHECK(read.gravity_m_s2 == one.design.gravity_m_s2);
  CHECK(read.gravity_sd_m_s2 == 0.0);  // what the motions were computed with
}

TEST_CASE("every effect of the diagnosis' list is among the blind ones, and nothing outside is") {
  std::set<std::string> known;
  for (const auto& info : diagnose::effect_list()) {
    const bool filmed = info.search == diagnose::Search::images || info.search == diagnose::Search::rows;
    if (!filmed) known.insert(std::string(info.id));  // cases are tracks
  }
  // The clean cases hold what the everyday ones do not add; those may be ahead of the list.
  const auto& library = validate::library_effects();
  const auto& everyday = validate::everyday_effects();
  for (const std::string& id : library) CHECK(known.contains(id));
  const std::set<std::string> unmoved = {"position_rounding", "force_gain", "force_delay", "mass_error"};
  for (const std::string& id : known) {
    INFO(id);
    const bool made = std::find(library.begin(), library.end(), id) != library.end() ||
                      std::find(everyday.begin(), everyday.end(), id) != everyday.end();
    CHECK((made || unmoved.contains(id)));
  }
  CHECK(validate::outside_effects().size() >= 10);
  for (const std::string& id : validate::outside_effects()) CHECK(!known.contains(id));
}

TEST_CASE("a truth is written after its diagnosis, a second run goes on, and another seed is refused") {
  tests::TempDir temp;
  std::size_t calls = 0;
  const validate::Diagnoser diagnoser = [&](const fs::path& folder, const fs::path& out, const auto&) -> std::string {
    ++calls;
    CHECK(!fs::exists(temp / "out" / "truth" / (folder.filename().string() + ".json")));
    if (calls == 2) return "made to fail";
    base::write_file(out / "diagnosis.json", diagnosis_text("none", "", 0.9));
    return "";
  };
  validate::BlindOptions options;
  options.seed = 9;
  options.cases = 3;
  const auto first = validate::run_blind(options, temp / "out", diagnoser);
  CHECK(calls == 3);
  CHECK(fs::exists(temp / "out" / "truth" / "0002.json"));
  CHECK_FALSE(first[1].verdict.verdict);
  CHECK(validate::verdict_word(first[1].verdict) == "failed");
  options.cases = 4;
  const auto more = validate::run_blind(options, temp / "out", diagnoser);
  CHECK(calls == 4);
  CHECK_FALSE(more[1].verdict.verdict);
  base::write_file(temp / "out" / "truth" / "0002.json", "{}\n");
  CHECK_THROWS_AS(validate::run_blind(options, temp / "out", diagnoser), base::InputError);
  options.seed = 10;
  CHECK_THROWS_AS(validate::run_blind(options, temp / "out", diagnoser), base::InputError);
  options.seed = 9;
  options.only = "magic";
  CHECK_THROWS_AS(validate::run_blind(options, temp / "out", diagnoser), base::InputError);
  options = {};
  CHECK_THROWS_AS(validate::run_blind(options, temp / "none", diagnoser), base::InputError);
}

TEST_CASE("images tell a camera that shakes from a table that does, and what a file says itself is no alarm") {
  using validate::BlindKind;
  auto shaken = outcome(BlindKind::single, "camera_motion", 100.0, "effect", "base_vibration", 0.9);
  CHECK(validate::score_blind({shaken}).methods.front().single.at("strong").yes == 1);
  shaken.filmed = true;
  CHECK(validate::score_blind({shaken}).methods.front().single.at("strong").yes == 0);

  auto lossy = outcome(BlindKind::none, "", 0.0, "effect", "compression", 0.9);
  lossy.filmed = true;
  CHECK(validate::score_blind({lossy}).false_alarm.yes == 1);
  validate::set_aside({"compression"}, lossy.verdict);
  CHECK(lossy.verdict.verdict == diagnose::Verdict::none);
  CHECK(lossy.verdict.none == 0.9);
  CHECK(validate::score_blind({lossy}).false_alarm.yes == 0);
  auto other = outcome(BlindKind::none, "", 0.0, "effect", "stribeck", 0.9);
  validate::set_aside({"compression"}, other.verdict);
  CHECK(other.verdict.verdict == diagnose::Verdict::effect);
}

TEST_CASE("a score tells whether what is outside is looked for in the right variable, and whether that is the first") {
  using validate::BlindKind;
  const auto score = validate::score_blind({
      outcome(BlindKind::outside, "cogging", 100.0, "unknown", "", 0.9, {"x_m", "t_s"}),
      outcome(BlindKind::outside, "cogging", 100.0, "unknown", "", 0.9, {"t_s", "x_m"}),
      outcome(BlindKind::outside, "cogging", 100.0, "unknown", "", 0.9, {"t_s"}),
      outcome(BlindKind::outside, "cogging", 100.0, "unknown", "", 0.9),
      outcome(BlindKind::outside, "cogging", 100.0, "none", "", 0.9, {"x_m"}),
  });
  CHECK(score.where.of == 4);
  CHECK(score.where.yes == 2);
  CHECK(score.where_first.of == 4);
  CHECK(score.where_first.yes == 1);
}

TEST_CASE("a score counts names, alarms and what was not recognised") {
  using validate::BlindKind;
  const auto score = validate::score_blind({
      outcome(BlindKind::none, "", 0.0, "none", "", 0.9),
      outcome(BlindKind::none, "", 0.0, "effect", "tether", 0.6),
      outcome(BlindKind::single, "tether", 100.0, "effect", "tether", 0.9),
      outcome(BlindKind::single, "scale_error", 20.0, "effect", "frame_rate_error", 0.5),
      outcome(BlindKind::outside, "cogging", 100.0, "unknown", "", 0.9),
      outcome(BlindKind::outside, "cogging", 100.0, "effect", "tether", 0.9),
  });
  CHECK(score.false_alarm.yes == 1);
  CHECK(score.false_alarm.of == 2);
  CHECK(score.methods.front().single.at("strong").yes == 1);
  CHECK(score.methods.front().single.at("moderate").yes == 1);  // the two are one thing on tracks
  CHECK(score.exact.at("moderate").yes == 0);
  CHECK(score.recognised.at("strong").yes == 1);
  CHECK(score.wrong_name.yes == 1);
  // Stated 0.9 four times, right three times; 0.6 wrong; 0.5 right: (4 |0.9 - 0.75| + 0.6 + 0.5)/6.
  CHECK(std::abs(score.calibration_error - (4.0 * 0.15 + 0.6 + 0.5) / 6.0) < 1e-6);  // as std::to_string has it
}

TEST_CASE("the methods beside the diagnosis take the largest gain, and the one that is worth its parameters") {
  using validate::BlindKind;
  const std::vector<validate::BlindRanked> ranking = {
      {{"tether"}, 0.2, 30.0, 5.0, {}},
      {{"quadratic_drag"}, 0.3, 28.0, 1.0, {}},
      {{"quadratic_drag", "tether"}, 0.1, 40.0, 6.0, {}},
      {{"quadratic_drag", "track_bow"}, 0.1, 36.0, 2.0, {}},
      {{"tether", "track_bow"}, 0.1, 90.0, 3.0, {}},  // without the first, which is kept
  };
  const auto right = [&](const std::vector<std::string>& truth, double points, validate::DecisionMethod method) {
    validate::BlindOutcome one;
    one.kind = truth.empty() ? BlindKind::none : truth.size() == 1 ? BlindKind::single : BlindKind::pair;
    for (const std::string& id : truth) one.causes.push_back({id, 1.0, {}, "x_m", 100.0});
    one.verdict.verdict = diagnose::Verdict::effect;
    one.verdict.points = points;
    one.verdict.ranking = ranking;
    const auto score = validate::score_blind({one});
    const validate::BlindMethod& of = score.methods.at(static_cast<std::size_t>(method));
    REQUIRE(of.by == method);
    return of.none.yes + of.pair.yes + (of.single.contains("strong") ? of.single.at("strong").yes : 0) == 1;
  };
  using enum validate::DecisionMethod;
  CHECK(right({"tether"}, 1000.0, best_residual));
  CHECK_FALSE(right({"quadratic_drag"}, 1000.0, best_residual));
  // A parameter costs log(1000) / 2 = 3.45: 12.7 and 24.5, and beside the second 19.3 and 29.1.
  CHECK(right({"quadratic_drag"}, 1000.0, stepwise_bic));
  CHECK(right({"quadratic_drag", "track_bow"}, 1000.0, stepwise_bic));
  // At 10: -20 and 18, and beside the second 16.
  CHECK(right({"quadratic_drag"}, std::exp(20.0), stepwise_bic));
  CHECK_FALSE(right({"quadratic_drag", "track_bow"}, std::exp(20.0), stepwise_bic));
  // At 29 nothing is worth it.
  CHECK(right({}, std::exp(58.0), stepwise_bic));
  CHECK_FALSE(right({}, std::exp(54.0), stepwise_bic));
}

TEST_CASE("a cause that is drawn as one outside the list may be called by what the list has for it") {
  using validate::BlindKind;
  const auto score = validate::score_blind({
      outcome(BlindKind::outside, "friction_of_each_run", 100.0, "effect", "clip_scatter", 0.9),
      outcome(BlindKind::outside, "drag_by_load", 100.0, "effect", "configuration_drag", 0.9),
      outcome(BlindKind::outside, "drag_of_each_run", 100.0, "effect", "tether", 0.9),
      outcome(BlindKind::outside, "cogging", 100.0, "effect", "clip_scatter", 0.9),
  });
  CHECK(score.recognised.at("strong").yes == 2);
  CHECK(score.wrong_name.yes == 2);
  CHECK(score.calibration_error == Approx(0.4).margin(1e-6));  // 0.9 stated, half of them right
}

TEST_CASE("a diagnosis' verdict is one of three words, and any other is refused") {
  tests::TempDir temp;
  using diagnose::Verdict;
  for (const Verdict verdict : {Verdict::none, Verdict::effect, Verdict::unknown}) {
    const std::string id(diagnose::verdict_id(verdict));
    base::write_file(temp / "diagnosis.json", diagnosis_text(id, "tether", 0.9));
    const validate::BlindVerdict read = validate::read_blind_verdict(temp / "diagnosis.json");
    CHECK(read.verdict == verdict);
    CHECK(validate::verdict_word(read) == id);
  }
  for (const char* word : {"failed", "None", ""}) {
    base::write_file(temp / "diagnosis.json", diagnosis_text(word, "tether", 0.9));
    CHECK_THROWS_AS(validate::read_blind_verdict(temp / "diagnosis.json"), base::InputError);
  }
  CHECK(validate::verdict_word({}) == "failed");
}

TEST_CASE("a case that could not be diagnosed is right by no method, though nothing was withheld in it") {
  const auto score = validate::score_blind({outcome(validate::BlindKind::none, "", 0.0, "failed", "", 0.0)});
  REQUIRE(score.methods.size() == 4);  // the last picks at random
  for (std::size_t m = 0; m < 3; ++m) {
    CHECK(score.methods[m].by == static_cast<validate::DecisionMethod>(m));
    CHECK(score.methods[m].none.of == 1);
    CHECK(score.methods[m].none.yes == 0);
  }
}
