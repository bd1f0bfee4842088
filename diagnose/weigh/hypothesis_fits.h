/// The steps that every search among explanations is made of: scans are ranked, the best are fitted in full, and what
/// was fitted joins the comparison.
#pragma once

#include <functional>
#include <set>
#include <vector>

#include "diagnose/weigh/hypotheses.h"

namespace glidelab::diagnose {

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
Found fit_more(const TrackSet& set, const MotionFit& base, const EffectScan& scan, const Hypothesis& beside);

/// Joins those compared; of the same effects the likelier stays.
void add(Comparison& comparison, Found found);

/// Those that are worth a full fit, by falling evidence.
std::vector<const EffectScan*> best_of(const std::vector<EffectScan>& scans, std::size_t most);

/// Explanations of so many effects that were fitted, by falling evidence.
std::vector<Hypothesis> leaders_of(const Comparison& comparison, std::size_t size, std::size_t most);

/// Full fits of the best scans around a fit.
void fit_best(const TrackSet& set, const MotionFit& base, const std::vector<const EffectScan*>& best,
              const Hypothesis& beside, const Work& work, Comparison& comparison);

/// One explanation among those fitted; null: none.
const Hypothesis* find(const Comparison& comparison, const std::set<std::size_t>& effects);

}  // namespace glidelab::diagnose
