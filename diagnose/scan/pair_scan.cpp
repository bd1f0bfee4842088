#include "diagnose/scan/pair_scan.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "diagnose/fit/effect_ranges.h"

namespace glidelab::diagnose {
namespace {

constexpr double kSameDirection = 1e-6;  // of sin²: one direction is the other, to what derivatives err

/// Sizes of two directions fitted together.
struct Together {
  double gain = 0.0;
  double first = 0.0, second = 0.0;        // sizes,
  double first_sd = 0.0, second_sd = 0.0;  // and how well they are known, the other one fitted
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

/// What a size that is averaged over its prior costs against the best one.
double price(double size, double sd, double most, bool both_signs) {
  const double z = std::abs(size) / sd;
  return 0.5 * z * z - log_amplitude_evidence(z, most / sd, both_signs);
}

/// Where a fit begins: well within the range.
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
  const ParameterRange range_a = range_of(space.set(), of_a.parameters[0]);
  const ParameterRange range_b = range_of(space.set(), of_b.parameters[0]);
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
