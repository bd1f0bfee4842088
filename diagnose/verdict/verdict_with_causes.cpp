#include "diagnose/verdict/verdict_with_causes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "diagnose/causes/cause_odds.h"
#include "diagnose/causes/cause_sequence.h"
#include "diagnose/causes/cause_weighing.h"
#include "diagnose/causes/gap_levels.h"
#include "diagnose/causes/remainder.h"
#include "diagnose/causes/scatter_structure.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/drag_of_air.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/gap/held_out.h"
#include "diagnose/next/next_experiment.h"
#include "diagnose/recovered/recovered.h"
#include "diagnose/tracks/rounded_positions.h"
#include "diagnose/unnamed/unnamed.h"
#include "diagnose/unnamed/unnamed_trifle.h"
#include "diagnose/verdict/likely_explanations.h"
#include "diagnose/verdict/named_explanation.h"
#include "diagnose/verdict/order_of_causes.h"
#include "diagnose/verdict/probabilities_by_share.h"
#include "diagnose/verdict/verdict.h"
#include "diagnose/verdict/verdict_details.h"
#include "diagnose/verdict/verdict_notes.h"

namespace glidelab::diagnose {
namespace {

constexpr double kLeastUnknown = 0.5;  // probability of something without a name, above which a remainder is weighed
constexpr double kLeastDoubt = 0.05;   // probability of none or unknown above which names by noise alone are in doubt
constexpr double kMostOfOneClip = 0.999;   // the highest probability that one clip can support
constexpr double kLeastNamed = 0.1;        // of the excess: a smaller share counts as part of the remainder
constexpr double kLeastMeasuredGap = 0.5;  // a gap below which the assumed noise is not that of the positions
constexpr double kNearlyAllOfGap = 0.99;   // of the excess
constexpr double kOpenSize = 0.25;    // the least probability of an unknown cause beside a name without a certain size
constexpr double kFollowed = 2.0;     // times the noise: a gap below which large errors of single positions are errors
constexpr double kSureScatter = 0.9;  // probability from which scatter without a gap is the verdict
constexpr double kSureIdle = 0.95;    // and an effect that shifts no quantity either

/// Where the rest of the gap lies beside the named causes. Empty if nothing is left.
std::vector<GapRegion> regions_beside(const TrackSet& set, const CauseSequence& sequence, int jobs) {
  if (!(sequence.gap_after > 1.0 + kClearGap * sequence.standard_error)) return {};
  Diagnosis rest;
  rest.verdict = Verdict::unknown;
  add_regions(set, sequence.named, unnamed_families(ScoreSpace(set, sequence.named), jobs), rest);
  return rest.regions;
}

/// The log evidence by which the positions alone prefer an explanation of a fall, a quadratic drag alone or with the
/// inertia of the air and what acts beside them, to a viscous drag with the same. Empty for other explanations.
std::optional<double> evidence_over_viscous(const Comparison& comparison, const Hypothesis& best) {
  const std::size_t drag = effect_index(ids::quadratic_drag);
  std::set<std::size_t> effects(best.effects.begin(), best.effects.end());
  if (effects.size() > 1 && !is_drag_with_its_air(best.effects)) return {};
  const Hypothesis* quadratic = find(comparison, effects);
  effects.erase(drag);
  const Hypothesis* viscous = find(comparison, effects);
  if (quadratic == nullptr || viscous == nullptr) return {};
  return quadratic->log_evidence - viscous->log_evidence;
}

/// Whether the nominal model has a gap and the likeliest explanation by the noise alone leaves one too, or leaves a
/// doubt although sizes of each clip or a second cause help it to follow the motion, or has sizes of each clip that
/// follow a law.
bool leaves_a_gap(const TrackSet& set, const Comparison& by_noise) {
  const MotionFit& nominal = by_noise.fits.front();
  if (!has_gap(set, nominal)) return false;
  const Hypothesis* best = best_named(set, by_noise);
  if (best == nullptr || best->fit <= 0) return true;
  const bool is_law = best->effects.size() == 1 && !follows_each_clip(best->effects.front());
  if (!is_law && by_noise.none + by_noise.unknown > kLeastDoubt) return true;
  const MotionFit& fit = by_noise.fits[static_cast<std::size_t>(best->fit)];
  return has_gap(set, fit) || (has(*best, effect_index(ids::clip_scatter)) && follows_structure(set, fit));
}

/// The fit that a diagnosis reports, and the remainder beside it.
struct Reported {
  const MotionFit& fit;
  RemainderSizes sizes;
  double part_s = 0.0;  ///< RemainderSpace::part_s()
};

/// One verdict: what its steps share, and the steps in the order in which run() takes them.
class VerdictWithCauses {
 public:
  VerdictWithCauses(const TrackSet& set, Comparison first, const std::vector<std::size_t>& left_out, int jobs)
      : set_(set), without_(left_out.begin(), left_out.end()), jobs_(jobs), first_(std::move(first)) {}

  Diagnosis run(ImageEvidence images, const base::Progress& progress) {
    weigh(images, progress);
    progress("measuring the gap", 0.9);
    choose_explanation();
    choose_measure_of_gap();
    put_causes_in_order();
    size_causes();
    const bool beside_remainder = settle_probabilities();
    Diagnosis diagnosis =
        beside_remainder ? verdict_beside_remainder(std::move(images)) : verdict_by_noise(std::move(images));
    const Reported reported = reported_by(diagnosis);
    add_shares(reported, diagnosis);
    if (weighed_ && sequence_.is_gap && diagnosis.verdict == Verdict::unknown && !diagnosis.limits.driving.empty()) {
      count_remainder(set_, reported.fit, reported.sizes, diagnosis);
    }
    diagnosis.next =
        beside_remainder ? next_experiment(with(), by(), diagnosis) : next_experiment(set_, first_, diagnosis);
    add_notes(diagnosis);
    add_recovered(reported, diagnosis);
    if (set_.clips.size() < 2) cap_probabilities(kMostOfOneClip, diagnosis);
    return diagnosis;
  }

 private:
  /// The comparison that counts.
  const Comparison& by() const { return weighed_ ? weighed_->comparison : first_; }
  /// The motions of that comparison.
  const TrackSet& with() const { return weighed_ ? weighed_->set : set_; }
  const MotionFit& nominal() const { return first_.fits.front(); }
  const MotionFit& fit_of(const Hypothesis& one) const {
    return names_ ? by().fits[static_cast<std::size_t>(one.fit)] : nominal();
  }
  /// Named causes of a gap, weighed beside a remainder. Without a gap nothing remains, and an effect without a name
  /// shows best against the noise alone.
  bool is_settled() const { return weighed_ && sequence_.is_gap && names_; }
  const MotionFit& fit_of_gap() const { return sequence_.named.effects.empty() ? fit_of(best_) : sequence_.named; }
  /// What brakes a fall through air is known without positions too coarse to show it (keep_drag_of_air()).
  bool drag_is_known() const { return set_.through_air && noise_is_rounding(set_); }
  const MotionFit& best_start(const Hypothesis& one) const;
  CauseSequence sequence_with(const Hypothesis& one) const {
    return sequence_of(gap_set_, gap_nominal_, gap_with_, best_start(one), without_, weighed_ ? kLeastNamed : 0.0);
  }
  bool viscous_leaves_less() const { return diagnose::viscous_leaves_less(set_, by(), over_viscous_); }
  /// Whether a fit by the noise alone leaves a gap, and a fall with a viscous drag and nothing else clearly less.
  bool leaves_more_than_viscous(const MotionFit& fit) const {
    const FallsThroughAir of{over_viscous_, gaps_of_fall(held_out_gap(set_, fit).value)};
    return of.viscous_leaves_less() && has_gap(set_, fit);
  }
  FallsThroughAir::Gaps gaps_of_fall(double named) const { return {held_out_gap(set_, nominal()).value, named}; }
  NoiseAlone noise_alone() const { return {gap_set_, gap_nominal_, sequence_.named, sized_.set, sized_.fit}; }

  void weigh(const ImageEvidence& images, const base::Progress& progress);
  void choose_explanation();
  void choose_measure_of_gap();
  void put_causes_in_order();
  void size_causes();
  bool settle_probabilities();
  Diagnosis verdict_beside_remainder(ImageEvidence images) const;
  Diagnosis verdict_by_noise(ImageEvidence images);
  double least_unknown() const;
  /// Whether the verdict is `best_`: without a gap a part of it may be a trace.
  bool names_best(const Diagnosis& diagnosis) const {
    return diagnosis.verdict == Verdict::effect && (sequence_.is_gap || names_all(diagnosis, best_.effects));
  }
  void name_by_stated();
  void doubt_by_share(bool in_images);
  void move_imperfections_to_none();
  Reported reported_by(const Diagnosis& diagnosis) const;
  void add_shares(const Reported& reported, Diagnosis& diagnosis) const;
  void add_notes(Diagnosis& diagnosis) const;
  void add_recovered(const Reported& reported, Diagnosis& diagnosis) const;

  const TrackSet& set_;  // the noise alone
  const std::set<std::size_t> without_;
  const int jobs_;

  // What is compared.
  Comparison first_;                      // by the noise alone
  std::optional<WeighedCauses> weighed_;  // beside a remainder, where that is needed
  std::vector<Hypothesis> before_;        // the explanations before the share changes their probabilities,
  double unknown_before_ = 0.0;           // and what then has no name
  std::optional<Hypothesis> helps_;       // the best explanation, likely enough to be named or not

  // What is named.
  std::optional<Hypothesis> found_;  // the best explanation
  bool claims_ = false;              // it is likely enough
  bool names_ = false;               // it has a fit
  bool resized_ = false;             // by the noise alone: it is not the likeliest, but its sizes are certain
  Hypothesis best_;                  // the explanation that is named; none without names_

  // The gap, and what takes it.
  bool by_air_ = false;  // the gap is that of a fall without any drag
  std::optional<double> over_viscous_;
  TrackSet gap_set_, gap_with_;
  MotionFit gap_nominal_;
  CauseSequence sequence_;
  BesideRemainder sized_;                      // the causes that keep their name, for the sizes that the verdict gives
  bool open_size_ = false;                     // a name whose effect may as well have no size at all is not confident
  std::set<std::size_t> empty_;                // named functions of the place without a size
  std::optional<ImpossibleSizes> impossible_;  // the explanation with these sizes
  std::vector<std::string> traces_;
};

void VerdictWithCauses::weigh(const ImageEvidence& images, const base::Progress& progress) {
  if (drag_is_known() && !has_gap(set_, nominal())) keep_drag_of_air(first_);
  if (first_.unknown > kLeastUnknown || leaves_a_gap(set_, first_)) {
    weighed_ = weigh_causes(set_, first_, without_, jobs_, &images,
                            [&](double part) { progress("weighing explanations", 0.5 + 0.4 * part); });
  }
  before_ = by().all;
  unknown_before_ = by().none + by().unknown;
  if (!weighed_) return;
  if (const Hypothesis* best = best_named(with(), by())) helps_ = *best;
  move_minorities_to_unknown(weighed_->comparison);
}

void VerdictWithCauses::choose_explanation() {
  // Beside a remainder, `none` counts as unknown: there is a gap.
  const double none = weighed_ ? 0.0 : by().none, unknown = weighed_ ? by().none + by().unknown : by().unknown;
  claims_ = verdict_by(none, unknown) == Verdict::effect;
  const Hypothesis* found = claims_ || !helps_ ? best_named(with(), by()) : &*helps_;
  if (found == nullptr) return;
  found_ = *found;
  names_ = found_->fit > 0 && (weighed_ || claims_);
  if (!names_) return;
  best_ = *found_;
  const Hypothesis* sized = with_certain_sizes(with(), by(), best_);
  resized_ = sized != nullptr && !weighed_;
  if (sized != nullptr) best_ = *sized;
}

/// Of the two fits of an explanation, beside the common remainder and by the noise alone, the one from which a fit by
/// the noise alone fits better.
const MotionFit& VerdictWithCauses::best_start(const Hypothesis& one) const {
  const MotionFit& with = fit_of(one);
  if (!weighed_ || !names_) return with;
  const std::optional<WeighedFit>& own = weighed_->fits[static_cast<std::size_t>(one.fit)];
  if (!own || !std::isfinite(own->noise_alone.cost)) return with;
  const auto cost_from = [&](const MotionFit& from) {
    return fit_motions(set_, from.effects, from.at, from.late).cost;
  };
  const double of_own = cost_from(own->noise_alone), of_with = cost_from(with);
  return of_own < of_with || !std::isfinite(of_with) ? own->noise_alone : with;
}

/// K of the nominal model imitates a drag of air. The gap that such a drag explains is that of a fall without any,
/// unless K does better: that gap would flatter any drag.
void VerdictWithCauses::choose_measure_of_gap() {
  by_air_ = set_.through_air && claims_ && names_ && has(best_, effect_index(ids::quadratic_drag));
  if (by_air_ && weighed_) {
    const MotionFit& from = best_start(best_);
    by_air_ = !leaves_more_than_viscous(fit_motions(set_, from.effects, from.at, from.late));
  }
  if (by_air_) over_viscous_ = evidence_over_viscous(by(), best_);
  gap_set_ = by_air_ ? without_drag(set_) : set_;
  gap_with_ = by_air_ ? without_drag(with()) : with();
  gap_nominal_ = by_air_ ? fit_nominal(gap_set_) : nominal();
}

/// The causes by their shares. A likelier part of the explanation, or a likelier cause alone, is named in its place if
/// it takes enough of the gap.
void VerdictWithCauses::put_causes_in_order() {
  const bool may_change = weighed_ && claims_;
  const Hypothesis* likely = names_ && may_change ? likely_part(set_, by(), best_) : nullptr;
  if (likely != nullptr) sequence_ = sequence_with(*likely);
  const bool by_share =
      likely != nullptr && (sequence_.named_share >= kHalfOfGap || needs_no_share(sequence_, *likely, by()));
  if (by_share && is_likelier_than_not(with(), by(), *likely, &best_)) {
    best_ = *likely;
  } else {
    sequence_ = sequence_with(best_);
  }
  if (const Hypothesis* alone = may_change ? without_the_lesser(by(), set_.images, best_, sequence_) : nullptr) {
    CauseSequence likelier = sequence_with(*alone);
    if (!may_displace(likelier, sequence_)) return;
    best_ = *alone;
    sequence_ = std::move(likelier);
  }
}

void VerdictWithCauses::size_causes() {
  // In the fit of the whole explanation a part of one cause may have gone into another that takes none of the gap.
  sized_ = is_settled() ? beside_own_remainder(set_, fit_of_gap()) : BesideRemainder{with(), fit_of(best_)};
  if (const Hypothesis* sized = is_settled() ? part_with_sizes(sized_.set, sized_.fit, by()) : nullptr) {
    CauseSequence of_sized = sequence_with(*sized);
    if (may_displace(of_sized, sequence_)) {
      best_ = *sized;
      sequence_ = std::move(of_sized);
      sized_ = beside_own_remainder(set_, fit_of_gap());
    }
  }
  // Lost frames are counted one by one: their size is certain.
  open_size_ = names_ && sequence_.is_gap && shows_in_gap(best_) && !has(best_, effect_index(ids::dropped_frames)) &&
               !has_certain_size(sized_.set, sized_.fit, fit_of_gap().effects);
  if (names_ && sequence_.is_gap && shows_in_gap(best_)) impossible_ = impossible_sizes(sized_.fit);
  if (!names_ || !shows_in_gap(best_)) return;
  const bool gap = sequence_.is_gap;
  for (const std::size_t e : gap ? fit_of_gap().effects : best_.effects) {
    if (is_function_without_size(gap ? sized_.set : set_, gap ? sized_.fit : fit_of(best_), e)) empty_.insert(e);
  }
}

/// The least probability of an unknown cause, by the sizes of what is named.
double VerdictWithCauses::least_unknown() const {
  const bool leads = !names_ || !sequence_.is_gap || by_air_ || may_lead(sized_, by(), sequence_);
  const bool leaves_much = open_size_ && sequence_.gap_after > kFollowed;
  const bool doubtful = impossible_ || !empty_.empty() || may_take_nothing(sequence_) || leaves_much || !leads;
  return doubtful ? kUnknownIfLess : open_size_ ? kOpenSize : 0.0;
}

/// The probabilities by what the named causes take of the gap. Whether they still make a verdict beside a remainder.
bool VerdictWithCauses::settle_probabilities() {
  if (!is_settled()) return false;
  Comparison& comparison = weighed_->comparison;
  hold_to_share(sequence_, best_.effects, by_air_, comparison);
  if (!is_likelier_than_not(with(), comparison, named_by(comparison, sequence_, best_), found_ ? &*found_ : nullptr)) {
    set_unknown(std::max(comparison.unknown, kUnknownIfLess), comparison);
  }
  set_unknown(std::max(comparison.unknown, least_unknown()), comparison);
  if (by_air_ && (viscous_leaves_less() || leaves_more_than_viscous(sequence_.named))) {
    set_unknown(std::max(comparison.unknown, kUnknownIfLess), comparison);
  }
  return verdict_by(comparison.none, comparison.unknown) == Verdict::effect;
}

Diagnosis VerdictWithCauses::verdict_beside_remainder(ImageEvidence images) const {
  const NoiseAlone alone = noise_alone();
  return verdict_of(with(), by(), std::move(images), &alone);
}

Diagnosis VerdictWithCauses::verdict_by_noise(ImageEvidence images) {
  const bool in_images = names_ ? shows_in_images_alone(best_) : found_ && shows_in_images_alone(*found_);
  // Nothing is claimed below the step of rounding: what shows there and leaves no gap comes from rounding. Nor is
  // anything claimed if the positions follow the model far better than the assumed noise allows.
  const bool not_measured = !drag_is_known() && (noise_is_rounding(set_) || sequence_.gap_before < kLeastMeasuredGap);
  const bool below_noise = not_measured && !sequence_.is_gap && !in_images;
  if (below_noise) {
    move_to_none([](const Hypothesis&) { return true; }, first_);
    first_.none += std::exchange(first_.unknown, 0.0);
  }
  // Small imperfections that make no gap still show, and then count as an unknown cause.
  const bool open = !sequence_.is_gap && !in_images && verdict_by(first_.none, first_.unknown) == Verdict::unknown;
  if ((below_noise || open) && trust_stated(first_)) name_by_stated();
  doubt_by_share(in_images);
  const bool by_name = first_.unknown < kUnknownIfLess;
  const bool at_floor = sequence_.gap_before < 1.0 + sequence_.standard_error;
  if (!by_name && at_floor && is_trifle(set_, nominal(), first_.unnamed)) {
    // What images show by themselves is as certain as without it.
    if (in_images && first_.unknown < 1.0) set_unknown(0.0, first_);
    first_.none += std::exchange(first_.unknown, 0.0);
  }
  if (!weighed_ && !sequence_.is_gap && !below_noise && !drag_is_known()) move_imperfections_to_none();
  const bool driven = in_images && !limits_of(set_, nominal()).driving.empty();  // which no image explains
  if (driven) set_unknown(std::max(first_.unknown, kUnknownIfLess), first_);
  const NoiseAlone alone = noise_alone();
  Diagnosis diagnosis =
      verdict_of(set_, first_, std::move(images), (by_air_ || resized_) && sequence_.is_gap ? &alone : nullptr);
  if (weighed_ && sequence_.is_gap && !in_images) {
    const NoiseAlone noise{set_, nominal(), nominal(), set_, nominal()};
    diagnosis.ranking = ranking_of(with(), by(), &noise);
  }
  return diagnosis;
}

/// The likeliest of the names that resolve a contradiction of stated inclinations (trust_stated()) is the verdict's.
void VerdictWithCauses::name_by_stated() {
  const Hypothesis* named = best_named(set_, first_);  // in the comparison whose fits are reported
  const Hypothesis* reported = named == nullptr ? nullptr : find(by(), {named->effects.begin(), named->effects.end()});
  if (reported == nullptr || reported->fit <= 0) return;
  best_ = *reported;
  names_ = claims_ = true;
}

/// Raises the probability of an unknown cause where the named ones do not explain the gap, by the noise alone.
void VerdictWithCauses::doubt_by_share(bool in_images) {
  if (weighed_ && sequence_.is_gap && !in_images) {
    // Nothing that moves the glider explains the gap.
    first_.unknown += std::exchange(first_.none, 0.0);
    set_unknown(std::max(by().none + by().unknown, kUnknownIfLess), first_);
  }
  if (weighed_ || !sequence_.is_gap) return;
  // A name that takes less than half of a gap does not explain it.
  const bool explains = !names_ || !shows_in_gap(best_) || sequence_.named_share >= kHalfOfGap;
  if (!explains) set_unknown(1.0, first_);
  if (names_ && shows_in_gap(best_) && !in_images && !is_likelier_than_not(set_, first_, best_)) {
    set_unknown(std::max(first_.unknown, kUnknownIfLess), first_);
  }
  if (!in_images) set_unknown(std::max(first_.unknown, least_unknown()), first_);
}

/// Without a gap, a name must do more than small imperfections would, and shift a quantity or be certain. Scatter of
/// single positions shifts no parameter either: unless it is all but certain, it is a trace.
void VerdictWithCauses::move_imperfections_to_none() {
  // Scatter has no fit of its own: the verdict on it is by the noise alone.
  const bool scatter = found_ && is_scatter_alone(*found_) && claims_;
  if ((!names_ && !scatter) || found_->effects.empty()) return;
  std::vector<std::size_t> seen = found_->effects;  // by the noise alone
  if (!scatter) std::erase_if(seen, [&](std::size_t e) { return first_.effect_probability[e] < kLikelierThanNot; });
  if (names_ && shows_in_gap(best_)) {
    allow_for_remainders(set_, without_, jobs_, first_);
    const bool sure = first_.none + first_.unknown < 1.0 - kSureIdle;  // whichever of those that look alike
    if (!sure && leaves_quantities(set_, nominal(), fit_of(best_))) empty_.insert(seen.begin(), seen.end());
  }
  const auto is_empty = [this](std::size_t e) { return empty_.contains(e); };
  move_to_none([&](const Hypothesis& one) { return std::ranges::any_of(one.effects, is_empty); }, first_);
  if (scatter && probability_of_scatter(first_) < kSureScatter) move_to_none(is_scatter_alone, first_);
  if ((scatter || shows_in_gap(best_)) && verdict_by(first_.none, first_.unknown) == Verdict::none) {
    for (const std::size_t e : seen) traces_.emplace_back(effect_list()[e].id);
  }
}

Reported VerdictWithCauses::reported_by(const Diagnosis& diagnosis) const {
  // Where causes are named whatever part of the gap they take, all of them are in the fit of the explanation itself.
  const MotionFit& with_effect =
      sequence_.is_gap && (is_settled() || by_air_ || resized_) ? sequence_.named : fit_of(best_);
  const MotionFit& fit = names_best(diagnosis) ? with_effect : nominal();
  const RemainderSpace space(set_, fit);
  const bool is_sized = is_settled() && &fit == &fit_of_gap();
  return {fit, is_sized ? sized_.remainder : space.likeliest().sizes, space.part_s()};
}

void VerdictWithCauses::add_shares(const Reported& reported, Diagnosis& diagnosis) const {
  diagnosis.traces = traces_;
  if (noise_is_rounding(set_)) diagnosis.traces.emplace_back(ids::position_rounding);
  if (!noise_is_rounding(set_) && sequence_.gap_after < kFollowed) add_clear_scatter(by(), diagnosis);
  diagnosis.explained = diagnosis.verdict == Verdict::unknown ? helpful(sequence_.causes) : sequence_.causes;
  for (DiagnosedEffect& effect : diagnosis.effects) {
    effect.by_stated = sequence_.by_stated.contains(effect_index(effect.id));
  }
  order_by_share(by_air_, diagnosis);
  if (sequence_.is_gap) {
    diagnosis.remainder = remainder_of(sequence_.gap_before, diagnosis.explained, reported.sizes, reported.part_s);
    diagnosis.remainder->regions =
        diagnosis.verdict == Verdict::effect ? regions_beside(set_, sequence_, jobs_) : diagnosis.regions;
  }
  diagnosis.levels = levels_of(gap_set_, gap_nominal_, jobs_);
}

void VerdictWithCauses::add_notes(Diagnosis& diagnosis) const {
  if (by_air_) {
    FallsThroughAir note{over_viscous_};
    if (diagnosis.remainder) note.gaps = gaps_of_fall(diagnosis.remainder->gap);
    // A quadratic drag with what acts beside it leaves less still, named or not.
    if (note.viscous_leaves_less() && !viscous_leaves_less()) note.gaps.reset();
    diagnosis.notes.emplace_back(note);
  }
  if (impossible_ && diagnosis.verdict == Verdict::unknown) diagnosis.notes.emplace_back(*impossible_);
  if (only_falls(set_)) {
    if (const auto buoyancy = buoyancy_like(set_, diagnosis)) diagnosis.notes.emplace_back(*buoyancy);
  }
  if (set_.images) return;
  if (std::vector<std::string> of_camera = named_of_camera(diagnosis); !of_camera.empty()) {
    diagnosis.notes.emplace_back(OfCamera{std::move(of_camera)});
  }
}

void VerdictWithCauses::add_recovered(const Reported& reported, Diagnosis& diagnosis) const {
  const bool with_names = names_best(diagnosis);
  const MovedOn settled = moved_on(with_names && by_air_ ? gap_set_ : set_, reported.fit, best_.converged || !names_);
  Explanations explanations{{&settled.fit, reported.sizes, 1.0}};
  if (weighed_) {
    explanations.front().probability = with_names ? 0.0 : unknown_before_;
    // What is off the list and imitates causes that take nearly all of the gap leaves the parameters as they do.
    const double unknown = with_names && sequence_.named_share > kNearlyAllOfGap ? 0.0 : unknown_before_;
    add_others(*weighed_, before_, unknown, with_names ? best_.effects : std::vector<std::size_t>(), explanations);
    explanations.front().probability = std::max(explanations.front().probability, kLikely);
  }
  if (with_names) {
    explanations.front().effects = best_.effects;
    explanations.front().at_minimum = settled.at_minimum;
  }
  if (!weighed_) add_others(first_, before_, explanations);
  diagnosis.recovered = recovered_of(set_, explanations);
  diagnosis.likely_twins = likely_twins(set_, explanations, diagnosis.effects);
}

}  // namespace

Diagnosis with_causes(const TrackSet& set, Comparison first, ImageEvidence images,
                      const std::vector<std::size_t>& left_out, int jobs, const base::Progress& progress) {
  return VerdictWithCauses(set, std::move(first), left_out, jobs).run(std::move(images), progress);
}

}  // namespace glidelab::diagnose
