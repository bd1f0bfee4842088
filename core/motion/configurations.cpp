#include "core/motion/configurations.h"

#include <Eigen/Dense>
#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/math/angles.h"
#include "core/math/least_squares.h"
#include "core/motion/lines/line_fit.h"
#include "core/motion/lines/line_law.h"
#include "core/motion/lines/mu_and_alpha.h"
#include "core/motion/speed_motion.h"
#include "core/motion/steady_fall.h"

namespace glidelab::core {

namespace {

/// A clip of a configuration; both outlive it.
struct MemberClip {
  const ClipSetup* setup;
  const ClipResult* clip;
};

/// Whether the clips' lines keep the kernel's bias of a line that follows its own law, or have it subtracted
/// (line_law.h).
enum class LawBiasIs { kept, taken_off };

Eigen::Matrix2d random_part(const LineUncertainty& parts) {
  Eigen::Matrix2d covariance;
  covariance << parts.var_k, parts.cov, parts.cov, parts.var_a0;
  return covariance;
}

/// One direction of one clip: the weight of its line (the moments of its points, or the line's inverse covariance), and
/// the line.
struct Part {
  std::size_t member = 0;
  LineFit line;
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  std::vector<double> v, a;
};

std::vector<Part> parts_of(const std::vector<MemberClip>& members, int direction, LineMethod lines, LawBiasIs bias) {
  std::vector<Part> parts;
  for (std::size_t m = 0; m < members.size(); ++m) {
    const MemberClip& member = members[m];
    for (const LineFit& line : member.clip->segments) {
      if (line.direction != direction) continue;
      Part part;
      part.member = m;
      part.line = bias == LawBiasIs::kept ? line : without_law_bias(line);
      for (const MotionPoint& point : member.clip->motion) {
        if (point.left_out != LeftOut::used || (point.v_m_s > 0.0 ? 1 : -1) != direction) continue;
        part.v.push_back(point.v_m_s);
        part.a.push_back(point.a_m_s2 - point.force_n / member.setup->mass_kg);
        const Eigen::Vector2d design(-point.v_m_s, 1.0);
        part.normal += design * design.transpose();
      }
      const Eigen::Matrix2d random = random_part(line.parts);
      if (lines == LineMethod::generalised && random.determinant() > 0.0) part.normal = random.inverse();
      parts.push_back(std::move(part));
    }
  }
  return parts;
}

Eigen::Vector2d off_joint(const Part& part, const Eigen::Vector2d& joint) {
  return Eigen::Vector2d(part.line.k_over_m_1_s.value, part.line.a0_m_s2.value) - joint;
}

/// Whether the clips' own lines scatter about the joint one by more than their uncertainty and chance allow. (Widening
/// for every chi^2 above 1 would make the standard deviation of two correct lines 17 % too large on average.)
bool clips_scatter(const std::vector<Part>& parts, const Eigen::Vector2d& joint) {
  if (parts.size() < 2) return false;
  double chi2 = 0.0;
  for (const Part& part : parts) {
    Eigen::Matrix2d covariance = random_part(part.line.parts);
    for (const LineShift& shift : shared_shifts(part.line)) {
      const Eigen::Vector2d both(shift.k, shift.a0);
      covariance += both * both.transpose();
    }
    if (!(covariance.determinant() > 0.0)) return false;
    const Eigen::Vector2d off = off_joint(part, joint);
    chi2 += off.dot(covariance.inverse() * off);
  }
  const double freedom = 2.0 * static_cast<double>(parts.size() - 1);
  return chi2 > freedom * chi2_ratio_limit(freedom);
}

/// If the clips' lines scatter: the covariance of the clips' scores N_c (line_c - joint), as one change of the line for
/// each clip. A clip that has a larger K/m has it in both directions, so the changes of both lines add up with their
/// signs.
///
///     covariance = n/(n - 1) sum of N^-1 N_c d_c d_c' N_c N^-1,     n - 1 degrees of freedom
///
/// It contains the noise, and nothing is assumed of how K/m and a0 scatter.
void add_scatter(const std::vector<Part>& parts, const Eigen::Matrix2d& inverse, const Eigen::Vector2d& joint,
                 LineUncertainty& to) {
  if (!clips_scatter(parts, joint)) return;
  const auto n = static_cast<double>(parts.size());
  const double wider = std::sqrt(n / (n - 1.0));
  to.clips.resize(parts.back().member + 1);
  for (const Part& part : parts) {
    const Eigen::Vector2d moved = wider * (inverse * (part.normal * off_joint(part, joint)));
    to.clips[part.member] = {moved[0], moved[1]};
  }
  to.clip_degrees = n - 1.0;
}

/// The covariance of the joint lines, each of the part's weights times the clips' own covariances.
void join_cross(const std::vector<Part>& minus, const std::vector<Part>& plus, LineFit& of_minus, LineFit& of_plus) {
  const auto inverse_of = [](const std::vector<Part>& parts) {
    Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
    for (const Part& part : parts) normal += part.normal;
    return Eigen::Matrix2d(normal.inverse());
  };
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const Part& one : minus) {
    for (const Part& other : plus) {
      if (one.member != other.member) continue;
      const LineCross& own = one.line.parts.with_other;
      Eigen::Matrix2d cross;
      cross << own.k_k, own.k_a0, own.a0_k, own.a0_a0;
      sum += one.normal * cross * other.normal;
    }
  }
  const Eigen::Matrix2d joint = inverse_of(minus) * sum * inverse_of(plus);
  of_minus.parts.with_other = {joint(0, 0), joint(0, 1), joint(1, 0), joint(1, 1)};
  of_plus.parts.with_other = {joint(0, 0), joint(1, 0), joint(0, 1), joint(1, 1)};
}

/// Least squares through the points of all parts; ordinary: every point with the same weight. The parts' noise is
/// independent: cov = N^-1 (sum N_c cov_c N_c) N^-1 with the normal matrices N_c of the parts.
LineFit join(const std::vector<Part>& parts, int direction) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero(), random = Eigen::Matrix2d::Zero();
  Eigen::Vector2d line = Eigen::Vector2d::Zero(), smoothing = line, mass = line;
  std::vector<Eigen::Vector2d> calibration;
  double var_a0 = 0.0, var2_per_degree = 0.0;
  LineFit joint;
  joint.direction = direction;
  joint.from_v_m_s = parts.front().line.from_v_m_s;
  joint.to_v_m_s = parts.front().line.to_v_m_s;
  for (const Part& part : parts) {
    const LineUncertainty& of = part.line.parts;
    normal += part.normal;
    line += part.normal * Eigen::Vector2d(part.line.k_over_m_1_s.value, part.line.a0_m_s2.value);
    random += part.normal * random_part(of) * part.normal;
    const LineShift law = of.law ? of.law->shift : LineShift{};
    smoothing += part.normal * Eigen::Vector2d(of.smoothing_k + law.k, of.smoothing_a0 + law.a0);
    mass += part.normal * Eigen::Vector2d(of.mass_k, of.mass_a0);
    const double share = part.normal(1, 1) * part.normal(1, 1) * of.var_a0;
    var_a0 += share;
    var2_per_degree += share * share / of.degrees;
    joint.points += part.line.points;
    joint.from_v_m_s = std::min(joint.from_v_m_s, part.line.from_v_m_s);
    joint.to_v_m_s = std::max(joint.to_v_m_s, part.line.to_v_m_s);
    joint.parts.scale_relative = std::max(joint.parts.scale_relative, of.scale_relative);
    if (calibration.size() < of.calibration.size()) calibration.resize(of.calibration.size(), Eigen::Vector2d::Zero());
    for (std::size_t mode = 0; mode < of.calibration.size(); ++mode) {
      calibration[mode] += part.normal * Eigen::Vector2d(of.calibration[mode].k, of.calibration[mode].a0);
    }
  }
  const Eigen::Matrix2d inverse = normal.inverse();
  const Eigen::Vector2d solution = inverse * line;
  const Eigen::Matrix2d covariance = inverse * random * inverse;
  joint.k_over_m_1_s.value = solution[0];
  joint.a0_m_s2.value = solution[1];
  joint.parts.var_k = covariance(0, 0);
  joint.parts.var_a0 = covariance(1, 1);
  joint.parts.cov = covariance(0, 1);
  // Welch-Satterthwaite: degrees of freedom of a sum of variances.
  joint.parts.degrees = var2_per_degree > 0.0 ? std::max(1.0, var_a0 * var_a0 / var2_per_degree)
                                              : std::numeric_limits<double>::infinity();
  add_scatter(parts, inverse, solution, joint.parts);
  joint.parts.smoothing_k = (inverse * smoothing)[0];
  joint.parts.smoothing_a0 = (inverse * smoothing)[1];
  joint.parts.mass_k = (inverse * mass)[0];
  joint.parts.mass_a0 = (inverse * mass)[1];
  for (const Eigen::Vector2d& sum : calibration) {
    const Eigen::Vector2d shift = inverse * sum;
    joint.parts.calibration.push_back({shift[0], shift[1]});
  }
  PairCorrelation correlation;
  for (const Part& part : parts) correlation.add(part.v, part.a);
  joint.r2 = correlation.squared();
  complete_line(joint);
  return joint;
}

/// At most one line for each direction, v < 0 first: least squares through the points of all members. Their noise is
/// independent; shared errors (LineUncertainty) add up with their signs. If the lines scatter about the joint one by
/// more than their uncertainty allows, its uncertainty is widened.
std::vector<LineFit> join_lines(const std::vector<MemberClip>& members, LineMethod lines, LawBiasIs bias) {
  std::vector<LineFit> joined;
  std::vector<std::vector<Part>> of_lines;
  for (const int direction : {-1, 1}) {
    std::vector<Part> parts = parts_of(members, direction, lines, bias);
    if (parts.empty()) continue;
    joined.push_back(join(parts, direction));
    of_lines.push_back(std::move(parts));
  }
  if (joined.size() == 2) join_cross(of_lines[0], of_lines[1], joined[0], joined[1]);
  return joined;
}

double degrees_of(double rad) {
  const double degrees = rad * base::kDegreesPerRad;
  return std::round(degrees * 1e9) / 1e9 + 0.0;  // 4, not 4.000000000000001; + 0.0: no -0
}

/// Whether a direction has points enough for a line.
bool has_points(const std::vector<MemberClip>& members) {
  for (const int direction : {-1, 1}) {
    std::size_t points = 0;
    for (const MemberClip& member : members) {
      for (const MotionPoint& point : member.clip->motion) {
        points += point.left_out == LeftOut::used && (point.v_m_s > 0.0 ? 1 : -1) == direction;
      }
    }
    if (points >= kFewestLinePoints) return true;
  }
  return false;
}

void recover(const std::vector<LineFit>& lines, const Gravity& gravity, const std::vector<MemberClip>& members,
             ConfigurationResult& result) {
  if (lines.empty() && has_points(members)) {
    result.k_over_m_1_s = result.mu = result.alpha_deg = result.v_lim_m_s = undetermined(unknown::SpeedHardlyChanges{});
    return;
  }
  result.k_over_m_1_s = mean_k(lines);
  result.v_lim_m_s = limit_velocity(lines);
  if (lines.size() == 2) {
    const MuAndAlpha found = mu_and_alpha_of_intercepts(lines[0], lines[1], gravity);
    result.mu = found.mu;
    result.alpha_deg = found.alpha_deg;
    return;
  }
  if (lines.empty()) {
    result.alpha_deg = result.mu = undetermined(unknown::NotBothLines{.minus = true, .plus = true});
    return;
  }
  result.alpha_deg =
      undetermined(unknown::NotBothLines{.minus = lines.front().direction == 1, .plus = lines.front().direction == -1});
  result.mu = mu_of_line(lines.front(), gravity, result);
}

void set_correction(const Quantity& as_fitted, Quantity& recovered) {
  if (!as_fitted.estimate || !recovered.estimate) return;
  recovered.smoothing_correction = recovered.estimate->value - as_fitted.estimate->value;
}

/// Adds to the reasons that a line is missing because the motion that it needs went against the stated launch.
void tell_launch(const std::vector<MemberClip>& members, ConfigurationResult& result) {
  std::vector<ClipAgainstLaunch> told, told_of_limit;
  for (const MemberClip& member : members) {
    const std::optional<AgainstLaunch>& against = member.clip->against_launch;
    if (!against || !against->until_s) continue;
    if (std::any_of(result.lines.begin(), result.lines.end(),
                    [&](const LineFit& line) { return line.direction == against->direction; })) {
      continue;
    }
    told.push_back({member.clip->name, *against});
    if (against->direction > 0) told_of_limit.push_back(told.back());
  }
  if (result.mu.why) result.mu.why->against_launch = told;
  if (result.alpha_deg.why) result.alpha_deg.why->against_launch = told;
  if (result.v_lim_m_s.why) result.v_lim_m_s.why->against_launch = told_of_limit;
  if (result.k_over_m_1_s.why) result.k_over_m_1_s.why->against_launch = told;
}

ConfigurationResult join_members(const std::vector<MemberClip>& members, const Gravity& gravity, LineMethod lines) {
  ConfigurationResult result;
  result.mass_kg = members.front().setup->mass_kg;
  result.incline_deg = degrees_of(members.front().setup->incline_rad);
  result.incline_assumed = members.front().setup->incline_assumed;
  result.group = members.front().setup->group;
  bool biased = false;
  for (const MemberClip& member : members) {
    result.clips.push_back(member.clip->name);
    if (const auto sd_rad = member.setup->incline_sd_rad) {
      const double sd_deg = degrees_of(*sd_rad);
      result.incline_sd_deg = std::min(result.incline_sd_deg.value_or(sd_deg), sd_deg);
    }
    for (const LineFit& line : member.clip->segments) biased = biased || line.parts.law.has_value();
  }
  result.lines = join_lines(members, lines, LawBiasIs::kept);
  if (!biased) {
    recover(result.lines, gravity, members, result);
    note_mu_from_incline(result);
    tell_launch(members, result);
    return result;
  }
  ConfigurationResult as_fitted = result;
  recover(result.lines, gravity, members, as_fitted);
  recover(join_lines(members, lines, LawBiasIs::taken_off), gravity, members, result);
  note_mu_from_incline(result);
  tell_launch(members, result);
  set_correction(as_fitted.k_over_m_1_s, result.k_over_m_1_s);
  set_correction(as_fitted.mu, result.mu);
  set_correction(as_fitted.alpha_deg, result.alpha_deg);
  set_correction(as_fitted.v_lim_m_s, result.v_lim_m_s);
  return result;
}

}  // namespace

std::vector<ConfigurationResult> configurations_of_clips(const std::vector<ClipSetup>& setups,
                                                         const std::vector<ClipResult>& clips, const Gravity& gravity,
                                                         LineMethod lines) {
  std::vector<std::vector<MemberClip>> configurations;
  for (std::size_t i = 0; i < setups.size(); ++i) {
    const auto same = [&](const std::vector<MemberClip>& members) {
      const ClipSetup& first = *members.front().setup;
      return first.mass_kg == setups[i].mass_kg && first.group == setups[i].group &&
             std::abs(first.incline_rad - setups[i].incline_rad) < kSameIncline_rad;
    };
    const auto found = std::find_if(configurations.begin(), configurations.end(), same);
    std::vector<MemberClip>& members = found != configurations.end() ? *found : configurations.emplace_back();
    members.push_back({&setups[i], &clips[i]});
  }
  std::vector<ConfigurationResult> results;
  for (const std::vector<MemberClip>& members : configurations) {
    results.push_back(join_members(members, gravity, lines));
  }
  add_steady_falls(clips, gravity.m_s2, results);
  note_statements(results, clips, gravity.m_s2);
  return results;
}

AnalysisResults analyze_tracks(const std::vector<ClipSetup>& setups, const std::vector<TrackData>& tracks,
                               const Gravity& gravity, const MotionOptions& options, int jobs,
                               const base::Progress& progress) {
  assert(setups.size() == tracks.size());
  AnalysisResults results;
  results.clips.resize(setups.size());
  std::atomic<std::size_t> done = 0;
  base::for_each_parallel(setups.size(), jobs, [&](std::size_t i) {
    results.clips[i] = tracks[i].v_m_s.empty() ? analyze_motion(setups[i], tracks[i], options)
                                               : analyze_speeds(setups[i], tracks[i], options);
    results.clips[i].images = tracks[i].images;
    progress("phase diagram", static_cast<double>(++done) / static_cast<double>(setups.size()));
  });
  results.gravity_m_s2 = gravity.m_s2;
  results.gravity_sd_m_s2 = gravity.sd_m_s2;
  results.configurations = configurations_of_clips(setups, results.clips, gravity, options.lines);
  note_gravity(results);
  results.estimator = name_of(options.lines);
  return results;
}

}  // namespace glidelab::core
