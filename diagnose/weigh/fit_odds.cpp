#include "diagnose/weigh/fit_odds.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "diagnose/effects/effect_library.h"
#include "diagnose/scan/effect_scan.h"
#include "diagnose/weigh/air_odds.h"

namespace glidelab::diagnose {
namespace {

constexpr double kAtEnd = 1e-3;
constexpr double kMovesAirAlong = 1.0 / 6.0;  // relative to the drag alone: with the odds of both effects, a third

/// Whether a place is further from all places at which its effect is looked for, the middles of equal parts of a range,
/// than these are from each other.
bool is_off_search(const TrackSet& set, std::size_t effect, double place_m) {
  const std::vector<std::vector<double>> shapes = effect_shapes(set, effect);
  double nearest = std::numeric_limits<double>::infinity(), part = nearest;
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    nearest = std::min(nearest, std::abs(shapes[k].front() - place_m));
    if (k > 0) part = std::min(part, shapes[k].front() - shapes[k - 1].front());
  }
  return nearest > part;
}

}  // namespace

double log_odds_of_sizes(const MotionFit& fit) {
  if (!fit.layout) return 0.0;
  double log = 0.0;
  const auto& globals = fit.layout->globals();
  for (std::size_t g = 0; g < globals.size(); ++g) {
    const EffectParameter* parameter = globals[g].parameter;
    if (parameter == nullptr || !(parameter->usual > 0.0)) continue;
    const ParameterRange& range = globals[g].range;
    const bool is_place = parameter->reach == Reach::places;
    const double middle = is_place ? 0.5 * (range.low + range.high) : parameter->absent;
    const double usual = parameter->usual * (is_place ? range.high - range.low : 1.0);
    log -= std::log1p(std::pow((fit.at.global[static_cast<Eigen::Index>(g)] - middle) / usual, 2));
  }
  return log;
}

std::vector<std::size_t> effects_at_end(const MotionFit& fit) {
  std::vector<std::size_t> found;
  if (!fit.layout) return found;
  const auto& globals = fit.layout->globals();
  for (std::size_t g = 0; g < globals.size(); ++g) {
    const EffectParameter* parameter = globals[g].parameter;
    if (parameter == nullptr || parameter->each != Each::experiment) continue;
    const EffectInfo& info = effect_list()[globals[g].effect];
    const bool is_size = parameter->slot.parameter == info.law.size;
    const bool is_touch = parameter->reach == Reach::places && info.touch == Touch::in_one_place;
    if (info.search == Search::spread || parameter->open_ended || !(is_size || is_touch)) continue;
    if (is_at_end(globals[g].range, fit.at.global[static_cast<Eigen::Index>(g)], parameter->absent)) {
      found.push_back(globals[g].effect);
    }
  }
  return found;
}

std::vector<std::size_t> effects_off_search(const TrackSet& set, const MotionFit& fit) {
  std::vector<std::size_t> found;
  if (!fit.layout) return found;
  const auto& globals = fit.layout->globals();
  for (std::size_t g = 0; g < globals.size(); ++g) {
    const EffectParameter* parameter = globals[g].parameter;
    if (parameter == nullptr || parameter->reach != Reach::places) continue;
    if (effect_list()[globals[g].effect].search != Search::shape) continue;
    if (is_off_search(set, globals[g].effect, fit.at.global[static_cast<Eigen::Index>(g)])) {
      found.push_back(globals[g].effect);
    }
  }
  return found;
}

void set_fit_odds(const TrackSet& set, Comparison& comparison) {
  comparison.fit_odds.clear();
  for (const MotionFit& fit : comparison.fits) {
    const std::size_t beyond = effects_at_end(fit).size() + effects_off_search(set, fit).size();
    double log = log_odds_of_sizes(fit) + std::log(kAtEnd) * static_cast<double>(beyond);
    if (set.through_air) {
      log += log_odds_without_air(set, fit) + (is_drag_with_its_air(fit.effects) ? std::log(kMovesAirAlong) : 0.0);
    }
    comparison.fit_odds.push_back(log);
  }
}

}  // namespace glidelab::diagnose
