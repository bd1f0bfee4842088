#include "core/free_motion.h"

#include <fmt/format.h>
#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/law_consensus.h"
#include "core/pilot.h"
#include "core/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kLeastMotion = 20.0;    // standard deviations of a position that a run must cover to be motion
constexpr double kRestBandwidths = 3.0;  // a reversal is still for less than one pilot bandwidth
constexpr std::size_t kRestPoints = 6;
constexpr double kRestGrowth = 3.0;      // standard deviations of a position
constexpr double kNearEvent = 3.0;       // pilot bandwidths within which the pilot mixes both sides
constexpr double kRealBandwidths = 4.0;  // a stretch shorter than this is no motion to fit
constexpr std::size_t kRealPoints = 8;
constexpr double kShortest = 0.574;  // of the longest: 4^(-2/5), see the header

struct Range {
  std::size_t from = 0, to = 0;  // to is one past the last
};

/// Maximal ranges of equal value.
template <typename T>
std::vector<Range> ranges_of(const std::vector<T>& values) {
  std::vector<Range> ranges;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i == 0 || values[i] != values[i - 1]) ranges.push_back({i, i});
    ranges.back().to = i + 1;
  }
  return ranges;
}

class Finder {
 public:
  Finder(const Motion& motion, const ClipSetup& setup)
      : motion_(motion), setup_(setup), pilot_(first_smoothing(motion)), n_(motion.t_s.size()) {}

  FreeMotion find() {
    assign_directions();
    find_rests();
    settle_between_runs();
    reason_.assign(n_, LeftOut::used);
    for (std::size_t i = 0; i < n_; ++i) {
      if (direction_[i] == 0) reason_[i] = LeftOut::rest;
    }
    flag_handling();
    FreeMotion free;
    free.pilot_bandwidth_s = pilot_.bandwidth_s;
    leave_out_backswing(free);
    free.stretches = stretches();
    free.reason = reason_;
    return free;
  }

 private:
  double span_s(const Range& range) const { return motion_.t_s[range.to - 1] - motion_.t_s[range.from]; }

  void assign_directions() {
    direction_.assign(n_, 0);
    for (std::size_t i = 0; i < n_; ++i) {
      if (std::abs(pilot_.v_m_s[i]) > still_below(pilot_, i)) direction_[i] = pilot_.v_m_s[i] > 0.0 ? 1 : -1;
    }
    for (const Range& run : ranges_of(direction_)) {
      if (direction_[run.from] == 0) continue;
      const auto [low, high] = std::minmax_element(motion_.x_m.begin() + static_cast<std::ptrdiff_t>(run.from),
                                                   motion_.x_m.begin() + static_cast<std::ptrdiff_t>(run.to));
      if (*high - *low >= kLeastMotion * motion_.noise_m) continue;
      std::fill(direction_.begin() + static_cast<std::ptrdiff_t>(run.from),
                direction_.begin() + static_cast<std::ptrdiff_t>(run.to), 0);
    }
  }

  /// Next to no slope and curvature of x in the middle part of the range.
  bool is_rest(const Range& range) const {
    if (range.to - range.from < kRestPoints || span_s(range) < kRestBandwidths * pilot_.bandwidth_s) return false;
    const std::size_t cut = (range.to - range.from) / 5;
    const Range middle{range.from + cut, range.to - cut};
    const auto count = static_cast<Eigen::Index>(middle.to - middle.from);
    const double half_s = 0.5 * span_s(middle), centre_s = motion_.t_s[middle.from] + half_s;
    Eigen::MatrixX3d design(count, 3);
    Eigen::VectorXd x(count);
    for (Eigen::Index r = 0; r < count; ++r) {
      const std::size_t i = middle.from + static_cast<std::size_t>(r);
      const double u = (motion_.t_s[i] - centre_s) / half_s;
      design.row(r) << 1.0, u, u * u;
      x[r] = motion_.x_m[i] - motion_.x_m[middle.from];
    }
    const Eigen::Matrix3d inverse = (design.transpose() * design).inverse();
    const Eigen::Vector3d fit = inverse * (design.transpose() * x);
    // fit[1] is the way over half the range, fit[2] how far its ends lie off: next to none is a fifth of the speed that
    // counts as still, or what a position's noise covers.
    const double little = std::max(0.2 * kStillShare * pilot_.top_speed_m_s * half_s, kRestGrowth * motion_.noise_m);
    return std::abs(fit[1]) <= little && std::abs(fit[2]) <= little;
  }

  void find_rests() {
    resting_.assign(n_, 0);
    for (const Range& range : ranges_of(direction_)) {
      if (direction_[range.from] != 0) continue;
      if (range.from == 0 && range.to == n_) {
        return rest(range);
      }
      if (!is_rest(range)) continue;
      const std::size_t cut = (range.to - range.from) / 5;
      const std::vector<double> middle(motion_.x_m.begin() + static_cast<std::ptrdiff_t>(range.from + cut),
                                       motion_.x_m.begin() + static_cast<std::ptrdiff_t>(range.to - cut));
      const double place = quantile(middle, 0.5);
      const auto near = [&](std::size_t i) {
        return std::abs(motion_.x_m[i] - place) <= kRestGrowth * motion_.noise_m;
      };
      std::size_t from = range.from + cut, to = range.to - cut;
      while (from > 0 && (near(from - 1) || (from > 1 && near(from - 2)))) --from;
      while (to < n_ && (near(to) || (to + 1 < n_ && near(to + 1)))) ++to;
      rest({from, to});
    }
  }

  /// Points of no significant v that do not rest belong to the run before or after, on the near side of the place where
  /// x turns.
  void settle_between_runs() {
    for (std::size_t i = 0; i < n_; ++i) {
      if (resting_[i]) direction_[i] = 0;
    }
    for (const Range& range : ranges_of(direction_)) {
      if (direction_[range.from] != 0) continue;
      for (std::size_t i = range.from; i < range.to; ++i) {
        if (resting_[i]) continue;
        Range part{i, i};
        while (part.to < range.to && !resting_[part.to]) ++part.to;
        settle(part, i > 0 ? direction_[i - 1] : 0, part.to < n_ ? direction_[part.to] : 0);
        i = part.to - 1;
      }
    }
    for (std::size_t i = 1; i < n_; ++i) {
      if (direction_[i] * direction_[i - 1] < 0) turns_.push_back(i);
      if ((resting_[i] != 0) != (resting_[i - 1] != 0)) rest_edges_s_.push_back(motion_.t_s[i]);
    }
  }

  void settle(const Range& range, int before, int after) {
    const auto fill = [&](std::size_t from, std::size_t to, int direction) {
      std::fill(direction_.begin() + static_cast<std::ptrdiff_t>(from),
                direction_.begin() + static_cast<std::ptrdiff_t>(to), direction);
    };
    if (before == after && before != 0) return fill(range.from, range.to, before);
    const double way = pilot_.x_m[range.to - 1] - pilot_.x_m[range.from];
    const double least = kLeastMotion * motion_.noise_m;
    if (before == 0 && after == 0) {
      if (std::abs(way) >= least) return fill(range.from, range.to, way > 0.0 ? 1 : -1);
      return rest(range);
    }
    // x is largest (smallest) where a motion towards +x (-x) turns, or where one towards -x (+x) begins.
    const int outward = before != 0 ? before : -after;
    std::size_t turn = range.from;
    for (std::size_t i = range.from; i < range.to; ++i) {
      if (outward * (pilot_.x_m[i] - pilot_.x_m[turn]) > 0.0) turn = i;
    }
    if (before != 0 && after != 0) {
      fill(range.from, turn, before);
      return fill(turn, range.to, after);
    }
    // One side is an end of the data or a rest. What goes too little way there to be motion is rest, unless it is
    // short.
    const Range inner = before != 0 ? Range{turn, range.to} : Range{range.from, turn};
    const Range outer = before != 0 ? Range{range.from, turn} : Range{turn, range.to};
    const int known = before != 0 ? before : after;
    fill(outer.from, outer.to, known);
    if (inner.from == inner.to) return;
    const double back = std::abs(pilot_.x_m[inner.to - 1] - pilot_.x_m[inner.from]);
    if (back >= least) return fill(inner.from, inner.to, -known);
    if (span_s(inner) < kRestBandwidths * pilot_.bandwidth_s) return fill(inner.from, inner.to, known);
    rest(inner);
  }

  void rest(const Range& range) {
    std::fill(resting_.begin() + static_cast<std::ptrdiff_t>(range.from),
              resting_.begin() + static_cast<std::ptrdiff_t>(range.to), 1);
  }

  bool near_time(const std::vector<double>& times, double t_s) const {
    const double reach = kNearEvent * pilot_.bandwidth_s;
    const auto found = std::lower_bound(times.begin(), times.end(), t_s - reach);
    return found != times.end() && *found <= t_s + reach;
  }

  void flag_handling() {
    if (setup_.start_s && setup_.end_s) return;
    std::optional<ConsensusLine> line[2];
    for (const int direction : {-1, 1}) {
      LawPoints points;
      for (std::size_t i = 0; i < n_; ++i) {
        if (direction_[i] != direction || !std::isfinite(pilot_.sd_a_m_s2[i])) continue;
        points.v_m_s.push_back(pilot_.v_m_s[i]);
        points.a_m_s2.push_back(pilot_.a_m_s2[i]);
        points.sd_m_s2.push_back(std::max(pilot_.sd_a_m_s2[i], 1e-12));
      }
      line[direction > 0] = find_consensus(points);
    }
    std::vector<double> turns_s;
    for (const std::size_t turn : turns_) turns_s.push_back(motion_.t_s[turn]);
    std::vector<char> handled(n_, 0);
    for (std::size_t i = 0; i < n_; ++i) {
      const int direction = direction_[i];
      if (direction == 0 || !line[direction > 0] || !std::isfinite(pilot_.sd_a_m_s2[i])) continue;
      const ConsensusLine& own = *line[direction > 0];
      double low = own.at(pilot_.v_m_s[i]), high = low;
      if (near_time(turns_s, motion_.t_s[i])) {  // the pilot mixes both directions' accelerations here
        const auto& other = line[direction < 0];
        const double beyond = other ? other->at(pilot_.v_m_s[i]) : 2.0 * low;
        low = std::min(low, beyond);
        high = std::max(high, beyond);
      }
      if (near_time(rest_edges_s_, motion_.t_s[i])) {
        low = std::min(low, 0.0);
        high = std::max(high, 0.0);
      }
      const double tolerance = own.tolerance(pilot_.sd_a_m_s2[i]);
      handled[i] = pilot_.a_m_s2[i] < low - tolerance || pilot_.a_m_s2[i] > high + tolerance;
    }
    name_handling(handled);
  }

  bool is_real(const Range& range) const {
    return range.to - range.from >= kRealPoints && span_s(range) >= kRealBandwidths * pilot_.bandwidth_s;
  }

  /// Hand before the first real stretch, stop after it. What is too short to be a stretch and lies between handled
  /// points is handled as well.
  void name_handling(const std::vector<char>& handled) {
    std::vector<int> kind(n_);  // direction of free motion, 0 at rest, 2 handled
    for (std::size_t i = 0; i < n_; ++i) kind[i] = handled[i] ? 2 : direction_[i];
    const std::vector<Range> ranges = ranges_of(kind);
    std::size_t first_real = n_, last_real = 0;
    for (const Range& range : ranges) {
      if (std::abs(kind[range.from]) != 1 || !is_real(range)) continue;
      first_real = std::min(first_real, range.from);
      last_real = range.to;
    }
    for (std::size_t r = 0; r < ranges.size(); ++r) {
      const Range& range = ranges[r];
      const auto is_handled = [&](std::size_t other) { return kind[ranges[other].from] == 2; };
      const bool sliver = std::abs(kind[range.from]) == 1 && !is_real(range) &&
                          ((r > 0 && is_handled(r - 1)) || (r + 1 < ranges.size() && is_handled(r + 1)));
      if (kind[range.from] != 2 && !sliver) continue;
      const bool before = range.from < first_real;
      if ((before && setup_.start_s) || (range.from >= last_real && setup_.end_s)) continue;  // the user's word
      std::fill(reason_.begin() + static_cast<std::ptrdiff_t>(range.from),
                reason_.begin() + static_cast<std::ptrdiff_t>(range.to), before ? LeftOut::hand : LeftOut::stop);
    }
  }

  /// What moves against the direction of the launch, before anything moves with it, is the hand.
  void leave_out_backswing(FreeMotion& free) {
    if (setup_.start_s || motion_.forced) return;
    int launched = 0;
    if (setup_.launched == Launched::up) launched = -1;
    if (setup_.launched == Launched::down) launched = 1;
    if (setup_.launched == Launched::released && setup_.incline_rad != 0.0)
      launched = setup_.incline_rad > 0.0 ? 1 : -1;
    if (launched == 0) return;
    std::size_t end = n_;
    for (const Range& range : ranges_of(direction_)) {
      if (direction_[range.from] != launched || reason_[range.from] != LeftOut::used || !is_real(range)) continue;
      end = range.from;
      break;
    }
    if (end == n_) return;  // it never moves as launched: nothing to tell from
    bool any = false;
    for (std::size_t i = 0; i < end; ++i) {
      if (direction_[i] != -launched || reason_[i] != LeftOut::used) continue;
      reason_[i] = LeftOut::hand;
      any = true;
    }
    if (any) {
      free.notes.push_back(
          fmt::format("what moves towards {} before {:.3f} s is left out as the hand: the launch was towards {}",
                      launched > 0 ? "-x" : "+x", motion_.t_s[end], launched > 0 ? "+x" : "-x"));
    }
  }

  std::vector<FreeStretch> stretches() const {
    std::vector<int> free(n_);
    for (std::size_t i = 0; i < n_; ++i) free[i] = reason_[i] == LeftOut::used ? direction_[i] : 0;
    const auto across = [&](std::size_t i) { return free[i - 1] * free[i] < 0; };
    std::vector<FreeStretch> found;
    for (const Range& range : ranges_of(free)) {
      if (free[range.from] == 0) continue;
      FreeStretch stretch{range.from, range.to - range.from, free[range.from], LeftOut::kernel_end,
                          LeftOut::kernel_end};
      if (range.from > 0 && across(range.from)) stretch.start = LeftOut::kernel_reversal;
      if (range.to < n_ && across(range.to)) stretch.end = LeftOut::kernel_reversal;
      found.push_back(stretch);
    }
    double longest_s[2] = {};
    const auto time_of = [&](const FreeStretch& of) { return span_s({of.first, of.first + of.count}); };
    for (const FreeStretch& of : found)
      longest_s[of.direction > 0] = std::max(longest_s[of.direction > 0], time_of(of));
    for (FreeStretch& of : found) {
      if (time_of(of) < kShortest * longest_s[of.direction > 0]) of.whole = LeftOut::short_stretch;
    }
    return found;
  }

  const Motion& motion_;
  const ClipSetup& setup_;
  Pilot pilot_;
  std::size_t n_;
  std::vector<int> direction_;  // of every point; 0 at rest
  std::vector<char> resting_;
  std::vector<std::size_t> turns_;    // first points after a reversal
  std::vector<double> rest_edges_s_;  // where a rest begins or ends
  std::vector<LeftOut> reason_;
};

Motion between(const Motion& motion, std::size_t from, std::size_t to) {
  std::vector<std::size_t> outside;
  for (std::size_t i = 0; i < motion.t_s.size(); ++i) {
    if (i < from || i >= to) outside.push_back(i);
  }
  return without(motion, outside);
}

}  // namespace

FreeMotion find_free_motion(const Motion& motion, const ClipSetup& setup) {
  const auto& t = motion.t_s;
  const auto from = setup.start_s ? std::lower_bound(t.begin(), t.end(), *setup.start_s) - t.begin() : 0;
  const auto to = setup.end_s ? std::upper_bound(t.begin(), t.end(), *setup.end_s) - t.begin()
                              : static_cast<std::ptrdiff_t>(t.size());
  FreeMotion free;
  if (to - from >= static_cast<std::ptrdiff_t>(kRealPoints)) {
    free = Finder(between(motion, static_cast<std::size_t>(from), static_cast<std::size_t>(to)), setup).find();
  } else {
    free.reason.assign(static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, to - from)), LeftOut::kernel_gap);
    free.pilot_bandwidth_s = 2.0 * motion.step_s;
  }
  free.reason.insert(free.reason.begin(), static_cast<std::size_t>(from), LeftOut::before_start);
  free.reason.resize(t.size(), LeftOut::after_end);
  for (FreeStretch& stretch : free.stretches) stretch.first += static_cast<std::size_t>(from);
  return free;
}

}  // namespace glidelab::core
