#include "core/motion/speed_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "base/errors.h"
#include "core/math/quantile.h"
#include "core/motion/bandwidth/bandwidth_rule.h"
#include "core/motion/bandwidth/rule_lines.h"
#include "core/motion/free/free_motion.h"
#include "core/motion/free/motion_events.h"
#include "core/motion/lines/line_fit.h"
#include "core/motion/smooth_clip.h"
#include "core/motion/smoothing/local_polynomial.h"
#include "core/motion/smoothing/smoother_list.h"

namespace glidelab::core {
namespace {

constexpr double kSlopeVariance = 0.4849;                 // of a, see the header
constexpr double kPilotNoise = 0.1;                       // of a, over the median |a| of the moving body
constexpr double kMovingShare = 0.1;                      // of the highest speed: slower is not "moving"
constexpr double kWidestPilot = 0.05;                     // of the clip
constexpr double kSurelyMoves = 3.0;                      // standard deviations of one speed
constexpr double kBesideTurn = 1.0, kBesideOthers = 2.0;  // pilot bandwidths
constexpr double kOffLine = 0.25;                         // of the line's size
// Of the longest stretch. From measured speeds the standard deviation of a goes with T^-3/2, not with T^-5/2 as from
// positions (free_motion.h); it is four times that of the longest where T is 4^(-2/3) of it.
constexpr double kShortStretch = 0.40;
constexpr double kWidestKernel = 0.2;        // of the longest stretch
constexpr double kPointsPerBandwidth = 3.0;  // closer points add no information
constexpr double kMostWeights = 2e7;         // of all rows together: half a gigabyte

[[noreturn]] void refuse(const std::string& clip, const char* what, const std::string& found,
                         const std::string& expected) {
  throw base::InputError(base::Issue{"", 0, fmt::format("clip \"{}\": {}", clip, what), found, expected});
}

void check_options(const ClipSetup& setup, const TrackData& track, const MotionOptions& options) {
  if (options.lines != LineMethod::ordinary) {
    refuse(setup.name, "estimator", fmt::format("{} for speeds without positions", name_of(options.lines)),
           fmt::format("--estimator {}", name_of(LineMethod::ordinary)));
  }
  if (options.smoother != kLocalPolynomial) {
    refuse(setup.name, "smoother", fmt::format("\"{}\" for speeds without positions", options.smoother),
           fmt::format("--smoother {}", kLocalPolynomial));
  }
  if (!options.bandwidth_rule.empty()) {
    refuse(setup.name, "bandwidth", fmt::format("the rule \"{}\" for speeds without positions", options.bandwidth_rule),
           "seconds, or no --bandwidth: it is then chosen for the lines");
  }
  const double duration_s = track.t_s.back() - track.t_s.front();
  if (options.bandwidth_s && *options.bandwidth_s > duration_s) {
    refuse(setup.name, "bandwidth", fmt::format("{:.6g} s", *options.bandwidth_s),
           fmt::format("at most {:.6g} s, what the clip lasts", duration_s));
  }
}

/// The speeds as a series for what works on any series: outliers, kernels, noise. Its x_m and y_m are the speeds.
Motion series_of(const TrackData& track) {
  Motion series{track.t_s, track.v_m_s, track.v_m_s, {}, median_step(track.t_s), 0.0, false};
  series.point.resize(track.t_s.size());
  std::iota(series.point.begin(), series.point.end(), std::size_t{0});
  series.noise_m = pilot_noise(series.t_s, series.x_m);
  const double rounding = 1e-12;  // of the largest speed: a few thousand epsilon
  for (const double v : series.x_m) series.noise_m = std::max(series.noise_m, rounding * std::abs(v));
  return series;
}

double sd_of_slope(const Motion& series, double bandwidth_s) {
  return series.noise_m * std::sqrt(kSlopeVariance * series.step_s / std::pow(bandwidth_s, 3));
}

/// v and a of the points from `range`'s own points.
struct States {
  std::vector<double> v_m_s, a_m_s2;  ///< NaN where the points do not determine them
};

States smooth(const Motion& series, const PointRange& range, double bandwidth_s) {
  States states;
  const LocalCubic cubic(std::span(series.t_s).subspan(range.from, range.size()), bandwidth_s);
  for (const auto& point : cubic.smooth(std::span(series.x_m).subspan(range.from, range.size()))) {
    states.v_m_s.push_back(point ? point->x_m : std::numeric_limits<double>::quiet_NaN());
    states.a_m_s2.push_back(point ? point->v_m_s : std::numeric_limits<double>::quiet_NaN());
  }
  return states;
}

std::size_t stride_of(const Motion& series, double bandwidth_s) {
  return static_cast<std::size_t>(std::max(1.0, std::floor(bandwidth_s / (kPointsPerBandwidth * series.step_s))));
}

double pilot_bandwidth(const Motion& series) {
  const double widest = kWidestPilot * (series.t_s.back() - series.t_s.front());
  double h = kLeastBandwidthSteps * series.step_s;
  for (; h * kBandwidthRatio < widest; h *= kBandwidthRatio) {
    const LocalCubic cubic(series.t_s, h);
    std::vector<SmoothedPoint> states;  // x_m is v, v_m_s is a
    double top = 0.0;
    for (std::size_t i = 0; i < series.t_s.size(); i += stride_of(series, h)) {
      const auto row = cubic.row_of_point(i);
      if (!row) continue;
      states.push_back(weighted_sums(*row, series.x_m));
      top = std::max(top, std::abs(states.back().x_m));
    }
    std::vector<double> moving;
    for (const SmoothedPoint& of : states) {
      if (std::abs(of.x_m) > kMovingShare * top) moving.push_back(std::abs(of.v_m_s));
    }
    if (!moving.empty() && sd_of_slope(series, h) <= kPilotNoise * median_of(std::move(moving))) break;
  }
  return h;
}

class FreeSpeeds {
 public:
  FreeSpeeds(const Motion& series, const ClipSetup& setup) : series_(series), setup_(setup) {
    free_.pilot_bandwidth_s = pilot_bandwidth(series);
    free_.reason.assign(series.t_s.size(), LeftOut::rest);
    law_m_s2.assign(series.t_s.size(), 0.0);
    agrees_.assign(series.t_s.size(), Agrees::unknown);
    const std::vector<Run> runs = runs_of_one_direction();
    for (const int direction : {-1, 1}) compare(runs, direction);
    trust_statements(runs);
    for (const Run& run : runs) add_stretches(run);
    if (!setup_.start_s) {
      const std::size_t first = free_.stretches.empty() ? 0 : free_.stretches.front().first;
      std::replace(free_.reason.begin(), free_.reason.begin() + static_cast<std::ptrdiff_t>(first), LeftOut::stop,
                   LeftOut::hand);
    }
    leave_out_backswing();
    leave_out_short();
  }

  FreeMotion free() && { return std::move(free_); }
  std::vector<double> law_m_s2;  ///< a of the line of most points, at each free point

 private:
  struct Run {
    PointRange range;
    int direction = 0;  ///< of the smoothed speeds
  };
  enum class Agrees : char { unknown, no, yes };  // with the line of most points of its direction

  /// Where the sign of v is beyond doubt, within start_s and end_s.
  std::vector<Run> runs_of_one_direction() {
    const double h = free_.pilot_bandwidth_s;
    const States pilot = smooth(series_, {0, series_.t_s.size()}, h);
    const double still = kSurelyMoves * series_.noise_m;
    std::vector<int> sign(series_.t_s.size(), 0);
    for (std::size_t i = 0; i < sign.size(); ++i) {
      const double t = series_.t_s[i], v = pilot.v_m_s[i];
      if (setup_.start_s && t < *setup_.start_s) {
        free_.reason[i] = LeftOut::before_start;
      } else if (setup_.end_s && t > *setup_.end_s) {
        free_.reason[i] = LeftOut::after_end;
      } else if (std::abs(v) > still) {
        sign[i] = v > 0.0 ? 1 : -1;
      }
    }
    std::vector<Run> runs;
    for (PointRange range : ranges_of(sign)) {
      const int direction = sign[range.from];
      if (direction == 0) continue;
      const double from = series_.t_s[range.from], to = series_.t_s[range.to - 1];
      const bool begins = range.from == 0 || free_.reason[range.from - 1] == LeftOut::before_start;
      const bool ends = range.to == sign.size() || free_.reason[range.to] == LeftOut::after_end;
      while (!begins && range.from < range.to && series_.t_s[range.from] < from + kBesideTurn * h) {
        free_.reason[range.from++] = LeftOut::kernel_reversal;
      }
      while (!ends && range.to > range.from && series_.t_s[range.to - 1] > to - kBesideTurn * h) {
        free_.reason[--range.to] = LeftOut::kernel_reversal;
      }
      if (range.size() >= kFewestLinePoints) runs.push_back({range, direction});
    }
    return runs;
  }

  /// Which points of the runs of one direction agree with one line.
  void compare(const std::vector<Run>& runs, int direction) {
    const double h = free_.pilot_bandwidth_s;
    LawPoints points;
    std::vector<std::size_t> at;
    RowVariance variance({series_.noise_m * series_.noise_m});
    for (const auto& [run, of_run] : runs) {
      if (of_run != direction) continue;
      const std::span t = std::span(series_.t_s).subspan(run.from, run.size());
      const LocalCubic cubic(t, h);
      for (std::size_t j = 0; j < run.size(); ++j) {
        const auto row = cubic.row_of_point(j);
        if (!row) continue;
        const SmoothedPoint of = weighted_sums(*row, std::span(series_.x_m).subspan(run.from, run.size()));
        points.v_m_s.push_back(of.x_m);
        points.a_m_s2.push_back(of.v_m_s);
        points.sd_m_s2.push_back(std::sqrt(variance.of_v(*row)));
        at.push_back(run.from + j);
      }
    }
    const std::optional<ConsensusLine> line = find_consensus(points);
    if (!line) return;
    for (std::size_t j = 0; j < at.size(); ++j) {
      const double off = std::abs(points.a_m_s2[j] - line->at(points.v_m_s[j]));
      const bool agrees = off <= kOffLine * line->size_m_s2 || off <= line->tolerance(points.sd_m_s2[j]);
      agrees_[at[j]] = agrees ? Agrees::yes : Agrees::no;
      law_m_s2[at[j]] = line->at(points.v_m_s[j]);
    }
  }

  /// After a stated start nothing is a hand, and before a stated end nothing is a stop: what comes before the first
  /// part that agrees is free, and so is what follows the last.
  void trust_statements(const std::vector<Run>& runs) {
    if (!setup_.start_s && !setup_.end_s) return;
    std::size_t first = agrees_.size(), last = 0;
    for (const Run& run : runs) {
      for (const PointRange& part : parts_of_run(run)) {
        if (agrees_[part.from] != Agrees::yes || !is_long(part)) continue;
        first = std::min(first, part.from);
        last = std::max(last, part.to);
      }
    }
    for (std::size_t i = 0; i < agrees_.size(); ++i) {
      const bool stated =
          (setup_.start_s && i < first) || (setup_.end_s && i >= last) || (setup_.start_s && setup_.end_s);
      if (agrees_[i] == Agrees::no && stated) agrees_[i] = Agrees::yes;
    }
  }

  /// Whether something is left of a part after its borders to others are taken away: noise alone agrees for a moment.
  bool is_long(const PointRange& part) const {
    const double lasts_s = series_.t_s[part.to - 1] - series_.t_s[part.from];
    return part.size() >= kFewestLinePoints && lasts_s > 2.0 * kBesideOthers * free_.pilot_bandwidth_s;
  }

  std::vector<PointRange> parts_of_run(const Run& run) const {
    const auto at = [&](std::size_t i) { return agrees_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::vector<PointRange> parts = ranges_of(std::vector<Agrees>(at(run.range.from), at(run.range.to)));
    for (PointRange& part : parts) part = {part.from + run.range.from, part.to + run.range.from};
    return parts;
  }

  void add_stretches(const Run& of) {
    const auto& [run, direction] = of;
    const double h = free_.pilot_bandwidth_s;
    for (PointRange range : parts_of_run(of)) {
      if (agrees_[range.from] != Agrees::yes) {
        fill_range(free_.reason, range, LeftOut::stop);
        continue;
      }
      const double from = series_.t_s[range.from], to = series_.t_s[range.to - 1];
      const bool begins = range.from == run.from, ends = range.to == run.to;
      while (!begins && range.from < range.to && series_.t_s[range.from] < from + kBesideOthers * h) {
        free_.reason[range.from++] = LeftOut::stop;
      }
      while (!ends && range.to > range.from && series_.t_s[range.to - 1] > to - kBesideOthers * h) {
        free_.reason[--range.to] = LeftOut::stop;
      }
      if (range.size() < kFewestLinePoints) {
        fill_range(free_.reason, range, LeftOut::short_stretch);
        continue;
      }
      fill_range(free_.reason, range, LeftOut::used);
      FreeStretch stretch;
      stretch.first = range.from;
      stretch.count = range.size();
      stretch.direction = direction;
      free_.stretches.push_back(stretch);
    }
  }

  /// The motion before the first one in the direction of the launch, if there is one and that direction is stated.
  void leave_out_backswing() {
    if (setup_.start_s) return;
    if (setup_.launched != Launched::up && setup_.launched != Launched::down) return;
    const int launch = setup_.launched == Launched::down ? 1 : -1;
    const auto first = std::ranges::find(free_.stretches, launch, &FreeStretch::direction);
    if (first == free_.stretches.end()) return;
    for (auto stretch = free_.stretches.begin(); stretch != first; ++stretch) {
      fill_range(free_.reason, {stretch->first, stretch->first + stretch->count}, LeftOut::hand);
    }
    free_.stretches.erase(free_.stretches.begin(), first);
  }

  void leave_out_short() {
    const auto duration = [&](const FreeStretch& of) {
      return series_.t_s[of.first + of.count - 1] - series_.t_s[of.first];
    };
    double longest[2] = {};
    for (const FreeStretch& of : free_.stretches) {
      longest[of.direction > 0] = std::max(longest[of.direction > 0], duration(of));
    }
    for (FreeStretch& of : free_.stretches) {
      if (duration(of) < kShortStretch * longest[of.direction > 0]) of.whole = LeftOut::short_stretch;
    }
  }

  const Motion& series_;
  const ClipSetup& setup_;
  FreeMotion free_;
  std::vector<Agrees> agrees_;  // of every point
};

/// The stretches' points with rows over the speeds: their v and a, in place of x and v of a series.
std::vector<StretchPoint> speed_points(const Motion& series, const std::vector<FreeStretch>& stretches,
                                       double bandwidth_s, std::size_t stride, WantedPoints wanted) {
  std::vector<StretchPoint> points = smooth_stretches(series, stretches, bandwidth_s, stride, wanted);
  std::shared_ptr<const KernelWeights> known, as_speeds;  // points that share a filter share it afterwards
  for (StretchPoint& point : points) {
    if (!point.row) continue;
    if (point.row->weights != known) {
      known = point.row->weights;
      as_speeds = std::make_shared<const KernelWeights>(
          KernelWeights{std::vector<double>(known->x.size(), 0.0), known->x, known->v});
    }
    point.row->weights = as_speeds;
    point.x = point.y = {0.0, point.x.x_m, point.x.v_m_s};
    if (point.left_out == LeftOut::kernel_reversal) point.left_out = LeftOut::used;
    if (point.left_out == LeftOut::used && point.x.v_m_s * point.direction <= 0.0) {
      point.left_out = LeftOut::kernel_reversal;
    }
  }
  return points;
}

/// All points of the stretches. Each point of irregular times has weights of its own; where these would be too many,
/// only some points have them, and the others are in no line.
std::vector<StretchPoint> all_speed_points(const Motion& series, const std::vector<FreeStretch>& stretches,
                                           double bandwidth_s) {
  double weights = 0.0;
  for (const FreeStretch& of : stretches) {
    const auto count = static_cast<double>(of.count);
    weights += count * std::min(count, 2.0 * kKernelReach * bandwidth_s / series.step_s);
  }
  const std::size_t stride = weights > kMostWeights ? stride_of(series, bandwidth_s) : 1;
  std::vector<StretchPoint> some = speed_points(series, stretches, bandwidth_s, stride, WantedPoints::all);
  if (stride == 1) return some;
  std::vector<StretchPoint> points;
  for (StretchPoint& point : some) {
    const FreeStretch& of = stretches[point.stretch];
    StretchPoint like = point;
    like.row.reset();
    const std::size_t until = std::min(point.point + stride, of.first + of.count);
    points.push_back(std::move(point));
    while (++like.point < until) points.push_back(like);
  }
  return points;
}

/// The error of a where a follows `law` over time: speeds that do are smoothed as the measured ones are.
std::vector<double> bias_of(const Motion& series, const std::vector<FreeStretch>& stretches,
                            const std::vector<double>& law_m_s2, const std::vector<StretchPoint>& points) {
  std::vector<double> speed(series.t_s.size(), 0.0);
  for (const FreeStretch& stretch : stretches) {
    for (std::size_t i = stretch.first + 1; i < stretch.first + stretch.count; ++i) {
      speed[i] = speed[i - 1] + 0.5 * (series.t_s[i] - series.t_s[i - 1]) * (law_m_s2[i - 1] + law_m_s2[i]);
    }
  }
  std::vector<double> bias;
  for (const StretchPoint& point : points) {
    bias.push_back(point.row ? weighted_sums(*point.row, speed).a_m_s2 - law_m_s2[point.point] : 0.0);
  }
  return bias;
}

PositionNoise noise_of(const Motion& series, const std::vector<FreeStretch>& stretches, double bandwidth_s) {
  std::vector<LocalCubic> cubics;
  std::vector<NoisePiece> pieces;
  cubics.reserve(stretches.size());
  for (const FreeStretch& stretch : stretches) {
    cubics.emplace_back(std::span(series.t_s).subspan(stretch.first, stretch.count), bandwidth_s);
    pieces.push_back({&cubics.back(), std::span(series.x_m).subspan(stretch.first, stretch.count)});
  }
  return estimate_noise(pieces, series.noise_m);
}

std::vector<LineFit> lines_of(const Motion& series, const FreeMotion& free, const std::vector<double>& law_m_s2,
                              const std::vector<StretchPoint>& points, const PositionNoise& noise, Misfit misfit) {
  const std::vector<double> bias = bias_of(series, free.stretches, law_m_s2, points);
  std::vector<LineFit> lines;
  for (const int direction : {-1, 1}) {
    const LineInput input = line_input(series, points, bias, direction, 0.0, 0.0);
    if (auto line = fit_line(direction, input, noise.autocovariance, 0.0, misfit)) lines.push_back(std::move(*line));
  }
  return lines;
}

/// The bandwidth of the least mean square error of the lines, noise and bias together, averaged from v = 0 to the
/// highest speed of the line.
BandwidthChoice choose(const Motion& series, const FreeMotion& free, const std::vector<double>& law_m_s2) {
  BandwidthChoice choice{free.pilot_bandwidth_s, chosen_by::FirstSmoothing{}};
  const PositionNoise noise = noise_of(series, free.stretches, free.pilot_bandwidth_s);
  double longest_s = 0.0, least = std::numeric_limits<double>::infinity();
  for (const FreeStretch& of : free.stretches) {
    longest_s = std::max(longest_s, series.t_s[of.first + of.count - 1] - series.t_s[of.first]);
  }
  std::size_t directions = 0;
  for (double h = kLeastBandwidthSteps * series.step_s; h < kWidestKernel * longest_s; h *= kBandwidthRatio) {
    const auto points = speed_points(series, free.stretches, h, stride_of(series, h), WantedPoints::inner);
    const auto lines = lines_of(series, free, law_m_s2, points, noise, Misfit::ignored);
    double square = 0.0;
    for (const LineFit& line : lines) {
      const double v = std::max(std::abs(line.from_v_m_s), std::abs(line.to_v_m_s)) * line.direction;
      const LineUncertainty& of = line.parts;
      const double kk = of.var_k + of.smoothing_k * of.smoothing_k, ka = of.cov + of.smoothing_k * of.smoothing_a0,
                   aa = of.var_a0 + of.smoothing_a0 * of.smoothing_a0;
      square += aa - v * ka + v * v / 3.0 * kk;
    }
    if (lines.size() < directions || lines.empty()) continue;
    if (lines.size() > directions || square < least) {
      least = square;
      choice = {h, chosen_by::LinesRule{h, {}}};
    }
    directions = lines.size();
  }
  return choice;
}

/// Every frame with v and a of the points of its own stretch, or of the gap between two stretches; no x.
std::vector<MotionPoint> smoothed_frames(const SmoothedClip& clip) {
  std::vector<MotionPoint> frames(clip.track.frame_t_s.size());
  for (std::size_t f = 0; f < frames.size(); ++f) frames[f].t_s = clip.track.frame_t_s[f];
  RowVariance variance(clip.noise.autocovariance);
  std::size_t f = 0;
  for (const PointRange& piece : pieces_of(clip.free.stretches, clip.motion.t_s.size())) {
    const std::span t = std::span(clip.motion.t_s).subspan(piece.from, piece.size());
    const std::span v = std::span(clip.motion.x_m).subspan(piece.from, piece.size());
    const LocalCubic cubic(t, clip.bandwidth_s);
    while (f < frames.size() && frames[f].t_s < t.front()) ++f;
    for (; f < frames.size() && frames[f].t_s <= t.back(); ++f) {
      const auto row = cubic.row(frames[f].t_s);
      if (!row) continue;
      const SmoothedPoint of = weighted_sums(*row, v);
      frames[f].smoothed = true;
      frames[f].v_m_s = of.x_m;
      frames[f].a_m_s2 = of.v_m_s;
      frames[f].sd_v_m_s = std::sqrt(variance.of_x(*row));
      frames[f].sd_a_m_s2 = std::sqrt(variance.of_v(*row));
    }
  }
  return frames;
}

}  // namespace

ClipResult analyze_speeds(const ClipSetup& setup, const TrackData& track, const MotionOptions& options) {
  check_options(setup, track, options);
  ClipResult clip;
  clip.name = setup.name;
  clip.frames = track.frame_t_s.size();
  clip.detected = track.t_s.size();
  clip.frame_rate_hz = track.frame_rate_hz;
  clip.notes = track.notes;

  const Motion measured = series_of(track);
  const std::vector<std::size_t> outliers = find_outliers(measured);
  const Motion series = without(measured, outliers);
  FreeSpeeds found(series, setup);
  const std::vector<double> law_m_s2 = std::move(found.law_m_s2);
  const FreeMotion free = std::move(found).free();
  const BandwidthChoice choice =
      options.bandwidth_s ? BandwidthChoice{*options.bandwidth_s, chosen_by::User{}} : choose(series, free, law_m_s2);
  clip.bandwidth_s = choice.bandwidth_s;
  clip.bandwidth_method = choice.method;
  const PositionNoise noise = noise_of(series, free.stretches, choice.bandwidth_s);
  clip.speed_noise_m_s = noise.sd_m;
  const std::vector<StretchPoint> points = all_speed_points(series, free.stretches, choice.bandwidth_s);
  clip.segments = lines_of(series, free, law_m_s2, points, noise, Misfit::widens);
  clip.v_lim_m_s = limit_velocity(clip.segments);

  const SmoothedClip smoothed{track, series, free, noise, points, choice.bandwidth_s, setup.mass_kg};
  clip.motion = frames_of(smoothed, smoothed_frames(smoothed));
  clip.left_out = intervals_of(clip.motion);
  clip.stretches = used_stretches(smoothed);
  if (!outliers.empty()) clip.notes.emplace_back(OutliersLeftOut{outliers.size(), clip.detected});
  for (const LineFit& line : clip.segments) {
    if (!std::isinf(line.parts.degrees)) clip.notes.emplace_back(LineScatters{line.direction, line.parts.scatter});
  }
  return clip;
}

}  // namespace glidelab::core
