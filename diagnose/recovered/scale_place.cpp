#include "diagnose/recovered/scale_place.h"

#include <algorithm>
#include <cmath>

#include "diagnose/model/acting_laws.h"

namespace glidelab::diagnose {
namespace {

/// Where the glider at x is seen through the lens and on the plane of the pattern.
double seen_at(const ActingLaws& laws, double x_m) {
  double seen_m = x_m;
  for (const Acting& one : laws.seen.all()) {
    const bool differs_by_place = one.law->seen_by == SeenBy::lens || one.law->seen_by == SeenBy::plane;
    if (differs_by_place) seen_m = one.law->seen_m(one.p, {}, x_m, 0.0, seen_m);
  }
  return seen_m;
}

}  // namespace

ScaleFactor scale_along_path(const TrackModel& model) {
  constexpr int kPlaces = 101;
  constexpr int kRounds = 50;  // the scale differs by much less than a half, so that each takes at least a bit
  const double length_m = model.x_high_m - model.x_low_m;
  if (!(length_m > 0.0)) return {};
  const ActingLaws laws(model.effects, {});
  const double step_m = 1e-4 * length_m;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const double seen_m = model.x_low_m + length_m * i / (kPlaces - 1.0);
    double x_m = seen_m;
    for (int round = 0; round < kRounds; ++round) x_m -= seen_at(laws, x_m) - seen_m;
    const double scale = (seen_at(laws, x_m + step_m) - seen_at(laws, x_m - step_m)) / (2.0 * step_m);
    sum += scale - 1.0;
    squares += (scale - 1.0) * (scale - 1.0);
  }
  const double mean = sum / kPlaces;
  return {1.0 + mean, std::sqrt(std::max(0.0, squares / kPlaces - mean * mean))};
}

}  // namespace glidelab::diagnose
