#include "core/analysis/repeats_left_out.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <variant>

#include "core/math/frame_repeats.h"
#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr double kLeastStepPx = 1.0;

/// Along the line from the first sighting to the one farthest from it.
std::vector<double> along_line(const std::vector<MarkerSighting>& sightings) {
  const MarkerSighting& first = sightings.front();
  const auto distance_px = [&](const MarkerSighting& at) {
    return std::hypot(at.u_px - first.u_px, at.v_px - first.v_px);
  };
  const MarkerSighting& far = *std::ranges::max_element(sightings, {}, distance_px);
  const double length_px = distance_px(far);
  std::vector<double> x_px;
  for (const MarkerSighting& at : sightings) {
    const double along =
        (at.u_px - first.u_px) * (far.u_px - first.u_px) + (at.v_px - first.v_px) * (far.v_px - first.v_px);
    x_px.push_back(length_px > 0.0 ? along / length_px : 0.0);
  }
  return x_px;
}

template <typename T>
void erase_points(const std::vector<std::size_t>& points, std::vector<T>& values) {
  std::size_t i = 0;
  std::erase_if(values, [&](const T&) { return std::ranges::binary_search(points, i++); });
}

}  // namespace

void leave_out_repeats(SeenClip& seen) {
  std::vector<MarkerSighting>& sightings = seen.marker.sightings;
  const double step_s = median_step(seen.frame_t_s);
  if (sightings.empty() || !has_even_steps(seen.frame_t_s, step_s)) return;
  std::vector<std::size_t> frames;
  for (const MarkerSighting& sighting : sightings) frames.push_back(sighting.frame);
  const auto repeats = frame_repeats(frames, along_line(sightings), kLeastStepPx);
  if (!repeats) return;

  RepeatsLeftOut note{repeats->points.size(), sightings.size(), repeats->in_place_of_lost, 0.0};
  if (sightings.size() == seen.marker.fits.size()) erase_points(repeats->points, seen.marker.fits);
  erase_points(repeats->points, sightings);
  seen.marker.left_out += repeats->points.size();
  if (const auto& cadence = repeats->cadence) {
    note.camera_hz = cadence->rate_ratio / step_s;
    for (std::size_t f = 0; f < seen.frame_t_s.size(); ++f) seen.frame_t_s[f] -= step_s * cadence->early_frames(f);
  }
  if (seen.images) {
    std::erase_if(seen.images->marker, [&](const MarkerLook& look) {
      return !std::ranges::binary_search(sightings, look.frame, {}, &MarkerSighting::frame);
    });
    for (MarkerLook& look : seen.images->marker) look.t_s = seen.frame_t_s[look.frame];
  }
  std::erase_if(seen.notes, [](const Note& of) { return std::holds_alternative<RepeatedFrames>(of); });
  seen.notes.emplace_back(note);
}

}  // namespace glidelab::core
