#include "core/check/light_findings.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

#include "core/math/quantile.h"
#include "core/pictures/scene/lamp_flicker.h"
#include "core/pictures/scene/path_light.h"

namespace glidelab::core {
namespace {

constexpr double kOfNoise = 0.1;        // the least displacement that is reported
constexpr double kSureOfSlope = 3.0;    // standard deviations
constexpr std::size_t kMostPlaces = 2;  // more are a pattern behind the marker

double px_per_m(const ClipCheck& clip) {
  return std::hypot(clip.brightness.u_px_per_m, clip.brightness.v_px_per_m);
}

/// The least of the clips, in metres; 0 if none is known.
double noise_of(const std::vector<const ClipCheck*>& clips) {
  double noise_m = HUGE_VAL;
  for (const ClipCheck* clip : clips) noise_m = std::min(noise_m, clip->position_noise_m.value_or(HUGE_VAL));
  return std::isfinite(noise_m) ? noise_m : 0.0;
}

struct Place {
  LightEdge edge;  ///< of the first clip
  std::vector<double> x_m, falls;
  std::vector<const ClipCheck*> clips;
  std::vector<found::ShadowEdge::Frames> frames;  ///< of the first
};

void add_to_places(const ClipCheck& clip, const LightEdge& edge, double diameter_m, std::vector<Place>& places) {
  const found::ShadowEdge::Frames frames{edge.first_frame + 1, edge.last_frame + 1};
  for (Place& place : places) {
    if (place.edge.downhill != edge.downhill || std::abs(place.edge.x_m - edge.x_m) > diameter_m) continue;
    place.x_m.push_back(edge.x_m);
    place.falls.push_back(edge.fall);
    if (place.clips.front() == &clip) place.frames.push_back(frames);
    if (place.clips.back() != &clip) place.clips.push_back(&clip);
    return;
  }
  places.push_back({edge, {edge.x_m}, {edge.fall}, {&clip}, {frames}});
}

std::vector<std::string> names_of(const std::vector<const ClipCheck*>& clips) {
  std::vector<std::string> names;
  for (const ClipCheck* clip : clips) names.push_back(clip->name);
  return names;
}

found::LightFalls::Towards towards(double u, double v) {
  using Towards = found::LightFalls::Towards;
  if (std::abs(u) >= std::abs(v)) return u > 0.0 ? Towards::right : Towards::left;
  return v > 0.0 ? Towards::bottom : Towards::top;
}

/// The clips of one view, in which a place of the track is at the same pixel.
class ViewLight {
 public:
  ViewLight(std::vector<const ClipCheck*> clips, double diameter_m)
      : clips_(std::move(clips)), diameter_m_(diameter_m), least_m_(kOfNoise * noise_of(clips_)) {}

  void add_to(std::vector<Finding>& findings) const {
    const std::vector<Place> places = edges();
    for (std::size_t i = 0; i < std::min(kMostPlaces, places.size()); ++i) {
      const Place& place = places[i];
      const ClipCheck& first = *place.clips.front();
      findings.push_back({Severity::note,
                          {Subject::Part::clips, names_of(place.clips)},
                          found::ShadowEdge{median_of(place.x_m), median_of(place.falls), place.edge.downhill,
                                            first.brightness.of_marker, first.name, place.frames}});
    }
    add_slope(places, findings);
  }

 private:
  /// The strongest first.
  std::vector<Place> edges() const {
    std::vector<Place> places;
    for (const ClipCheck* clip : clips_) {
      for (const LightEdge& edge : edges_of_light(clip->brightness.points, diameter_m_)) {
        const double displaces_m = edge.fall * diameter_m_ / (3.0 * std::numbers::pi);
        if (displaces_m > least_m_) add_to_places(*clip, edge, diameter_m_, places);
      }
    }
    std::ranges::stable_sort(places, std::ranges::greater{}, [](const Place& place) { return median_of(place.falls); });
    return places;
  }

  void add_slope(const std::vector<Place>& places, std::vector<Finding>& findings) const {
    std::vector<std::vector<LitPoint>> points;
    std::vector<double> edges_m;
    for (const ClipCheck* clip : clips_) points.push_back(clip->brightness.points);
    for (const Place& place : places) edges_m.push_back(median_of(place.x_m));
    const auto slope = slope_of_light(points, edges_m, diameter_m_);
    if (!slope || std::abs(slope->per_m) < kSureOfSlope * slope->sd_per_m) return;
    const double displaces_m = displacement_by_slope(std::abs(slope->per_m), 0.5 * diameter_m_);
    if (displaces_m < least_m_) return;
    const PathBrightness& image = clips_.front()->brightness;
    const double down = slope->per_m < 0.0 ? 1.0 : -1.0;  // the light falls downhill, or uphill
    findings.push_back({Severity::note,
                        {Subject::Part::clips, names_of(clips_)},
                        found::LightFalls{1.0 - std::exp(-std::abs(slope->per_m)), displaces_m, image.of_marker,
                                          towards(down * image.u_px_per_m, down * image.v_px_per_m)}});
  }

  std::vector<const ClipCheck*> clips_;
  double diameter_m_, least_m_;
};

void add_flicker(const CameraSettings& camera, const std::vector<const ClipCheck*>& clips,
                 std::vector<Finding>& findings) {
  std::vector<std::shared_ptr<const ImageRecord>> records;
  for (const ClipCheck* clip : clips) {
    if (clip->record) records.push_back(clip->record);
  }
  const auto flicker = find_flicker(records, camera);
  if (!flicker) return;
  double displaces_m = 0.0;
  bool matters = false;
  for (const ClipCheck* clip : clips) {
    if (!(px_per_m(*clip) > 0.0)) continue;
    const double here_m =
        flicker_displacement_px(*flicker, camera, clip->top_speed_px_s, 0.5 * clip->marker_px) / px_per_m(*clip);
    displaces_m = std::max(displaces_m, here_m);
    matters = matters || here_m > kOfNoise * clip->position_noise_m.value_or(0.0);
  }
  if (!matters) return;
  findings.push_back({Severity::note,
                      {Subject::Part::clips, names_of(clips)},
                      found::LightFlickers{flicker->depth, flicker->f_hz, flicker->seen_hz, displaces_m}});
}

/// Set-ups without images of their own plane share the view.
std::string view_of(const Experiment& experiment, const std::string& name) {
  const GroupSetup* const group = group_of(experiment, name);
  return group != nullptr && !group->planes.empty() ? name : std::string();
}

}  // namespace

std::vector<Finding> light_findings(const Experiment& experiment, const std::vector<ClipCheck>& clips) {
  std::vector<Finding> findings;
  if (!experiment.camera || !experiment.marker) return findings;
  std::vector<std::pair<std::string, std::vector<const ClipCheck*>>> groups;
  std::vector<const ClipCheck*> filmed;
  for (const ClipCheck& clip : clips) {
    if (!clip.images || !clip.failure.empty()) continue;
    const auto setup = std::ranges::find(experiment.clips, clip.name, &ClipSetup::name);
    if (setup == experiment.clips.end()) continue;
    filmed.push_back(&clip);
    if (clip.brightness.points.empty()) continue;
    const std::string view = view_of(experiment, setup->group);
    auto group = std::ranges::find(groups, view, [](const auto& one) { return one.first; });
    if (group == groups.end()) group = groups.insert(groups.end(), {view, {}});
    group->second.push_back(&clip);
  }
  for (auto& [name, of_group] : groups) {
    ViewLight(std::move(of_group), experiment.marker->diameter_m).add_to(findings);
  }
  if (!filmed.empty()) add_flicker(*experiment.camera, filmed, findings);
  return findings;
}

}  // namespace glidelab::core
