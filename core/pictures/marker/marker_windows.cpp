#include "core/pictures/marker/marker_windows.h"

#include <algorithm>
#include <cmath>

#include "core/pictures/marker/sphere/sphere_window.h"

namespace glidelab::core {

std::vector<FrameWindow> windows_around(const TrackedMarker& marker, const ClipAgain& clip, const ShapeAt& shape_at) {
  constexpr double kSeenRadii = 3.0, kLostRadii = 6.0, kMargin_px = 6.0;
  std::vector<PlaceInFrame> places;
  for (const MarkerSighting& sighting : marker.sightings)
    places.push_back({sighting.frame, {sighting.u_px, sighting.v_px}});
  std::vector<FrameWindow> windows;
  const auto source = clip.open();
  while (const auto frame = source->next()) {
    const auto expected = place_by_neighbours(places, frame->index, false);
    if (!expected) continue;
    const auto shape = shape_at(*expected, MarkerBody::sphere);
    if (!shape) continue;
    FrameWindow window;
    window.frame = frame->index;
    window.expected = *expected;
    window.seen = std::binary_search(places.begin(), places.end(), PlaceInFrame{frame->index, {}},
                                     [](const PlaceInFrame& a, const PlaceInFrame& b) { return a.frame < b.frame; });
    window.full_code = frame->grey.depth() == CV_8U ? 255.0 : 65535.0;
    const double reach = (window.seen ? kSeenRadii : kLostRadii) * radius_of(*shape) + kMargin_px;
    const int half = static_cast<int>(std::ceil(reach));
    window.part = cv::Rect(static_cast<int>(std::lround(expected->x)) - half,
                           static_cast<int>(std::lround(expected->y)) - half, 2 * half + 1, 2 * half + 1) &
                  cv::Rect({}, frame->grey.size());
    if (window.part.empty()) continue;
    frame->grey(window.part).convertTo(window.codes, CV_32F);
    windows.push_back(std::move(window));
  }
  return windows;
}

}  // namespace glidelab::core
