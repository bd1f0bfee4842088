#include "core/track/fall_direction.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include "core/experiment/local_gravity.h"
#include "core/math/parabola.h"
#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kHardlyTurns = 0.8;  // of the range of x: distance from the first position to the last
constexpr double kParabola = 0.03;    // of the range of x: rms residual
constexpr double kThrown_m_s2 = 0.7 * kStandardGravity_m_s2;

/// The positions without jumps to wrong echoes, or to where a tracker lost the object: no step is longer than a few
/// times the long ones. Only the direction of the motion is read from them.
std::vector<double> without_jumps(const std::vector<double>& x_m) {
  constexpr double kJump = 4.0, kLongStep = 0.8;  // times the quantile of the steps
  std::vector<double> steps;
  for (std::size_t i = 1; i < x_m.size(); ++i) steps.push_back(std::abs(x_m[i] - x_m[i - 1]));
  const double longest = kJump * quantile(steps, kLongStep);
  if (!(longest > 0.0)) return x_m;
  std::vector<double> smooth = {0.0};
  for (std::size_t i = 1; i < x_m.size(); ++i) {
    smooth.push_back(smooth.back() + std::clamp(x_m[i] - x_m[i - 1], -longest, longest));
  }
  return smooth;
}

double drop_of_speeds(const TrackData& track) {
  double sum = 0.0, size = 0.0;
  for (const double v : track.v_m_s) {
    sum += v;
    size += std::abs(v);
  }
  return std::abs(sum) < kHardlyTurns * size ? track.v_m_s.back() - track.v_m_s.front() : sum;
}

}  // namespace

double signed_drop(const TrackData& track) {
  if (!track.v_m_s.empty()) return drop_of_speeds(track);
  const std::vector<double> x_m = without_jumps(track.x_m);
  const auto [low, high] = std::minmax_element(x_m.begin(), x_m.end());
  const double range_m = *high - *low, displacement_m = x_m.back() - x_m.front();
  const Parabola parabola = parabola_through(track.t_s, x_m);
  double squares_m2 = 0.0;
  for (std::size_t i = 0; i < x_m.size(); ++i) squares_m2 += std::pow(x_m[i] - parabola.at(track.t_s[i]), 2);
  const bool follows = squares_m2 <= std::pow(kParabola * range_m, 2) * static_cast<double>(x_m.size());
  if (follows && std::abs(parabola.a) >= kThrown_m_s2) return std::copysign(range_m, parabola.a);
  if (std::abs(displacement_m) >= kHardlyTurns * range_m) return displacement_m;
  // From the positions at both ends and at the middle of the time: the direction of the acceleration.
  const double middle_s = 0.5 * (track.t_s.front() + track.t_s.back());
  const auto at =
      static_cast<std::size_t>(std::lower_bound(track.t_s.begin(), track.t_s.end(), middle_s) - track.t_s.begin());
  return x_m.front() + x_m.back() - 2.0 * x_m[at];
}

void count_downwards(const std::vector<TrackData*>& tracks) {
  double drop = 0.0;
  for (const TrackData* track : tracks) drop += signed_drop(*track);
  if (!(drop < 0.0)) return;
  for (TrackData* track : tracks) {
    for (std::vector<double>* values : {&track->x_m, &track->v_m_s, &track->force_n}) {
      for (double& value : *values) value = -value;
    }
    const std::size_t reversed_before =
        std::erase_if(track->notes, [](const Note& note) { return std::holds_alternative<CountedAlongMotion>(note); });
    if (reversed_before == 0) track->notes.emplace_back(CountedAlongMotion{});
  }
}

}  // namespace glidelab::core
