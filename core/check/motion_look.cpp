#include "core/check/motion_look.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/math/angles.h"
#include "base/math/dense.h"
#include "core/math/parabola.h"
#include "core/math/quantile.h"
#include "core/motion/free/motion.h"
#include "core/motion/smoothing/noise.h"
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
constexpr std::size_t kManyTurns = 6;
constexpr double kHarmonic = 0.8;                         // of the variance of a
constexpr double kSmoothPart = 1e-7;                      // of the range of x
constexpr double kAboveGravity = 1.05;                    // of g: a fall has 1
constexpr double kMedian = 2.0;                           // parabolas' sds by which the median of |a| is certain
constexpr double kFreeFall = 0.9, kShallow_rad = 1.05;    // of g, on an incline of less than 60 degrees
constexpr double kSameGravity = 0.1;                      // of g
constexpr double kMostBend = 0.08;                        // a wide lens bends a straight path by half of that
constexpr double kLongRange_m = 8.0, kLongFall_m = 20.0;  // on an incline of less than 60 degrees, and of more
constexpr double kSlowFrames_s = 1.0;                     // from one to the next
constexpr double kGapSteps = 3.0;                         // median steps: a longer one is a gap
constexpr double kMostUnseen = 0.2;                       // of the time

/// The median of |a| of parabolas through `size` points each, where it is above their noise.
void find_acceleration(std::span<const double> t_s, std::span<const double> x_m, std::size_t size, double noise_m,
                       MotionLook& look) {
  std::vector<double> sizes;
  double sd_m_s2 = 0.0;
  for (std::size_t from = 0; from + size <= x_m.size(); from += std::max<std::size_t>(1, size / 2)) {
    sizes.push_back(std::abs(parabola_through(t_s.subspan(from, size), x_m.subspan(from, size)).a));
    const double span = t_s[from + size - 1] - t_s[from];
    // Variance of a by n even points over a time T: 720 s²/(n T⁴).
    sd_m_s2 = std::max(sd_m_s2, noise_m * std::sqrt(720.0 / static_cast<double>(size)) / (span * span));
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

}  // namespace

MotionLook look_at_motion(std::span<const double> t_s, std::span<const double> x_m,
                          std::span<const MarkerSighting> sightings, bool forced) {
  MotionLook look;
  if (x_m.size() < kFewestPoints) return look;
  const auto [least, most] = std::minmax_element(x_m.begin(), x_m.end());
  look.distance_m = *most - *least;
  look.frame_s = (t_s.back() - t_s.front()) / static_cast<double>(t_s.size() - 1);
  look.bend = bend_of(sightings);
  look_for_gaps(t_s, look);
  const double noise_m = pilot_noise(t_s, x_m);
  look.smooth = noise_m < kSmoothPart * look.distance_m;
  if (forced) return look;
  const Motion steady = without_outliers(t_s, x_m);
  t_s = steady.t_s;
  x_m = steady.x_m;
  find_acceleration(t_s, x_m, std::max(kFewestOfParabola, x_m.size() / kParts), noise_m, look);
  if (!look.acceleration_m_s2 && is_parabola(t_s, x_m, kOffWhole * look.distance_m)) {
    find_acceleration(t_s, x_m, x_m.size(), noise_m, look);
  }
  look.turns = turns_in(x_m, std::max(kTurnOverNoise * noise_m, kTurnOverRange * look.distance_m));
  // Fine enough for a swing: eight parabolas between turns.
  if (look.turns >= kManyTurns) {
    const std::size_t fine = std::max(kFewestOfParabola, x_m.size() / (8 * (look.turns + 1)));
    std::vector<double> places, accelerations;
    for (std::size_t from = 0; from + fine <= x_m.size(); from += fine) {
      const Parabola parabola = parabola_through(t_s.subspan(from, fine), x_m.subspan(from, fine));
      places.push_back(parabola.middle);
      accelerations.push_back(parabola.a);
    }
    look.oscillates = harmonic_part(places, accelerations) > kHarmonic;
  }
  return look;
}

namespace {

/// Accelerations that no incline has, with the units of x that would explain them.
found::BeyondGravity beyond_gravity(double a, double gravity_m_s2) {
  found::BeyondGravity found{a, gravity_m_s2, {}, false};
  for (const LengthUnit unit : {LengthUnit::feet, LengthUnit::centimetres, LengthUnit::millimetres}) {
    if (std::abs(a / per_metre(unit) / gravity_m_s2 - 1.0) < kSameGravity) {
      found.units = {unit};
      found.fall = true;
      return found;
    }
  }
  if (a < 100.0 * gravity_m_s2) found.units.push_back(LengthUnit::centimetres);
  if (a > 20.0 * gravity_m_s2 && a < 1000.0 * gravity_m_s2) found.units.push_back(LengthUnit::millimetres);
  return found;
}

}  // namespace

std::vector<Finding> motion_findings(const MotionLook& look, const ClipSetup& setup, double gravity_m_s2) {
  std::vector<Finding> findings;
  FindingBook book(findings, {Subject::Part::clips, {setup.name}});
  const double a = look.acceleration_m_s2.value_or(0.0);
  if (look.oscillates) {
    book.add(Severity::unusable, found::Oscillation{look.turns});
  } else if (a - kMedian * look.acceleration_sd_m_s2 > kAboveGravity * gravity_m_s2) {
    book.add(Severity::unusable, beyond_gravity(a, gravity_m_s2), Topic::length);
  } else if (a > kFreeFall * gravity_m_s2 && std::abs(setup.incline_rad) < kShallow_rad) {
    book.add(Severity::unusable, found::FreeFall{a / gravity_m_s2, setup.incline_rad * base::kDegreesPerRad},
             Topic::incline);
  } else if (look.distance_m > (std::abs(setup.incline_rad) < kShallow_rad ? kLongRange_m : kLongFall_m)) {
    book.add(Severity::change, found::LongRun{look.distance_m}, Topic::length);
  }
  if (look.frame_s > kSlowFrames_s) book.add(Severity::change, found::SlowFrames{look.frame_s});
  if (look.unseen > kMostUnseen && look.frame_s <= kSlowFrames_s) {
    book.add(Severity::change, found::Gaps{look.unseen, look.longest_gap_s});
  }
  if (look.bend > kMostBend) book.add(Severity::unusable, found::CurvedPath{look.bend});
  if (look.smooth) book.add(Severity::change, found::Smoothed{kSmoothPart});
  return findings;
}

}  // namespace glidelab::core
