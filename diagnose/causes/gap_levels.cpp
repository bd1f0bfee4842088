#include "diagnose/causes/gap_levels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "base/long_work.h"
#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/gap/gap_sizes.h"

namespace glidelab::diagnose {
namespace {

struct Squares {
  double sum = 0.0, freedom = 0.0;
  void add(const Squares& of) {
    sum += of.sum;
    freedom += of.freedom;
  }
  double gap() const { return std::sqrt(std::max(0.0, sum) / freedom); }
};

/// chi² of a fit and its degrees of freedom: positions less the starts of motions, K, mu and the inclinations of its
/// motions.
Squares left_by(const TrackSet& set, const MotionFit& fit) {
  Squares left;
  std::map<std::size_t, bool> groups;
  for (std::size_t i = 0; i < fit.motions.size(); ++i) {
    const ProjectedMotion motion = project(fit.motions[i]);
    left.sum += motion.residual.squaredNorm();
    left.freedom += motion.freedom;
    groups[set.motions[i].group] = true;
  }
  left.freedom -= 2.0 + static_cast<double>(groups.size());
  return left;
}

/// The motions with these indices, with everything that is stated.
TrackSet part_of(const TrackSet& set, const std::vector<std::size_t>& motions) {
  TrackSet part = set;
  part.motions.clear();
  for (const std::size_t i : motions) part.motions.push_back(set.motions[i]);
  return part;
}

std::optional<double> gap_of_parts(const TrackSet& set, const MotionFit& nominal,
                                   const std::vector<std::vector<std::size_t>>& parts, int jobs) {
  if (parts.size() < 2) return {};
  std::vector<Squares> squares(parts.size());
  base::for_each_parallel(parts.size(), jobs, [&](std::size_t k) {
    const TrackSet part = part_of(set, parts[k]);
    FitPoint start{nominal.at.global, {}};
    Lateness late;
    for (const std::size_t i : parts[k]) {
      start.own.push_back(nominal.at.own[i]);
      if (!nominal.late.empty()) late.push_back(nominal.late[i]);
    }
    squares[k] = left_by(part, fit_motions(part, {}, start, late));
  });
  Squares all;
  for (const Squares& one : squares) {
    if (one.freedom > 0.0 && std::isfinite(one.sum)) all.add(one);
  }
  if (!(all.freedom > 0.0)) return {};
  return all.gap();
}

template <class Key>
std::vector<std::vector<std::size_t>> parts_by(const TrackSet& set, const Key& key) {
  std::map<decltype(key(set.motions.front())), std::vector<std::size_t>> by;
  for (std::size_t i = 0; i < set.motions.size(); ++i) by[key(set.motions[i])].push_back(i);
  std::vector<std::vector<std::size_t>> parts;
  for (auto& [of, motions] : by) parts.push_back(std::move(motions));
  return parts;
}

}  // namespace

GapLevels levels_of(const TrackSet& set, const MotionFit& nominal, int jobs) {
  GapLevels levels;
  const Squares all = left_by(set, nominal);
  if (!(all.freedom > 0.0)) return levels;
  levels.all = all.gap();
  levels.configuration = gap_of_parts(
      set, nominal, parts_by(set, [](const TrackedMotion& m) { return std::pair(m.mass, m.group); }), jobs);
  levels.clip = gap_of_parts(set, nominal, parts_by(set, [](const TrackedMotion& m) { return m.clip; }), jobs);
  const double error = std::sqrt(1.82 / all.freedom);  // standard error of a gap at the floor (held_out.cpp)
  if (levels.configuration && levels.all > 1.0 + kClearGap * error) {
    levels.holds_within = holds_within(*levels.configuration, levels.all);
  }
  return levels;
}

}  // namespace glidelab::diagnose
