#include "core/motion/smooth_clip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/math/least_squares.h"
#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kLeastDeterminant = 1e-12;  // relative: rounding alone leaves 1e-16

/// Points of the motion given to a smoother, and the additional frames requested from it.
struct Gathered {
  SmoothingInput input;
  std::vector<std::size_t> point;  // of the motion
  std::vector<std::size_t> frame;  // of input.at_s
};

/// Adds the points of a range as a new part, or after a break.
void add(const Motion& motion, const PointRange& range, bool goes_on, Gathered& to) {
  if (!to.point.empty()) {
    if (goes_on) {
      to.input.breaks_s.push_back(0.5 * (motion.t_s[range.from - 1] + motion.t_s[range.from]));
    } else {
      to.input.starts.push_back(to.point.size());
    }
  }
  for (std::size_t i = range.from; i < range.to; ++i) {
    to.point.push_back(i);
    to.input.t_s.push_back(motion.t_s[i]);
    to.input.x_m.push_back(motion.y_m[i]);
  }
}

/// The frames within a part that have no position that counts.
void want_other_frames(const TrackData& track, const Motion& motion, const std::vector<MotionPoint>& frames,
                       Gathered& to) {
  std::vector<bool> has_point(frames.size(), false);
  for (const std::size_t of : motion.point) has_point[track.frame[of]] = true;
  for (const SeriesPart& part : parts_of(to.input)) {
    const double from = to.input.t_s[part.first], until = to.input.t_s[part.first + part.count - 1];
    for (std::size_t f = 0; f < frames.size(); ++f) {
      if (has_point[f] || frames[f].t_s <= from || frames[f].t_s >= until) continue;
      to.frame.push_back(f);
      to.input.at_s.push_back(frames[f].t_s);
    }
  }
}

void fill_frame(const SmoothedState& state, double force_a_m_s2, double mass_kg, MotionPoint& frame) {
  frame.smoothed = true;
  frame.x_m = state.x_m;
  frame.v_m_s = state.v_m_s;
  frame.a_m_s2 = state.a_m_s2;
  frame.sd_x_m = state.sd_x_m;
  frame.sd_v_m_s = state.sd_v_m_s;
  frame.sd_a_m_s2 = state.sd_a_m_s2;
  frame.force_n = mass_kg * force_a_m_s2;
}

/// Leaves out points that are too uncertain, at the ends of a stretch or around a gap: the points at its start, at its
/// end, and in between.
void leave_out(const FreeStretch& stretch, double most_sd_m_s2, const std::vector<double>& sd_m_s2, std::size_t from,
               std::vector<StretchPoint>& points) {
  const std::size_t to = points.size();
  // If all of a is well known compared with its range, all points count.
  constexpr double kMostSdOverRange = 0.02;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t j = from; j < to; ++j) {
    if (!points[j].smoothed) continue;
    low = std::min(low, points[j].y.a_m_s2);
    high = std::max(high, points[j].y.a_m_s2);
  }
  const double most = std::max(most_sd_m_s2, kMostSdOverRange * (high - low));
  const auto bad = [&](std::size_t j) { return !(sd_m_s2[points[j].point] <= most); };
  std::size_t start = from, end = to;
  while (start < to && bad(start)) ++start;
  while (end > start && bad(end - 1)) --end;
  for (std::size_t j = from; j < to; ++j) {
    StretchPoint& point = points[j];
    if (stretch.whole != LeftOut::used) {
      point.left_out = stretch.whole;
    } else if (j < start) {
      point.left_out = stretch.start;
    } else if (j >= end) {
      point.left_out = stretch.end;
    } else if (bad(j)) {
      point.left_out = LeftOut::kernel_gap;
    } else if (point.x.v_m_s * stretch.direction <= 0.0) {
      point.left_out = LeftOut::kernel_reversal;
    }
  }
}

}  // namespace

std::vector<PointRange> pieces_of(const std::vector<FreeStretch>& stretches, std::size_t points) {
  std::vector<PointRange> pieces;
  std::size_t next = 0;
  for (const FreeStretch& stretch : stretches) {
    if (stretch.first > next) pieces.push_back({next, stretch.first});
    next = stretch.first + stretch.count;
    pieces.push_back({stretch.first, next});
  }
  if (points > next) pieces.push_back({next, points});
  return pieces;
}

std::vector<MotionPoint> measured_frames(const TrackData& track) {
  std::vector<MotionPoint> frames(track.frame_t_s.size());
  for (std::size_t f = 0; f < frames.size(); ++f) frames[f].t_s = track.frame_t_s[f];
  for (std::size_t i = 0; i < track.t_s.size(); ++i) {
    frames[track.frame[i]].t_s = track.t_s[i];  // of the marker's row, with a rolling shutter
    frames[track.frame[i]].measured_m = track.x_m[i];
  }
  return frames;
}

SmoothedWhole smooth_whole(const Smoother& smoother, const TrackData& track, const Motion& motion,
                           const FreeMotion& free, double mass_kg) {
  SmoothedWhole whole;
  whole.frames = measured_frames(track);
  Gathered of_free, of_rest;
  std::vector<bool> is_free(motion.t_s.size(), false);
  for (std::size_t s = 0; s < free.stretches.size(); ++s) {
    const FreeStretch& stretch = free.stretches[s];
    const PointRange range{stretch.first, stretch.first + stretch.count};
    add(motion, range, s > 0 && turns_into(free.stretches[s - 1], stretch), of_free);
    fill_range(is_free, range, true);
  }
  for (const PointRange& piece : pieces_of(free.stretches, motion.t_s.size())) {
    if (!is_free[piece.from]) add(motion, piece, false, of_rest);
  }

  std::vector<MotionShift> without_rate(motion.t_s.size());
  std::vector<std::optional<KernelRow>> held_rows(motion.t_s.size());
  bool holds_rate = true;
  bool has_no_rate = false;
  std::vector<double> sd_m_s2(motion.t_s.size(), std::numeric_limits<double>::infinity());
  std::vector<StretchPoint> smoothed(motion.t_s.size());
  for (Gathered* gathered : {&of_free, &of_rest}) {
    if (gathered->point.empty()) continue;
    want_other_frames(track, motion, whole.frames, *gathered);
    gathered->input.rows = gathered == &of_free;
    gathered->input.rate_in_rows = !motion.forced;  // x of a driven motion is smoothed by the weights of y
    gathered->input.simultaneous = gathered == &of_free;
    if (motion.forced) {
      for (const std::size_t i : gathered->point) gathered->input.along_m.push_back(motion.x_m[i]);
    }
    const SmoothedSeries series = smoother.smooth(gathered->input);
    if (gathered == &of_free) whole.strength = series.strength;
    // Rows are over the points given to the smoother; there may be others between two parts.
    const auto in_motion = [&](std::optional<KernelRow> row) {
      if (!row) return row;
      const std::size_t from = row->first, last = from + row->weights->a.size() - 1;
      row->first = gathered->point[from];
      const std::size_t size = gathered->point[last] - row->first + 1;
      if (size == row->weights->a.size()) return row;
      KernelWeights spread{std::vector<double>(size), std::vector<double>(size), std::vector<double>(size)};
      for (std::size_t i = from; i <= last; ++i) {
        const std::size_t to = gathered->point[i] - row->first;
        spread.x[to] = row->weights->x[i - from];
        spread.v[to] = row->weights->v[i - from];
        spread.a[to] = row->weights->a[i - from];
      }
      row->weights = std::make_shared<const KernelWeights>(std::move(spread));
      return row;
    };
    for (std::size_t j = 0; j < gathered->point.size(); ++j) {
      if (!series.points[j]) continue;
      const SmoothedState& y = *series.points[j];
      const std::size_t i = gathered->point[j];
      StretchPoint& point = smoothed[i];
      if (gathered->input.rows) point.row = in_motion(series.rows[j]);
      if (!series.held_rows.empty()) {
        held_rows[i] = in_motion(series.held_rows[j]);
        holds_rate = false;
      }
      if (!series.with_rate.empty() && series.with_rate[j]) {
        without_rate[i] = {y.v_m_s - series.with_rate[j]->v_m_s, y.a_m_s2 - series.with_rate[j]->a_m_s2};
        has_no_rate = true;
      }
      const SmoothedState& x = motion.forced ? *series.along[j] : y;
      point.smoothed = true;
      point.x = {x.x_m, x.v_m_s, x.a_m_s2};
      point.y = {y.x_m, y.v_m_s, y.a_m_s2};
      sd_m_s2[i] = y.sd_a_m_s2;
      fill_frame(x, x.a_m_s2 - y.a_m_s2, mass_kg, whole.frames[track.frame[motion.point[i]]]);
    }
    for (std::size_t j = 0; j < gathered->frame.size(); ++j) {
      if (!series.at[j]) continue;
      const SmoothedState& y = *series.at[j];
      const SmoothedState& x = motion.forced ? *series.along_at[j] : y;
      fill_frame(x, x.a_m_s2 - y.a_m_s2, mass_kg, whole.frames[gathered->frame[j]]);
    }
  }

  // By direction: where a is constant in each, the one that lasts less long is known less well at all of its points.
  const auto most_of = [&](int direction) {
    std::vector<double> typical;
    for (const FreeStretch& stretch : free.stretches) {
      if (stretch.direction != direction) continue;
      const auto first = sd_m_s2.begin() + static_cast<std::ptrdiff_t>(stretch.first);
      typical.insert(typical.end(), first, first + static_cast<std::ptrdiff_t>(stretch.count));
    }
    return typical.empty() ? 0.0 : std::sqrt(kEndVariance) * median_of(std::move(typical));
  };
  const double most_minus = most_of(-1), most_plus = most_of(1);
  for (std::size_t s = 0; s < free.stretches.size(); ++s) {
    const FreeStretch& stretch = free.stretches[s];
    const std::size_t from = whole.points.size();
    for (std::size_t i = stretch.first; i < stretch.first + stretch.count; ++i) {
      StretchPoint& point = smoothed[i];
      point.point = i;
      point.stretch = s;
      point.direction = stretch.direction;
      whole.points.push_back(std::move(point));
      if (has_no_rate) whole.without_rate.push_back(without_rate[i]);
      if (!holds_rate) whole.held_rows.push_back(std::move(held_rows[i]));
    }
    leave_out(stretch, stretch.direction < 0 ? most_minus : most_plus, sd_m_s2, from, whole.points);
  }
  return whole;
}

std::vector<double> own_law(const std::vector<double>& pilot_m_s2, const SmoothedWhole& whole) {
  const auto under_rate = [&](std::size_t j) {
    return j < whole.without_rate.size() ? whole.without_rate[j] : MotionShift{};
  };
  std::vector<double> law = pilot_m_s2;
  for (const int direction : {-1, 1}) {
    LineSums sums;
    for (std::size_t j = 0; j < whole.points.size(); ++j) {
      const StretchPoint& point = whole.points[j];
      if (point.direction != direction || point.left_out != LeftOut::used || !point.row) continue;
      sums.add(1.0, point.x.v_m_s - under_rate(j).v_m_s, point.y.a_m_s2 - under_rate(j).a_m_s2);
    }
    if (!sums.is_regular(kLeastDeterminant)) continue;
    for (std::size_t j = 0; j < whole.points.size(); ++j) {
      const StretchPoint& point = whole.points[j];
      if (point.direction != direction || !point.smoothed) continue;
      law[point.point] = sums.intercept() + sums.slope() * (point.x.v_m_s - under_rate(j).v_m_s);
    }
  }
  return law;
}

std::vector<double> smoothing_bias(const Motion& motion, const std::vector<FreeStretch>& stretches,
                                   const std::vector<double>& law_m_s2, const SmoothedWhole& whole) {
  std::vector<double> place(motion.t_s.size(),
                            0.0);  // double integral of the law, restarted where the motion does not continue
  std::size_t next_break = 0;
  const std::vector<double>& breaks_s = whole.strength.breaks_s;
  double v = 0.0, x = 0.0;
  for (std::size_t s = 0; s < stretches.size(); ++s) {
    const FreeStretch& stretch = stretches[s];
    const bool goes_on = s > 0 && turns_into(stretches[s - 1], stretch);
    if (!goes_on) v = x = 0.0;
    for (std::size_t i = stretch.first + (goes_on ? 0 : 1); i < stretch.first + stretch.count; ++i) {
      const double from = motion.t_s[i - 1], to = motion.t_s[i];
      while (next_break < breaks_s.size() && breaks_s[next_break] <= from) ++next_break;
      if (next_break < breaks_s.size() && breaks_s[next_break] <= to) {
        const double before = breaks_s[next_break] - from, after = to - breaks_s[next_break];
        x += v * before + 0.5 * before * before * law_m_s2[i - 1];
        v += before * law_m_s2[i - 1];
        x += v * after + 0.5 * after * after * law_m_s2[i];
        v += after * law_m_s2[i];
      } else {
        const double dt = to - from;
        x += v * dt + dt * dt * (2.0 * law_m_s2[i - 1] + law_m_s2[i]) / 6.0;
        v += 0.5 * dt * (law_m_s2[i - 1] + law_m_s2[i]);
      }
      place[i] = x;
    }
  }
  std::vector<double> bias;
  for (std::size_t j = 0; j < whole.points.size(); ++j) {
    const std::optional<KernelRow>& row = whole.held_rows.empty() ? whole.points[j].row : whole.held_rows[j];
    bias.push_back(row ? weighted_sums(*row, place).a_m_s2 - law_m_s2[whole.points[j].point] : 0.0);
  }
  return bias;
}

}  // namespace glidelab::core
