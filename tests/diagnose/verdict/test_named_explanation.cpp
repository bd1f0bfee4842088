#include "diagnose/verdict/named_explanation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/gap/size_uncertainty.h"
#include "diagnose/verdict/verdict.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

/// A comparison of explanations that follow the motions equally well.
struct Named {
  diagnose::TrackSet set;
  diagnose::Comparison comparison;

  Named() {
    const tests::MadeEffect drag = {[](double, double, double v, double) { return -0.1 * v * std::abs(v); }};
    const tests::MadeExperiment made = tests::made_experiment(tests::made_launches({0.4}), drag, 7, 1e-4, 60, 50.0);
    set = diagnose::track_set(made.results, made.setups, true);
    comparison.fits.push_back(diagnose::fit_nominal(set));
    comparison.effect_probability.assign(diagnose::effect_list().size(), 0.0);
  }

  /// An explanation by these effects, the sizes of the last of which are as fitted or 0.
  void add(const std::vector<std::string_view>& ids, bool has_size, double probability) {
    diagnose::Hypothesis one;
    diagnose::MotionFit fit = comparison.fits.front();
    for (const std::string_view id : ids) {
      const std::size_t effect = diagnose::effect_index(id);
      one.effects.push_back(effect);
      fit = diagnose::fit_with_effect(set, fit, effect, diagnose::with_effect(set, fit, effect, {0.05}, {}));
    }
    const auto size = static_cast<Eigen::Index>(fit.layout->first_of(one.effects.back()));
    if (!has_size) fit.at.global[size] = 0.0;
    one.probability = probability;
    one.gain = 40.0;
    one.log_evidence = 30.0;
    one.fit = static_cast<int>(comparison.fits.size());
    comparison.fits.push_back(std::move(fit));
    comparison.all.push_back(std::move(one));
  }

  std::vector<std::size_t> instead() const {
    const diagnose::Hypothesis* named = diagnose::with_certain_sizes(set, comparison, comparison.all.front());
    return named != nullptr ? named->effects : std::vector<std::size_t>();
  }
};

const std::size_t kDrag = diagnose::effect_index(diagnose::ids::quadratic_drag);

}  // namespace

TEST_CASE("what images show is claimed by them alone only where nothing beside it would explain a gap") {
  const auto alone = [](const std::vector<std::string_view>& ids) {
    diagnose::Hypothesis of;
    for (const std::string_view id : ids) of.effects.push_back(diagnose::effect_index(id));
    return diagnose::shows_in_images_alone(of);
  };
  CHECK(alone({diagnose::ids::compression}));
  CHECK(alone({diagnose::ids::timestamp_jitter, diagnose::ids::exposure_blur}));
  CHECK_FALSE(alone({diagnose::ids::tether, diagnose::ids::compression}));
  CHECK_FALSE(alone({diagnose::ids::dropped_frames, diagnose::ids::light_flicker}));
  CHECK_FALSE(alone({diagnose::ids::timestamp_jitter}));
  CHECK_FALSE(alone({}));
}

TEST_CASE("an effect without a certain size gives way to an equal that has one, and to no other") {
  Named named;
  named.add({"power_law_drag"}, false, 0.5);
  named.add({"quadratic_drag"}, true, 0.4);
  CHECK(named.instead() == std::vector{kDrag});
  named.comparison.all[1].probability = 0.1;  // far less likely: it does not take the place
  CHECK(named.instead().empty());
  named.comparison.all[1].probability = 0.4;
  CHECK(named.instead() == std::vector{kDrag});
  named.comparison.all[1].gain = 30.0;  // it follows the motions less well: no equal
  CHECK(named.instead().empty());
}

TEST_CASE("where no equal has a certain size the others of an explanation stand alone, or it is kept") {
  Named named;
  named.add({"power_law_drag"}, false, 0.5);
  named.add({"quadratic_drag"}, false, 0.4);
  CHECK(named.instead().empty());
  Named beside;
  beside.add({"quadratic_drag", "load_independent_friction"}, false, 0.5);
  beside.add({"quadratic_drag"}, true, 0.4);
  CHECK(beside.instead() == std::vector{kDrag});
  Named certain;
  certain.add({"quadratic_drag"}, true, 0.5);
  CHECK(certain.instead().empty());
}

TEST_CASE("several sizes of one kind are certain if they are together farther from 0 than by chance") {
  Named named;
  const auto fit_with = [&](std::string_view id) {
    const std::size_t effect = diagnose::effect_index(id);
    return diagnose::fit_with_effect(named.set, named.comparison.fits.front(), effect,
                                     diagnose::with_effect(named.set, named.comparison.fits.front(), effect, {}, {}));
  };
  diagnose::MotionFit fit = fit_with(diagnose::ids::place_friction);
  const std::size_t friction = diagnose::effect_index(diagnose::ids::place_friction);
  const auto first = static_cast<Eigen::Index>(fit.layout->first_of(friction));
  const Eigen::Index sizes = fit.at.global.size() - first;
  REQUIRE(sizes > 3);
  const diagnose::SizeUncertainty uncertainty(named.set, fit);
  std::vector<Eigen::Index> globals;
  for (Eigen::Index g = 0; g < sizes; ++g) globals.push_back(first + g);
  // Any direction, scaled so that v' C⁻¹ v is what is asked for; chi² of n degrees has its 99 % quantile below 3.4 n
  // from n = 4 on, and above 2 n up to n = 15.
  const auto certain_at = [&](const Eigen::VectorXd& along, double chi2) {
    const Eigen::VectorXd scaled = along * std::sqrt(chi2 / uncertainty.chi2(globals, along));
    for (Eigen::Index g = 0; g < sizes; ++g) fit.at.global[first + g] = scaled[g];
    return diagnose::has_certain_size(named.set, fit, {friction});
  };
  const double n = static_cast<double>(sizes);
  REQUIRE(n < 15.0);
  const Eigen::VectorXd all = Eigen::VectorXd::Ones(sizes), one = Eigen::VectorXd::Unit(sizes, 1);
  for (const Eigen::VectorXd& along : {all, one}) {
    CHECK_FALSE(certain_at(along, 2.0 * n));
    CHECK(certain_at(along, 3.4 * n));
    CHECK(certain_at(-along, 3.4 * n));
  }
  const std::size_t scatter = diagnose::effect_index(diagnose::ids::clip_scatter);
  diagnose::MotionFit scattering = fit_with(diagnose::ids::clip_scatter);
  scattering.at.global
      .tail(scattering.at.global.size() - static_cast<Eigen::Index>(scattering.layout->first_of(scatter)))
      .setZero();
  CHECK(diagnose::has_certain_size(named.set, scattering, {scatter}));
}

TEST_CASE("an effect without a certain size is no cause only if the others leave no more of the gap") {
  Named named;
  named.add({"quadratic_drag", "load_independent_friction"}, false, 0.5);
  named.add({"quadratic_drag"}, true, 0.4);
  named.comparison.all[0].left = 0.05;
  named.comparison.all[1].left = 0.1;
  CHECK(named.instead() == std::vector{kDrag});
  named.comparison.all[1].left = 0.3;
  CHECK(named.instead().empty());
}

TEST_CASE("of two causes of which one takes the part of both, the likelier by its own name keeps it") {
  const std::size_t pattern = diagnose::effect_index(diagnose::ids::perspective_error);
  Named named;
  named.add({"quadratic_drag", "perspective_error"}, true, 0.3);
  named.add({"perspective_error"}, true, 0.1);
  named.add({"quadratic_drag"}, true, 0.1);
  named.add({"perspective_error", "friction_drift"}, true,
            0.3);  // as likely: it stands for the drag beside the pattern
  diagnose::CauseSequence sequence;
  sequence.is_gap = true;
  sequence.named.effects = {kDrag};
  const auto keeps = [&]() -> std::vector<std::size_t> {
    const diagnose::Hypothesis* alone =
        diagnose::without_the_lesser(named.comparison, false, named.comparison.all.front(), sequence);
    return alone != nullptr ? alone->effects : std::vector<std::size_t>();
  };
  CHECK(keeps() == std::vector{pattern});
  named.comparison.all[3].probability = 0.05;  // hardly likelier
  CHECK(keeps().empty());
}

TEST_CASE("a quadratic drag counts towards a drag with a power of the speed, of which it is one") {
  Named named;
  named.add({"power_law_drag", "late_release"}, true, 0.35);
  named.add({"late_release"}, true, 0.1);
  named.add({"quadratic_drag", "late_release"}, true, 0.3);
  named.add({"quadratic_drag"}, true, 0.1);
  named.comparison.all[2].gain = 0.0;  // the data tell the two powers apart
  diagnose::CauseSequence sequence;
  sequence.is_gap = true;
  sequence.named.effects = {diagnose::effect_index(diagnose::ids::power_law_drag)};
  const diagnose::Hypothesis& best = named.comparison.all.front();
  CHECK(diagnose::without_the_lesser(named.comparison, false, best, sequence) == nullptr);
  named.comparison.all[2].effects.front() = diagnose::effect_index(diagnose::ids::track_bow);
  named.comparison.all[3].effects.front() = diagnose::effect_index(diagnose::ids::track_bow);
  const diagnose::Hypothesis* hand = diagnose::without_the_lesser(named.comparison, false, best, sequence);
  REQUIRE(hand != nullptr);
  CHECK(hand->effects == std::vector{diagnose::effect_index(diagnose::ids::late_release)});
}

TEST_CASE("a cause that alone keeps its name has to be likelier than not by itself") {
  Named named;
  named.add({"quadratic_drag", "perspective_error"}, true, 0.4);
  named.add({"perspective_error"}, true, 0.3);
  named.add({"quadratic_drag"}, true, 0.05);
  named.comparison.all[1].gain = 30.0;  // it follows the motions less well than the drag: no equal
  const diagnose::Hypothesis& best = named.comparison.all.front();
  CHECK(diagnose::is_likelier_than_not(named.set, named.comparison, best));
  diagnose::CauseSequence sequence;
  const auto by = [&](std::vector<std::size_t> effects) -> const diagnose::Hypothesis& {
    sequence.named.effects = std::move(effects);
    return diagnose::named_by(named.comparison, sequence, best);
  };
  CHECK(by({kDrag}).effects == std::vector{kDrag});
  CHECK_FALSE(diagnose::is_likelier_than_not(named.set, named.comparison, by({kDrag})));
  CHECK(&by({}) == &best);
}

TEST_CASE("of several causes those that have a size beside what remains keep their name") {
  Named named;
  named.add({"quadratic_drag", "load_independent_friction"}, false, 0.5);
  named.add({"quadratic_drag"}, true, 0.4);
  const auto kept = [&](std::size_t fit) {
    const diagnose::Hypothesis* part =
        diagnose::part_with_sizes(named.set, named.comparison.fits[fit], named.comparison);
    return part != nullptr ? part->effects : std::vector<std::size_t>();
  };
  CHECK(kept(1) == std::vector{kDrag});
  CHECK(kept(2).empty());  // all that it names has a size
  named.comparison.all.pop_back();
  CHECK(kept(1).empty());  // no such explanation
}

TEST_CASE("an explanation leaves the quantities if none moves by two standard deviations, whatever its own sizes are") {
  Named named;
  named.add({"load_independent_friction"}, true, 0.5);
  const diagnose::MotionFit& nominal = named.comparison.fits.front();
  diagnose::MotionFit with = named.comparison.fits.back();
  const auto friction = static_cast<Eigen::Index>(with.layout->first_of(named.comparison.all.front().effects.back()));
  constexpr Eigen::Index kMu = 1;
  const double before = diagnose::SizeUncertainty(named.set, nominal).sd(kMu),
               after = diagnose::SizeUncertainty(named.set, with).sd(kMu), sd = std::max(before, after);
  const auto leaves_at = [&](double off) {
    with.at.global.head(nominal.at.global.size()) = nominal.at.global;
    with.at.global[kMu] += off * sd;
    return diagnose::leaves_quantities(named.set, nominal, with);
  };
  REQUIRE(friction >= nominal.at.global.size());
  CHECK(leaves_at(1.9));
  CHECK(leaves_at(-1.9));
  CHECK_FALSE(leaves_at(2.1));
  with.at.global[friction] *= 10.0;
  CHECK(leaves_at(0.0));
}

TEST_CASE("the ranking falls by probability, in whatever order the hypotheses were weighed, and then by evidence") {
  Named made;
  const auto add = [&](std::string_view id, double probability, double log_evidence) {
    diagnose::Hypothesis one;
    one.effects = {diagnose::effect_index(id)};
    one.probability = probability;
    one.log_evidence = log_evidence;
    made.comparison.all.push_back(one);
  };
  namespace ids = diagnose::ids;
  add(ids::place_friction, 0.0, 3.0);  // what images contradict was likely before
  add(ids::quadratic_drag, 0.11, 1.0);
  add(ids::rotational_inertia, 0.0, 5.0);
  add(ids::track_bow, 0.06, 9.0);
  std::vector<std::string> order;
  for (const auto& ranked : diagnose::ranking_of(made.set, made.comparison, nullptr)) {
    order.push_back(ranked.explanation.effects.front());
  }
  CHECK(order == std::vector<std::string>{std::string(ids::quadratic_drag), std::string(ids::track_bow),
                                          std::string(ids::rotational_inertia), std::string(ids::place_friction)});
}

TEST_CASE("no verdict rests on a name with less evidence than the nominal model, nor on a size that may be 0") {
  Named named;
  named.add({"quadratic_drag"}, true, 0.5);
  named.add({"track_bow"}, true, 0.3);
  diagnose::Hypothesis& drag = named.comparison.all.front();
  drag.log_evidence = -2.9;
  const auto may_lead = [&](double gap, double sds, double share = 0.9) {
    diagnose::CauseSequence sequence;
    sequence.causes.push_back({.id = "quadratic_drag", .share = share});
    sequence.gap_before = gap;
    sequence.named = named.comparison.fits[1];
    const auto size = static_cast<Eigen::Index>(sequence.named.layout->first_of(kDrag));
    sequence.named.at.global[size] = sds * diagnose::SizeUncertainty(named.set, sequence.named).sd(size);
    return diagnose::may_lead({named.set, sequence.named}, named.comparison, sequence);
  };
  CHECK_FALSE(may_lead(2.0, 10.0));
  CHECK(may_lead(1e4, 10.0));  // where the noise is negligible, evidence says nothing
  drag.log_evidence = 0.3;
  CHECK(may_lead(2.0, 10.0));
  CHECK(may_lead(2.0, -2.1));
  CHECK_FALSE(may_lead(2.0, 1.9));
  // What takes a trifle of the gap bears no verdict, however well its size is known.
  CHECK_FALSE(may_lead(2.0, 10.0, 0.05));
  // With another effect the name may have the evidence that it has not alone.
  drag.log_evidence = -2.9;
  named.comparison.all[1].effects.push_back(kDrag);
  CHECK(may_lead(2.0, 10.0));
  // The remainder of the nominal model contains clips that scatter: they need none.
  CHECK(diagnose::has_evidence({}, diagnose::effect_index(diagnose::ids::clip_scatter), false));
  CHECK_FALSE(diagnose::has_evidence({}, kDrag, false));
}
