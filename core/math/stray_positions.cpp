#include "core/math/stray_positions.h"

#include <algorithm>
#include <cmath>

#include "core/math/jump_limits.h"
#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kJumpAtEnd = 12.0;       // times the speed: eight lost frames have 9
constexpr std::size_t kFewestAstray = 3;  // fewer are outliers
constexpr std::size_t kPartWithin = 10;   // one in so many positions may lie in a run,
constexpr std::size_t kPartAtEnd = 20;    // and in one at an end
constexpr double kMeets = 0.25;           // of the smaller jump
constexpr double kNoBody_m_s2 = 200.0;    // 20 g: no hand takes a body that far within a step
constexpr double kPartOfRange = 0.5;      // of the widest stretch: two such are two motions

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
      if (!(speed_[out] > kJump * typical_)) continue;
      const bool strays = out - in >= kFewestAstray && is_jump(out, 1, kJump) && goes_on(in, out);
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
      if (!(speed_[out] > kJump * typical_)) continue;
      const double reach = kJump * typical_ * (t_s_[out + 1] - t_s_[in]);
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
    if (!path.is_jump(in, -1, kJump)) continue;
    const std::optional<std::size_t> out = path.way_back(in);
    if (!out) continue;
    leave_out(in + 1, *out + 1, std::min(path.jump(in), path.jump(*out)));
    in = *out;
  }
  if (end < steps) leave_out(end + 1, x.size(), path.jump(end));
  if (stray.count == 0) return {};
  return stray;
}

}  // namespace

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

}  // namespace glidelab::core
