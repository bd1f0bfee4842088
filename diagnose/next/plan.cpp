#include "diagnose/next/plan.h"

#include <algorithm>
#include <cmath>

#include "base/errors.h"
#include "diagnose/fit/fit_model.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/scan/effect_scan.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {
namespace {

struct Direction {
  ScoreColumn column;
  double square = 0.0;
};

/// Of the shapes that an effect may have, the one that these data would show best.
Direction best_direction(const ScoreSpace& space, std::size_t effect) {
  Direction best;
  for (const std::vector<double>& shape : effect_shapes(space.set(), effect)) {
    ScoreColumn column = space.of_effect(effect, shape);
    const double square = seen_square(space, column);
    if (!(square > best.square)) continue;
    best.square = square;
    best.column = std::move(column);
  }
  return best;
}

double size_for_reader(const EffectParameter& parameter, double member) {
  const double at = shown(parameter, member).value;
  const double null = shown(parameter, 0.0).value;
  return std::isfinite(null) ? at - null : at;  // n - 1 and s - 1; v_c has no null
}

}  // namespace

Plan plan_of(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups) {
  const TrackSet set = track_set(results, setups, true);
  if (set.motions.empty()) {
    throw base::InputError(base::Issue{"", 0, "clips", "no clip in which anything moves freely",
                                       "one or more clips of a glider that moves"});
  }
  Plan plan;
  plan.clips = set.clips.size();
  plan.notes = set.notes;
  for (const TrackedMotion& motion : set.motions) {
    plan.points += motion.t_s.size();
    plan.noise_m += motion.sd_m / static_cast<double>(set.motions.size());
  }
  const MotionFit nominal = fit_nominal(set);
  const ScoreSpace space(set, nominal);
  std::vector<Direction> directions;
  const auto& list = effect_list();
  for (std::size_t e = 0; e < list.size(); ++e) {
    if (list[e].search != Search::amplitude && list[e].search != Search::shape) continue;
    const EffectParameter& parameter = list[e].parameters[0];
    Direction direction = best_direction(space, e);
    PlannedEffect planned{
        std::string(list[e].id), std::string(list[e].words), std::string(parameter.key), 0.0, false, {}};
    if (direction.square > 0.0) {
      const double size = kVisible_sd / std::sqrt(direction.square);
      planned.seen = size <= range_of(set, parameter).high && prior_odds(set, e) > 0.0;
      planned.seen_from = std::abs(size_for_reader(parameter, size));
    }
    if (planned.seen) {
      plan.isolability.ids.push_back(planned.id);
      plan.isolability.least_seen.push_back(1.0 / std::sqrt(direction.square));
      directions.push_back(std::move(direction));
    }
    plan.effects.push_back(std::move(planned));
  }
  for (std::size_t a = 0; a < directions.size(); ++a) {
    std::vector<double> row;
    for (const Direction& other : directions) {
      const double cosine =
          space.dot(directions[a].column, other.column) / std::sqrt(directions[a].square * other.square);
      row.push_back(std::min(1.0, std::abs(cosine)));
    }
    for (PlannedEffect& planned : plan.effects) {
      if (planned.id != plan.isolability.ids[a]) continue;
      for (std::size_t b = 0; b < row.size(); ++b) {
        if (b != a && row[b] >= kAlike) planned.alike.push_back(plan.isolability.ids[b]);
      }
    }
    plan.isolability.cosine.push_back(std::move(row));
  }
  return plan;
}

}  // namespace glidelab::diagnose
