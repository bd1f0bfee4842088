#include "diagnose/scan/effect_scan.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "diagnose/fit/common_limits.h"
#include "diagnose/fit/effect_ranges.h"
#include "diagnose/scan/push_scan.h"
#include "diagnose/scan/wave_scan.h"

namespace glidelab::diagnose {
namespace {

constexpr double kDerivativeFloor = 1e-15;  // of the raw square: below, the derivatives' errors are all that is left

EffectScan scan_sizes(const ScoreSpace& space, std::size_t effect) {
  const EffectInfo& info = effect_list()[effect];
  EffectScan scan;
  scan.effect = effect;
  const double most = range_of(space.set(), info.parameters[0]).high;
  std::vector<double> logs;
  double best = -1.0;
  for (const std::vector<double>& shape : effect_shapes(space.set(), effect)) {
    ScoreColumn column = space.of_effect(effect, shape);
    const double square = seen_square(space, column);
    const double z_most = most * std::sqrt(square);
    if (z_most < kVisible_sd) {
      logs.push_back(0.0);  // says nothing
      continue;
    }
    scan.visible = true;
    const double score = space.dot(column, space.residual());
    const double z = score / std::sqrt(square);
    const double gain = z > 0.0 || info.both_signs ? 0.5 * z * z : 0.0;
    logs.push_back(log_amplitude_evidence(z, z_most, info.both_signs));
    scan.shapes.push_back({shape, std::move(column), square, score});
    if (gain <= best) continue;
    best = gain;
    scan.gain = gain;
    scan.least_seen = 1.0 / std::sqrt(square);
    const double size = gain > 0.0 ? score / square : 0.0;
    const double step = info.parameters[0].step;
    scan.values = {std::clamp(std::abs(size) < step ? step : size,
                              info.both_signs ? 0.9 * info.parameters[0].low : step, 0.9 * most)};
    scan.values.insert(scan.values.end(), shape.begin(), shape.end());
    scan.direction = scan.shapes.back().column;
  }
  scan.log_evidence = log_mean(logs);
  return scan;
}

}  // namespace

std::vector<std::vector<double>> effect_shapes(const TrackSet& set, std::size_t effect) {
  const EffectInfo& info = effect_list()[effect];
  if (info.search != Search::shape) return {{}};
  std::vector<std::vector<double>> shapes;
  const ParameterRange x = range_of_places(set);
  for (const double second : info.shapes({x.low, x.high, set.groups.size() > 1, set.held_m_s}))
    shapes.push_back({second});
  return shapes;
}

double seen_square(const ScoreSpace& space, const ScoreColumn& column) {
  const double square = space.dot(column, column);
  const bool derived = std::isfinite(square) && square >= kDerivativeFloor * column.rest.squaredNorm();
  return derived ? std::max(0.0, square) : 0.0;
}

EffectScan scan_effect(const ScoreSpace& space, std::size_t effect) {
  switch (effect_list()[effect].search) {
    case Search::wave:
      return scan_waves(space, effect, find_wave(space));
    case Search::pushes:
      return scan_pushes(space, effect);
    case Search::amplitude:
    case Search::shape:
    case Search::rows:
      return scan_sizes(space, effect);
    default: {
      EffectScan nothing;
      nothing.effect = effect;
      return nothing;
    }
  }
}

std::vector<EffectScan> scan_effects(const ScoreSpace& space, const std::set<std::size_t>& without, int jobs) {
  const auto& list = effect_list();
  std::vector<EffectScan> scans(list.size());
  std::vector<std::size_t> wanted;
  bool waves = false;
  for (std::size_t e = 0; e < list.size(); ++e) {
    scans[e].effect = e;
    if (without.contains(e)) continue;
    waves = waves || list[e].search == Search::wave;
    if (list[e].search != Search::wave) wanted.push_back(e);
  }
  Wave wave;  // the slowest of all, and both waves' start
  base::for_each_parallel(wanted.size() + 1, jobs, [&](std::size_t i) {
    if (i > 0) {
      scans[wanted[i - 1]] = scan_effect(space, wanted[i - 1]);
    } else if (waves) {
      wave = find_wave(space);
    }
  });
  for (std::size_t e = 0; e < list.size(); ++e) {
    if (!without.contains(e) && list[e].search == Search::wave) scans[e] = scan_waves(space, e, wave);
  }
  return scans;
}

}  // namespace glidelab::diagnose
