/// Hypotheses that are compared, and the steps that every search among them is made of: scans are ranked, the best are
/// fitted in full, and what was fitted joins the comparison.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "diagnose/frames/frame_effects.h"
#include "diagnose/frames/missing_frames.h"
#include "diagnose/scan/effect_scan.h"
#include "diagnose/unnamed/unnamed_family.h"

namespace glidelab::diagnose {

struct Hypothesis {
  std::vector<std::size_t> effects;  ///< none, one or two, in the order found; more where pictures show them
  bool unnamed = false;              ///< and something unnamed as well
  double gain = 0.0;                 ///< log likelihood, against nothing
  double log_evidence = 0.0;         ///< against nothing, sizes averaged over their priors
  double probability = 0.0;
  int fit = -1;                       ///< index in Comparison::fits
  bool converged = true;              ///< false: its fit did not reach a minimum; its gain is then a lower bound
  double unnamed_log_evidence = 0.0;  ///< the part of it that something unnamed has, beside effects or alone
  std::optional<double> left = {};    ///< the part of the gap's excess that it leaves, where a remainder was weighed
};

struct Comparison {
  std::vector<MotionFit> fits;      ///< the nominal one first
  std::vector<Hypothesis> all;      ///< by falling probability
  std::vector<EffectScan> scans;    ///< around the nominal fit, as effect_list()
  std::vector<FrameEffect> frames;  ///< jitter, tails
  MissingFrames missing;
  std::vector<UnnamedFamily> unnamed;       ///< around nothing
  int left_fit = 0;                         ///< index of the best named explanation's fit
  std::vector<UnnamedFamily> unnamed_left;  ///< beside the named explanation with which they are likeliest
  int beside_fit = 0;                       ///< index of its fit
  std::set<std::size_t> in_pictures;        ///< effects that the pictures speak for or against
  double none = 0.0, unknown = 0.0;
  std::vector<double> effect_probability;  ///< of each of effect_list(), alone or with another
  /// Of each of effect_list(), the first one that these data cannot tell from it (alike_in()); empty: first_alike().
  std::vector<std::size_t> alike;
  std::vector<double> odds;  ///< of each of effect_list(), before the data (prior_odds()); empty: 1
};

/// How many fits run at a time, and a callback for the progress of the comparison; an exception from it ends the
/// comparison.
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
Found fit_more(const TrackSet& set, const MotionFit& base, const EffectScan& scan, const Hypothesis& beside);

/// Adds a hypothesis to those compared; of two with the same effects the likelier stays.
void add(Comparison& comparison, Found found);

/// Those that are worth a full fit, by falling evidence.
std::vector<const EffectScan*> best_of(const std::vector<EffectScan>& scans, std::size_t most);

/// Fitted explanations with this number of effects, by falling evidence.
std::vector<Hypothesis> leaders_of(const Comparison& comparison, std::size_t size, std::size_t most);

/// Full fits of the best scans around a fit.
void fit_best(const TrackSet& set, const MotionFit& base, const std::vector<const EffectScan*>& best,
              const Hypothesis& beside, const Work& work, Comparison& comparison);

/// `none`, `unknown` and the probability of each effect, by those of the hypotheses, which then stand by falling
/// probability.
void set_probabilities(Comparison& comparison);

/// Whether an effect is among a hypothesis' own.
bool has(const Hypothesis& hypothesis, std::size_t effect);

/// The probability that one of these effects acts: the sum over the explanations that have one of them and nothing
/// without a name.
double probability_of_any(const Comparison& comparison, const std::vector<std::size_t>& effects);

/// Log of the prior odds of a hypothesis' effects, against as many others.
double log_prior_odds(const Comparison& comparison, const Hypothesis& hypothesis);

/// One explanation among those fitted; null: none.
const Hypothesis* find(const Comparison& comparison, const std::set<std::size_t>& effects);

/// For each of effect_list(), the first effect that does the same to these motions, or itself. Besides those that no
/// experiment tells apart (first_alike()), two are alike whose directions differ by so little that the log likelihood
/// at the size that is seen differs by less than a half: masses that are wrong by a common factor and a force that is
/// recorded too small are one cause, and with one mass an inertia without weight is the same again on a level track.
/// `space` is the neighbourhood of the nominal fit.
std::vector<std::size_t> alike_in(const ScoreSpace& space, const std::vector<EffectScan>& scans);

/// Whether an effect is scatter of single positions or times (Search::noise), which makes no gap.
bool is_scatter(std::size_t effect);

/// Whether an explanation is nothing but such scatter.
bool is_scatter_alone(const Hypothesis& hypothesis);

/// The hypothesis that a verdict would name, or null: of those with the likeliest cause the likeliest. A cause may be
/// the likeliest by far and have its probability shared out among many second ones; a pair that has neither of the
/// likely causes is then no answer, even where no other pair is as likely (the median probability model of Barbieri and
/// Berger, Annals of Statistics 32, 870, 2004). Causes that no experiment of tracks tells apart
/// (first_alike()), or not these (`alike`), count together, so that several names for one cause are not beaten by a
/// less likely one with a single name. Scatter of single positions is a cause only by itself.
const Hypothesis* best_named(const TrackSet& set, const Comparison& comparison);

}  // namespace glidelab::diagnose
