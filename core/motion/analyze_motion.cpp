#include "core/motion/analyze_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>
#include <utility>

#include "base/errors.h"
#include "base/text/number_text.h"
#include "core/math/quantile.h"
#include "core/motion/bandwidth/bandwidth_rule.h"
#include "core/motion/bandwidth/rule_lines.h"
#include "core/motion/free/free_motion.h"
#include "core/motion/free/lost_frames.h"
#include "core/motion/free/motion.h"
#include "core/motion/free/stretch_noise.h"
#include "core/motion/lines/gls_line.h"
#include "core/motion/lines/line_fit.h"
#include "core/motion/lines/line_law.h"
#include "core/motion/smooth_clip.h"
#include "core/motion/smoothing/local_polynomial.h"
#include "core/motion/smoothing/noise.h"
#include "core/motion/smoothing/smoother_list.h"

namespace glidelab::core {
namespace {

/// `left_out` is not yet set.
std::vector<MotionPoint> smooth_frames(const SmoothedClip& clip) {
  const TrackData& track = clip.track;
  const Motion& motion = clip.motion;
  std::vector<MotionPoint> frames = measured_frames(track);
  RowVariance variance(clip.noise.autocovariance);
  std::size_t f = 0;
  for (const PointRange& piece : pieces_of(clip.free.stretches, motion.t_s.size())) {
    const std::span t = std::span(motion.t_s).subspan(piece.from, piece.size());
    const std::span x = std::span(motion.x_m).subspan(piece.from, piece.size());
    const std::span y = std::span(motion.y_m).subspan(piece.from, piece.size());
    const LocalCubic cubic(t, clip.bandwidth_s);
    while (f < frames.size() && frames[f].t_s < t.front()) ++f;
    for (; f < frames.size() && frames[f].t_s <= t.back(); ++f) {
      const auto row = cubic.row(frames[f].t_s);
      if (!row) continue;
      MotionPoint& frame = frames[f];
      const SmoothedPoint of_x = weighted_sums(*row, x);
      frame.smoothed = true;
      frame.x_m = of_x.x_m;
      frame.v_m_s = of_x.v_m_s;
      frame.a_m_s2 = of_x.a_m_s2;
      frame.sd_x_m = std::sqrt(variance.of_x(*row));
      frame.sd_v_m_s = std::sqrt(variance.of_v(*row));
      frame.sd_a_m_s2 = std::sqrt(variance.of_a(*row));
      if (motion.forced) frame.force_n = clip.mass_kg * (of_x.a_m_s2 - weighted_sums(*row, y).a_m_s2);
    }
  }
  return frames;
}

}  // namespace

std::vector<MotionPoint> frames_of(const SmoothedClip& clip) {
  return frames_of(clip, smooth_frames(clip));
}

std::vector<MotionPoint> frames_of(const SmoothedClip& clip, std::vector<MotionPoint> frames) {
  const TrackData& track = clip.track;
  const std::vector<std::size_t>& point = clip.motion.point;
  for (MotionPoint& frame : frames) frame.left_out = LeftOut::no_marker;
  for (const std::size_t f : track.frame) frames[f].left_out = LeftOut::outlier;  // unless it is among those kept
  for (std::size_t i = 0; i < track.force_n.size(); ++i) frames[track.frame[i]].applied_n = track.force_n[i];
  for (std::size_t i = 0; i < point.size(); ++i) frames[track.frame[point[i]]].left_out = clip.free.reason[i];
  for (const StretchPoint& of : clip.points) frames[track.frame[point[of.point]]].left_out = of.left_out;
  return frames;
}

std::vector<std::vector<double>> shared_of_frames(const TrackData& track) {
  std::vector<std::vector<double>> shared_m(track.shared_m.size());
  for (std::size_t mode = 0; mode < shared_m.size(); ++mode) {
    if (track.shared_m[mode].empty()) continue;
    shared_m[mode].resize(track.frame_t_s.size(), 0.0);
    for (std::size_t i = 0; i < track.frame.size(); ++i) shared_m[mode][track.frame[i]] = track.shared_m[mode][i];
  }
  return shared_m;
}

std::vector<LeftOutInterval> intervals_of(const std::vector<MotionPoint>& frames) {
  std::vector<LeftOutInterval> intervals;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    if (frames[f].left_out == LeftOut::used) continue;
    if (f == 0 || frames[f].left_out != frames[f - 1].left_out) {
      intervals.push_back({frames[f].t_s, frames[f].t_s, 0, frames[f].left_out});
    }
    intervals.back().to_s = frames[f].t_s;
    ++intervals.back().frames;
  }
  return intervals;
}

std::vector<Stretch> used_stretches(const SmoothedClip& clip) {
  const std::vector<double>& t_s = clip.motion.t_s;
  std::vector<Stretch> stretches;
  for (const FreeStretch& stretch : clip.free.stretches) {
    stretches.push_back({t_s[stretch.first], t_s[stretch.first + stretch.count - 1], stretch.direction, 0});
  }
  for (const StretchPoint& point : clip.points) stretches[point.stretch].points += point.left_out == LeftOut::used;
  std::erase_if(stretches, [](const Stretch& stretch) { return stretch.points == 0; });
  return stretches;
}

namespace {

/// Replaces the clip's lines by generalised ones. Either kind may exist where the other does not.
void generalise_lines(const Motion& motion, const FreeMotion& free, GlsInput input, ClipResult& clip) {
  const std::vector<FreePiece> pieces = free_pieces(motion, free, input.bandwidth_s, input.autocovariance);
  const std::vector<LineFit> ordinary = std::exchange(clip.segments, {});
  for (const int direction : {-1, 1}) {
    const auto start = std::find_if(ordinary.begin(), ordinary.end(),
                                    [&](const LineFit& line) { return line.direction == direction; });
    input.k_start_1_s = start != ordinary.end() ? start->k_over_m_1_s.value : 0.0;
    auto line = fit_line_gls(direction, motion, pieces, input);
    if (line) {
      clip.notes.emplace_back(GeneralisedLine{direction, line->points});
      if (start != ordinary.end()) line->r2 = start->r2;  // of the diagram as shown
      clip.segments.push_back(std::move(*line));
    } else if (start != ordinary.end()) {
      clip.notes.emplace_back(NoGeneralisedLine{direction});
    }
  }
}

/// v_lim from the lines with the kernel's bias subtracted.
Quantity recovered_limit(const std::vector<LineFit>& lines) {
  std::vector<LineFit> straight;
  for (const LineFit& line : lines) straight.push_back(without_law_bias(line));
  Quantity limit = limit_velocity(straight);
  const Quantity as_fitted = limit_velocity(lines);
  const bool biased =
      std::any_of(lines.begin(), lines.end(), [](const LineFit& line) { return line.parts.law.has_value(); });
  if (biased && limit.estimate && as_fitted.estimate) {
    limit.smoothing_correction = limit.estimate->value - as_fitted.estimate->value;
  }
  return limit;
}

/// A rule sees y (x without the known force's part) in the stretches that count.
BandwidthChoice by_rule(const std::string& name, const Motion& motion, const FreeMotion& free,
                        const PositionNoise& noise) {
  BandwidthProblem problem;
  problem.noise = noise;
  problem.step_s = motion.step_s;
  for (const FreeStretch& stretch : free.stretches) {
    if (stretch.whole != LeftOut::used) continue;
    problem.parts.push_back({std::span(motion.t_s).subspan(stretch.first, stretch.count),
                             std::span(motion.y_m).subspan(stretch.first, stretch.count)});
  }
  const BandwidthRule* rule = find_bandwidth_rule(name);
  assert(rule);
  const auto pick = rule->choose(problem);
  if (pick) return {pick->bandwidth_s, pick->by};
  return {free.pilot_bandwidth_s, chosen_by::FirstSmoothing{name}};
}

/// InputError if the given bandwidth smooths over more than the clip.
void check_bandwidth(const MotionOptions& options, const std::string& clip, const Motion& motion) {
  if (!options.bandwidth_s || motion.t_s.empty()) return;
  const double duration_s = motion.t_s.back() - motion.t_s.front();
  if (*options.bandwidth_s <= duration_s) return;
  throw base::InputError(base::Issue{"", 0, fmt::format("clip \"{}\": bandwidth", clip),
                                     fmt::format("{:.6g} s", *options.bandwidth_s),
                                     fmt::format("at most {:.6g} s, what the clip lasts", duration_s)});
}

/// The bandwidth given in the options, or chosen by their rule.
BandwidthChoice bandwidth_of(const Motion& motion, const FreeMotion& free, const MotionOptions& options) {
  if (options.bandwidth_s) return {*options.bandwidth_s, chosen_by::User{}};
  const PositionNoise noise = noise_at(motion, free.stretches, free.pilot_bandwidth_s);
  return options.bandwidth_rule.empty() ? choose_bandwidth(motion, free.stretches, noise, free.pilot_bandwidth_s)
                                        : by_rule(options.bandwidth_rule, motion, free, noise);
}

/// What the lines of a clip rest on besides its points.
struct LineWeights {
  std::vector<double> law_m_s2;  ///< f(v(t)) of the first smoothing
  std::vector<double> factors;   ///< of each point's noise; empty: all 1
};

/// Adds to the line's bias what a rate would change in it. The likeliest motion has none wherever its effect hides in
/// the noise; the covariance is that of the motion with a rate.
void add_rate_shift(const SmoothedWhole& whole, const LineInput& input, LineFit& line) {
  if (whole.without_rate.empty()) return;
  LineInput under_rate = input;
  std::size_t of_line = 0;
  for (std::size_t j = 0; j < whole.points.size(); ++j) {
    const StretchPoint& point = whole.points[j];
    if (point.direction != line.direction || point.left_out != LeftOut::used || !point.row) continue;
    under_rate.v_m_s[of_line] -= whole.without_rate[j].v_m_s;
    under_rate.a_m_s2[of_line] -= whole.without_rate[j].a_m_s2;
    ++of_line;
  }
  const auto other = fit_line(line.direction, under_rate, {0.0}, 0.0, Misfit::ignored);
  if (!other) return;
  line.parts.smoothing_k += line.k_over_m_1_s.value - other->k_over_m_1_s.value;
  line.parts.smoothing_a0 += line.a0_m_s2.value - other->a0_m_s2.value;
  complete_line(line);
}

/// The line of each direction that has one, by least squares. The smoothing's bias under the line's own law is known if
/// a stretch is smoothed with its own points alone.
std::vector<LineFit> ordinary_lines(const SmoothedClip& clip, const ClipSetup& setup, const LineWeights& weights,
                                    const SmoothedWhole* whole) {
  const std::vector<double> bias =
      whole != nullptr ? smoothing_bias(clip.motion, clip.free.stretches, own_law(weights.law_m_s2, *whole), *whole)
                       : smoothing_bias(clip.motion, clip.free.stretches, weights.law_m_s2, clip.points);
  std::vector<LineFit> lines;
  std::vector<LineInput> inputs;
  for (const int direction : {-1, 1}) {
    LineInput input = line_input(clip.motion, clip.points, bias, direction, setup.mass_kg, setup.mass_sd_kg);
    input.noise_factor = weights.factors;
    input.calibration = calibration_shifts(clip.motion, input, clip.track.shared_m);
    auto line = fit_line(direction, input, clip.noise.autocovariance, clip.track.scale_sd_relative);
    if (!line || (whole != nullptr && !speed_varies(input, clip.noise.autocovariance))) continue;
    if (whole != nullptr) add_rate_shift(*whole, input, *line);
    if (whole == nullptr) line->parts.law = law_bias(input, *line, clip.noise.autocovariance);
    if (line->parts.law) {
      line->parts.smoothing_k = line->parts.smoothing_a0 = 0.0;
      complete_line(*line);
    }
    lines.push_back(std::move(*line));
    if (whole != nullptr) inputs.push_back(std::move(input));
  }
  if (inputs.size() == 2) {
    const LineCross cross = cross_covariance(inputs[0], lines[0], inputs[1], lines[1], clip.noise.autocovariance);
    lines[0].parts.with_other = cross;
    lines[1].parts.with_other = {cross.k_k, cross.a0_k, cross.k_a0, cross.a0_a0};
  }
  return lines;
}

GlsInput gls_input(const SmoothedClip& clip, const ClipSetup& setup, const LineWeights& weights) {
  GlsInput input;
  input.bandwidth_s = clip.bandwidth_s;
  input.autocovariance = clip.noise.autocovariance;
  input.noise_factor = weights.factors;
  input.scale_sd_relative = clip.track.scale_sd_relative;
  input.mass_kg = setup.mass_kg;
  input.mass_sd_kg = setup.mass_sd_kg;
  input.law_m_s2 = weights.law_m_s2;
  input.shared_m = clip.track.shared_m;
  return input;
}

std::vector<LostFrames> lost_frames(const TrackData& track, double mass_kg) {
  return find_lost_frames(track, motion_of(track, mass_kg));
}

/// start_s and end_s refer to the file's times.
ClipSetup later(ClipSetup setup, const std::vector<LostFrames>& lost, double step_s) {
  if (setup.start_s) setup.start_s = core::put_right(*setup.start_s, lost, step_s);
  if (setup.end_s) setup.end_s = core::put_right(*setup.end_s, lost, step_s);
  return setup;
}

void note_lost_frames(const std::vector<LostFrames>& lost, LostFrameTimes times, std::vector<Note>& notes) {
  if (lost.empty()) return;
  FramesMissing missing;
  missing.put_right = times == LostFrameTimes::put_right;
  for (const LostFrames& gap : lost) {
    missing.frames += gap.count;
    missing.after_s.push_back(gap.after_s);
  }
  notes.emplace_back(std::move(missing));
}

void note_findings(const Motion& motion, std::size_t outliers, const std::vector<double>& factors, LineMethod lines,
                   ClipResult& clip) {
  const std::vector<double>& covariance_m2 = clip.noise_autocovariance_m2;
  if (outliers > 0) clip.notes.emplace_back(OutliersLeftOut{outliers, outliers + motion.t_s.size()});
  if (covariance_m2.size() > 1) clip.notes.emplace_back(CorrelatedNoise{covariance_m2[1] / covariance_m2[0]});
  for (const LineFit& line : clip.segments) {
    if (std::isinf(line.parts.degrees)) continue;
    clip.notes.emplace_back(LineScatters{line.direction, line.parts.scatter});
  }
  if (!factors.empty()) {
    const auto [least, most] = std::minmax_element(factors.begin(), factors.end());
    clip.notes.emplace_back(NoiseGrowsWithSpeed{*least * clip.position_noise_m, *most * clip.position_noise_m});
  }
  if (clip.rounding_m && lines == LineMethod::ordinary) {
    clip.notes.emplace_back(CoarseRounding{*clip.rounding_m, false});
  }
}

}  // namespace

void check_smoothing(const MotionOptions& options) {
  check_smoother(options.smoother, options.bandwidth_s || !options.bandwidth_rule.empty());
  if (options.lines == LineMethod::generalised && !find_smoother(options.smoother)->takes_bandwidth()) {
    throw base::InputError(base::Issue{
        "", 0, "smoother", fmt::format("\"{}\" with the estimator {}", options.smoother, name_of(options.lines)),
        fmt::format("\"{}\": generalised lines are fitted to local cubics of their own", kLocalPolynomial)});
  }
}

ClipResult analyze_motion(const ClipSetup& stated, const TrackData& filed, const MotionOptions& options) {
  assert(filed.v_m_s.empty());
  ClipResult clip;
  clip.lost_frames = lost_frames(filed, stated.mass_kg);
  const bool put_right = options.lost_frames == LostFrameTimes::put_right;
  const ClipSetup setup = put_right ? later(stated, clip.lost_frames, median_step(filed.frame_t_s)) : stated;
  const TrackData track = put_right ? core::put_right(filed, clip.lost_frames) : filed;
  clip.name = setup.name;
  clip.frames = track.frame_t_s.size();
  clip.detected = track.t_s.size();
  clip.frame_rate_hz = track.frame_rate_hz;
  clip.sightings = track.sightings;
  clip.scale_sd_relative = track.scale_sd_relative;
  clip.sensor_column = track.sensor_column;
  clip.notes = track.notes;
  note_lost_frames(clip.lost_frames, options.lost_frames, clip.notes);

  const Motion measured = motion_of(track, setup.mass_kg);
  check_bandwidth(options, setup.name, measured);
  const std::vector<std::size_t> outliers = find_outliers(measured);
  const Motion motion = without(measured, outliers);
  const FreeMotion free = find_free_motion(motion, setup);
  clip.forced = motion.forced;
  clip.against_launch = free.against_launch;
  if (free.against_launch) clip.notes.emplace_back(*free.against_launch);

  const BandwidthChoice choice = bandwidth_of(motion, free, options);
  clip.bandwidth_s = choice.bandwidth_s;
  clip.bandwidth_method = choice.method;
  const PositionNoise noise = noise_at(motion, free.stretches, choice.bandwidth_s);
  clip.position_noise_m = noise.sd_m;
  clip.noise_autocovariance_m2 = noise.autocovariance;
  clip.rounding_m = coarse_rounding(motion, noise);
  clip.blocks = free_blocks(motion, free, track.shared_m, choice.bandwidth_s);
  for (FreeBlock& block : clip.blocks) {
    if (clip.forced) block.force = force_over(block, track, setup.mass_kg, setup.mass_sd_kg);
  }

  const Smoother* smoother = find_smoother(options.smoother);
  assert(smoother);
  std::optional<SmoothedWhole> whole;
  if (!smoother->takes_bandwidth()) {
    whole = smooth_whole(*smoother, track, motion, free, setup.mass_kg);
    clip.strength = whole->strength;
    clip.bandwidth_s = whole->strength.bandwidth_s;
    clip.bandwidth_method = whole->strength.method;
  }
  const std::vector<StretchPoint> points =
      whole ? whole->points : smooth_stretches(motion, free.stretches, choice.bandwidth_s);
  const SmoothedClip smoothed{track, motion, free, noise, points, choice.bandwidth_s, setup.mass_kg};
  const LineWeights weights{pilot_law(motion, free.stretches, law_bandwidth(motion, free.pilot_bandwidth_s)),
                            noise_factors(motion, free.stretches, choice.bandwidth_s)};
  clip.segments = ordinary_lines(smoothed, setup, weights, whole ? &*whole : nullptr);
  if (options.lines == LineMethod::generalised && clip.rounding_m) {
    clip.notes.emplace_back(CoarseRounding{*clip.rounding_m, true});
  } else if (options.lines == LineMethod::generalised) {
    generalise_lines(motion, free, gls_input(smoothed, setup, weights), clip);
  }
  clip.v_lim_m_s = recovered_limit(clip.segments);

  clip.motion = whole ? frames_of(smoothed, std::move(whole->frames)) : frames_of(smoothed);
  clip.shared_m = shared_of_frames(track);
  clip.left_out = intervals_of(clip.motion);
  clip.stretches = used_stretches(smoothed);
  note_findings(motion, outliers.size(), weights.factors, options.lines, clip);
  return clip;
}

}  // namespace glidelab::core
