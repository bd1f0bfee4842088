#include "core/check/motion_look.h"

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>

#include "base/math/angles.h"
#include "base/math/dense.h"
#include "core/experiment/local_gravity.h"
#include "core/math/parabola.h"
#include "core/math/quantile.h"
#include "core/motion/free/motion.h"
#include "core/motion/smoothing/noise.h"
#include "core/result/estimate.h"
#include "core/track/track_data.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kFewestPoints = 12;
constexpr std::size_t kParts = 10;            // parabolas go through a tenth of the points,
constexpr std::size_t kFewestOfParabola = 7;  // but at least this many
constexpr double kOffWhole = 0.05;            // of the range of x: one parabola through all points is off by less
constexpr double kOverNoise = 5.0;            // a typical a must exceed this many standard deviations of a parabola's a
constexpr double kTurnOverNoise = 20.0;       // a turn comes back by this many standard deviations of a position,
constexpr double kTurnOverRange = 0.05;       // and by this part of the range of x
constexpr std::size_t kManyTurns = 6, kFewTurns = 2;
constexpr double kHarmonic = 0.8, kClearlyHarmonic = 0.95;  // of the variance of a, after many turns and few
constexpr std::size_t kFewestOfFewTurns = 8;                // parabolas
constexpr double kSmoothPart = 1e-7;                        // of the range of x
constexpr double kAboveGravity = 1.05;                      // of g: a fall has 1
constexpr double kFarAboveGravity = 2.0;                    // of g: no scale or frame rate is measured that badly
constexpr double kMedian = 2.0;                             // parabolas' sds by which the median of |a| is certain
constexpr double kLeastOfMetres = 0.3;                      // of g: a fall in feet would have 3.3, in centimetres 100
constexpr double kFreeFall = 0.9, kShallow_rad = 1.05;      // of g, on an incline of less than 60 degrees
constexpr double kSameGravity = 0.1;                        // of g
constexpr double kMostBend = 0.08;                          // a wide lens bends a straight path by half of that
constexpr double kGapSteps = 3.0;                           // median steps: a longer one is a gap
constexpr double kMostUnseen = 0.2;                         // of the time
constexpr double kLongestPush_m = 1.0;                      // at 2 g it would give 6 m/s
constexpr double kOffStretch = 0.05;                        // of the distance that a stretch covers
constexpr double kLostInNoise = 0.4;                        // of the distance: positions at rest span more than that,
constexpr std::size_t kFewestToRest = 40;                   // if they are so many,
constexpr double kLeastLost_m = 0.01;                       // and are not one step of rounding apart
constexpr double kSpreadOfRest = 1.15;                      // times the noise: a distance of 2.5 times has more
constexpr double kSureSds = 3.0;                            // of the acceleration of a stretch
constexpr double kKeepsSpeed = 0.75;                        // of the speed at its end

/// The step by which all positions go on, if it is that of a count, 1, or of turns, a quarter turn in radians or a
/// multiple. Marks in equal steps, as those of light gates, have others.
std::optional<double> counted_step(std::span<const double> x_m) {
  constexpr double kSame = 1e-5, kMostQuarters = 8.0;
  const double step = x_m[1] - x_m[0];
  for (std::size_t i = 2; i < x_m.size(); ++i) {
    if (!(std::abs(x_m[i] - x_m[i - 1] - step) <= kSame * std::abs(step))) return {};
  }
  const double quarters = std::abs(step) / (0.5 * std::numbers::pi);
  const bool turns = std::round(quarters) >= 1.0 && quarters < kMostQuarters + 0.5 &&
                     std::abs(quarters - std::round(quarters)) < kSame * quarters;
  return std::abs(step) == 1.0 || turns ? std::optional(step) : std::nullopt;
}

/// Standard deviation of a by n even points over a time T: its variance is 720 s²/(n T⁴).
double sd_of_a(double noise_m, std::size_t points, double span_s) {
  return noise_m * std::sqrt(720.0 / static_cast<double>(points)) / (span_s * span_s);
}

/// The median of |a| of parabolas through `size` points each, where it is above their noise.
void find_acceleration(std::span<const double> t_s, std::span<const double> x_m, std::size_t size, double noise_m,
                       MotionLook& look) {
  std::vector<double> sizes;
  double sd_m_s2 = 0.0;
  for (std::size_t from = 0; from + size <= x_m.size(); from += std::max<std::size_t>(1, size / 2)) {
    sizes.push_back(std::abs(parabola_through(t_s.subspan(from, size), x_m.subspan(from, size)).a));
    sd_m_s2 = std::max(sd_m_s2, sd_of_a(noise_m, size, t_s[from + size - 1] - t_s[from]));
  }
  const double typical = quantile(sizes, 0.5);
  if (!(typical > kOverNoise * sd_m_s2)) return;
  look.acceleration_m_s2 = typical;
  look.acceleration_sd_m_s2 = sd_m_s2;
}

/// The motion without single positions that lie off it: one of them bends the parabola through all of its part.
Motion without_outliers(std::span<const double> t_s, std::span<const double> x_m) {
  TrackData track;
  track.t_s.assign(t_s.begin(), t_s.end());
  track.x_m.assign(x_m.begin(), x_m.end());
  constexpr double kAnyMass_kg = 1.0;  // there is no force
  const Motion motion = motion_of(track, kAnyMass_kg);
  const Motion steady = without(motion, find_outliers(motion));
  return steady.t_s.size() < kFewestPoints ? motion : steady;
}

/// Whether one parabola passes through all points to within `off_m`: they then include neither a bounce nor a sensor's
/// jump.
bool is_parabola(std::span<const double> t_s, std::span<const double> x_m, double off_m) {
  const Parabola parabola = parabola_through(t_s, x_m);
  for (std::size_t i = 0; i < t_s.size(); ++i) {
    if (!(std::abs(x_m[i] - parabola.at(t_s[i])) < off_m)) return false;
  }
  return true;
}

/// The most by which the body surely speeds up all along a stretch that is longer than a hand's or a spring's push, and
/// after which it keeps its speed. A sensor that drifts to another object comes to rest there.
double most_speeding_up(std::span<const double> t_s, std::span<const double> x_m, double noise_m) {
  double most = 0.0;
  for (std::size_t size = kFewestOfParabola; size <= x_m.size(); size += std::max<std::size_t>(1, size / 3)) {
    for (std::size_t from = 0; from + size <= x_m.size(); from += std::max<std::size_t>(1, size / 8)) {
      const auto t = t_s.subspan(from, size), x = x_m.subspan(from, size);
      const double distance = std::abs(x.back() - x.front()), span = t.back() - t.front();
      if (distance < kLongestPush_m) continue;
      const Parabola parabola = parabola_through(t, x);
      const double sure = std::abs(parabola.a) - kSureSds * sd_of_a(noise_m, size, span);
      const double at_start = parabola.v - 0.5 * parabola.a * span, at_end = parabola.v + 0.5 * parabola.a * span;
      const bool speeds_up = at_end * parabola.a > 0.0 && at_start * parabola.a > -0.1 * std::abs(at_end * parabola.a);
      if (!(sure > most) || !speeds_up || !is_parabola(t, x, kOffStretch * distance)) continue;
      const std::size_t after = std::min(from + 2 * size, x_m.size()) - 1, last = from + size - 1;
      if (after < last + size / 2) continue;
      const double kept = (x_m[after] - x_m[last]) / (t_s[after] - t_s[last]);
      if (kept * at_end > kKeepsSpeed * at_end * at_end) most = sure;
    }
  }
  return most;
}

/// A push at the start: parabolas through a few positions each, as long as they surely speed up by more than gravity.
void look_for_push(std::span<const double> t_s, std::span<const double> x_m, double noise_m, MotionLook& look) {
  constexpr std::size_t kFew = 5, kFewestOfPush = 2;  // positions of a parabola, parabolas of a push
  std::size_t pushes = 0;
  for (std::size_t from = 0; from + kFew <= x_m.size() / 2; ++from) {
    const auto t = t_s.subspan(from, kFew), x = x_m.subspan(from, kFew);
    const Parabola parabola = parabola_through(t, x);
    const double span = t.back() - t.front(), at_end = parabola.v + 0.5 * parabola.a * span;
    const double sure = std::abs(parabola.a) - kSureSds * sd_of_a(noise_m, kFew, span);
    const double moved_m = x_m[from] - x_m[0];
    // It has moved the other way before: this is a bounce.
    if (pushes == 0 && moved_m * parabola.a < 0.0 && std::abs(moved_m) > kTurnOverNoise * noise_m) break;
    const bool pushed = sure > kAboveGravity * kStandardGravity_m_s2 && at_end * parabola.a > 0.0;
    if (!pushed && pushes > 0) break;
    if (!pushed) continue;
    ++pushes;
    look.push_m_s2 = std::max(look.push_m_s2, std::abs(parabola.a));
    look.pushed_until_s = t.back();
  }
  if (pushes < kFewestOfPush) look.push_m_s2 = 0.0;
}

std::size_t turns_in(std::span<const double> x_m, double back_m) {
  double lowest = x_m[0], highest = x_m[0];
  int direction = 0;
  std::size_t turns = 0;
  for (const double x : x_m) {
    lowest = std::min(lowest, x);
    highest = std::max(highest, x);
    const bool falls = direction >= 0 && highest - x > back_m, rises = direction <= 0 && x - lowest > back_m;
    if (!falls && !rises) continue;
    turns += direction != 0;
    direction = falls ? -1 : 1;
    lowest = highest = x;
  }
  return turns;
}

/// Part of the variance of a that a line decreasing with x explains; 0 if the line increases.
double harmonic_part(const std::vector<double>& x, const std::vector<double>& a) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::ArrayXd dx = Eigen::Map<const Eigen::ArrayXd>(x.data(), n), da = Eigen::Map<const Eigen::ArrayXd>(a.data(), n);
  dx -= dx.mean();
  da -= da.mean();
  const double xa = (dx * da).sum(), xx = dx.square().sum(), aa = da.square().sum();
  return xa < 0.0 && aa > 0.0 && xx > 0.0 ? xa * xa / (xx * aa) : 0.0;
}

void look_for_gaps(std::span<const double> t_s, MotionLook& look) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < t_s.size(); ++i) steps.push_back(t_s[i] - t_s[i - 1]);
  const double longest = kGapSteps * quantile(steps, 0.5);
  for (const double step : steps) {
    if (!(step > longest)) continue;
    look.unseen += step / (t_s.back() - t_s.front());
    look.longest_gap_s = std::max(look.longest_gap_s, step);
  }
}

double bend_of(std::span<const MarkerSighting> sightings) {
  if (sightings.size() < kFewestPoints) return 0.0;
  const auto& first = sightings.front();
  // Along the line to the point farthest from the first, and across it.
  double along_u = 0.0, along_v = 0.0;
  for (const MarkerSighting& at : sightings) {
    const double du = at.u_px - first.u_px, dv = at.v_px - first.v_px;
    if (std::hypot(du, dv) > std::hypot(along_u, along_v)) along_u = du, along_v = dv;
  }
  const double length = std::hypot(along_u, along_v);
  if (!(length > 0.0)) return 0.0;
  Eigen::MatrixXd design(static_cast<Eigen::Index>(sightings.size()), 3);
  Eigen::VectorXd across(design.rows());
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    const MarkerSighting& at = sightings[static_cast<std::size_t>(i)];
    const double du = at.u_px - first.u_px, dv = at.v_px - first.v_px;
    const double s = (du * along_u + dv * along_v) / (length * length);
    design.row(i) << 1.0, s, s * s;
    across[i] = (dv * along_u - du * along_v) / length;
  }
  const Eigen::VectorXd fit = base::least_squares(design, across);
  return std::abs(fit[2]) / 4.0 / length;  // sagitta of c s² over the unit length of s
}

double spread_of(std::span<const double> x_m) {
  const Eigen::Map<const Eigen::ArrayXd> x(x_m.data(), static_cast<Eigen::Index>(x_m.size()));
  return std::sqrt((x - x.mean()).square().mean());
}

}  // namespace

bool is_at_rest(const MotionLook& look) {
  if (look.positions > 0 && look.distance_m == 0.0) return true;
  return look.positions >= kFewestToRest && look.spread_m > 0.0 && look.spread_m < kSpreadOfRest * look.noise_m;
}

MotionLook look_at_motion(std::span<const double> t_s, std::span<const double> x_m,
                          std::span<const MarkerSighting> sightings, bool forced) {
  MotionLook look;
  if (x_m.size() < kFewestPoints) return look;
  const auto [least, most] = std::minmax_element(x_m.begin(), x_m.end());
  look.distance_m = *most - *least;
  look.frame_s = (t_s.back() - t_s.front()) / static_cast<double>(t_s.size() - 1);
  look.bend = bend_of(sightings);
  look_for_gaps(t_s, look);
  look.counted = counted_step(x_m);
  look.positions = x_m.size();
  const double noise_m = pilot_noise(t_s, x_m);
  look.noise_m = noise_m;
  look.smooth = noise_m < kSmoothPart * look.distance_m;
  if (forced) return look;
  const Motion steady = without_outliers(t_s, x_m);
  t_s = steady.t_s;
  x_m = steady.x_m;
  look.spread_m = spread_of(x_m);
  find_acceleration(t_s, x_m, std::max(kFewestOfParabola, x_m.size() / kParts), noise_m, look);
  if (!look.acceleration_m_s2 && is_parabola(t_s, x_m, kOffWhole * look.distance_m)) {
    find_acceleration(t_s, x_m, x_m.size(), noise_m, look);
  }
  look.speeding_up_m_s2 = most_speeding_up(t_s, x_m, noise_m);
  look_for_push(t_s, x_m, noise_m, look);
  look.turns = turns_in(x_m, std::max(kTurnOverNoise * noise_m, kTurnOverRange * look.distance_m));
  // Fine enough for a swing: eight parabolas between turns.
  if (look.turns >= kFewTurns) {
    const std::size_t fine = std::max(kFewestOfParabola, x_m.size() / (8 * (look.turns + 1)));
    std::vector<double> places, accelerations;
    for (std::size_t from = 0; from + fine <= x_m.size(); from += fine) {
      const Parabola parabola = parabola_through(t_s.subspan(from, fine), x_m.subspan(from, fine));
      places.push_back(parabola.middle);
      accelerations.push_back(parabola.a);
    }
    const double harmonic = harmonic_part(places, accelerations);
    look.oscillates = look.turns >= kManyTurns ? harmonic > kHarmonic
                                               : harmonic > kClearlyHarmonic && places.size() >= kFewestOfFewTurns;
  }
  return look;
}

MotionLook look_at_motion(const ClipResult& clip) {
  std::vector<double> t_s, x_m;
  for (const MotionPoint& point : clip.motion) {
    const bool stated_out = point.left_out == LeftOut::before_start || point.left_out == LeftOut::after_end;
    if (!point.measured_m || stated_out) continue;
    t_s.push_back(point.t_s);
    x_m.push_back(*point.measured_m);
  }
  return look_at_motion(t_s, x_m, clip.sightings, clip.forced);
}

namespace {

bool may_fall(const ClipSetup& setup) {
  return std::abs(setup.incline_rad) >= kShallow_rad;
}

/// Accelerations that a free motion on the stated incline may have, in g.
struct PlausibleRange {
  double least = 0.0, most = 0.0;
};

/// A fall: less than 1 because of drag, air that moves along, and a scale that is off. An incline: between a quarter
/// and four times sin α, because of friction. Nearly level: friction, or a slope that nobody knows.
PlausibleRange plausible(const ClipSetup& setup) {
  constexpr double kLevel_rad = 0.01, kLeastOfLevel = 1e-3, kMostOfLevel = 0.3;
  if (may_fall(setup)) return {0.4, 1.2};
  if (setup.incline_assumed) return {kLeastOfLevel, 1.2};
  const double sine = std::sin(std::abs(setup.incline_rad));
  if (sine < kLevel_rad) return {kLeastOfLevel, kMostOfLevel};
  return {0.25 * sine, std::min(1.0, 4.0 * sine)};
}

/// Accelerations that no incline has, with the units of x that would explain them.
found::BeyondGravity beyond_gravity(double a, double distance_m, const ClipSetup& setup, double gravity_m_s2) {
  found::BeyondGravity found{a, gravity_m_s2, {}, false};
  constexpr std::array kUnits = {LengthUnit::centimetres, LengthUnit::millimetres, LengthUnit::inches,
                                 LengthUnit::feet};
  for (const LengthUnit unit : kUnits) {
    if (std::abs(a / per_metre(unit) / gravity_m_s2 - 1.0) < kSameGravity) {
      found.units = {unit};
      found.fall = true;
      return found;
    }
  }
  const PlausibleRange range = plausible(setup);
  for (const LengthUnit unit : kUnits) {
    const double of_gravity = a / per_metre(unit) / gravity_m_s2;
    const bool too_long = distance_m / per_metre(unit) > kLongestRun_m;
    if (!too_long && of_gravity > range.least && of_gravity < range.most) found.units.push_back(unit);
  }
  // The times may be wrong as well: then the distance alone tells.
  if (found.units.empty()) {
    if (const std::optional<LengthUnit> unit = unit_of_long_run(distance_m)) found.units = {*unit};
  }
  return found;
}

}  // namespace

std::vector<Finding> motion_findings(const MotionLook& look, const ClipSetup& setup, double gravity_m_s2,
                                     bool any_moves) {
  std::vector<Finding> findings;
  FindingBook book(findings, {Subject::Part::clips, {setup.name}});
  const double a = look.acceleration_m_s2.value_or(0.0), sure = a - kMedian * look.acceleration_sd_m_s2;
  const bool falls = may_fall(setup);
  const double most = (falls ? kFarAboveGravity : kAboveGravity) * gravity_m_s2;
  if (look.counted) {
    book.add(Severity::unusable, found::Counted{*look.counted});
  } else if (look.positions >= kFewestToRest && look.noise_m > kLeastLost_m &&
             look.noise_m > kLostInNoise * look.distance_m) {
    book.add(Severity::unusable, found::LostInNoise{look.noise_m, look.distance_m});
  } else if (is_at_rest(look)) {
    book.add(any_moves ? Severity::change : Severity::unusable,
             found::AtRest{look.distance_m > 0.0 ? look.spread_m : 0.0});
  } else if (look.oscillates) {
    book.add(Severity::unusable, found::Oscillation{look.turns});
  } else if (sure > most || look.speeding_up_m_s2 > kFarAboveGravity * gravity_m_s2) {
    book.add(Severity::unusable,
             beyond_gravity(std::max(a, look.speeding_up_m_s2), look.distance_m, setup, gravity_m_s2), Topic::length);
  } else if (a > kFreeFall * gravity_m_s2 && !falls) {
    book.add(Severity::unusable, found::FreeFall{a / gravity_m_s2, setup.incline_rad * base::kDegreesPerRad},
             Topic::incline);
  } else if (sure > kAboveGravity * gravity_m_s2) {
    book.add(Severity::change, found::FallAboveGravity{a, gravity_m_s2}, Topic::length);
  } else if (look.distance_m > (falls ? kLongFall_m : kLongRange_m) &&
             !(falls && a > kLeastOfMetres * gravity_m_s2 && a < kAboveGravity * gravity_m_s2)) {
    book.add(Severity::change, found::LongRun{look.distance_m}, Topic::length);
  }
  if (findings.empty() && !falls && look.push_m_s2 > 0.0) {
    book.add(Severity::change, found::Pushed{look.push_m_s2, look.pushed_until_s});
  }
  if (look.frame_s >= kSlowFrames_s) book.add(Severity::change, found::SlowFrames{look.frame_s});
  if (look.unseen > kMostUnseen && look.frame_s < kSlowFrames_s) {
    book.add(Severity::change, found::Gaps{look.unseen, look.longest_gap_s});
  }
  if (look.bend > kMostBend) book.add(Severity::unusable, found::CurvedPath{look.bend});
  if (look.smooth && !look.counted && look.distance_m > 0.0) book.add(Severity::change, found::Smoothed{kSmoothPart});
  return findings;
}

void note_no_runs(AnalysisResults& results) {
  for (const ConfigurationResult& configuration : results.configurations) {
    for (ClipResult& clip : results.clips) {
      if (std::find(configuration.clips.begin(), configuration.clips.end(), clip.name) == configuration.clips.end()) {
        continue;
      }
      ClipSetup setup;
      setup.name = clip.name;
      setup.incline_rad = configuration.incline_deg * base::kRadPerDegree;
      setup.incline_assumed = configuration.incline_assumed;
      for (const Finding& finding : motion_findings(look_at_motion(clip), setup, results.gravity_m_s2)) {
        const auto* const fault = std::get_if<found::MotionFault>(&finding.found);
        if (fault == nullptr ||
            !(std::holds_alternative<found::Oscillation>(*fault) || std::holds_alternative<found::CurvedPath>(*fault) ||
              std::holds_alternative<found::Counted>(*fault) || std::holds_alternative<found::LostInNoise>(*fault) ||
              std::holds_alternative<found::AtRest>(*fault))) {
          continue;
        }
        found::FaultWords words = found::fault_words(*fault);
        clip.notes.emplace_back(
            NoRun{std::move(words.found), std::move(words.advice), std::holds_alternative<found::AtRest>(*fault)});
      }
    }
  }
}

}  // namespace glidelab::core
