#include "diagnose/tracks/track_set.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/math/angles.h"
#include "base/math/dense.h"
#include "core/math/quantile.h"
#include "core/motion/smoothing/noise.h"
#include "diagnose/tracks/neighbour_residual.h"
#include "diagnose/tracks/rounded_positions.h"
#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {
namespace {

constexpr double kPixelError_px = 0.01;
constexpr double kLeastTravel_px = 1.0;

}  // namespace

void add_pixel_modes(const core::ClipResult& clip, const std::vector<std::size_t>& frames, std::size_t first_mode,
                     TrackedMotion& motion) {
  std::vector<double> columns, rows;
  auto sighting = clip.sightings.begin();
  for (const std::size_t frame : frames) {
    while (sighting != clip.sightings.end() && sighting->frame < frame) ++sighting;
    if (sighting == clip.sightings.end() || sighting->frame != frame) return;  // a clip from a track
    columns.push_back(sighting->u_px);
    rows.push_back(sighting->v_px);
  }
  if (frames.empty()) return;
  motion.row_px = rows;
  const auto extent_of = [](const std::vector<double>& at) {
    const auto [low, high] = std::minmax_element(at.begin(), at.end());
    return *high - *low;
  };
  const std::vector<double>& along = extent_of(columns) >= extent_of(rows) ? columns : rows;
  if (extent_of(along) < kLeastTravel_px) return;
  motion.along_px = along;
  motion.m_per_px = extent_of(motion.x_m) / extent_of(along);
  motion.shared_m.resize(std::max(motion.shared_m.size(), first_mode + kPixelModes));
  motion.first_pixel_mode = first_mode;
  for (std::size_t k = 0; k < kPixelModes; ++k) {
    const double turns = k < 2 ? 1.0 : 2.0, phase = k % 2 == 0 ? 0.0 : 0.25;
    std::vector<double>& mode = motion.shared_m[first_mode + k];
    mode.clear();
    for (const double s : along) {
      mode.push_back(kPixelError_px * motion.m_per_px * std::sin(2.0 * std::numbers::pi * (turns * s + phase)));
    }
  }
}

std::vector<std::vector<double>> without_pixel_errors(const std::vector<TrackedMotion>& motions) {
  constexpr double kOutlier = 5.0;  // standard deviations off the neighbours
  constexpr auto kMany = static_cast<Eigen::Index>(kPixelModes);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Identity(kMany, kMany);  // prior of each amplitude: N(0, 1)
  Eigen::VectorXd right = Eigen::VectorXd::Zero(kMany);
  const auto has = [](const TrackedMotion& motion) { return motion.shared_m.size() > motion.first_pixel_mode; };
  for (const TrackedMotion& motion : motions) {
    for (std::size_t i = 2; has(motion) && i + 2 < motion.t_s.size(); ++i) {
      const auto near = motion.outlier.begin() + static_cast<std::ptrdiff_t>(i) - 2;
      if (std::any_of(near, near + 5, [](char out) { return out != 0; })) continue;
      const double off = neighbour_residual(motion.t_s, motion.x_m, i) / motion.sd_m;
      if (std::abs(off) > kOutlier) continue;
      Eigen::VectorXd row(kMany);
      for (Eigen::Index k = 0; k < kMany; ++k) {
        const auto& mode = motion.shared_m[motion.first_pixel_mode + static_cast<std::size_t>(k)];
        row[k] = neighbour_residual(motion.t_s, mode, i) / motion.sd_m;
      }
      normal += row * row.transpose();
      right += off * row;
    }
  }
  const Eigen::MatrixXd amplitude = base::solve_positive(normal, right);
  std::vector<std::vector<double>> without;
  for (const TrackedMotion& motion : motions) {
    without.push_back(motion.x_m);
    for (std::size_t k = 0; has(motion) && k < kPixelModes; ++k) {
      const auto& mode = motion.shared_m[motion.first_pixel_mode + k];
      for (std::size_t p = 0; p < mode.size(); ++p)
        without.back()[p] -= amplitude(static_cast<Eigen::Index>(k), 0) * mode[p];
    }
  }
  return without;
}

namespace {

// Of a motion: its start takes two, and the noise shows in five. A short piece of a clip that has a longer one is a
// remnant of a collision or a hand, and would mislead more than inform.
constexpr std::size_t kFewestPoints = 6, kFewestOfPiece = 12;
constexpr std::size_t kFewestForNoise = 8;  // residuals from the neighbours
constexpr double kOutlier = 5.0;            // standard deviations off the neighbours
constexpr double kLongestBridge = 0.08;     // s of disputed frames within a motion that are bridged
constexpr double kLeastNoise = 1e-7;        // of the longest distance covered: no camera or sensor measures better

enum class Kind { no, free, disputed };

Kind kind_of(const core::MotionPoint& point, bool all) {
  using core::LeftOut;
  if (!point.measured_m) return Kind::no;
  switch (point.left_out) {
    case LeftOut::used:
    case LeftOut::kernel_end:
    case LeftOut::kernel_reversal:
    case LeftOut::kernel_gap:
    case LeftOut::outlier:
    case LeftOut::short_stretch:
      return Kind::free;
    case LeftOut::hand:
    case LeftOut::stop:
      return all ? Kind::free : Kind::disputed;
    default:
      return Kind::no;
  }
}

double slope(const std::vector<core::MotionPoint>& motion, std::size_t from, std::size_t to) {
  const auto& a = motion[from];
  const auto& b = motion[to];
  return (*b.measured_m - *a.measured_m) / (b.t_s - a.t_s);
}

struct Run {
  std::size_t from = 0, to = 0;  // frames, inclusive, both measured and free
};

std::vector<Run> runs_of(const core::ClipResult& clip, bool all) {
  std::vector<Run> runs;
  const auto& motion = clip.motion;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (kind_of(motion[i], all) != Kind::free) continue;
    bool joins = false;
    if (!runs.empty()) {
      const std::size_t last = runs.back().to;
      bool rest = false;
      for (std::size_t j = last + 1; j < i; ++j) rest = rest || kind_of(motion[j], all) == Kind::no;
      rest = rest && std::any_of(motion.begin() + static_cast<long>(last), motion.begin() + static_cast<long>(i),
                                 [](const core::MotionPoint& p) { return p.left_out == core::LeftOut::rest; });
      const bool near = motion[i].t_s - motion[last].t_s <= kLongestBridge || i == last + 1;
      const bool room = last >= runs.back().from + 2 && i + 2 < motion.size() && motion[i + 2].measured_m;
      const bool same_direction =
          i == last + 1 || (room && slope(motion, last - 2, last) * slope(motion, i, i + 2) > 0.0);
      joins = near && !rest && same_direction;
    }
    if (joins) {
      runs.back().to = i;
    } else {
      runs.push_back({i, i});
    }
  }
  return runs;
}

/// Ratio of the errors of camera and plane to those that the calibration's own noise explains: if the pattern fits its
/// plane view less well, the corners have errors that the modes do not include. Never below 1.
double calibration_excess(const core::AnalysisResults& results, const std::string& experiment) {
  for (const core::CalibrationResult& calibration : results.calibrations) {
    if (calibration.experiment != experiment || !(calibration.plane_expected_px > 0.0)) continue;
    return std::max(1.0, calibration.plane_rms_px / calibration.plane_expected_px);
  }
  return 1.0;
}

TrackedMotion motion_of(const core::ClipResult& clip, const Run& run, bool all, std::size_t camera_modes,
                        double excess) {
  TrackedMotion motion;
  std::vector<std::size_t> frames;
  const double first = clip.motion.front().t_s;
  // A border with something else is known to about a bandwidth.
  double from = clip.motion[run.from].t_s, to = clip.motion[run.to].t_s;
  const auto before = run.from > 0 ? clip.motion[run.from - 1].left_out : core::LeftOut::before_start;
  const auto after = run.to + 1 < clip.motion.size() ? clip.motion[run.to + 1].left_out : core::LeftOut::after_end;
  if (before != core::LeftOut::before_start && !(all && before == core::LeftOut::no_marker)) from += clip.bandwidth_s;
  if (after != core::LeftOut::after_end) to -= clip.bandwidth_s;
  for (std::size_t i = run.from; i <= run.to; ++i) {
    const core::MotionPoint& point = clip.motion[i];
    if (kind_of(point, all) != Kind::free || point.t_s < from || point.t_s > to) continue;
    motion.t_s.push_back(point.t_s - first);
    motion.x_m.push_back(*point.measured_m);
    motion.outlier.push_back(point.left_out == core::LeftOut::outlier ? 1 : 0);
    frames.push_back(i);
  }
  if (motion.t_s.empty()) return motion;
  motion.start_s = motion.t_s.front();
  motion.shared_m.resize(clip.shared_m.size());
  for (std::size_t m = 0; m < clip.shared_m.size(); ++m) {
    if (clip.shared_m[m].empty()) continue;
    for (const std::size_t frame : frames) motion.shared_m[m].push_back(excess * clip.shared_m[m][frame]);
    const bool any =
        std::any_of(motion.shared_m[m].begin(), motion.shared_m[m].end(), [](double s) { return s != 0.0; });
    if (!any) motion.shared_m[m].clear();
  }
  motion.scale_sd = excess * clip.scale_sd_relative;
  for (std::size_t i = run.from; clip.forced && i <= run.to; ++i) {
    if (!clip.motion[i].measured_m) continue;
    motion.known.t_s.push_back(clip.motion[i].t_s - first);
    motion.known.force_n.push_back(clip.motion[i].applied_n);
  }
  add_pixel_modes(clip, frames, camera_modes, motion);
  return motion;
}

/// The step to which the positions of a clip are rounded; 0 if they are not.
double step_of(const core::ClipResult& clip) {
  std::vector<double> x_m;
  for (const core::MotionPoint& point : clip.motion) {
    if (point.measured_m) x_m.push_back(*point.measured_m);
  }
  return core::rounding_step(x_m);
}

/// The plumb lines and readings of a set-up, each of them once, however many clips have it.
void add_statements(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups, TrackSet& set) {
  const auto add = [&set](std::size_t group, const InclineStatement& statement) {
    std::vector<InclineStatement>& known = set.groups[group].statements;
    const auto same = [&](const InclineStatement& other) {
      return other.against == statement.against && other.sd_rad == statement.sd_rad &&
             std::abs(other.alpha_rad - statement.alpha_rad) < core::kSameIncline_rad;
    };
    if (std::none_of(known.begin(), known.end(), same)) known.push_back(statement);
  };
  for (const TrackedMotion& motion : set.motions) {
    const core::ClipSetup& setup = setups[motion.clip];
    for (const core::PlumbResult& plumb : results.plumbs) {
      if (plumb.group != setup.group || plumb.experiment != results.clips[motion.clip].experiment) continue;
      if (!plumb.plumb_deg.estimate) continue;
      const core::Estimate& deg = *plumb.plumb_deg.estimate;
      add(motion.group, {deg.value * base::kRadPerDegree, deg.sd * base::kRadPerDegree, Against::plumb});
    }
  }
  for (const TrackedMotion& motion : set.motions) {
    const core::ClipSetup& setup = setups[motion.clip];
    if (!setup.incline_sd_rad || !(*setup.incline_sd_rad > 0.0)) continue;
    add(motion.group, {setup.incline_rad, *setup.incline_sd_rad, Against::stated});
  }
}

/// The set-up of a clip. Clips of one group that state different inclinations share a set-up if their uncertainties
/// allow it and one folder says so; otherwise each has its own.
std::size_t group_of(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups, std::size_t clip,
                     TrackSet& set) {
  const core::ClipSetup& setup = setups[clip];
  for (const TrackedMotion& motion : set.motions) {
    const core::ClipSetup& other = setups[motion.clip];
    if (other.group != setup.group) continue;
    const bool readings = setup.incline_sd_rad && other.incline_sd_rad && !core::contradicts(setup, other) &&
                          results.clips[clip].experiment == results.clips[motion.clip].experiment;
    if (readings || std::abs(other.incline_rad - setup.incline_rad) < core::kSameIncline_rad) return motion.group;
  }
  set.groups.push_back({setup.group, setup.incline_rad, {}, 0.0});
  return set.groups.size() - 1;
}

std::size_t mass_of(const core::ClipSetup& setup, TrackSet& set) {
  for (std::size_t m = 0; m < set.masses.size(); ++m) {
    if (set.masses[m].mass_kg == setup.mass_kg && set.masses[m].sd_kg == setup.mass_sd_kg) return m;
  }
  set.masses.push_back({setup.mass_kg, setup.mass_sd_kg});
  return set.masses.size() - 1;
}

/// One level for all clips if theirs differ by no more than their own errors; otherwise half way between.
void share_noise(std::vector<TrackedMotion>& motions) {
  double sum = 0.0, weights = 0.0, chi2 = 0.0;
  for (const TrackedMotion& motion : motions) {
    const auto n = static_cast<double>(motion.t_s.size());
    sum += n * std::log(motion.sd_m);
    weights += n;
  }
  const double mean = sum / weights;
  // Variance of log sd from fourth differences of n points: 2.63 / (2 n).
  for (const TrackedMotion& motion : motions) {
    chi2 += std::pow(std::log(motion.sd_m) - mean, 2) * static_cast<double>(motion.t_s.size()) / 1.32;
  }
  const double freedom = static_cast<double>(motions.size()) - 1.0;
  const double own = std::clamp(1.0 - freedom / std::max(chi2, 1e-9), 0.0, 1.0);  // James-Stein shrinkage
  for (TrackedMotion& motion : motions) motion.sd_m = std::exp(mean + own * (std::log(motion.sd_m) - mean));
}

/// Residuals from the neighbours, at points that are not outliers and have none beside them.
std::vector<double> neighbour_residuals(const std::vector<double>& t_s, const std::vector<double>& x_m,
                                        const std::vector<char>& outlier) {
  std::vector<double> residuals;
  for (std::size_t i = 2; i + 2 < t_s.size(); ++i) {
    if (outlier[i - 2] || outlier[i - 1] || outlier[i] || outlier[i + 1] || outlier[i + 2]) continue;
    residuals.push_back(neighbour_residual(t_s, x_m, i));
  }
  return residuals;
}

}  // namespace

void measure_noise(std::vector<TrackedMotion>& motions, const std::vector<std::vector<double>>& late_s) {
  double least_m = 0.0;
  for (const TrackedMotion& motion : motions) {
    const auto [low, high] = std::minmax_element(motion.x_m.begin(), motion.x_m.end());
    least_m = std::max(least_m, kLeastNoise * (*high - *low));
  }
  const auto measure = [&](const std::vector<std::vector<double>>& x_m) {
    std::vector<std::size_t> of_short;
    std::vector<double> together;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      TrackedMotion& motion = motions[i];
      std::vector<double> t_s = motion.t_s;
      for (std::size_t p = 0; p < t_s.size() && !late_s.empty(); ++p) t_s[p] += late_s[i][p];
      const std::vector<double>& x = x_m.empty() ? motion.x_m : x_m[i];
      motion.sd_m = std::max(neighbour_noise(t_s, x, motion.outlier), least_m);
      motion.wider.clear();
      motion.coarser.clear();
      const std::vector<double> own = neighbour_residuals(t_s, x, motion.outlier);
      if (own.size() >= kFewestForNoise) continue;
      of_short.push_back(i);
      for (const double off : own) together.push_back(std::abs(off));
    }
    // Short motions show it only all together.
    if (together.size() < kFewestForNoise) return;
    const double sd_m = std::max(core::kSdOverMedian * core::median_of(std::move(together)), least_m);
    for (const std::size_t i : of_short) motions[i].sd_m = sd_m;
  };
  measure({});
  constexpr int kRounds = 3;  // the weights are the noise without the sub-pixel errors
  const bool filmed = std::any_of(motions.begin(), motions.end(), [](const TrackedMotion& motion) {
    return motion.shared_m.size() > motion.first_pixel_mode;
  });
  for (int round = 0; filmed && round < kRounds; ++round) measure(without_pixel_errors(motions));
  share_noise(motions);
  for (TrackedMotion& motion : motions) add_rounding(motion);
}

double neighbour_noise(const std::vector<double>& t_s, const std::vector<double>& x_m,
                       const std::vector<char>& outlier) {
  const double pilot = core::pilot_noise(t_s, x_m);
  double sum = 0.0, count = 0.0;
  for (const double off : neighbour_residuals(t_s, x_m, outlier)) {
    if (std::abs(off) > kOutlier * pilot) continue;
    sum += off * off;
    count += 1.0;
  }
  // The pilot's value includes rounding; it is kept if hardly any points are left.
  return count < static_cast<double>(kFewestForNoise) ? pilot : std::max(std::sqrt(sum / count), 0.7 * pilot);
}

TrackSet track_set(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups, bool all) {
  TrackSet set;
  set.gravity_m_s2 = results.gravity_m_s2;
  set.gravity_sd_m_s2 = results.gravity_sd_m_s2;
  std::size_t camera_modes = 0;
  for (const core::ClipResult& clip : results.clips) {
    camera_modes = std::max(camera_modes, clip.shared_m.size());
  }
  for (std::size_t c = 0; c < results.clips.size(); ++c) {
    const core::ClipResult& clip = results.clips[c];
    const double duration = clip.motion.empty() ? 0.0 : clip.motion.back().t_s - clip.motion.front().t_s;
    set.clips.push_back({clip.name, clip.frame_rate_hz, duration, clip.frames, clip.bandwidth_s, clip.lost_frames});
    for (core::LostFrames& gap : set.clips.back().lost) gap.after_s -= clip.motion.front().t_s;
    set.images = set.images || !clip.sightings.empty();
    for (const core::MotionPoint& point : clip.motion) {
      set.disputed += point.left_out == core::LeftOut::hand || point.left_out == core::LeftOut::stop;
      set.moving += kind_of(point, true) == Kind::free;
      set.left_out += kind_of(point, all) == Kind::disputed;
    }
    bool any = false;
    const double excess = calibration_excess(results, clip.experiment);
    std::vector<TrackedMotion> of_clip;
    std::size_t longest = 0;
    for (const Run& run : runs_of(clip, all)) {
      of_clip.push_back(motion_of(clip, run, all, camera_modes, excess));
      longest = std::max(longest, of_clip.back().t_s.size());
    }
    const double step_m = step_of(clip);
    for (TrackedMotion& motion : of_clip) {
      if (motion.t_s.size() < std::max(kFewestPoints, std::min(longest, kFewestOfPiece))) continue;
      motion.clip = c;
      motion.step_m = step_m;
      motion.group = group_of(results, setups, c, set);
      motion.mass = mass_of(setups[c], set);
      set.modes = std::max(set.modes, motion.shared_m.size());
      set.motions.push_back(std::move(motion));
      any = true;
    }
    if (!any) set.notes.emplace_back(NoFreeMotion{clip.name, kFewestPoints});
    for (const core::Note& note : clip.notes) {
      if (core::is_of_reading(note)) set.notes.emplace_back(OfReading{clip.name, note});
    }
  }
  if (set.motions.empty()) return set;
  measure_noise(set.motions);
  thin_out(set, kFewestPoints);
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;
  for (std::size_t g = 0; g < set.groups.size(); ++g) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const TrackedMotion& motion : set.motions) {
      if (motion.group != g) continue;
      for (const double x : motion.x_m) {
        low = std::min(low, x);
        high = std::max(high, x);
      }
    }
    set.groups[g].x_mid_m = 0.5 * (low + high);
    lowest = std::min(lowest, low);
    highest = std::max(highest, high);
  }
  set.x_mid_m = 0.5 * (lowest + highest);
  add_statements(results, setups, set);
  set.plain_scale =
      results.calibrations.empty() &&
      std::none_of(results.clips.begin(), results.clips.end(), [](const auto& clip) { return clip.sightings.empty(); });
  set.through_air = falls_through_air(set);
  set.mass_assumed = std::any_of(setups.begin(), setups.end(), [](const auto& setup) { return setup.mass_assumed; });
  return set;
}

}  // namespace glidelab::diagnose
