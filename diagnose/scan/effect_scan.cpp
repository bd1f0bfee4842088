#include "diagnose/scan/effect_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/long_work.h"
#include "base/math/log_sum.h"
#include "diagnose/fit/fit_model.h"
#include "diagnose/scan/timed_scan.h"

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kFewestScattered = 3;  // clips that can show a spread
constexpr double kDerivativeFloor = 1e-15;   // of the raw square: less is only the error of the derivatives

EffectScan scan_sizes(const ScoreSpace& space, std::size_t effect) {
  const EffectInfo& info = effect_list()[effect];
  EffectScan scan;
  scan.effect = effect;
  const double most = range_of(space.set(), info.parameters[0], space.fit().effects).high;
  std::vector<double> logs;
  double best = -1.0;
  for (const std::vector<double>& shape : effect_shapes(space.set(), effect)) {
    ScoreColumn column = space.of_effect(effect, shape);
    const double square = seen_square(space, column);
    const double z_most = most * std::sqrt(square);
    if (z_most < kVisible_sd) {
      logs.push_back(0.0);  // the data say nothing
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
  scan.log_evidence = base::log_mean(logs);
  return scan;
}

/// Whether these data can show that sizes of one kind differ.
bool can_spread(const TrackSet& set, const EffectInfo& info) {
  std::map<Configuration, std::set<std::size_t>> clips;  // of each configuration
  for (const TrackedMotion& motion : set.motions) clips[{motion.group, motion.mass}].insert(motion.clip);
  switch (info.parameters.front().each) {
    case Each::configuration:
      return clips.size() > 1;
    case Each::clip:  // at least two of one configuration, and enough in all for a spread
      return set.clips.size() >= kFewestScattered &&
             std::any_of(clips.begin(), clips.end(), [](const auto& of_one) { return of_one.second.size() > 1; });
    default:
      return true;
  }
}

EffectScan scan_spread(const ScoreSpace& space, std::size_t effect) {
  EffectScan scan;
  scan.effect = effect;
  if (!can_spread(space.set(), effect_list()[effect])) return scan;
  const ParameterLayout layout(space.set(), {effect});
  std::vector<ScoreColumn> columns;
  std::vector<const ParameterLayout::Global*> of;
  for (const ParameterLayout::Global& global : layout.globals()) {
    if (global.kind != ParameterLayout::Global::Kind::effect) continue;
    columns.push_back(space.of_parameter(global));
    of.push_back(&global);
  }
  SpreadSeen seen = space.seen(columns);
  // Sizes in units of their prior's standard deviation, so that those of different kinds are comparable.
  Eigen::VectorXd unit(std::ssize(of));
  double most = 0.0;
  for (Eigen::Index g = 0; g < unit.size(); ++g) {
    const auto i = static_cast<std::size_t>(g);
    unit[g] = of[i]->parameter->held_sd;
    most = std::max(most, unit[g] * std::sqrt(seen_square(space, columns[i])));
  }
  if (!(most >= kVisible_sd) || !seen.products.allFinite() || !seen.scores.allFinite()) return scan;
  const SpreadEvidence evidence =
      log_spread_evidence(unit.asDiagonal() * seen.products * unit.asDiagonal(), unit.cwiseProduct(seen.scores));
  if (evidence.mean.size() == 0) return scan;
  scan.visible = true;
  scan.gain = evidence.free_gain;
  scan.log_evidence = evidence.log_evidence;
  for (Eigen::Index g = 0; g < unit.size(); ++g) {
    const auto& range = of[static_cast<std::size_t>(g)]->range;
    scan.values.push_back(std::clamp(unit[g] * evidence.mean[g], 0.9 * range.low, 0.9 * range.high));
  }
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

namespace {

/// The largest normal force over the smallest. In a fall without one, mu is no parameter that another friction could be
/// a part of.
double ratio_of_loads(const TrackSet& set) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  if (only_falls(set)) return least;
  for (const TrackedMotion& motion : set.motions) {
    const double load_kg = set.masses[motion.mass].mass_kg * std::abs(std::cos(set.groups[motion.group].stated_rad));
    least = std::min(least, load_kg);
    most = std::max(most, load_kg);
  }
  return most / least;
}

}  // namespace

double prior_odds(const TrackSet& set, std::size_t effect) {
  const auto odds = effect_list()[effect].odds;
  return odds == nullptr ? 1.0
                         : odds({.clips = set.clips.size(),
                                 .only_falls = only_falls(set),
                                 .through_air = set.through_air,
                                 .loads = ratio_of_loads(set)});
}

namespace {

/// Whether these are enough positions to show one more effect than the fit has: each effect needs as many to spare.
bool are_enough(const ScoreSpace& space, std::size_t effect) {
  std::size_t positions = 0;
  for (const TrackedMotion& motion : space.set().motions) positions += motion.t_s.size();
  std::vector<std::size_t> effects = space.fit().effects;
  effects.push_back(effect);
  return positions >= free_parameters(space.set(), effects) + kFewestSpare * effects.size();
}

}  // namespace

EffectScan scan_effect(const ScoreSpace& space, std::size_t effect) {
  if (!(prior_odds(space.set(), effect) > 0.0) || !are_enough(space, effect)) {
    EffectScan nothing;
    nothing.effect = effect;
    return nothing;
  }
  switch (effect_list()[effect].search) {
    case Search::wave:
      return scan_waves(space, effect, find_wave(space));
    case Search::pushes:
      return scan_pushes(space, effect);
    case Search::spread:
      return scan_spread(space, effect);
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
  Wave wave;  // the slowest search, shared by both effects that are waves
  base::for_each_parallel(wanted.size() + 1, jobs, [&](std::size_t i) {
    if (i > 0) {
      scans[wanted[i - 1]] = scan_effect(space, wanted[i - 1]);
    } else if (waves) {
      wave = find_wave(space);
    }
  });
  for (std::size_t e = 0; e < list.size(); ++e) {
    const bool is_wave = !without.contains(e) && list[e].search == Search::wave;
    if (is_wave && are_enough(space, e)) scans[e] = scan_waves(space, e, wave);
  }
  return scans;
}

namespace {

constexpr double kSameDirection = 1e-6;  // of sin²: the two directions agree to within the errors of the derivatives

/// The sizes of two directions that are fitted together.
struct Together {
  double gain = 0.0;
  double first = 0.0, second = 0.0;        // sizes,
  double first_sd = 0.0, second_sd = 0.0;  // and their standard deviations with the other one fitted
};

std::optional<Together> fit_together(const TriedShape& a, const TriedShape& b, double ab) {
  const double det = a.square * b.square - ab * ab;
  if (!(det > kSameDirection * a.square * b.square)) return std::nullopt;
  Together both;
  both.first = (b.square * a.score - ab * b.score) / det;
  both.second = (a.square * b.score - ab * a.score) / det;
  both.gain = 0.5 * (both.first * a.score + both.second * b.score);
  both.first_sd = std::sqrt(b.square / det);
  both.second_sd = std::sqrt(a.square / det);
  return both;
}

bool allowed(double size, const EffectInfo& info) {
  return size > 0.0 || info.both_signs;
}

/// The log likelihood that averaging a size over its prior costs, compared with its best value.
double price(double size, double sd, double most, bool both_signs) {
  const double z = std::abs(size) / sd;
  return 0.5 * z * z - log_amplitude_evidence(z, most / sd, both_signs);
}

/// A size from which a fit can start: well within its range.
double start_of(double size, const ParameterRange& range, const EffectInfo& info) {
  return std::clamp(size, info.both_signs ? 0.9 * range.low : info.parameters[0].step, 0.9 * range.high);
}

std::optional<PairScan> scan_pair(const ScoreSpace& space, const EffectScan& a, const EffectScan& b) {
  const EffectInfo &of_a = effect_list()[a.effect], &of_b = effect_list()[b.effect];
  const TriedShape *shape_a = nullptr, *shape_b = nullptr;
  Together best;
  for (const TriedShape& one : a.shapes) {
    for (const TriedShape& other : b.shapes) {
      const std::optional<Together> both = fit_together(one, other, space.dot(one.column, other.column));
      if (!both || both->gain <= best.gain || !allowed(both->first, of_a) || !allowed(both->second, of_b)) continue;
      best = *both;
      shape_a = &one;
      shape_b = &other;
    }
  }
  if (shape_a == nullptr) return std::nullopt;
  const ParameterRange range_a = range_of(space.set(), of_a.parameters[0], {b.effect});
  const ParameterRange range_b = range_of(space.set(), of_b.parameters[0], {a.effect});
  PairScan scan{a.effect, b.effect, best.gain, best.gain, {}, {}};
  scan.log_evidence -= price(best.first, best.first_sd, range_a.high, of_a.both_signs);
  scan.log_evidence -= price(best.second, best.second_sd, range_b.high, of_b.both_signs);
  scan.log_evidence -= std::log(static_cast<double>(a.shapes.size() * b.shapes.size()));
  scan.first_values = {start_of(best.first, range_a, of_a)};
  scan.first_values.insert(scan.first_values.end(), shape_a->values.begin(), shape_a->values.end());
  scan.second_values = {start_of(best.second, range_b, of_b)};
  scan.second_values.insert(scan.second_values.end(), shape_b->values.begin(), shape_b->values.end());
  return scan;
}

}  // namespace

std::vector<PairScan> scan_pairs(const ScoreSpace& space, const std::vector<EffectScan>& scans) {
  std::vector<PairScan> pairs;
  for (const EffectScan& a : scans) {
    for (const EffectScan& b : scans) {
      if (a.effect >= b.effect) continue;
      if (std::optional<PairScan> pair = scan_pair(space, a, b)) pairs.push_back(std::move(*pair));
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const PairScan& x, const PairScan& y) { return x.log_evidence > y.log_evidence; });
  return pairs;
}

}  // namespace glidelab::diagnose
