/// The hypotheses that are compared, and the steps that every search among them consists of: scans are ranked, the best
/// are fitted in full, and the fits join the comparison.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "diagnose/scan/effect_scan.h"
#include "diagnose/single_frames/frame_effects.h"
#include "diagnose/single_frames/missing_frames.h"
#include "diagnose/unnamed/unnamed_family.h"

namespace glidelab::diagnose {

struct Hypothesis {
  std::vector<std::size_t> effects;  ///< none, one or two, in the order found; more if images show them
  bool unnamed = false;              ///< whether something unnamed acts as well
  double gain = 0.0;                 ///< log likelihood relative to the hypothesis of nothing
  double log_evidence = 0.0;         ///< relative to nothing, sizes averaged over their priors
  double probability = 0.0;
  int fit = -1;                       ///< index in Comparison::fits
  bool converged = true;              ///< false: its fit did not reach a minimum; its gain is then a lower bound
  double unnamed_log_evidence = 0.0;  ///< the part of it due to something unnamed, beside effects or alone
  double of_images = 0.0;             ///< the part of it that the images add (joined_evidence.h)
  std::optional<double> left = {};    ///< the part of the gap's excess that it leaves, if a remainder was weighed
};

struct Comparison {
  std::vector<MotionFit> fits;      ///< the nominal one is first
  std::vector<Hypothesis> all;      ///< by decreasing probability
  std::vector<EffectScan> scans;    ///< around the nominal fit, in the order of effect_list()
  std::vector<FrameEffect> frames;  ///< jitter, tails
  MissingFrames missing;
  std::vector<UnnamedFamily> unnamed;       ///< around the nominal fit
  int left_fit = 0;                         ///< index of the best named explanation's fit
  std::vector<UnnamedFamily> unnamed_left;  ///< beside the named explanation that makes them likeliest
  int beside_fit = 0;                       ///< index of that explanation's fit
  std::set<std::size_t> in_images;          ///< effects that the images support or contradict
  double none = 0.0, unknown = 0.0;
  std::vector<double> effect_probability;  ///< of each of effect_list(), alone or with another
  /// For each of effect_list(), the first effect that these data cannot tell from it (alike_in()); empty:
  /// first_alike().
  std::vector<std::size_t> alike;
  std::vector<double> odds;      ///< of each of effect_list(), before the data (prior_odds()); empty: 1
  std::vector<double> fit_odds;  ///< of each of `fits`, log (fit_odds.h); empty: 0
  /// Effects that alone bring stated inclinations and the motion together (gain_in_stated()) and leave the gap as it
  /// is. They are known by the statements, and are not measured by what they take of the gap.
  std::set<std::size_t> by_stated;
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

/// What averaging the sizes of a spread over their prior costs at a fit that has them, as a log likelihood; never above
/// 0, and 0 for other effects. Around a fit without it a spread of friction can cost next to nothing, because it shows
/// nothing there: its derivatives are in proportion to mu.
double price_of_spread(const MotionFit& fit, std::size_t effect);

/// The log evidence of one more effect than the fit `base` has, from the full fit with it: the gain in log likelihood
/// less what the scan around `base` charges for the sizes, or, if that is more, price_of_spread(). A quadratic drag
/// that takes the place of K is not charged for its size, as K is not.
double log_evidence_beyond(const TrackSet& set, const MotionFit& base, const EffectScan& scan, const MotionFit& fit);

/// The full fit of one more effect, and its evidence.
Found fit_more(const TrackSet& set, const MotionFit& base, const EffectScan& scan, const Hypothesis& beside);

/// Adds a hypothesis to the comparison; of two with the same effects the likelier one stays.
void add(Comparison& comparison, Found found);

/// The scans that are worth a full fit, by decreasing evidence.
std::vector<const EffectScan*> best_of(const std::vector<EffectScan>& scans, std::size_t most);

/// Fitted explanations with this number of effects, by decreasing evidence.
std::vector<Hypothesis> leaders_of(const Comparison& comparison, std::size_t size, std::size_t most);

/// Full fits of the best scans around a fit.
void fit_best(const TrackSet& set, const MotionFit& base, const std::vector<const EffectScan*>& best,
              const Hypothesis& beside, const Work& work, Comparison& comparison);

/// Sets `none`, `unknown` and the probability of each effect from those of the hypotheses, and sorts these by
/// decreasing probability.
void set_probabilities(Comparison& comparison);

/// Whether any effect of a hypothesis contributes to the gap. Effects in `except` do not count, such as those that are
/// known by stated inclinations (Comparison::by_stated).
bool shows_in_gap(const Hypothesis& hypothesis, const std::set<std::size_t>& except = {});

/// Whether an effect is among a hypothesis' own.
bool has(const Hypothesis& hypothesis, std::size_t effect);

/// The probability that one of these effects acts: the sum over the explanations that have one of them and nothing
/// without a name.
double probability_of_any(const Comparison& comparison, const std::vector<std::size_t>& effects);

/// Log of the prior odds of a hypothesis' effects, against as many others, and of the sizes in its fit (fit_odds.h).
double log_prior_odds(const Comparison& comparison, const Hypothesis& hypothesis);

/// Whether a quadratic drag and the inertia of air that moves along are among these effects. In a fall through air both
/// come from the same air, so they are one cause rather than two that coincide, with a third of the odds of the drag
/// alone (fit_odds.h), and always weighed.
bool is_drag_with_its_air(const std::vector<std::size_t>& effects);

/// The fitted explanation by exactly these effects; null: none.
const Hypothesis* find(const Comparison& comparison, const std::set<std::size_t>& effects);

/// For each of effect_list(), the first effect that does the same to these motions, or itself. Besides effects that no
/// experiment can tell apart (first_alike()), two are alike if their directions differ by so little that the log
/// likelihood at the observed size differs by less than a half. For example, masses that are wrong by a common factor
/// and a recorded force that is too small are one cause; with one mass on a level track, an inertia without weight is
/// the same again. `space` is the neighbourhood of the nominal fit.
std::vector<std::size_t> alike_in(const ScoreSpace& space, const std::vector<EffectScan>& scans);

/// Whether the data cannot tell two effects apart, by `alike` or first_alike().
bool are_alike(const Comparison& comparison, std::size_t one, std::size_t other, bool filmed);

/// Whether an effect is scatter of single positions or times (Search::noise), which causes no gap.
bool is_scatter(std::size_t effect);

/// Whether an explanation consists only of such scatter.
bool is_scatter_alone(const Hypothesis& hypothesis);

/// The hypothesis that a verdict would name, or null: the likeliest of those that contain the likeliest cause, and what
/// acts beside it in more than half of them. A cause may be by far the likeliest and have its probability shared among
/// many second ones. A pair that contains none of the likely causes is then no answer, even if no other pair is as
/// likely (the median probability model of Barbieri and Berger, Annals of Statistics 32, 870, 2004). Causes that no
/// experiment with tracks (first_alike()), or not this one (`alike`), can tell apart count together, so that several
/// names for one cause are not beaten by a less likely cause with a single name. Scatter of single positions is a cause
/// only by itself.
const Hypothesis* best_named(const TrackSet& set, const Comparison& comparison);

inline constexpr double kLikelierThanNot = 0.5;  ///< the probability from which a cause is rather there than not

}  // namespace glidelab::diagnose
