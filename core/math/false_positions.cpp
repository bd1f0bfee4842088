#include "core/math/false_positions.h"

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

}  // namespace

std::optional<StrayPositions> stray_positions(std::span<const double> t_s, std::span<const double> x) {
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

}  // namespace glidelab::core
