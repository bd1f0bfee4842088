#include "core/math/false_positions.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kFewestSteps = 8;    // that show the speed of the motion
constexpr std::size_t kNearestOfJump = 6;  // steps, or positions, on one side of a jump
constexpr double kTypicalOfSteps = 0.9;    // quantile of the speeds of all steps
constexpr double kJumpOverSpeed = 4.0;     // times the speed: a launch or a stop within one step has 1

constexpr std::size_t kFewestEqual = 4;

constexpr double kJumpAtEnd = 12.0;       // times the speed: eight lost frames have 9
constexpr std::size_t kFewestAstray = 3;  // fewer are outliers
constexpr std::size_t kPartWithin = 10;   // one in so many positions may lie in a run,
constexpr std::size_t kPartAtEnd = 20;    // and in one at an end
constexpr double kMeets = 0.25;           // of the smaller jump
constexpr double kNoBody_m_s2 = 200.0;    // 20 g: no hand takes a body that far within a step
constexpr double kOverTurn = 20.0;        // times a usual acceleration: noise has seven times the median once in 10^5
constexpr std::size_t kFewestTurns = 6;   // two outliers make as many, if they lie side by side
constexpr std::size_t kFurthestTurn = 4;  // positions from one to the next
constexpr double kPartOfRange = 0.5;      // of the widest stretch: two such are two motions

/// Equal neighbouring values, [from, to).
struct EqualRun {
  std::size_t from = 0, to = 0;
  double value = 0.0;
  std::size_t size() const { return to - from; }
};

std::vector<EqualRun> equal_runs(std::span<const double> x) {
  std::vector<EqualRun> runs;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (runs.empty() || runs.back().value != x[i]) runs.push_back({i, i, x[i]});
    runs.back().to = i + 1;
  }
  return runs;
}

std::set<double> values_of_long(const std::vector<EqualRun>& runs) {
  std::set<double> values;
  for (const EqualRun& run : runs) {
    if (run.size() >= kFewestEqual) values.insert(run.value);
  }
  return values;
}

/// The speeds of all steps, and which of them touch no value that some long run has: where it may mean that nothing is
/// seen, single ones do so as well.
class Steps {
 public:
  Steps(std::span<const double> t_s, std::span<const double> x, const std::vector<EqualRun>& runs)
      : speed_(x.size() > 0 ? x.size() - 1 : 0), counts_(speed_.size(), true) {
    for (std::size_t i = 0; i < speed_.size(); ++i) speed_[i] = std::abs(x[i + 1] - x[i]) / (t_s[i + 1] - t_s[i]);
    const std::set<double> of_long_runs = values_of_long(runs);
    for (const EqualRun& run : runs) {
      if (!of_long_runs.contains(run.value)) continue;
      const std::size_t from = run.from > 0 ? run.from - 1 : 0, to = std::min(run.to, speed_.size());
      std::fill(counts_.begin() + static_cast<std::ptrdiff_t>(from), counts_.begin() + static_cast<std::ptrdiff_t>(to),
                false);
    }
    std::vector<double> own;
    for (std::size_t i = 0; i < speed_.size(); ++i) {
      if (counts_[i]) own.push_back(speed_[i]);
    }
    enough_ = own.size() >= kFewestSteps;
    typical_ = quantile(own, kTypicalOfSteps);
  }

  bool enough() const { return enough_; }

  /// Whether step `i` is a jump, where the motion is on this side of it (-1 before, 1 after).
  bool is_jump(std::size_t i, int side) const {
    std::vector<double> near;
    for (std::size_t k = i; near.size() < kNearestOfJump;) {
      if (side < 0 ? k == 0 : k + 1 == speed_.size()) break;
      k = side < 0 ? k - 1 : k + 1;
      if (counts_[k]) near.push_back(speed_[k]);
    }
    return speed_[i] > kJumpOverSpeed * std::max(typical_, quantile(near, 0.5));
  }

 private:
  std::vector<double> speed_;
  std::vector<bool> counts_;
  bool enough_ = false;
  double typical_ = 0.0;
};

bool has_only_jumps(const EqualRun& run, const Steps& steps, std::size_t positions) {
  const bool first = run.from == 0, last = run.to == positions;
  if (first && last) return false;
  return (first || steps.is_jump(run.from - 1, -1)) && (last || steps.is_jump(run.to - 1, 1));
}

/// The speeds of a path, and the jumps in it.
class Path {
 public:
  Path(std::span<const double> t_s, std::span<const double> x) : t_s_(t_s), x_(x) {
    std::vector<double> moving;
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      speed_.push_back(std::abs(x[i + 1] - x[i]) / (t_s[i + 1] - t_s[i]));
      if (speed_.back() > 0.0) moving.push_back(speed_.back());
    }
    shows_speed_ = moving.size() >= kFewestSteps;
    if (shows_speed_) typical_ = quantile(moving, kTypicalOfSteps);
  }

  bool shows_speed() const { return shows_speed_; }
  double jump(std::size_t step) const { return std::abs(x_[step + 1] - x_[step]); }

  /// Whether a step has more than `times` the speed of the motion, which is on this side of it (-1 before, 1 after).
  bool is_jump(std::size_t step, int side, double times) const {
    if (!(speed_[step] > times * typical_)) return false;
    const std::size_t from = side < 0 ? step - std::min(step, kNearestOfJump) : step + 1;
    const std::size_t to = side < 0 ? step : std::min(speed_.size(), step + 1 + kNearestOfJump);
    const auto at = [&](std::size_t i) { return speed_.begin() + static_cast<std::ptrdiff_t>(i); };
    return from < to && speed_[step] > times * quantile({at(from), at(to)}, 0.5);
  }

  /// Whether the path goes on behind step `out` where it ended before step `in`.
  bool goes_on(std::size_t in, std::size_t out) const {
    if (in + 1 < kNearestOfJump || out + 1 + kNearestOfJump > x_.size()) return false;
    const double middle_s = 0.5 * (t_s_[in] + t_s_[out + 1]);
    const double apart = line_at(middle_s, out + 1) - line_at(middle_s, in + 1 - kNearestOfJump);
    return std::abs(apart) < kMeets * std::min(jump(in), jump(out));
  }

  /// The last step of the run that begins behind the jump `in`; none if it is no stray one.
  std::optional<std::size_t> way_back(std::size_t in) const {
    const std::size_t last = std::min(in + x_.size() / kPartWithin, speed_.size() - 1);
    for (std::size_t out = in + 1; out <= last; ++out) {
      if (!(speed_[out] > kJumpOverSpeed * typical_)) continue;
      const bool strays = out - in >= kFewestAstray && is_jump(out, 1, kJumpOverSpeed) && goes_on(in, out);
      return strays ? std::optional(out) : std::nullopt;
    }
    return {};
  }

  /// Whether no body goes so far within a step, and is slow both before and after.
  bool tears(std::size_t step) const {
    const double step_s = t_s_[step + 1] - t_s_[step];
    return is_jump(step, -1, kJumpAtEnd) && is_jump(step, 1, kJumpAtEnd) && jump(step) > kNoBody_m_s2 * step_s * step_s;
  }

  /// The jump, later than `in`, that leads to where the motion before `in` may have got by then; none if none does.
  std::optional<std::size_t> comes_back(std::size_t in) const {
    for (std::size_t out = in + 1; out < speed_.size(); ++out) {
      if (!(speed_[out] > kJumpOverSpeed * typical_)) continue;
      const double reach = kJumpOverSpeed * typical_ * (t_s_[out + 1] - t_s_[in]);
      const bool shows_lines = in + 1 >= kNearestOfJump && out + 1 + kNearestOfJump <= x_.size();
      if (std::abs(x_[out + 1] - x_[in]) <= reach && (!shows_lines || goes_on(in, out))) return out;
    }
    return {};
  }

 private:
  /// At a time, the least-squares line through the kNearestOfJump positions from `first` on.
  double line_at(double t_s, std::size_t first) const {
    double mean_t = 0.0, mean_x = 0.0, tt = 0.0, tx = 0.0;
    constexpr auto kMany = static_cast<double>(kNearestOfJump);
    for (std::size_t i = first; i < first + kNearestOfJump; ++i) {
      mean_t += t_s_[i] / kMany;
      mean_x += x_[i] / kMany;
    }
    for (std::size_t i = first; i < first + kNearestOfJump; ++i) {
      tt += (t_s_[i] - mean_t) * (t_s_[i] - mean_t);
      tx += (t_s_[i] - mean_t) * (x_[i] - mean_x);
    }
    return mean_x + tx / tt * (t_s - mean_t);
  }

  std::span<const double> t_s_, x_;
  std::vector<double> speed_;  // of each step
  bool shows_speed_ = false;
  double typical_ = 0.0;
};

/// Parts between the jumps that tear a path apart, [from, to); a single one if none does.
struct PathPart {
  std::size_t from = 0, to = 0;
  double range = 0.0;
};

std::vector<PathPart> torn_parts(const Path& path, std::span<const double> x) {
  std::vector<PathPart> parts = {{0, x.size(), 0.0}};
  for (std::size_t step = 0; step + 1 < x.size(); ++step) {
    if (!path.tears(step)) continue;
    if (const std::optional<std::size_t> back = path.comes_back(step)) {
      step = *back;
      continue;
    }
    parts.back().to = step + 1;
    parts.push_back({step + 1, x.size(), 0.0});
  }
  for (PathPart& one : parts) {
    const auto at = [&](std::size_t i) { return x.begin() + static_cast<std::ptrdiff_t>(i); };
    const auto [low, high] = std::minmax_element(at(one.from), at(one.to));
    one.range = *high - *low;
  }
  return parts;
}

/// The part that has the motion: the one of the widest range, if the others have less than half of it.
std::optional<PathPart> moving_part(const std::vector<PathPart>& parts) {
  const auto widest = std::ranges::max_element(parts, {}, &PathPart::range);
  const bool alone = std::ranges::all_of(
      parts, [&](const PathPart& one) { return one.from == widest->from || one.range < kPartOfRange * widest->range; });
  return alone ? std::optional(*widest) : std::nullopt;
}

std::optional<StrayPositions> stray_runs(std::span<const double> t_s, std::span<const double> x) {
  const Path path(t_s, x);
  if (!path.shows_speed()) return {};
  StrayPositions stray;
  stray.is_stray.resize(x.size(), false);
  const auto leave_out = [&](std::size_t from, std::size_t to, double off) {  // [from, to)
    if (stray.count == 0) stray.from_s = t_s[from];
    stray.count += to - from;
    stray.off = std::max(stray.off, off);
    std::fill(stray.is_stray.begin() + static_cast<std::ptrdiff_t>(from),
              stray.is_stray.begin() + static_cast<std::ptrdiff_t>(to), true);
  };
  const std::size_t steps = x.size() - 1, at_end = x.size() / kPartAtEnd;
  std::size_t begin = 0, end = steps;  // of the steps between the runs at the ends
  for (std::size_t step = 0; step < at_end; ++step) {
    if (path.is_jump(step, 1, kJumpAtEnd)) begin = step + 1;
  }
  if (begin > 0) leave_out(0, begin, path.jump(begin - 1));
  for (std::size_t step = steps; step > steps - at_end; --step) {
    if (path.is_jump(step - 1, -1, kJumpAtEnd)) end = step - 1;
  }
  for (std::size_t in = begin; in < end; ++in) {
    if (!path.is_jump(in, -1, kJumpOverSpeed)) continue;
    const std::optional<std::size_t> out = path.way_back(in);
    if (!out) continue;
    leave_out(in + 1, *out + 1, std::min(path.jump(in), path.jump(*out)));
    in = *out;
  }
  if (end < steps) leave_out(end + 1, x.size(), path.jump(end));
  if (stray.count == 0) return {};
  return stray;
}

/// The size of the acceleration at each position but the first and the last.
std::vector<double> accelerations(std::span<const double> t_s, std::span<const double> x) {
  std::vector<double> sizes;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    const double before = (x[i] - x[i - 1]) / (t_s[i] - t_s[i - 1]), after = (x[i + 1] - x[i]) / (t_s[i + 1] - t_s[i]);
    sizes.push_back(std::abs(2.0 * (after - before) / (t_s[i + 1] - t_s[i - 1])));
  }
  return sizes;
}

/// The turns of one end, and how many of the accelerations before or behind it belong to them.
struct TurningEnd {
  std::vector<double> turns;
  std::size_t size = 0;
};

template <typename Iterator>
TurningEnd turning_end(Iterator from, Iterator to, double least) {
  TurningEnd end;
  std::size_t i = 0;
  for (Iterator at = from; at != to && i < end.size + kFurthestTurn; ++at, ++i) {
    if (*at <= least) continue;
    end.turns.push_back(*at);
    end.size = i + 1;
  }
  if (end.turns.size() < kFewestTurns) return {};
  return end;
}

}  // namespace

std::optional<ScatteredEnds> scattered_ends(std::span<const double> t_s, std::span<const double> x) {
  const std::vector<double> sizes = accelerations(t_s, x);
  if (sizes.size() < kFewestSteps) return {};
  const double least = std::max(kNoBody_m_s2, kOverTurn * quantile(sizes, 0.5));
  const TurningEnd start = turning_end(sizes.begin(), sizes.end(), least),
                   end = turning_end(sizes.rbegin(), sizes.rend(), least);
  if (start.size + end.size == 0 || 2 * (start.size + end.size) > x.size()) return {};
  const double usual = quantile(
      {sizes.begin() + static_cast<std::ptrdiff_t>(start.size), sizes.end() - static_cast<std::ptrdiff_t>(end.size)},
      kTypicalOfSteps);
  std::vector<double> steps;  // sizes
  for (std::size_t i = 0; i + 1 < x.size(); ++i) steps.push_back(std::abs(x[i + 1] - x[i]));
  const auto typical = [&](std::size_t from, std::size_t to, double part) {
    return quantile(
        {steps.begin() + static_cast<std::ptrdiff_t>(from), steps.begin() + static_cast<std::ptrdiff_t>(to)}, part);
  };
  // The last turn is at a place of the body: the first acceleration is that of the second position.
  const std::size_t until = steps.size() - end.size;
  const double usual_step = typical(start.size, until, kTypicalOfSteps);
  if (!(usual_step > 0.0)) return {};  // a rest, and coarse positions: what moves beside it is no scatter
  const auto scatters = [&](const TurningEnd& of, std::size_t from, std::size_t to) {
    return of.size > 0 && quantile(of.turns, 0.5) > kOverTurn * usual &&
           typical(from, to, 0.5) > kJumpAtEnd * usual_step;
  };
  ScatteredEnds ends;
  if (scatters(start, 0, start.size)) ends.at_start = start.size;
  if (scatters(end, until, steps.size())) ends.at_end = end.size;
  return ends.at_start + ends.at_end > 0 ? std::optional(ends) : std::nullopt;
}

std::optional<UnseenPositions> unseen_positions(std::span<const double> t_s, std::span<const double> x) {
  const std::vector<EqualRun> runs = equal_runs(x);
  if (std::ranges::none_of(runs, [](const EqualRun& run) { return run.size() >= kFewestEqual; })) return {};
  const Steps steps(t_s, x, runs);
  if (!steps.enough()) return {};
  const std::set<double> of_long_runs = values_of_long(runs);
  std::set<double> values;
  for (const EqualRun& run : runs) {
    const bool within = run.from > 0 && run.to < x.size();
    if (!of_long_runs.contains(run.value) || (run.size() < kFewestEqual && !within)) continue;
    if (has_only_jumps(run, steps, x.size())) values.insert(run.value);
  }
  if (values.empty()) return {};
  UnseenPositions unseen;
  unseen.is_unseen.resize(x.size(), false);
  for (const EqualRun& run : runs) {
    if (!values.contains(run.value)) continue;
    if (run.size() < kFewestEqual && !has_only_jumps(run, steps, x.size())) continue;
    if (unseen.count == 0) {
      unseen.value = run.value;
      unseen.from_s = t_s[run.from];
    }
    unseen.count += run.size();
    std::fill(unseen.is_unseen.begin() + static_cast<std::ptrdiff_t>(run.from),
              unseen.is_unseen.begin() + static_cast<std::ptrdiff_t>(run.to), true);
  }
  return unseen;
}

std::optional<StrayPositions> stray_positions(std::span<const double> t_s, std::span<const double> x) {
  std::optional<StrayPositions> stray = stray_runs(t_s, x);
  std::vector<std::size_t> kept;
  std::vector<double> kept_t_s, kept_x;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (stray && stray->is_stray[i]) continue;
    kept.push_back(i);
    kept_t_s.push_back(t_s[i]);
    kept_x.push_back(x[i]);
  }
  const Path path(kept_t_s, kept_x);
  if (!path.shows_speed()) return stray;
  const std::vector<PathPart> parts = torn_parts(path, kept_x);
  const std::optional<PathPart> motion = moving_part(parts);
  if (parts.size() < 2 || !motion) return stray;
  if (!stray) stray = StrayPositions{std::vector<bool>(x.size(), false)};
  for (const PathPart& one : parts) {
    if (one.from == motion->from) continue;
    const double from_s = kept_t_s[one.from];
    stray->from_s = stray->count == 0 ? from_s : std::min(stray->from_s, from_s);
    stray->count += one.to - one.from;
    stray->off = std::max(stray->off, path.jump(one.from > 0 ? one.from - 1 : one.to - 1));
    for (std::size_t i = one.from; i < one.to; ++i) stray->is_stray[kept[i]] = true;
  }
  return stray;
}

std::vector<double> without_flagged(const std::vector<double>& values, const std::vector<bool>& flagged) {
  std::vector<double> kept;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!flagged[i]) kept.push_back(values[i]);
  }
  return kept;
}

}  // namespace glidelab::core
