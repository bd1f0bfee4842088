#include "diagnose/causes/scale_place.h"

#include <algorithm>
#include <cmath>

#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {
namespace {

/// Where the glider at x is seen through the lens and on the plane of the pattern.
double seen_at(const TrackModel& model, double x_m) {
  double seen_m = x_m;
  for (const SeenBy by : {SeenBy::lens, SeenBy::plane}) {
    for (std::size_t e = 0; e < effect_list().size(); ++e) {
      const EffectLaw& law = effect_list()[e].law;
      const double* const p = model.effects.of(e);
      if (law.seen_m != nullptr && law.seen_by == by && law.acts(p)) seen_m = law.seen_m(p, {}, x_m, 0.0, seen_m);
    }
  }
  return seen_m;
}

}  // namespace

ScaleFactor scale_along_path(const TrackModel& model) {
  constexpr int kPlaces = 101;
  constexpr int kRounds = 50;  // the scale differs by much less than a half, so that each takes at least a bit
  const double length_m = model.x_high_m - model.x_low_m;
  if (!(length_m > 0.0)) return {};
  const double step_m = 1e-4 * length_m;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const double seen_m = model.x_low_m + length_m * i / (kPlaces - 1.0);
    double x_m = seen_m;
    for (int round = 0; round < kRounds; ++round) x_m -= seen_at(model, x_m) - seen_m;
    const double scale = (seen_at(model, x_m + step_m) - seen_at(model, x_m - step_m)) / (2.0 * step_m);
    sum += scale - 1.0;
    squares += (scale - 1.0) * (scale - 1.0);
  }
  const double mean = sum / kPlaces;
  return {1.0 + mean, std::sqrt(std::max(0.0, squares / kPlaces - mean * mean))};
}

}  // namespace glidelab::diagnose
