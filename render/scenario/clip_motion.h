/// The glider's position during each frame's exposure.
///
/// The first row's exposure of frame k is [start, start + exposure] on the clock of sim, start = k / rate if the
/// camera's clock is right (frame_clock.h); the motion starts at t = 0, with the first exposure. Other rows follow
/// according to the shutter. The middle of the middle row's exposure has the time `start` on the clock of the truth.
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/scenario/scenario_data.h"
#include "sim/motion/simulate.h"

namespace glidelab::render {

/// Slots of the clock whose last row's exposure ends within the motion's duration; at least one.
std::size_t frame_count(const Recording& recording, const sim::MotionSetup& motion);

/// The motion at the middle of each exposure of the first row, on the recording's clock: the first frame's middle is t
/// = 0. Clock errors are not included.
sim::Trajectory recorded_motion(const sim::Body& body, const sim::MotionSetup& motion, const Recording& recording);

/// The motion while a frame is read, for any instant: cubic Hermite between states of equal distance. With knots h = 1
/// ms apart the error is h^4/384 times the fourth derivative of x, below 1e-13 m on a track; if a reversal changes a by
/// 0.2 m/s², 1e-8 m.
class MotionPath {
 public:
  MotionPath() = default;
  /// Two states or more, at start_s, start_s + step_s, …
  MotionPath(double start_s, double step_s, std::vector<sim::State> knots);
  double start_s() const { return start_s_; }
  double end_s() const { return start_s_ + step_s_ * static_cast<double>(knots_.size() - 1); }
  /// On sim's clock; beyond the ends the nearest piece is extrapolated.
  double x_m(double t_s) const;
  double v_m_s(double t_s) const;
  bool empty() const { return knots_.empty(); }
  /// Over the knots; between them the body goes farther by less than a h²/8 at its turning point.
  double least_x_m() const;
  double largest_x_m() const;

 private:
  /// x = c0 + c1 s + c2 s² + c3 s³, s from 0 to 1 over the piece.
  struct Piece {
    double s;
    std::array<double, 4> c;
  };
  Piece piece_at(double t_s) const;

  double start_s_ = 0.0;
  double step_s_ = 1.0;
  std::vector<sim::State> knots_;
};

struct FrameMotion {
  std::size_t frame = 0;    ///< slot of the clock
  double start_s = 0.0;     ///< when its first row's exposure starts, on sim's clock
  sim::State middle;        ///< at the middle row's mid-exposure; t_s = start_s, from the first frame's middle
  std::vector<double> x_m;  ///< at the instants that represent the exposure (below); empty if there is a path
  MotionPath path;          ///< from the start of the first row's exposure to the end of the last one's
};

/// The requested detail of a frame's motion.
enum class MotionDetail {
  parts,  ///< `x_m`, or `path` with a rolling shutter
  path,   ///< `path` always
};

/// The number of instants that represent an exposure in which the body moves by `length_m`: one for each
/// `longest_step_m`, at least two, but only one if it moves by less than 1/500 of that.
std::size_t exposure_instants(double length_m, double longest_step_m);

/// The i-th of n instants that represent an exposure, as a fraction of it: uniformly spaced about its middle, and
/// spread such that their variance is that of the whole, 1/12 (for n = 1: 0). A smear thus has the correct second
/// moment.
double exposure_instant(std::size_t i, std::size_t n);

/// The slots of a clip's clock, one after another, simulated in chunks so that no clip is held in memory. The body must
/// outlive this object.
class FrameMotions {
 public:
  FrameMotions(const sim::Body& body, const sim::MotionSetup& motion, const Recording& recording,
               const FrameClock& clock, double longest_step_m, MotionDetail detail = MotionDetail::parts);
  /// Empty after the last slot.
  std::optional<FrameMotion> next();

 private:
  void simulate_chunk();

  const sim::Body& body_;
  Recording recording_;
  FrameClock clock_;
  double longest_step_m_;
  bool with_path_;
  std::size_t frames_;
  std::size_t first_ = 0;  ///< slot of the next chunk
  double x0_m_, v0_m_s_;   ///< there
  std::deque<FrameMotion> waiting_;
};

/// Calls `visit` for every slot of the clock in order. Without a clock, frames come at the stated rate.
void for_each_frame(const sim::Body& body, const sim::MotionSetup& motion, const Recording& recording,
                    const FrameClock& clock, double longest_step_m,
                    const std::function<void(const FrameMotion&)>& visit, MotionDetail detail = MotionDetail::parts);
void for_each_frame(const sim::Body& body, const sim::MotionSetup& motion, const Recording& recording,
                    double longest_step_m, const std::function<void(const FrameMotion&)>& visit,
                    MotionDetail detail = MotionDetail::parts);

/// The middle of the exposure of a row of a frame (also between rows), on sim's clock.
double mid_exposure_s(const Recording& recording, const FrameMotion& frame, double row);

/// How long a clip of a scenario may be.
///
/// Frames of one clip: an hour at 1389 Hz. Its true motion is held in memory, 0.6 GB of it.
inline constexpr std::size_t kMostFrames = 5'000'000;

/// InputError (file, key) if a true motion would have more states than that, with their size as a CSV.
void check_states(const sim::MotionScenario& scenario, const Recording& recording, const std::string& file,
                  const std::string& key);

}  // namespace glidelab::render
