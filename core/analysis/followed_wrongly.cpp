#include "core/analysis/followed_wrongly.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.h"
#include "base/text/number_text.h"
#include "core/math/quantile.h"
#include "core/pictures/marker/marker_track.h"

namespace glidelab::core {

std::optional<NoMarker> not_from_start(const SeenClip& seen, const MarkerSetup& marker, const ClipSetup& clip) {
  if (!marker.start_px || seen.marker.sightings.empty()) return std::nullopt;
  const std::vector<double>& t_s = seen.frame_t_s;
  const auto start =
      std::ranges::min_element(t_s, {}, [&](double t) { return std::abs(t - clip.start_s.value_or(t_s.front())); });
  const auto frame = static_cast<std::size_t>(start - t_s.begin());
  std::vector<PlaceInFrame> places;
  for (const MarkerSighting& sighting : seen.marker.sightings)
    places.push_back({sighting.frame, {sighting.u_px, sighting.v_px}});
  const cv::Point2d at(marker.start_px->x, marker.start_px->y);
  const bool is_before = frame<places.front().frame, is_after = frame> places.back().frame;
  const cv::Point2d end = is_after ? places.back().at : places.front().at;
  // Beyond an end of the track, it may have been at rest, or have bounced.
  const cv::Point2d expected = place_by_neighbours(places, frame, false).value_or(end);
  const double off = cv::norm(expected - at), from_end = is_before || is_after ? cv::norm(end - at) : off;
  const double allowed = farthest_from_start(seen.marker.sightings.front().radius_px);
  if (std::min(off, from_end) <= allowed) return std::nullopt;
  return NoMarker(base::Issue{
      clip.file.string(), 0, "marker",
      fmt::format("no marker that can be followed from start_px = [{:.1f}, {:.1f}] in frame {}: what is followed {} "
                  "{:.0f} px away from there",
                  at.x, at.y, frame,
                  is_before  ? fmt::format("is first seen in frame {},", places.front().frame)
                  : is_after ? fmt::format("is last seen in frame {},", places.back().frame)
                             : std::string("is"),
                  from_end),
      "one thing of the stated diameter that stands out from its surroundings in every frame, as a plain disc does, or "
      "another start_px"});
}

std::optional<NoMarker> far_rougher(const std::vector<SeenClip>& clips, std::size_t which, const ClipSetup& clip) {
  constexpr double kTimesRougher = 10.0, kLeastRough_px = 0.3;
  constexpr std::size_t kFewestOthers = 2;
  std::optional<double> mine;
  std::vector<double> others;
  for (std::size_t i = 0; i < clips.size(); ++i) {
    const auto roughness = roughness_of(places_of(clips[i].marker));
    if (i == which) {
      mine = roughness;
    } else if (roughness) {
      others.push_back(*roughness);
    }
  }
  if (!mine || *mine < kLeastRough_px || others.size() < kFewestOthers) return std::nullopt;
  const double usual = median_of(std::move(others));
  if (*mine < kTimesRougher * usual) return std::nullopt;
  return NoMarker(
      base::Issue{clip.file.string(), 0, "marker",
                  fmt::format("no marker that can be followed: what is followed scatters by {} px from frame "
                              "to frame, the marker of the other clips by {} px",
                              base::number_text(*mine, 2), base::number_text(usual, 2)),
                  "one thing of the stated diameter that stands out from its surroundings in every frame"});
}

void require_no_twin(const std::vector<MovingPattern>& patterns, std::size_t which, const ClipSetup& clip) {
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    if (i == which || !are_twins(patterns[which], patterns[i])) continue;
    const MarkerSighting &a = patterns[which].rough.sightings.front(), &b = patterns[i].rough.sightings.front();
    throw TwoMarkers(base::Issue{
        clip.file.string(), 0, "marker",
        fmt::format("two markers that look and move alike, at ({:.0f}, {:.0f}) px in frame {} and ({:.0f}, {:.0f}) px "
                    "in frame {}",
                    a.u_px, a.v_px, a.frame, b.u_px, b.v_px, b.frame),
        "one marker, or start_px in the clip's [[clip]] (or in [marker], for all clips) to say which"});
  }
}

}  // namespace glidelab::core
