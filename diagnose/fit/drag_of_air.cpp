#include "diagnose/fit/drag_of_air.h"

#include <algorithm>

#include "diagnose/effects/effect_list.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kQuadratic = slot_of(ids::quadratic_drag).effect;

}  // namespace

bool holds_drag(const TrackSet& set, const std::vector<std::size_t>& effects) {
  return set.no_drag || (set.through_air && std::find(effects.begin(), effects.end(), kQuadratic) != effects.end());
}

bool takes_place_of_drag(const TrackSet& set, const std::vector<std::size_t>& effects, std::size_t effect) {
  return set.through_air && effect == kQuadratic && !holds_drag(set, effects);
}

TrackSet without_drag(TrackSet set) {
  set.no_drag = true;
  return set;
}

}  // namespace glidelab::diagnose
