#include "core/motion/free/free_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/experiment/local_gravity.h"
#include "core/math/quantile.h"
#include "core/motion/free/fall_ends.h"
#include "core/motion/free/motion_events.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kFewestPoints = 6;
constexpr std::size_t kEnoughPoints = 400;  // more are thinned: the cost is candidates times points
constexpr double kToleranceOfSize = 0.25;   // tolerance of a point, as a fraction of the line's size
constexpr double kToleranceSds = 5.0;       // tolerance of a point, in standard deviations

/// Least squares through the points for which `counts(i)` is true; a level line if their v hardly differ.
template <typename Counts>
std::optional<ConsensusLine> fit(const LawPoints& points, std::size_t from, std::size_t to, const Counts& counts) {
  double n = 0.0, v = 0.0, a = 0.0, vv = 0.0, va = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    if (!counts(i)) continue;
    n += 1.0;
    v += points.v_m_s[i];
    a += points.a_m_s2[i];
    vv += points.v_m_s[i] * points.v_m_s[i];
    va += points.v_m_s[i] * points.a_m_s2[i];
  }
  if (n < static_cast<double>(kFewestPoints)) return {};
  ConsensusLine line;
  const double spread = vv - v * v / n;
  if (spread > 1e-4 * vv) line.k_1_s = -(va - v * a / n) / spread;
  line.a0_m_s2 = (a + line.k_1_s * v) / n;
  return line;
}

bool agrees(const LawPoints& points, const ConsensusLine& line, std::size_t i) {
  return std::abs(points.a_m_s2[i] - line.at(points.v_m_s[i])) <= line.tolerance(points.sd_m_s2[i]);
}

/// Size and scatter over the points that agree with the line at a scatter of 1: a wider tolerance would let in more
/// points and so widen itself.
void measure(const LawPoints& points, ConsensusLine& line) {
  std::vector<double> sizes, offs;
  line.scatter = 1.0;
  for (std::size_t i = 0; i < points.v_m_s.size(); ++i) {
    if (!agrees(points, line, i)) continue;
    sizes.push_back(std::abs(line.at(points.v_m_s[i])));
    offs.push_back(std::abs(points.a_m_s2[i] - line.at(points.v_m_s[i])) / points.sd_m_s2[i]);
  }
  if (sizes.size() < kFewestPoints) return;
  line.size_m_s2 = quantile(sizes, 0.9);
  line.scatter = std::max(1.0, kSdOverMedian * quantile(offs, 0.5));
}

LawPoints thinned(const LawPoints& points) {
  const std::size_t stride = (points.v_m_s.size() + kEnoughPoints - 1) / kEnoughPoints;
  LawPoints few;
  for (std::size_t i = 0; i < points.v_m_s.size(); i += stride) {
    few.v_m_s.push_back(points.v_m_s[i]);
    few.a_m_s2.push_back(points.a_m_s2[i]);
    few.sd_m_s2.push_back(points.sd_m_s2[i]);
  }
  return few;
}

}  // namespace

double ConsensusLine::tolerance(double sd_m_s2) const {
  return std::max(kToleranceOfSize * size_m_s2, kToleranceSds * scatter * sd_m_s2);
}

std::optional<ConsensusLine> find_consensus(const LawPoints& all) {
  if (all.v_m_s.size() < kFewestPoints) return {};
  const LawPoints points = thinned(all);
  const std::size_t n = points.v_m_s.size();
  std::vector<double> magnitudes;
  for (const double a : points.a_m_s2) magnitudes.push_back(std::abs(a));
  const double typical = quantile(magnitudes, 0.5);
  std::optional<ConsensusLine> best;
  std::size_t most = 0;
  for (std::size_t length = std::max(kFewestPoints, n / 10); length <= n;
       length = std::max(length + 1, 3 * length / 2)) {
    for (std::size_t from = 0; from + length <= n; from += std::max<std::size_t>(1, length / 4)) {
      auto line = fit(points, from, from + length, [](std::size_t) { return true; });
      line->size_m_s2 = typical;  // one size for all candidates: a steep line must not gain agreement by its size
      std::size_t agree = 0;
      for (std::size_t i = 0; i < n; ++i) agree += agrees(points, *line, i);
      if (agree > most) {
        most = agree;
        best = line;
      }
    }
  }
  if (!best) return {};
  for (int again = 0; again < 4; ++again) {
    const ConsensusLine before = *best;
    auto refit = fit(points, 0, n, [&](std::size_t i) { return agrees(points, before, i); });
    if (!refit) break;
    refit->size_m_s2 = before.size_m_s2;
    measure(points, *refit);
    best = refit;
  }
  return best;
}

namespace {

constexpr double kNearEvent = 3.0;               // pilot bandwidths within which the pilot mixes both sides
constexpr double kLeastStretchBandwidths = 4.0;  // a stretch shorter than this is not fitted
constexpr std::size_t kLeastStretchPoints = 8;
constexpr double kLeastShareAlong =
    0.05;  // of the points against the launch: below that, motion along it does not count
constexpr double kLeastOfLongest = 0.574;  // of the longest: 4^(-2/5), see the header
constexpr std::size_t kFewestOfFall = 24;  // of fewer points the pilot's kernel spans all of the speeding up
constexpr double kMostGravity_m_s2 = 1.02 * kStandardGravity_m_s2;  // at any place, and a scale that is off by 1 %

/// The direction of every point, 0 at rest. Motion that is stated to be free is not rest: it continues the adjacent
/// motion.
std::vector<int> directions(const MotionRuns& runs, const ClipSetup& setup) {
  std::vector<int> direction = runs.direction;
  for (const PointRange& range : ranges_of(runs.direction)) {
    if (direction[range.from] != 0) continue;
    const int before = range.from > 0 ? direction[range.from - 1] : 0;
    const int after = range.to < direction.size() ? runs.direction[range.to] : 0;
    const bool stated = (before != 0 || setup.start_s) && (after != 0 || setup.end_s);
    if (!stated || (before != 0 && after != 0 && !(setup.start_s && setup.end_s))) continue;
    const std::size_t middle = before == 0 ? range.from : after == 0 ? range.to : (range.from + range.to) / 2;
    fill_range(direction, {range.from, middle}, before);
    fill_range(direction, {middle, range.to}, after);
  }
  return direction;
}

class Finder {
 public:
  Finder(const Motion& motion, const ClipSetup& setup)
      : motion_(motion),
        setup_(setup),
        pilot_(first_smoothing(motion)),
        runs_(find_runs(motion, pilot_)),
        direction_(directions(runs_, setup)),
        falling_(motion.forced || motion.t_s.size() < kFewestOfFall || !is_fall(setup.incline_rad) ? 0
                 : setup.incline_rad > 0.0                                                         ? 1
                                                                                                   : -1),
        n_(motion.t_s.size()) {}

  FreeMotion find() {
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
  double span_s(const PointRange& range) const { return motion_.t_s[range.to - 1] - motion_.t_s[range.from]; }

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
    std::vector<char> handled(n_, 0);
    for (std::size_t i = 0; i < n_; ++i) {
      const int direction = direction_[i];
      if (direction == 0 || !line[direction > 0] || !std::isfinite(pilot_.sd_a_m_s2[i])) continue;
      const ConsensusLine& own = *line[direction > 0];
      double low = own.at(pilot_.v_m_s[i]), high = low;
      if (near_time(runs_.turns_s, motion_.t_s[i])) {  // the pilot mixes both directions' accelerations here
        const auto& other = line[direction < 0];
        const double beyond = other ? other->at(pilot_.v_m_s[i]) : 2.0 * low;
        low = std::min(low, beyond);
        high = std::max(high, beyond);
      }
      if (near_time(runs_.rest_edges_s, motion_.t_s[i])) {
        low = std::min(low, 0.0);
        high = std::max(high, 0.0);
      }
      if (direction == falling_) {  // gravity less any drag
        low = std::min(low, direction > 0 ? 0.0 : -kMostGravity_m_s2);
        high = std::max(high, direction > 0 ? kMostGravity_m_s2 : 0.0);
      }
      const double tolerance = own.tolerance(pilot_.sd_a_m_s2[i]);
      handled[i] = pilot_.a_m_s2[i] < low - tolerance || pilot_.a_m_s2[i] > high + tolerance;
    }
    name_handling(handled);
  }

  bool is_real(const PointRange& range) const {
    return range.to - range.from >= kLeastStretchPoints &&
           span_s(range) >= kLeastStretchBandwidths * pilot_.bandwidth_s;
  }

  /// Before the first real stretch it is the hand, after it a stop. A piece too short to be a stretch between handled
  /// points is handled too.
  void name_handling(const std::vector<char>& handled) {
    std::vector<int> kind(n_);  // direction of free motion, 0 at rest, 2 handled
    for (std::size_t i = 0; i < n_; ++i) kind[i] = handled[i] ? 2 : direction_[i];
    const std::vector<PointRange> ranges = ranges_of(kind);
    std::size_t first_real = n_, last_real = 0;
    for (const PointRange& range : ranges) {
      if (std::abs(kind[range.from]) != 1 || !is_real(range)) continue;
      first_real = std::min(first_real, range.from);
      last_real = range.to;
    }
    for (std::size_t r = 0; r < ranges.size(); ++r) {
      const PointRange& range = ranges[r];
      const auto is_handled = [&](std::size_t other) { return kind[ranges[other].from] == 2; };
      const bool sliver = std::abs(kind[range.from]) == 1 && !is_real(range) &&
                          ((r > 0 && is_handled(r - 1)) || (r + 1 < ranges.size() && is_handled(r + 1)));
      if (kind[range.from] != 2 && !sliver) continue;
      const bool before = range.from < first_real;
      if ((before && setup_.start_s) || (range.from >= last_real && setup_.end_s)) continue;  // as stated by the user
      fill_range(reason_, range, before ? LeftOut::hand : LeftOut::stop);
    }
  }

  /// Motion against the direction of the launch, before any motion along it, is the hand.
  void leave_out_backswing(FreeMotion& free) {
    if (setup_.start_s || motion_.forced) return;
    int launched = 0;
    if (setup_.launched == Launched::up) launched = -1;
    if (setup_.launched == Launched::down) launched = 1;
    if (setup_.launched == Launched::released && setup_.incline_rad != 0.0)
      launched = setup_.incline_rad > 0.0 ? 1 : -1;
    if (launched == 0) return;
    std::size_t end = n_;
    for (const PointRange& range : ranges_of(direction_)) {
      if (direction_[range.from] != launched || reason_[range.from] != LeftOut::used || !is_real(range)) continue;
      end = range.from;
      break;
    }
    std::size_t against = 0, with = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      if (reason_[i] != LeftOut::used) continue;
      against += direction_[i] == -launched && i < end;
      with += direction_[i] == launched;
    }
    if (against == 0) return;
    AgainstLaunch found;
    found.direction = -launched;
    found.share = share_of_free(against);
    if (end == n_) {  // it never moves in the launch direction, so a hand cannot be told apart
      if (static_cast<double>(with) > kLeastShareAlong * static_cast<double>(against)) return;
      free.against_launch = found;
      return;
    }
    found.until_s = motion_.t_s[end];
    for (const PointRange& range : ranges_of(direction_)) {
      if (range.to != end || direction_[range.from] != -launched) continue;
      found.at_a_turn = is_real(range) && reason_[range.to - 1] == LeftOut::used;
    }
    for (std::size_t i = 0; i < end; ++i) {
      if (direction_[i] == -launched && reason_[i] == LeftOut::used) reason_[i] = LeftOut::hand;
    }
    free.against_launch = found;
  }

  double share_of_free(std::size_t count) const {
    const auto free = std::count(reason_.begin(), reason_.end(), LeftOut::used);
    return static_cast<double>(count) / static_cast<double>(free);
  }

  std::vector<FreeStretch> stretches() const {
    std::vector<int> free(n_);
    for (std::size_t i = 0; i < n_; ++i) free[i] = reason_[i] == LeftOut::used ? direction_[i] : 0;
    const auto across = [&](std::size_t i) { return free[i - 1] * free[i] < 0; };
    std::vector<FreeStretch> found;
    for (const PointRange& range : ranges_of(free)) {
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
      if (time_of(of) < kLeastOfLongest * longest_s[of.direction > 0]) of.whole = LeftOut::short_stretch;
    }
    return found;
  }

  const Motion& motion_;
  const ClipSetup& setup_;
  const Pilot pilot_;
  const MotionRuns runs_;
  const std::vector<int> direction_;  // of every point; 0 at rest
  const int falling_;                 // the direction in which the body falls; 0 on a track
  const std::size_t n_;
  std::vector<LeftOut> reason_;
};

Motion between(const Motion& motion, std::size_t from, std::size_t to) {
  std::vector<std::size_t> outside;
  for (std::size_t i = 0; i < motion.t_s.size(); ++i) {
    if (i < from || i >= to) outside.push_back(i);
  }
  return without(motion, outside);
}

/// The points that may be free: what the setup states, else what lies between the release and the landing of a fall.
PointRange within_limits(const Motion& motion, const ClipSetup& setup) {
  const auto& t = motion.t_s;
  const auto index = [&](auto at) { return static_cast<std::size_t>(at - t.begin()); };
  const bool falls = !motion.forced && is_fall(setup.incline_rad);
  const int direction = setup.incline_rad > 0.0 ? 1 : -1;
  PointRange range{0, t.size()};
  if (setup.end_s) {
    range.to = index(std::upper_bound(t.begin(), t.end(), *setup.end_s));
  } else if (falls) {
    range.to = landed_from(motion, direction);
  }
  if (setup.start_s) {
    range.from = index(std::lower_bound(t.begin(), t.end(), *setup.start_s));
  } else if (falls) {
    range.from = released_at(motion, direction, range.to);
  }
  return range;
}

}  // namespace

FreeMotion find_free_motion(const Motion& motion, const ClipSetup& setup) {
  const PointRange range = within_limits(motion, setup);
  FreeMotion free;
  if (range.to >= range.from + kLeastStretchPoints) {
    free = Finder(between(motion, range.from, range.to), setup).find();
  } else {
    free.reason.assign(range.to > range.from ? range.to - range.from : 0, LeftOut::kernel_gap);
    free.pilot_bandwidth_s = 2.0 * motion.step_s;
  }
  if (!setup.start_s) free.released_at = range.from;
  free.reason.insert(free.reason.begin(), range.from, setup.start_s ? LeftOut::before_start : LeftOut::rest);
  free.reason.resize(motion.t_s.size(), setup.end_s ? LeftOut::after_end : LeftOut::rest);
  for (FreeStretch& stretch : free.stretches) stretch.first += range.from;
  return free;
}

namespace {

constexpr std::size_t kStretchesOfDriven = 3;  // of a block: two turns

FreeBlock block_of(const Motion& motion, std::size_t from, std::size_t to,
                   const std::vector<std::vector<double>>& shared_m) {
  FreeBlock block;
  block.shared_m.resize(shared_m.size());
  for (std::size_t i = from; i < to; ++i) {
    block.t_s.push_back(motion.t_s[i]);
    block.x_m.push_back(motion.x_m[i]);
    for (std::size_t mode = 0; mode < shared_m.size(); ++mode) {
      if (!shared_m[mode].empty()) block.shared_m[mode].push_back(shared_m[mode][motion.point[i]]);
    }
  }
  return block;
}

}  // namespace

bool turns_into(const FreeStretch& before, const FreeStretch& after) {
  return before.end == LeftOut::kernel_reversal && after.start == LeftOut::kernel_reversal &&
         before.first + before.count == after.first;
}

std::vector<FreeBlock> free_blocks(const Motion& motion, const FreeMotion& free,
                                   const std::vector<std::vector<double>>& shared_m, double margin_s) {
  const std::vector<FreeStretch>& stretches = free.stretches;
  std::vector<FreeBlock> blocks;
  const auto middle_of = [&](std::size_t s) { return stretches[s].first + stretches[s].count / 2; };
  bool cut = false;  // the block starts in the middle of its first stretch
  for (std::size_t s = 0; s < stretches.size();) {
    std::size_t end = s + 1;
    while (end < stretches.size() && turns_into(stretches[end - 1], stretches[end])) ++end;
    std::size_t from = stretches[s].first, to = stretches[end - 1].first + stretches[end - 1].count;
    const bool cuts = motion.forced && end - s > kStretchesOfDriven;
    if (cut) from = middle_of(s);
    if (cuts) {
      end = s + kStretchesOfDriven;
      to = middle_of(end - 1);
    }
    bool counts = false;
    std::vector<int> directions;
    for (std::size_t of = s; of < end; ++of) {
      counts = counts || stretches[of].whole == LeftOut::used;
      directions.push_back(stretches[of].direction);
    }
    s = cuts ? end - 1 : end;
    const double first_s = motion.t_s[from] + (from > free.released_at && !cut ? margin_s : 0.0);
    const double last_s = motion.t_s[to - 1] - (to < motion.t_s.size() && !cuts ? margin_s : 0.0);
    cut = cuts;
    while (from < to && motion.t_s[from] < first_s) ++from;
    while (to > from && motion.t_s[to - 1] > last_s) --to;
    if (!counts || to - from < kFewestBlockPoints) continue;
    blocks.push_back(block_of(motion, from, to, shared_m));
    blocks.back().directions = std::move(directions);
  }
  return blocks;
}

RecordedForce force_over(const FreeBlock& block, const TrackData& track, double mass_kg, double mass_sd_kg) {
  RecordedForce force;
  force.mass_sd_relative = mass_sd_kg / mass_kg;
  for (std::size_t i = 0; i < track.force_n.size(); ++i) {
    if (track.t_s[i] < block.t_s.front() || track.t_s[i] > block.t_s.back()) continue;
    force.t_s.push_back(track.t_s[i]);
    force.a_m_s2.push_back(track.force_n[i] / mass_kg);
  }
  return force;
}

}  // namespace glidelab::core
