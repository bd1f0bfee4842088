#include "render/scenario/clip_motion.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/errors.h"

namespace glidelab::render {

std::size_t frame_count(const Recording& recording, const sim::MotionSetup& motion) {
  const double rate_hz = FrameClock(recording.clock, recording.frame_rate_hz, 0, 0).true_rate_hz();
  const double last_start = motion.duration_s - recording.exposure_s - recording.shutter.readout_s();
  // A whole number of frame times that rounding made slightly shorter still counts.
  return last_start <= 0.0 ? 1 : static_cast<std::size_t>(std::floor(last_start * rate_hz + 1e-9)) + 1;
}

sim::Trajectory recorded_motion(const sim::Body& body, const sim::MotionSetup& motion, const Recording& recording) {
  const double first_middle_s = 0.5 * recording.exposure_s;
  std::vector<double> times_s(frame_count(recording, motion));
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    times_s[k] = static_cast<double>(k) / recording.frame_rate_hz + first_middle_s;
  }
  sim::Trajectory trajectory = sim::simulate(body, motion.x0_m, motion.v0_m_s, times_s);
  for (std::size_t k = 0; k < times_s.size(); ++k) {
    trajectory.states[k].t_s = static_cast<double>(k) / recording.frame_rate_hz;
  }
  for (sim::ModeChange& change : trajectory.changes) change.t_s -= first_middle_s;
  return trajectory;
}

std::size_t exposure_instants(double length_m, double longest_step_m) {
  constexpr double kStill = 0.002;  // of a step: a thousandth of a pixel where a step is half of one
  if (length_m < kStill * longest_step_m) return 1;
  return static_cast<std::size_t>(std::max(2.0, std::ceil(length_m / longest_step_m)));
}

double exposure_instant(std::size_t i, std::size_t n) {
  if (n == 1) return 0.5;
  const double count = static_cast<double>(n);
  const double from_middle = (static_cast<double>(i) + 0.5) / count - 0.5;
  // The middles of n equal parts have the variance (1 - 1/n²)/12.
  return 0.5 + from_middle / std::sqrt(1.0 - 1.0 / (count * count));
}

MotionPath::MotionPath(double start_s, double step_s, std::vector<sim::State> knots)
    : start_s_(start_s), step_s_(step_s), knots_(std::move(knots)) {
  if (knots_.size() < 2 || !(step_s_ > 0.0)) throw std::logic_error("a path needs two states and a step");
}

MotionPath::Piece MotionPath::piece_at(double t_s) const {
  const double last = static_cast<double>(knots_.size() - 2);
  const double at = (t_s - start_s_) / step_s_;
  const double number = std::clamp(std::floor(at), 0.0, last);
  const sim::State& from = knots_[static_cast<std::size_t>(number)];
  const sim::State& to = knots_[static_cast<std::size_t>(number) + 1];
  const double dx = to.x_m - from.x_m;
  const double v0 = step_s_ * from.v_m_s;
  const double v1 = step_s_ * to.v_m_s;
  return {at - number, {from.x_m, v0, 3.0 * dx - 2.0 * v0 - v1, v0 + v1 - 2.0 * dx}};
}

double MotionPath::x_m(double t_s) const {
  const auto [s, c] = piece_at(t_s);
  return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
}

double MotionPath::v_m_s(double t_s) const {
  const auto [s, c] = piece_at(t_s);
  return (c[1] + s * (2.0 * c[2] + s * 3.0 * c[3])) / step_s_;
}

double MotionPath::least_x_m() const {
  return std::min_element(knots_.begin(), knots_.end(), [](const auto& a, const auto& b) { return a.x_m < b.x_m; })
      ->x_m;
}

double MotionPath::largest_x_m() const {
  return std::max_element(knots_.begin(), knots_.end(), [](const auto& a, const auto& b) { return a.x_m < b.x_m; })
      ->x_m;
}

double mid_exposure_s(const Recording& recording, const FrameMotion& frame, double row) {
  return frame.start_s + recording.shutter.delay_s(row) + 0.5 * recording.exposure_s;
}

void for_each_frame(const sim::Body& body, const sim::MotionSetup& motion, const Recording& recording,
                    double longest_step_m, const std::function<void(const FrameMotion&)>& visit, MotionDetail detail) {
  const FrameClock even({}, recording.frame_rate_hz, 0, 0);
  for_each_frame(body, motion, recording, even, longest_step_m, visit, detail);
}

FrameMotions::FrameMotions(const sim::Body& body, const sim::MotionSetup& motion, const Recording& recording,
                           const FrameClock& clock, double longest_step_m, MotionDetail detail)
    : body_(body),
      recording_(recording),
      clock_(clock),
      longest_step_m_(longest_step_m),
      with_path_(detail == MotionDetail::path || recording.shutter.rolling),
      frames_(frame_count(recording, motion)),
      x0_m_(motion.x0_m),
      v0_m_s_(motion.v0_m_s) {}

std::optional<FrameMotion> FrameMotions::next() {
  if (waiting_.empty() && first_ < frames_) simulate_chunk();
  if (waiting_.empty()) return std::nullopt;
  FrameMotion frame = std::move(waiting_.front());
  waiting_.pop_front();
  return frame;
}

void FrameMotions::simulate_chunk() {
  constexpr std::size_t kChunk = 1024;
  constexpr double kLongestStep = 0.001;  // s, between the knots of a path
  const double open_s = recording_.exposure_s + recording_.shutter.readout_s();
  const auto pieces = static_cast<std::size_t>(std::max(1.0, std::ceil(open_s / kLongestStep - 1e-9)));
  const double step_s = open_s / static_cast<double>(pieces);
  const auto start_of = [&](std::size_t i) { return clock_.between_s(first_, first_ + i); };
  const std::size_t count = std::min(kChunk, frames_ - first_);
  // Once for the middles, which give the speed of the glider; then for the instants of each exposure.
  std::vector<double> times;
  for (std::size_t i = 0; i < count; ++i) {
    times.push_back(start_of(i) + 0.5 * recording_.exposure_s + 0.5 * recording_.shutter.readout_s());
  }
  // A frame whose readout takes longer than the frame time may have its middle after the next chunk's start.
  if (times.back() < start_of(count)) times.push_back(start_of(count));
  const sim::Trajectory middles = sim::simulate(body_, x0_m_, v0_m_s_, times);

  std::vector<double> part_times;
  std::vector<std::size_t> parts;
  for (std::size_t i = 0; i < count; ++i) {
    if (with_path_) {
      // The last knot of a frame may be the first of the next one, or lie after it by a rounding error.
      for (std::size_t k = 0; k <= pieces; ++k) part_times.push_back(start_of(i) + static_cast<double>(k) * step_s);
      parts.push_back(pieces + 1);
      continue;
    }
    const double length = std::abs(middles.states[i].v_m_s) * recording_.exposure_s;
    const std::size_t n = exposure_instants(length, longest_step_m_);
    parts.push_back(n);
    for (std::size_t k = 0; k < n; ++k) {
      part_times.push_back(start_of(i) + exposure_instant(k, n) * recording_.exposure_s);
    }
  }
  part_times.push_back(start_of(count));
  // sim requires rising times.
  std::vector<double> rising = part_times;
  std::sort(rising.begin(), rising.end());
  rising.erase(std::unique(rising.begin(), rising.end()), rising.end());
  const sim::Trajectory inside = sim::simulate(body_, x0_m_, v0_m_s_, rising);
  const auto state_at = [&](double t_s) -> const sim::State& {
    return inside
        .states[static_cast<std::size_t>(std::lower_bound(rising.begin(), rising.end(), t_s) - rising.begin())];
  };
  std::size_t at = 0;
  for (std::size_t i = 0; i < count; ++i) {
    FrameMotion frame;
    frame.frame = first_ + i;
    frame.start_s = clock_.start_s(first_ + i);
    frame.middle = middles.states[i];
    frame.middle.t_s = frame.start_s;
    if (with_path_) {
      std::vector<sim::State> knots;
      for (std::size_t k = 0; k < parts[i]; ++k) knots.push_back(state_at(part_times[at++]));
      frame.path = MotionPath(frame.start_s, step_s, std::move(knots));
    } else {
      for (std::size_t k = 0; k < parts[i]; ++k) frame.x_m.push_back(state_at(part_times[at++]).x_m);
    }
    waiting_.push_back(std::move(frame));
  }
  x0_m_ = state_at(start_of(count)).x_m;
  v0_m_s_ = state_at(start_of(count)).v_m_s;
  first_ += count;
}

void for_each_frame(const sim::Body& body, const sim::MotionSetup& motion, const Recording& recording,
                    const FrameClock& clock, double longest_step_m,
                    const std::function<void(const FrameMotion&)>& visit, MotionDetail detail) {
  FrameMotions motions(body, motion, recording, clock, longest_step_m, detail);
  while (const std::optional<FrameMotion> frame = motions.next()) visit(*frame);
}

void check_states(const sim::MotionScenario& scenario, const Recording& recording, const std::string& file,
                  const std::string& key) {
  constexpr double kBytesOfRow = 65.0;  // of the CSV
  for (const sim::ConfigurationSetup& configuration : scenario.configurations) {
    for (const sim::MotionSetup& motion : configuration.motions) {
      const std::size_t states = frame_count(recording, motion);
      if (states <= kMostFrames) continue;
      throw base::InputError(base::Issue{
          file, 0, key,
          fmt::format("{:.6g} Hz, for clip \"{}\" of {:.6g} s {} states or {:.3g} GB", recording.frame_rate_hz,
                      motion.name, motion.duration_s, states, 1e-9 * kBytesOfRow * static_cast<double>(states)),
          fmt::format("at most {} states in a clip, {:.6g} Hz", kMostFrames,
                      static_cast<double>(kMostFrames) / motion.duration_s)});
    }
  }
}

}  // namespace glidelab::render
