#include "diagnose/next/next_experiment.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "diagnose/fit/nominal_fit.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/next/expected_evidence.h"
#include "diagnose/next/next_changes.h"
#include "diagnose/tracks/tracked_motions.h"
#include "diagnose/verdict/diagnose.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;
using diagnose::Change;
using diagnose::ChangeKind;
using diagnose::GapKind;
using diagnose::GapVariable;

namespace {

constexpr double kDegree = 0.017453292519943295;

/// On one inclination, which nobody states with an uncertainty.
diagnose::TrackSet inclined(double rate_hz = 100.0, double incline_sd_deg = 0.0) {
  const std::vector<tests::MadeLaunch> launches = {
      {0.335, 4.0, 0.3, -1.1}, {0.335, 4.0, -0.6, 1.2}, {0.535, 4.0, 0.3, -1.1}, {0.535, 4.0, -0.6, 1.2}};
  const auto made = tests::made_experiment(launches, {}, 11, 3e-5, 120, rate_hz, incline_sd_deg);
  return diagnose::track_set(made.results, made.setups, true);
}

/// The fit's point with one effect of this size and other K, mu, alpha, nothing fitted.
diagnose::MotionFit with(const diagnose::TrackSet& set, const diagnose::MotionFit& nominal, const char* id, double size,
                         double k_n_s_m, double alpha_rad) {
  const std::size_t effect = diagnose::effect_index(id);
  diagnose::FitPoint at = diagnose::with_effect(set, nominal, effect, {size}, {});
  at.global[0] = k_n_s_m;
  at.global[2] = alpha_rad;
  return diagnose::linearise_at(set, {effect}, at);
}

std::map<ChangeKind, double> most_of_each(const diagnose::TrackSet& set, const diagnose::MotionFit& nominal,
                                          const diagnose::MotionFit& a, const diagnose::MotionFit& b) {
  const Eigen::MatrixXd covariance = diagnose::common_covariance(b);
  std::map<ChangeKind, double> most;
  for (const Change& change : diagnose::feasible_changes(set, nominal)) {
    double& of = most[change.kind];
    of = std::max(of, diagnose::expected_split(set, a, b, covariance, change));
  }
  return most;
}

Change clip_of(const diagnose::NextClip& clip) {
  Change change;
  change.clip = clip;
  return change;
}

double sd_of_k(const diagnose::TrackSet& set, const diagnose::MotionFit& fit, const diagnose::NextClip& clip) {
  const Eigen::Index n = fit.at.global.size();
  // Nothing known before: one N s/m, one of mu, one radian.
  const Eigen::MatrixXd after = diagnose::expected_covariance(set, fit, Eigen::MatrixXd::Identity(n, n), clip_of(clip));
  return std::sqrt(after(0, 0));
}

}  // namespace

TEST_CASE("an asymmetry of the friction hides in an inclination that is known badly: a plumb view is what tells") {
  const diagnose::TrackSet set = inclined();
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const double mu = nominal.at.global[1], alpha = nominal.at.global[2], d = 0.7;
  // The nominal fit takes sin(a) - d mu cos(a) for its sin(alpha); mu itself is 3e-4 of it off, which hardly shows.
  double a = alpha;
  for (int i = 0; i < 20; ++i) a = std::asin(std::sin(alpha) + d * mu * std::cos(a));
  const auto asymmetric = with(set, nominal, "direction_asymmetry", d, nominal.at.global[0], a);
  auto most = most_of_each(set, nominal, asymmetric, nominal);
  const double variance = std::pow(0.05 * kDegree, 2) + diagnose::common_covariance(nominal)(2, 2);
  CHECK(most.at(ChangeKind::plumb) == Approx(0.5 * std::pow(a - alpha, 2) / variance).epsilon(1e-6));
  CHECK(most.at(ChangeKind::plumb) > 5.0);
  for (const auto& [kind, gain] : most) {
    if (kind != ChangeKind::plumb) CHECK(gain < 1.0);
  }
}

TEST_CASE("after a plumb view the variance of an inclination is that of the two together") {
  const diagnose::TrackSet set = inclined();
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const auto fit = with(set, nominal, "direction_asymmetry", 0.1, nominal.at.global[0], nominal.at.global[2]);
  const Eigen::MatrixXd before = diagnose::common_covariance(fit);
  const double plumb = 0.05 * kDegree;
  CHECK(std::sqrt(before(2, 2)) > 10.0 * plumb);
  for (const Change& change : diagnose::feasible_changes(set, nominal)) {
    if (change.kind != ChangeKind::plumb) continue;
    const double after = diagnose::expected_covariance(set, fit, before, change)(2, 2);
    CHECK(after == Approx(1.0 / (1.0 / before(2, 2) + 1.0 / (plumb * plumb))).epsilon(1e-6));
  }
}

TEST_CASE("what falls is dropped again, not thrown up nor laid on another slope") {
  const auto made = tests::made_experiment({{0.3, 90.0, 0.0, 0.2}, {0.5, 90.0, 0.0, 0.2}}, {}, 5, 1e-4, 40, 60.0);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(diagnose::only_falls(set));
  const auto changes = diagnose::feasible_changes(set, diagnose::fit_nominal(set));
  std::size_t drops = 0;
  for (const Change& change : changes) {
    CHECK(change.kind != ChangeKind::inclination);
    if (change.clip) CHECK(change.clip->v0_m_s > 0.0);
    if (change.clip) CHECK(change.falls);
    if (change.kind != ChangeKind::launch && change.kind != ChangeKind::mass) continue;
    ++drops;
    REQUIRE(change.clip);
    CHECK(change.clip->v0_m_s > 0.0);
    CHECK(change.clip->v0_m_s < 2.0);
  }
  CHECK(drops == 4);  // both masses, a lighter one and a heavier one
}

TEST_CASE("the next fall is one through air if those so far are: beside its quadratic drag K is held at 0") {
  const auto made = tests::made_experiment({{0.3, 90.0, 0.0, 0.2}, {0.5, 90.0, 0.0, 0.2}}, {}, 5, 1e-4, 40, 60.0);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(set.through_air);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const std::size_t drag = diagnose::effect_index("quadratic_drag");
  const diagnose::MotionFit fit =
      diagnose::fit_motions(set, {drag}, diagnose::with_effect(set, nominal, drag, {1e-3}, {}));
  const diagnose::ParameterRange held = fit.layout->globals().front().range;
  REQUIRE(held.high < 1e-3);
  std::size_t clips = 0;
  for (const Change& change : diagnose::feasible_changes(set, nominal)) {
    if (!change.clip) continue;
    ++clips;
    const diagnose::TrackSet next = diagnose::next_motion(set, fit, change).set;
    const diagnose::ParameterRange range = diagnose::ParameterLayout(next, {drag}).globals().front().range;
    CHECK(range.low == held.low);
    CHECK(range.high == held.high);
  }
  CHECK(clips > 0);
}

TEST_CASE("no clip splits a wrong scale from a wrong clock: a measured length or a stopwatch does") {
  const diagnose::TrackSet set = inclined(100.0, 0.05);
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const double k = nominal.at.global[0], alpha = nominal.at.global[2], e = 0.02;
  // (1 + e) x(t) obeys x'' = (1 + e) (g sin(alpha) -+ mu g cos(alpha)) - K/m x'; x((1 + c) t) the same where
  // (1 + c)² = 1 + e and its own K is K/(1 + c).
  const double c = std::sqrt(1.0 + e) - 1.0;
  const auto scale = with(set, nominal, "scale_error", e, k, alpha);
  const auto clock = with(set, nominal, "frame_rate_error", c, k / (1.0 + c), alpha);
  auto most = most_of_each(set, nominal, scale, clock);
  double low = 1e9, high = -1e9;
  for (const auto& motion : set.motions) {
    low = std::min(low, *std::min_element(motion.x_m.begin(), motion.x_m.end()));
    high = std::max(high, *std::max_element(motion.x_m.begin(), motion.x_m.end()));
  }
  const double half = 0.5 * (high - low);
  CHECK(most.at(ChangeKind::pattern) == Approx(std::pow(e * half / 5e-4, 2)).epsilon(1e-6));  // 2 halves of 1/2 z²
  const double variance =
      std::pow(1.0 / (10.0 * 100.0), 2) +
      diagnose::common_covariance(clock)(
          static_cast<Eigen::Index>(clock.layout->first_of(diagnose::effect_index("frame_rate_error"))),
          static_cast<Eigen::Index>(clock.layout->first_of(diagnose::effect_index("frame_rate_error"))));
  CHECK(most.at(ChangeKind::clock) == Approx(0.5 * c * c / variance).epsilon(1e-6));
  CHECK(most.at(ChangeKind::pattern) > most.at(ChangeKind::clock));
  for (const auto& [kind, gain] : most) {
    if (kind != ChangeKind::pattern && kind != ChangeKind::clock) CHECK(gain < 0.1);
  }
}

TEST_CASE("twice the frame rate knows the drag better by the root of two, half the exposure of a blurred clip twice") {
  diagnose::TrackSet set = inclined();
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const diagnose::NextClip turning = {0, 0.335, -1.1, 100.0};
  diagnose::NextClip twice = turning;
  twice.rate_hz = 200.0;
  // Of n = 120 frames the last one weighs 1/n.
  CHECK(sd_of_k(set, nominal, turning) / sd_of_k(set, nominal, twice) == Approx(std::sqrt(2.0)).epsilon(0.02));
  // Noise that is nearly all in proportion to the speed: 1e-3 s v beside 1e-7 m.
  for (std::size_t i = 0; i < set.motions.size(); ++i) {
    set.motions[i].sd_m = 1e-7;
    for (const double v : nominal.motions[i].v_m_s) set.motions[i].wider.push_back(std::hypot(1.0, 1e4 * v));
  }
  const diagnose::NextClip passing = {0, 0.335, 1.2, 100.0};  // never slow
  diagnose::NextClip sharper = passing;
  sharper.exposure = 0.5;
  CHECK(sd_of_k(set, nominal, passing) / sd_of_k(set, nominal, sharper) == Approx(2.0).epsilon(0.02));
  const auto offered = [&] {
    const auto changes = diagnose::feasible_changes(set, nominal);
    return std::any_of(changes.begin(), changes.end(), [](const auto& c) { return c.kind == ChangeKind::exposure; });
  };
  CHECK_FALSE(offered());  // tracks
  set.images = true;
  CHECK(offered());
  for (auto& motion : set.motions) motion.wider.clear();
  CHECK_FALSE(offered());  // no blur that costs anything
}

TEST_CASE("a clip is worth what it is worth once it is recorded, also where the camera errs") {
  const bool errs = GENERATE(false, true);
  // Errors of a plane of some tenths of a millimetre over the view, the same in every clip.
  const auto with_errors = [&](diagnose::TrackSet set) {
    for (auto& motion : set.motions) {
      if (!errs) continue;
      for (int power = 1; power <= 3; ++power) {
        motion.shared_m.emplace_back();
        for (const double x : motion.x_m) motion.shared_m.back().push_back(3e-4 * std::pow(x, power));
      }
    }
    if (errs) set.modes = 3;
    return set;
  };
  const std::vector<tests::MadeLaunch> launches = {{0.335, 4.0, 0.3, -1.1}, {0.335, 4.0, -0.6, 1.2}};
  const auto before = tests::made_experiment(launches, {}, 5, 3e-5, 120);
  const diagnose::TrackSet set = with_errors(diagnose::track_set(before.results, before.setups, true));
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const Change change = clip_of({0, 0.7, 1.6, 100.0});
  const diagnose::Moved clip = diagnose::next_motion(set, nominal, change).moved;
  REQUIRE(clip.x_m.size() > 20);
  std::vector<tests::MadeLaunch> more = launches;
  more.push_back({0.7, 4.0, clip.x_m.front(), 1.6});
  const auto after = tests::made_experiment(more, {}, 5, 3e-5, 120);
  diagnose::TrackSet recorded = diagnose::track_set(after.results, after.setups, true);
  auto& last = recorded.motions.back();
  last.t_s.resize(clip.x_m.size());
  last.x_m.resize(clip.x_m.size());
  last.outlier.resize(clip.x_m.size());
  recorded = with_errors(std::move(recorded));
  const Eigen::MatrixXd now = diagnose::common_covariance(nominal);
  const Eigen::MatrixXd expected = diagnose::expected_covariance(set, nominal, now, change);
  const Eigen::MatrixXd found = diagnose::common_covariance(diagnose::fit_nominal(recorded));
  // The noise level is measured anew from some 300 positions, to 1.15/sqrt(300), and the fit is another one.
  for (Eigen::Index g = 0; g < 2; ++g) {
    CHECK(std::sqrt(expected(g, g) / found(g, g)) == Approx(1.0).epsilon(0.2));
    CHECK(expected(g, g) < now(g, g));
  }
}

TEST_CASE("what only images or single frames show has a sentence with its reason, what moves a glider has none") {
  using diagnose::Search;
  for (const diagnose::EffectInfo& info : diagnose::effect_list()) {
    const bool seen = info.search == Search::images || info.search == Search::noise || info.search == Search::frames ||
                      info.search == Search::rows || info.id == std::string_view("camera_motion");
    INFO(info.id);
    CHECK(info.next.empty() != seen);
  }
  CHECK(diagnose::effect_of("light_flicker").next.find("whole period") != std::string::npos);
  CHECK(diagnose::effect_of("rolling_shutter").next.find("upside down") != std::string::npos);
}

TEST_CASE("what has no name is followed into the speeds, places and masses in which it lies") {
  const diagnose::TrackSet set = inclined();
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const auto step = [&](GapVariable variable, double from, double to, GapKind what, const char* clip = "") {
    diagnose::Diagnosis diagnosis;
    diagnosis.verdict = diagnose::Verdict::unknown;
    diagnosis.regions = {{variable, from, to, 5.0, 0.01, "N", what, clip}};
    return diagnose::next_for_unnamed(set, nominal, diagnosis);
  };
  // Only a launch of 1.8 times 1.2 m/s gets there, and only downhill.
  const auto fast = std::get<diagnose::CoverRegion>(step(GapVariable::speed, 1.5, 2.1, GapKind::force));
  CHECK(fast.over == diagnose::CoverRegion::Over::speeds);
  CHECK(fast.launch.clip.value().v0_m_s == Approx(1.8 * 1.2).epsilon(0.02));
  const auto back = std::get<diagnose::CoverRegion>(step(GapVariable::speed, -2.1, -1.5, GapKind::force));
  CHECK(back.launch.clip.value().v0_m_s < -1.95);
  CHECK(std::get<diagnose::CoverRegion>(step(GapVariable::position, 0.0, 0.1, GapKind::force)).over ==
        diagnose::CoverRegion::Over::places);
  CHECK(std::get<diagnose::AddMass>(step(GapVariable::mass, 0.335, 0.335, GapKind::friction)).mass_kg == Approx(0.435));
  CHECK(std::get<diagnose::RepeatClip>(step(GapVariable::time, 0.0, 1.0, GapKind::displacement, "clip2")).clip ==
        "clip2");
  CHECK(std::get<diagnose::Routine>(step(GapVariable::column, 0.0, 1.0, GapKind::displacement)) ==
        diagnose::Routine::move_camera);
}

TEST_CASE("where nothing is in doubt the weakest parameter is sharpened, and nothing is told from nothing") {
  tests::MadeEffect drag;
  drag.force = [](double, double, double v, double) { return -0.1 * v * std::abs(v); };
  const auto advice = [](const std::vector<tests::MadeLaunch>& launches, const tests::MadeEffect& effect) {
    const auto made = tests::made_experiment(launches, effect, 3, 2e-5, 120, 100.0, 0.01);
    const auto diagnosis = diagnose::diagnose_results(made.results, made.setups, {.without = {}, .jobs = 2});
    return diagnosis.next;
  };
  const auto weakest = std::get<diagnose::SharpenParameter>(advice(tests::made_launches(), drag));
  CHECK(weakest.key == "c_kg_m");
  CHECK(weakest.effect == "quadratic_drag");
  const tests::MadeEffect scale{{}, [](double x, double) { return 1.02 * x; }};
  const auto alike = std::get<diagnose::SettleDoubt>(advice(tests::made_launches(), scale));
  REQUIRE_FALSE(alike.doubt.empty());
  for (const diagnose::Alternative& of : alike.doubt) CHECK_FALSE(of.one.is_nothing());  // never told from nothing
  REQUIRE(alike.by);
  CHECK((alike.by->kind == ChangeKind::pattern || alike.by->kind == ChangeKind::clock));
}

TEST_CASE("what may act besides, and no change would show, does not stand before the weakest parameter") {
  const diagnose::TrackSet set = inclined();
  diagnose::Comparison comparison;
  comparison.fits = {diagnose::fit_nominal(set)};
  const diagnose::MotionFit& nominal = comparison.fits.front();
  const auto drag = with(set, nominal, "quadratic_drag", 0.1, nominal.at.global[0], nominal.at.global[2]);
  comparison.fits.push_back(drag);
  comparison.fits.push_back(drag);  // of the rival, which moves the glider alike: no change tells them apart
  const std::size_t of_drag = diagnose::effect_index("quadratic_drag"), bumper = diagnose::effect_index("end_stop");
  diagnose::Hypothesis first, rival;
  first.effects = {of_drag};
  first.probability = 0.9;
  first.fit = 1;
  rival.effects = {of_drag, bumper};
  rival.probability = 0.1;
  rival.fit = 2;
  diagnose::Diagnosis diagnosis;
  diagnosis.verdict = diagnose::Verdict::effect;
  comparison.all = {first, rival};
  const auto sharpen = std::get<diagnose::SharpenParameter>(diagnose::next_experiment(set, comparison, diagnosis));
  REQUIRE(sharpen.undecided.size() == 1);
  CHECK(sharpen.undecided.front().one.effects == std::vector<std::string>{"end_stop"});
  CHECK(sharpen.undecided.front().other.is_nothing());
  // A rival in the first one's place puts its name in doubt, which goes first.
  comparison.all[1].effects = {bumper};
  const auto settle = std::get<diagnose::SettleDoubt>(diagnose::next_experiment(set, comparison, diagnosis));
  CHECK_FALSE(settle.by);
}

TEST_CASE(
    "the doubt is about the effects that the verdict names and about what may act besides, in however many pairs") {
  const diagnose::TrackSet set = inclined();
  diagnose::Comparison comparison;
  comparison.fits = {diagnose::fit_nominal(set)};
  const diagnose::MotionFit& nominal = comparison.fits.front();
  const auto drag = with(set, nominal, "quadratic_drag", 0.1, nominal.at.global[0], nominal.at.global[2]);
  comparison.fits.push_back(drag);  // all move the glider alike: no change tells them apart
  const std::size_t named = diagnose::effect_index("quadratic_drag"), bow = diagnose::effect_index("track_bow"),
                    lens = diagnose::effect_index("lens_distortion"), stop = diagnose::effect_index("end_stop"),
                    plane = diagnose::effect_index("perspective_error");
  const auto one = [](std::vector<std::size_t> effects, double probability) {
    diagnose::Hypothesis hypothesis;
    hypothesis.effects = std::move(effects);
    hypothesis.probability = probability;
    hypothesis.fit = 1;
    return hypothesis;
  };
  // The likeliest single explanation is a pair, the verdict names the drag alone. The end stop comes to 0.06 in two.
  comparison.all = {one({named, plane}, 0.30), one({named, lens}, 0.25), one({named}, 0.20),
                    one({named, bow}, 0.04),   one({named, stop}, 0.03), one({named, plane, stop}, 0.03),
                    one({bow}, 0.03)};
  diagnose::Diagnosis diagnosis;
  diagnosis.verdict = diagnose::Verdict::effect;
  diagnosis.effects.resize(1);
  diagnosis.effects.front().id = "quadratic_drag";
  const auto step = std::get<diagnose::SharpenParameter>(diagnose::next_experiment(set, comparison, diagnosis));
  CHECK(step.effect == "quadratic_drag");
  for (const diagnose::Alternative& of : step.undecided) CHECK(of.other.is_nothing());
  // What each could add, by its sum: 0.33, 0.25, 0.06. Only the likeliest is told if no change decides all.
  REQUIRE(step.undecided.size() == 1);
  CHECK(step.undecided.front().one.effects == std::vector<std::string>{"perspective_error"});
  // A replacement counts by the sum over its explanations too.
  comparison.all = {one({named}, 0.60), one({lens, plane}, 0.04), one({lens}, 0.04), one({lens, bow}, 0.04)};
  const auto settle = std::get<diagnose::SettleDoubt>(diagnose::next_experiment(set, comparison, diagnosis));
  REQUIRE(settle.doubt.size() == 1);
  CHECK(settle.doubt.front().one.effects == std::vector<std::string>{"quadratic_drag"});
  CHECK(settle.doubt.front().other.effects == std::vector<std::string>{"lens_distortion"});
}

TEST_CASE("what to record next does not follow a named effect that takes nothing of the gap") {
  const diagnose::TrackSet set = inclined();
  diagnose::Comparison comparison;
  comparison.fits = {diagnose::fit_nominal(set)};
  const diagnose::MotionFit& nominal = comparison.fits.front();
  comparison.fits.push_back(with(set, nominal, "quadratic_drag", 0.1, nominal.at.global[0], nominal.at.global[2]));
  const std::size_t drag = diagnose::effect_index("quadratic_drag"), flicker = diagnose::effect_index("light_flicker");
  diagnose::Hypothesis both, drag_alone;
  both.effects = {drag, flicker};
  both.probability = 0.9;
  both.fit = drag_alone.fit = 1;
  drag_alone.effects = {drag};
  drag_alone.probability = 0.1;
  comparison.all = {both, drag_alone};
  diagnose::Diagnosis diagnosis;
  diagnosis.verdict = diagnose::Verdict::effect;
  diagnosis.effects.resize(2);
  diagnosis.effects[0].id = "quadratic_drag";
  diagnosis.effects[1].id = "light_flicker";
  diagnosis.explained = {{.id = "quadratic_drag", .share = 0.99}};
  const auto step = std::get<diagnose::SharpenParameter>(diagnose::next_experiment(set, comparison, diagnosis));
  CHECK(step.effect == "quadratic_drag");
  // A flicker that takes a third of the gap is worth a recording of its own.
  diagnosis.explained = {{.id = "quadratic_drag", .share = 0.6}, {.id = "light_flicker", .share = 0.3}};
  CHECK(std::holds_alternative<diagnose::RecordForEffect>(diagnose::next_experiment(set, comparison, diagnosis)));
}

TEST_CASE("a fall's friction on a track that it does not touch is never the parameter to sharpen") {
  const auto made = tests::made_experiment({{0.3, 90.0, 0.0, 0.2}, {0.3, 90.0, 0.0, 0.3}}, {}, 5, 1e-4, 40, 60.0);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(diagnose::only_falls(set));
  diagnose::Comparison comparison;
  comparison.fits = {diagnose::fit_nominal(set)};
  comparison.all.emplace_back();
  comparison.all.front().fit = 0;
  comparison.all.front().probability = 0.97;
  const auto step = std::get<diagnose::SharpenParameter>(diagnose::next_experiment(set, comparison, {}));
  CHECK(step.key == "K");
  CHECK_FALSE(step.one_mass);
}

TEST_CASE("the weakest parameter is quoted as the tables give it, and what is expected of it alike") {
  diagnose::Diagnosis diagnosis;
  const diagnose::SharpenParameter mu{"mu", "", 0.009931, 0.000034, {}, {}, 0.000017};
  diagnosis.next = mu;
  diagnosis.recovered.resize(2);
  for (auto& of : diagnosis.recovered) of.mu.estimate = core::Estimate{0.009942, 0.000096, 0.0, 0.0};
  diagnose::quote_tables(diagnosis);
  const auto& told = std::get<diagnose::SharpenParameter>(diagnosis.next);
  CHECK(told.value == 0.009942);
  CHECK(told.sd == 0.000096);
  CHECK(told.sd_after == Approx(0.000048).epsilon(1e-12));
  // K is the same for all masses: K/m times m.
  diagnosis.next = diagnose::SharpenParameter{"K", "", 0.9, 0.01, {}, {}, 0.005};
  for (std::size_t c = 0; c < 2; ++c) {
    diagnosis.recovered[c].mass_kg = c == 0 ? 0.3 : 0.6;
    diagnosis.recovered[c].k_over_m_1_s.estimate = core::Estimate{0.96 / diagnosis.recovered[c].mass_kg, 0.1, 0.0, 0.0};
  }
  diagnose::quote_tables(diagnosis);
  CHECK(std::get<diagnose::SharpenParameter>(diagnosis.next).value == Approx(0.96).epsilon(1e-12));
  CHECK(std::get<diagnose::SharpenParameter>(diagnosis.next).sd == Approx(0.03).epsilon(1e-12));
  // Frictions that differ between configurations are not one parameter.
  diagnosis.next = mu;
  diagnosis.recovered[1].mu.estimate->value = 0.011;
  diagnose::quote_tables(diagnosis);
  CHECK(std::get<diagnose::SharpenParameter>(diagnosis.next).value == mu.value);
  // The size of a named effect is that of the verdict.
  diagnosis.next = diagnose::SharpenParameter{"c_kg_m", "quadratic_drag", 0.1, 0.01, {}, {}, 0.008};
  diagnosis.effects.resize(1);
  diagnosis.effects.front().id = "quadratic_drag";
  diagnosis.effects.front().parameters = {{"c_kg_m", 0.11, 0.02}};
  diagnose::quote_tables(diagnosis);
  CHECK(std::get<diagnose::SharpenParameter>(diagnosis.next).value == 0.11);
  CHECK(std::get<diagnose::SharpenParameter>(diagnosis.next).sd_after == Approx(0.016).epsilon(1e-12));
}

TEST_CASE("the next clip comes after the last one: a friction that drifts has gone on drifting") {
  const diagnose::TrackSet set = inclined();
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const double k = 0.93, mu = nominal.at.global[1], alpha = nominal.at.global[2], r = 0.3, m = 0.335;
  const auto drift = with(set, nominal, "friction_drift", r, k, alpha);
  const auto next = diagnose::next_motion(set, drift, clip_of({0, m, 1.2, 100.0}));
  REQUIRE(set.clips.size() == 4);
  // Downhill, with v' = A - (K/m) v: v = v_lim + (v0 - v_lim) exp(-(K/m) t).
  const double rate = k / m, a = 9.80665 * (std::sin(alpha) - mu * (1.0 + 4.0 * r) * std::cos(alpha));
  REQUIRE(next.moved.v_m_s.size() > 20);
  for (std::size_t p = 0; p < next.moved.v_m_s.size(); ++p) {
    const double t = static_cast<double>(p) / 100.0;
    // The integrator is good to 1e-6 m/s here; clip number 0 would be 1.2 mu g t = 0.07 t m/s off.
    CHECK(std::abs(next.moved.v_m_s[p] - (a / rate + (1.2 - a / rate) * std::exp(-rate * t))) < 1e-5);
  }
}

TEST_CASE("one more clip knows a friction that scatters from clip to clip no better than it scatters") {
  const diagnose::TrackSet set = inclined();
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  const std::size_t scatter = diagnose::effect_index("clip_scatter");
  const diagnose::MotionFit start = diagnose::linearise_at(
      set, {scatter}, diagnose::with_effect(set, nominal, scatter, std::vector<double>(8, 0.0), {}));
  diagnose::FitPoint at = start.at;
  const auto& globals = start.layout->globals();
  const double spread = 2e-3;
  std::size_t deviations = 0;
  for (std::size_t g = 0; g < globals.size(); ++g) {
    const bool of_mu = globals[g].parameter != nullptr && globals[g].parameter->shown_as == diagnose::ShownAs::of_mu;
    if (of_mu) at.global[static_cast<Eigen::Index>(g)] = deviations++ % 2 == 0 ? spread : -spread;
  }
  REQUIRE(deviations == set.clips.size());
  const diagnose::MotionFit fit = diagnose::linearise_at(set, {scatter}, at);
  Eigen::MatrixXd before = Eigen::MatrixXd::Zero(at.global.size(), at.global.size());
  before(1, 1) = 1e-4;  // of mu alone, (0.01)²
  const Eigen::MatrixXd after = diagnose::expected_covariance(set, fit, before, clip_of({0, 0.335, -1.1, 100.0}));
  // mu + d is then known to some 1e-5, which does not count, and d has the spread so far.
  const double expected = 1.0 / (1.0 / before(1, 1) + 1.0 / (spread * spread));
  CHECK(after(1, 1) == Approx(expected).epsilon(0.01));
}

TEST_CASE("after a motion under a recorded force no launch is suggested, but the same places with other forces") {
  tests::MadeEffect effect;
  effect.recorded = [](double t) { return 0.3 * std::sin(2.9 * t); };
  const auto made = tests::made_experiment({{0.4, 0.0, 0.0, 0.05}}, effect, 11, 2e-5, 800, 100.0);
  const diagnose::TrackSet set = diagnose::track_set(made.results, made.setups, true);
  REQUIRE(diagnose::is_driven(set));
  CHECK_FALSE(diagnose::is_driven(inclined()));
  const diagnose::MotionFit nominal = diagnose::fit_nominal(set);
  for (const Change& change : diagnose::feasible_changes(set, nominal)) CHECK_FALSE(change.clip);
  diagnose::Diagnosis diagnosis;
  for (const GapVariable variable : {GapVariable::position, GapVariable::speed}) {
    diagnosis.regions = {{variable, 0.0, 0.1, 9.0, 0.1, "N", GapKind::force, ""}};
    const diagnose::NextStep step = diagnose::next_for_unnamed(set, nominal, diagnosis);
    REQUIRE(std::holds_alternative<diagnose::Routine>(step));
    CHECK(std::get<diagnose::Routine>(step) == diagnose::Routine::other_forces);
  }
}
