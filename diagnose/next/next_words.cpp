#include "diagnose/next/next_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "base/text/number_text.h"
#include "diagnose/next/next_changes.h"
#include "diagnose/next/next_clip.h"

namespace glidelab::diagnose {
namespace {

const char* const kMoveCamera =
    "what belongs to the track stays at its place on it, what belongs to the image moves with the camera.";
const char* const kRepeat =
    "Repeat one of the launches three times without changing anything: what differs between the repetitions is no law "
    "of motion.";

/// The launch, of those with what there is, that has most positions of which `inside` is true.
struct Cover {
  std::string words;
  std::size_t launches = 0, inside = 0, positions = 0;
};

Cover best_cover(const TrackSet& set, const MotionFit& nominal, const std::function<bool(double, double)>& inside) {
  Cover best;
  for (const Change& change : feasible_changes(set, nominal)) {
    if (change.kind != Change::Kind::launch) continue;
    ++best.launches;
    const Moved clip = next_motion(set, nominal, change).moved;
    std::size_t count = 0;
    for (std::size_t p = 0; p < clip.x_m.size(); ++p) count += inside(clip.x_m[p], clip.v_m_s[p]) ? 1 : 0;
    if (count <= best.inside) continue;
    best.inside = count;
    best.positions = clip.x_m.size();
    best.words = change.words;
  }
  return best;
}

/// `unit` and `of`: "m" and "places".
std::string cover_words(const Cover& cover, const GapRegion& region, const char* of, const char* unit) {
  return fmt::format(
      "{}: of {} launches it has most positions ({} of {}) at {} from {} to {} {}, where the "
      "excess lies",
      cover.words, cover.launches, cover.inside, cover.positions, of, base::number_text(region.from, 2),
      base::number_text(region.to, 2), unit);
}

std::string for_masses(const TrackSet& set) {
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
  return fmt::format(
      "Record a further mass of {:.0f} g both ways, and the lightest one again: what depends on the "
      "mass has a third point on its curve then, what differed by chance does not come back.",
      1000.0 * next);
}

}  // namespace

std::string next_for_unnamed(const TrackSet& set, const MotionFit& nominal, const Diagnosis& diagnosis) {
  if (diagnosis.regions.empty()) return kRepeat;
  const GapRegion& region = diagnosis.regions.front();
  const std::string& variable = region.variable;
  if (!region.clip.empty()) {
    return fmt::format(
        "Repeat clip {} three times without changing anything: what is its own does not come back, what "
        "its launch, mass or set-up does to it comes back each time.",
        region.clip);
  }
  if (variable == "x_m") {
    const Cover cover = best_cover(set, nominal, [&](double x, double) { return x >= region.from && x <= region.to; });
    const std::string move = "Move the camera along the track by a third of the view. ";
    if (cover.inside == 0) return move + "Record the same launches again: " + kMoveCamera;
    return move + cover_words(cover, region, "places", "m") + "; " + kMoveCamera;
  }
  if (variable == "v_m_s") {
    const bool either_way = region.what == "friction";  // over how fast it moves
    const Cover cover = best_cover(set, nominal, [&](double, double v) {
      const double at = either_way ? std::abs(v) : v;
      return at >= region.from && at <= region.to;
    });
    if (cover.inside > 0) {
      return cover_words(cover, region, "speeds", "m/s") + ", and its shape over the speed tells what it is.";
    }
    return "Record launches at two further speeds, with one mass and on one inclination: the force that is missing "
           "depends on the speed, and its shape tells what it is.";
  }
  if (variable == "mass_kg") return for_masses(set);
  if (variable == "t_s") {
    return "Repeat one of the launches three times, each one second later after the camera was started: what goes with "
           "the clip's time (a clock, something that warms or settles) stays at that time, what acts on the glider "
           "comes later with it.";
  }
  if (variable == "direction") {
    return "Turn the glider round on the track and record the same launches each way: what belongs to the glider turns "
           "with it, what belongs to the track does not.";
  }
  if (variable == "group") {
    return "Take the track down, set it up once more at the same inclination, and record the same launches: what "
           "differs then comes from setting it up, and not from the inclination.";
  }
  if (variable == "u_px" || variable == "v_px") {
    return std::string("Move the camera along the track by a third of the view and record the same launches again: ") +
           kMoveCamera;
  }
  return kRepeat;
}

}  // namespace glidelab::diagnose
