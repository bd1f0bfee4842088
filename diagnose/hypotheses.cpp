#include "diagnose/hypotheses.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <utility>

#include "base/parallel.h"
#include "diagnose/joined_evidence.h"
#include "diagnose/pair_scan.h"

namespace glidelab::diagnose {
namespace {

constexpr double kPriorNone = 0.3, kPriorOne = 0.4, kPriorTwo = 0.1, kPriorUnnamed = 0.2;
constexpr std::size_t kFitted = 9;   // effects of the short list that are fitted in full
constexpr std::size_t kLeaders = 3;  // that are tried with a second one
constexpr std::size_t kSeconds = 4;
constexpr std::size_t kTogether = 4;   // pairs that show together and that no leader found
constexpr int kExchanges = 3;          // rounds in which the best pair's two lead in turn
constexpr double kWorthFitting = 1.0;  // log likelihood gained
constexpr double kTrifle = 6.0;        // log evidence
constexpr double kTriflePart = 0.01;   // of that of the effects

bool moves(std::size_t effect) {
  const Search search = effect_list()[effect].search;
  return search != Search::frames && search != Search::noise && search != Search::pictures;
}

/// How many at a time, and whom to tell how far it is: who may end it there, by an exception.
struct Work {
  int jobs = 1;
  const std::function<void(double)>& done;
  double part = 0.0;

  void look() const { done(part); }
  Work at(double now) const { return {jobs, done, now}; }
};

struct Found {
  Hypothesis hypothesis;
  MotionFit fit;
};

/// The full fit of one more effect, and its evidence.
Found fit_more(const TrackSet& set, const MotionFit& base, const EffectScan& scan, const Hypothesis& beside) {
  const FitPoint start = with_effect(set, base, scan.effect, scan.values, scan.own);
  std::vector<std::size_t> effects = base.effects;
  effects.push_back(scan.effect);
  Found found;
  found.fit = fit_motions(set, effects, start, base.late);
  const double gain = 0.5 * (base.cost - found.fit.cost);
  found.hypothesis.effects = beside.effects;  // missing frames are in the fit's times, not among its effects
  found.hypothesis.effects.push_back(scan.effect);
  found.hypothesis.gain = beside.gain + gain;
  found.hypothesis.log_evidence =
      beside.log_evidence + scan.log_evidence + (std::isfinite(gain) ? gain - scan.gain : -scan.gain);
  return found;
}

void add(Comparison& comparison, Found found) {
  std::set<std::size_t> members(found.hypothesis.effects.begin(), found.hypothesis.effects.end());
  for (Hypothesis& other : comparison.all) {
    if (other.unnamed || std::set<std::size_t>(other.effects.begin(), other.effects.end()) != members) continue;
    if (other.log_evidence >= found.hypothesis.log_evidence) return;
    found.hypothesis.fit = static_cast<int>(comparison.fits.size());
    comparison.fits.push_back(std::move(found.fit));
    other = found.hypothesis;
    return;
  }
  found.hypothesis.fit = static_cast<int>(comparison.fits.size());
  comparison.fits.push_back(std::move(found.fit));
  comparison.all.push_back(found.hypothesis);
}

std::vector<const EffectScan*> best_of(const std::vector<EffectScan>& scans, std::size_t most) {
  std::vector<const EffectScan*> best;
  for (const EffectScan& scan : scans) {
    if (scan.visible && scan.gain > kWorthFitting && !scan.values.empty()) best.push_back(&scan);
  }
  std::sort(best.begin(), best.end(), [](const auto* a, const auto* b) { return a->log_evidence > b->log_evidence; });
  if (best.size() > most) best.resize(most);
  return best;
}

/// Singles by falling evidence.
std::vector<Hypothesis> leaders_of(const Comparison& comparison, std::size_t size, std::size_t most) {
  std::vector<Hypothesis> leaders;
  for (const Hypothesis& hypothesis : comparison.all) {
    if (hypothesis.effects.size() == size && hypothesis.fit >= 0 && !hypothesis.unnamed) leaders.push_back(hypothesis);
  }
  std::sort(leaders.begin(), leaders.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.log_evidence > b.log_evidence; });
  if (leaders.size() > most) leaders.resize(most);
  return leaders;
}

/// Full fits of the best scans around a fit.
void fit_best(const TrackSet& set, const MotionFit& base, const std::vector<const EffectScan*>& best,
              const Hypothesis& beside, const Work& work, Comparison& comparison) {
  std::vector<Found> found(best.size());
  base::for_each_parallel(best.size(), work.jobs, [&](std::size_t i) {
    work.look();
    found[i] = fit_more(set, base, *best[i], beside);
  });
  for (Found& one : found) add(comparison, std::move(one));
}

/// One explanation among those fitted; null: none.
const Hypothesis* find(const Comparison& comparison, const std::set<std::size_t>& effects) {
  for (const Hypothesis& one : comparison.all) {
    if (one.unnamed || one.fit < 0 || one.effects.size() != effects.size()) continue;
    if (std::set<std::size_t>(one.effects.begin(), one.effects.end()) == effects) return &one;
  }
  return nullptr;
}

/// A leader with each of the effects that show best beside it.
void add_seconds(const TrackSet& set, const Hypothesis& leader, const std::set<std::size_t>& without, const Work& work,
                 Comparison& comparison) {
  const MotionFit base = comparison.fits[static_cast<std::size_t>(leader.fit)];
  const ScoreSpace space(set, base);
  std::set<std::size_t> others = without;
  others.insert(leader.effects.begin(), leader.effects.end());
  work.look();
  const std::vector<EffectScan> scans = scan_effects(space, others, work.jobs);
  std::vector<const EffectScan*> best = best_of(scans, kSeconds);
  std::erase_if(best, [](const EffectScan* scan) { return scan->log_evidence < -1.0; });
  fit_best(set, base, best, leader, work, comparison);
}

/// One effect's own full fit, made where there was none.
Found alone(const TrackSet& set, std::size_t effect, Comparison& comparison) {
  if (const Hypothesis* known = find(comparison, {effect}); known != nullptr) {
    return {*known, comparison.fits[static_cast<std::size_t>(known->fit)]};
  }
  Found found = fit_more(set, comparison.fits.front(), comparison.scans[effect], {});
  add(comparison, found);
  return found;
}

/// The full fit of a second effect that was scanned around some point of the first one's, and its evidence beside that
/// one's own fit.
Found fit_beside(const TrackSet& set, const MotionFit& around, const EffectScan& scan, const Found& leader) {
  const FitPoint start = with_effect(set, around, scan.effect, scan.values, scan.own);
  Found found;
  found.fit = fit_motions(set, {around.effects.front(), scan.effect}, start, leader.fit.late);
  const double gain = 0.5 * (leader.fit.cost - found.fit.cost);
  found.hypothesis.effects = found.fit.effects;
  found.hypothesis.gain = leader.hypothesis.gain + gain;
  found.hypothesis.log_evidence =
      leader.hypothesis.log_evidence + scan.log_evidence - scan.gain + (std::isfinite(gain) ? gain : 0.0);
  return found;
}

/// Two effects fitted at once, from where they are in the neighbourhood of the nominal fit.
void add_together(const TrackSet& set, const PairScan& pair, Comparison& comparison) {
  const auto shows = [&](std::size_t effect) { return comparison.scans[effect].log_evidence; };
  const bool in_order = shows(pair.first) >= shows(pair.second);
  const Found leader = alone(set, in_order ? pair.first : pair.second, comparison);
  EffectScan beside = scan_effect(ScoreSpace(set, leader.fit), in_order ? pair.second : pair.first);
  if (!beside.visible) return;
  beside.values = in_order ? pair.second_values : pair.first_values;
  MotionFit first = comparison.fits.front();
  first.at =
      with_effect(set, first, leader.hypothesis.effects.front(), in_order ? pair.first_values : pair.second_values, {});
  first.effects = leader.hypothesis.effects;
  add(comparison, fit_beside(set, first, beside, leader));
}

/// Where one of two is left as the two were fitted and the other is taken out: what is then missing shows as it is, and
/// not as the first one's own fit has made up for it.
MotionFit without_one(const TrackSet& set, const MotionFit& both, std::size_t kept) {
  const ParameterLayout layout(set, {kept});
  FitPoint at{Eigen::VectorXd(static_cast<Eigen::Index>(layout.globals().size())), {}};
  Eigen::Index to = 0;
  for (std::size_t g = 0; g < both.layout->globals().size(); ++g) {
    const ParameterLayout::Global& global = both.layout->globals()[g];
    if (global.kind == ParameterLayout::Global::Kind::effect && global.effect != kept) continue;
    at.global[to++] = both.at.global[static_cast<Eigen::Index>(g)];
  }
  const bool first = both.effects.front() == kept;
  const auto own = static_cast<Eigen::Index>(layout.own().size());
  for (const Eigen::VectorXd& motion : both.at.own) {
    Eigen::VectorXd of_one(2 + own);
    of_one << motion.head(2), (first ? motion.segment(2, own) : motion.tail(own));
    at.own.push_back(of_one);
  }
  return linearise_at(set, {kept}, at);
}

/// The same pair, its evidence that of its first one beside its second. What an effect costs by itself, where it has to
/// make up for the other, is not what it costs beside it.
Found turned(const TrackSet& set, const MotionFit& both, Comparison& comparison) {
  const Found leader = alone(set, both.effects.back(), comparison);
  const MotionFit around = without_one(set, both, both.effects.back());
  const EffectScan scan = scan_effect(ScoreSpace(set, around), both.effects.front());
  Found found;
  found.fit = both;
  const double gain = 0.5 * (leader.fit.cost - both.cost);
  found.hypothesis.effects = {both.effects.back(), both.effects.front()};
  found.hypothesis.gain = leader.hypothesis.gain + gain;
  found.hypothesis.log_evidence = leader.hypothesis.log_evidence + scan.log_evidence - scan.gain + gain;
  return found;
}

/// In place of one of the best pair's two, whatever shows best beside the other; the same with what is best then.
void exchange(const TrackSet& set, double best_one, const std::set<std::size_t>& without, const Work& work,
              Comparison& comparison) {
  for (int round = 0; round < kExchanges; ++round) {
    const std::vector<Hypothesis> pairs = leaders_of(comparison, 2, 1);
    if (pairs.empty() || pairs.front().log_evidence <= best_one) return;
    const Hypothesis best = pairs.front();
    const MotionFit both = comparison.fits[static_cast<std::size_t>(best.fit)];
    if (both.effects.size() < 2) return;  // missing frames are in the fit's times
    for (const std::size_t kept : both.effects) {
      const Found leader = alone(set, kept, comparison);
      const MotionFit base = without_one(set, both, kept);
      std::set<std::size_t> others = without;
      others.insert(both.effects.begin(), both.effects.end());
      work.look();
      const std::vector<EffectScan> scans = scan_effects(ScoreSpace(set, base), others, work.jobs);
      std::vector<const EffectScan*> seconds = best_of(scans, kSeconds);
      std::vector<Found> found(seconds.size());
      base::for_each_parallel(seconds.size(), work.jobs, [&](std::size_t i) {
        work.look();
        found[i] = fit_beside(set, base, *seconds[i], leader);
      });
      for (const Found& one : found) {
        add(comparison, one);
        if (one.hypothesis.gain > best.gain) add(comparison, turned(set, one.fit, comparison));
      }
    }
    if (leaders_of(comparison, 2, 1).front().effects == best.effects) return;
  }
}

/// Pairs by their leaders; those that show together only; and, the best pair's two leading in turn, whatever is better
/// beside one of them.
void add_pairs(const TrackSet& set, const ScoreSpace& nominal, const std::set<std::size_t>& without, const Work& work,
               Comparison& comparison) {
  double best_one = 0.0;
  for (const Hypothesis& leader : leaders_of(comparison, 1, kLeaders)) {
    if (leader.log_evidence < 0.0) continue;
    best_one = std::max(best_one, leader.log_evidence);
    add_seconds(set, leader, without, work, comparison);
  }
  std::size_t more = 0;
  for (const PairScan& pair : scan_pairs(nominal, comparison.scans)) {
    if (more == kTogether || pair.log_evidence <= best_one) break;
    if (find(comparison, {pair.first, pair.second}) != nullptr) continue;
    ++more;
    work.look();
    add_together(set, pair, comparison);
  }
  exchange(set, best_one, without, work.at(0.6), comparison);
}

void add_unnamed(const TrackSet& set, const Work& work, Comparison& comparison) {
  std::vector<Hypothesis> around = leaders_of(comparison, 1, 2);
  for (const Hypothesis& pair : leaders_of(comparison, 2, 2)) around.push_back(pair);
  std::sort(around.begin(), around.end(),
            [](const Hypothesis& a, const Hypothesis& b) { return a.log_evidence > b.log_evidence; });
  bool first = true;
  double likeliest = 0.0;
  for (const Hypothesis& named : around) {
    if (named.log_evidence < 3.0) continue;
    work.look();
    const ScoreSpace space(set, comparison.fits[static_cast<std::size_t>(named.fit)]);
    std::vector<UnnamedFamily> families = unnamed_families(space);
    Hypothesis both = named;
    both.unnamed = true;
    both.unnamed_log_evidence = log_unnamed_evidence(families);
    both.log_evidence += both.unnamed_log_evidence;
    for (const UnnamedFamily& family : families) both.gain = std::max(both.gain, named.gain + family.gain);
    comparison.all.push_back(both);
    if (comparison.unnamed_left.empty() || both.log_evidence > likeliest) {
      likeliest = both.log_evidence;
      comparison.unnamed_left = std::move(families);
      comparison.beside_fit = named.fit;
    }
    if (first) comparison.left_fit = named.fit;
    first = false;
  }
}

/// Single-frame effects join the hypotheses: alone, and with the best others.
void add_frame_effects(Comparison& comparison) {
  const std::vector<Hypothesis> so_far = comparison.all;
  for (const FrameEffect& frame : comparison.frames) {
    for (const Hypothesis& other : so_far) {
      if (other.effects.size() > 1 || (other.effects.size() == 1 && other.log_evidence < 3.0)) continue;
      if (std::find(other.effects.begin(), other.effects.end(), frame.effect) != other.effects.end()) continue;
      Hypothesis with = other;
      with.effects.push_back(frame.effect);
      with.gain += frame.gain;
      with.log_evidence += frame.log_evidence;
      comparison.all.push_back(with);
      if (with.unnamed || frame.in_runs <= 0.0) continue;
      // Errors that last over frames, or come with a clip's start, are in no list.
      with.effects = other.effects;
      with.unnamed = true;
      with.unnamed_log_evidence = frame.log_evidence + frame.in_runs;
      with.log_evidence += frame.in_runs;
      comparison.all.push_back(with);
    }
  }
}

/// Something unnamed that shows weakly beside effects of a hundred times its log evidence leaves them their name, in
/// filmed experiments: a lens, a sensor and a tracker leave some micrometres that no list holds, and the better an
/// effect shows, the better they show beside it. Their probability is that of the effects then. (A rest that shows well
/// is none of this: an effect takes up most of many a thing that is not in the list.)
void give_trifles_to_their_effects(Comparison& comparison) {
  for (Hypothesis& with : comparison.all) {
    if (!with.unnamed || with.effects.empty()) continue;
    const double of_effects = with.log_evidence - with.unnamed_log_evidence;
    if (with.unnamed_log_evidence >= std::min(kTrifle, kTriflePart * of_effects)) continue;
    const auto named = std::find_if(comparison.all.begin(), comparison.all.end(), [&](const Hypothesis& other) {
      return !other.unnamed && other.effects == with.effects;
    });
    if (named == comparison.all.end()) continue;
    named->probability += std::exchange(with.probability, 0.0);
  }
}

void weigh(const TrackSet& set, const std::set<std::size_t>& without, Comparison& comparison) {
  const auto& list = effect_list();
  double seen = 0.0;
  for (std::size_t e = 0; e < list.size(); ++e) {
    const bool tracked = list[e].search != Search::pictures && (!moves(e) || comparison.scans[e].visible);
    const bool shown = tracked || comparison.in_pictures.contains(e);
    const bool candidate = !without.contains(e) && shown;
    seen += candidate ? 1.0 : 0.0;
  }
  const double one = std::log(kPriorOne / std::max(1.0, seen));
  const double two = std::log(kPriorTwo / std::max(1.0, 0.5 * seen * (seen - 1.0)));
  std::vector<double> logs;
  for (const Hypothesis& hypothesis : comparison.all) {
    const std::size_t many = hypothesis.effects.size();
    double prior = many == 0   ? std::log(kPriorNone)
                   : many == 1 ? one
                               : two + static_cast<double>(many - 2) * (two - one);
    if (hypothesis.unnamed) prior += std::log(kPriorUnnamed / (1.0 - kPriorUnnamed));
    logs.push_back(prior + hypothesis.log_evidence);
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (double& l : logs) sum += l = std::exp(l - most);
  comparison.effect_probability.assign(list.size(), 0.0);
  for (std::size_t h = 0; h < logs.size(); ++h) comparison.all[h].probability = logs[h] / sum;
  if (set.pictures) give_trifles_to_their_effects(comparison);
  for (const Hypothesis& hypothesis : comparison.all) {
    if (hypothesis.unnamed) {
      comparison.unknown += hypothesis.probability;
    } else if (hypothesis.effects.empty()) {
      comparison.none += hypothesis.probability;
    } else {
      for (const std::size_t e : hypothesis.effects) comparison.effect_probability[e] += hypothesis.probability;
    }
  }
  std::stable_sort(comparison.all.begin(), comparison.all.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.probability > b.probability; });
}

}  // namespace

Comparison compare_hypotheses(const TrackSet& set, const std::vector<std::size_t>& without, int jobs,
                              const PictureEvidence* pictures, const std::function<void(double)>& done) {
  const Work work{jobs, done};
  const std::set<std::size_t> left_out(without.begin(), without.end());
  Comparison comparison;
  comparison.fits.push_back(fit_nominal(set));
  comparison.all.push_back({{}, false, 0.0, 0.0, 0.0, 0});
  const MotionFit nominal = comparison.fits.front();
  const ScoreSpace space(set, nominal);
  work.look();
  comparison.scans = scan_effects(space, left_out, jobs);
  work.at(0.1).look();
  comparison.unnamed = unnamed_families(space);
  Hypothesis unnamed;
  unnamed.unnamed = true;
  unnamed.unnamed_log_evidence = log_unnamed_evidence(comparison.unnamed);
  unnamed.log_evidence = unnamed.unnamed_log_evidence;
  for (const UnnamedFamily& family : comparison.unnamed) unnamed.gain = std::max(unnamed.gain, family.gain);
  comparison.all.push_back(unnamed);

  const Hypothesis nothing = comparison.all.front();
  fit_best(set, nominal, best_of(comparison.scans, kFitted), nothing, work.at(0.2), comparison);
  for (const EffectScan& scan : comparison.scans) {
    const bool fitted = std::any_of(comparison.all.begin(), comparison.all.end(), [&](const Hypothesis& h) {
      return h.effects == std::vector<std::size_t>{scan.effect};
    });
    if (scan.visible && !fitted)
      comparison.all.push_back({{scan.effect}, false, scan.gain, scan.log_evidence, 0.0, -1});
  }
  if (const auto dropped = effect_index("dropped_frames"); !left_out.contains(dropped)) {
    work.at(0.4).look();
    comparison.missing = find_missing_frames(set, nominal);
    if (comparison.missing.count > 0) {
      Found found;
      found.fit = comparison.missing.fit;
      found.hypothesis.effects = {dropped};
      found.hypothesis.gain = comparison.missing.effect.gain;
      found.hypothesis.log_evidence = comparison.missing.effect.log_evidence;
      add(comparison, std::move(found));
    } else {
      comparison.all.push_back({{dropped}, false, 0.0, -3.0, 0.0, -1});
    }
  }
  add_pairs(set, space, left_out, work.at(0.5), comparison);
  add_unnamed(set, work.at(0.8), comparison);
  const MotionFit& best = comparison.fits[static_cast<std::size_t>(comparison.left_fit)];
  for (const FrameEffect& frame : {scan_jitter(set, best), scan_tails(set, best)}) {
    if (!left_out.contains(frame.effect)) comparison.frames.push_back(frame);
  }
  add_frame_effects(comparison);
  if (pictures != nullptr) join_pictures(set, *pictures, left_out, comparison);
  weigh(set, left_out, comparison);
  return comparison;
}

}  // namespace glidelab::diagnose
