#include "diagnose/next/next_unnamed.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "diagnose/next/next_changes.h"
#include "diagnose/next/next_clip.h"

namespace glidelab::diagnose {
namespace {

/// The launch, of those with the masses and set-ups so far, that has most positions of which `inside` is true; none
/// where no launch has any.
std::optional<CoverRegion> best_cover(const TrackSet& set, const MotionFit& nominal, CoverRegion::Over over,
                                      const GapRegion& region, const std::function<bool(double, double)>& inside) {
  CoverRegion best;
  best.over = over;
  best.from = region.from;
  best.to = region.to;
  for (const Change& change : feasible_changes(set, nominal)) {
    if (change.kind != ChangeKind::launch) continue;
    ++best.launches;
    const Moved clip = next_motion(set, nominal, change).moved;
    std::size_t count = 0;
    for (std::size_t p = 0; p < clip.x_m.size(); ++p) count += inside(clip.x_m[p], clip.v_m_s[p]) ? 1 : 0;
    if (count <= best.inside) continue;
    best.inside = count;
    best.positions = clip.x_m.size();
    best.launch = change;
  }
  return best.inside > 0 ? std::optional(best) : std::nullopt;
}

/// In the middle of the widest gap between masses, or well above the heaviest.
AddMass mass_between(const TrackSet& set) {
  std::vector<double> masses;
  for (const TrackedMass& mass : set.masses) masses.push_back(mass.mass_kg);
  std::sort(masses.begin(), masses.end());
  double next = 1.6 * masses.back(), widest = 1.0;
  for (std::size_t m = 1; m < masses.size(); ++m) {
    const double apart = masses[m] / masses[m - 1];
    if (apart <= widest) continue;
    widest = apart;
    next = 0.5 * (masses[m] + masses[m - 1]);
  }
  return {next};
}

}  // namespace

NextStep next_for_unnamed(const TrackSet& set, const MotionFit& nominal, const Diagnosis& diagnosis) {
  if (diagnosis.regions.empty()) return Routine::repeat_launch;
  const GapRegion& region = diagnosis.regions.front();
  const std::string& variable = region.variable;
  if (!region.clip.empty()) return RepeatClip{region.clip};
  if (variable == "x_m") {
    const auto cover = best_cover(set, nominal, CoverRegion::Over::places, region,
                                  [&](double x, double) { return x >= region.from && x <= region.to; });
    if (cover) return *cover;
    return Routine::move_camera;
  }
  if (variable == "v_m_s") {
    const bool of_speed = region.what == "friction";  // whichever way it moves
    const auto cover = best_cover(set, nominal, CoverRegion::Over::speeds, region, [&](double, double v) {
      const double at = of_speed ? std::abs(v) : v;
      return at >= region.from && at <= region.to;
    });
    if (cover) return *cover;
    return Routine::other_speeds;
  }
  if (variable == "mass_kg") return mass_between(set);
  if (variable == "t_s") return Routine::start_later;
  if (variable == "direction") return Routine::turn_glider;
  if (variable == "group") return Routine::set_up_again;
  if (variable == "u_px" || variable == "v_px") return Routine::move_camera;
  return Routine::repeat_launch;
}

}  // namespace glidelab::diagnose
