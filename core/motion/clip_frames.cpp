#include "core/motion/clip_frames.h"

#include <cmath>
#include <span>

#include "core/motion/smoothing/local_cubic.h"

namespace glidelab::core {
namespace {

/// Points that follow each other and are smoothed together: a stretch, or what lies between two of them.
struct Piece {
  std::size_t first = 0, count = 0;
};

std::vector<Piece> pieces_of(const std::vector<FreeStretch>& stretches, std::size_t points) {
  std::vector<Piece> pieces;
  std::size_t next = 0;
  for (const FreeStretch& stretch : stretches) {
    if (stretch.first > next) pieces.push_back({next, stretch.first - next});
    pieces.push_back({stretch.first, stretch.count});
    next = stretch.first + stretch.count;
  }
  if (points > next) pieces.push_back({next, points - next});
  return pieces;
}

/// `left_out` is not yet set.
std::vector<MotionPoint> smooth_frames(const SmoothedClip& clip) {
  const TrackData& track = clip.track;
  const Motion& motion = clip.motion;
  std::vector<MotionPoint> frames(track.frame_t_s.size());
  for (std::size_t f = 0; f < frames.size(); ++f) frames[f].t_s = track.frame_t_s[f];
  for (std::size_t i = 0; i < track.t_s.size(); ++i) {
    frames[track.frame[i]].t_s = track.t_s[i];  // of the marker's row, with a rolling shutter
    frames[track.frame[i]].measured_m = track.x_m[i];
  }
  RowVariance variance(clip.noise.autocovariance);
  std::size_t f = 0;
  for (const Piece& piece : pieces_of(clip.free.stretches, motion.t_s.size())) {
    const std::span t = std::span(motion.t_s).subspan(piece.first, piece.count);
    const std::span x = std::span(motion.x_m).subspan(piece.first, piece.count);
    const std::span y = std::span(motion.y_m).subspan(piece.first, piece.count);
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
  const TrackData& track = clip.track;
  const std::vector<std::size_t>& point = clip.motion.point;
  std::vector<MotionPoint> frames = smooth_frames(clip);
  for (MotionPoint& frame : frames) frame.left_out = LeftOut::no_marker;
  for (const std::size_t f : track.frame) frames[f].left_out = LeftOut::outlier;  // unless it is among the kept
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

}  // namespace glidelab::core
