#include "core/motion/lines/free_pieces.h"

#include <algorithm>
#include <cmath>

namespace glidelab::core {
namespace {

constexpr double kWindow = 3.0;      // bandwidths on both sides of an event that its time is estimated from
constexpr double kDeviations = 2.0;  // of the event's time that are left out

std::optional<EventTime> event_between(const Motion& motion, std::size_t from, std::size_t border, std::size_t to,
                                       EventKind kind, double bandwidth_s, const std::vector<double>& autocovariance) {
  const std::span t = std::span(motion.t_s).subspan(from, to - from);
  const std::span y = std::span(motion.y_m).subspan(from, to - from);
  return estimate_event(t, y, kind, motion.t_s[border], kWindow * bandwidth_s, autocovariance);
}

/// The range of points of one stretch between the times.
FreePiece between(const Motion& motion, double from_s, double to_s, int direction) {
  const auto first = std::lower_bound(motion.t_s.begin(), motion.t_s.end(), from_s);
  const auto last = std::upper_bound(motion.t_s.begin(), motion.t_s.end(), to_s);
  return {static_cast<std::size_t>(first - motion.t_s.begin()),
          static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, last - first)), direction};
}

}  // namespace

std::vector<FreePiece> free_pieces(const Motion& motion, const FreeMotion& free, double bandwidth_s,
                                   const std::vector<double>& autocovariance) {
  std::vector<FreePiece> pieces;
  const std::size_t n = motion.t_s.size();
  std::optional<EventTime> turned;  // the event at which the last stretch turned into this one
  for (std::size_t s = 0; s < free.stretches.size(); ++s) {
    const FreeStretch& stretch = free.stretches[s];
    const std::size_t end = stretch.first + stretch.count;
    double from_s = motion.t_s[stretch.first], to_s = motion.t_s[end - 1];
    if (turned) {
      from_s = turned->t_s + kDeviations * turned->sd_s;
    } else if (stretch.first > 0) {
      from_s += bandwidth_s;
    }
    turned.reset();
    std::optional<EventTime> event;
    if (s + 1 < free.stretches.size() && stretch.end == LeftOut::kernel_reversal &&
        free.stretches[s + 1].first == end) {
      event = event_between(motion, stretch.first, end, end + free.stretches[s + 1].count, EventKind::turns,
                            bandwidth_s, autocovariance);
      turned = event;
    } else if (end < n && free.reason[end] == LeftOut::rest) {
      std::size_t rest = end;
      while (rest < n && free.reason[rest] == LeftOut::rest) ++rest;
      event = event_between(motion, stretch.first, end, rest, EventKind::stops, bandwidth_s, autocovariance);
    }
    if (event) {
      to_s = event->t_s - kDeviations * event->sd_s;
    } else if (end < n) {
      to_s -= bandwidth_s;
    }
    if (to_s > from_s) pieces.push_back(between(motion, from_s, to_s, stretch.direction));
  }
  return pieces;
}

}  // namespace glidelab::core
