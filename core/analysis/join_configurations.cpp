// Clips of one configuration joined: equation (13) from the lines through the points of all of them (joint_line.h).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/analysis/analyze_motion.h"
#include "core/analysis/joint_line.h"
#include "core/motion/lines/line_fit.h"
#include "core/result/estimate.h"
#include "core/result/stated_values.h"

namespace glidelab::core {
namespace {

double degrees_of(double rad) {
  const double degrees = rad * 180.0 / std::numbers::pi;
  return std::round(degrees * 1e9) / 1e9 + 0.0;  // 4, not 4.000000000000001; + 0.0: no -0
}

/// The mean of the directions' K/m, each weighted by one over its variance. Where the two lie further apart than three
/// standard deviations, half of what is unexplained is a variance of each direction's own (DerSimonian and Laird 1986,
/// who add it at any distance; two right lines would then state 1.2 times their standard deviation on average): it
/// evens out the weights, and the standard deviation grows with the spread.
Quantity mean_k(const std::vector<LineFit>& lines) {
  if (lines.empty()) return undetermined("no line: no direction has enough points that count");
  double between = 0.0;
  if (lines.size() == 2) {
    const double apart = lines[0].k_over_m_1_s.value - lines[1].k_over_m_1_s.value;
    double allowed = lines[0].parts.var_k + lines[1].parts.var_k;
    const std::vector<LineShift> one = shared_shifts(lines[0]), other = shared_shifts(lines[1]);
    for (std::size_t i = 0; i < std::max(one.size(), other.size()); ++i) {
      const double shift = (i < one.size() ? one[i].k : 0.0) - (i < other.size() ? other[i].k : 0.0);
      allowed += shift * shift;
    }
    if (apart * apart > 9.0 * allowed) between = 0.5 * (apart * apart - allowed);
  }
  double weights = 0.0, value = 0.0, degrees = std::numeric_limits<double>::infinity();
  std::vector<double> shared;
  for (const LineFit& line : lines) {
    const double weight = 1.0 / std::max(line.parts.var_k + between, 1e-30);  // noise-free points weigh the same
    weights += weight;
    value += weight * line.k_over_m_1_s.value;
    const std::vector<LineShift> shifts = shared_shifts(line);
    if (shared.size() < shifts.size()) shared.resize(shifts.size(), 0.0);
    for (std::size_t k = 0; k < shifts.size(); ++k) shared[k] += weight * shifts[k].k;
    degrees = std::min(degrees, line.parts.degrees);
  }
  double variance = 1.0 / weights;
  for (const double shift : shared) variance += std::pow(shift / weights, 2);
  return determined(estimate(value / weights, std::sqrt(variance), degrees), std::sqrt(1.0 / weights));
}

/// A quantity with the gradient (by_minus, by_plus) in (a0-, a0+).
Quantity of_intercepts(double value, double by_minus, double by_plus, const LineFit& minus, const LineFit& plus) {
  const double random = by_minus * by_minus * minus.parts.var_a0 + by_plus * by_plus * plus.parts.var_a0;
  double variance = random;
  const std::vector<LineShift> of_minus = shared_shifts(minus), of_plus = shared_shifts(plus);
  for (std::size_t k = 0; k < std::max(of_minus.size(), of_plus.size()); ++k) {
    const double a = k < of_minus.size() ? by_minus * of_minus[k].a0 : 0.0;
    const double b = k < of_plus.size() ? by_plus * of_plus[k].a0 : 0.0;
    variance += (a + b) * (a + b);
  }
  const double degrees = std::min(minus.parts.degrees, plus.parts.degrees);
  return determined(estimate(value, std::sqrt(variance), degrees), std::sqrt(random));
}

/// Equation (13): (a0- + a0+)/2 = g sin(alpha), (a0- - a0+)/2 = mu g cos(alpha).
void split_intercepts(const LineFit& minus, const LineFit& plus, double gravity_m_s2, ConfigurationResult& result) {
  const double mean = 0.5 * (minus.a0_m_s2.value + plus.a0_m_s2.value);
  const double half_jump = 0.5 * (minus.a0_m_s2.value - plus.a0_m_s2.value);
  if (std::abs(mean) >= gravity_m_s2) {
    const std::string why = fmt::format("the mean of a0 is {:.4g} m/s^2, no less than gravity", mean);
    result.alpha_deg = result.mu = undetermined(why);
    return;
  }
  const double alpha = std::asin(mean / gravity_m_s2);
  const double g_cos = gravity_m_s2 * std::cos(alpha);
  const double degrees = 180.0 / std::numbers::pi;
  const double by_mean = degrees / g_cos;
  result.alpha_deg = of_intercepts(alpha * degrees, 0.5 * by_mean, 0.5 * by_mean, minus, plus);
  // mu = half_jump / sqrt(g^2 - mean^2)
  const double by_jump = 1.0 / g_cos, mu_by_mean = half_jump * mean / std::pow(g_cos, 3);
  result.mu = of_intercepts(half_jump / g_cos, 0.5 * (mu_by_mean + by_jump), 0.5 * (mu_by_mean - by_jump), minus, plus);
}

void recover(const std::vector<LineFit>& lines, double gravity_m_s2, ConfigurationResult& result) {
  result.k_over_m_1_s = mean_k(lines);
  result.v_lim_m_s = limit_velocity(lines);
  if (lines.size() == 2) {
    split_intercepts(lines[0], lines[1], gravity_m_s2, result);
    return;
  }
  const std::string missing = lines.empty()                  ? "v < 0 and none for v > 0"
                              : lines.front().direction == 1 ? "v < 0"
                                                             : "v > 0";
  result.alpha_deg = result.mu =
      undetermined("no line for " + missing + ": equation (13) needs both directions to tell friction from slope");
}

void set_correction(const Quantity& as_fitted, Quantity& recovered) {
  if (!as_fitted.estimate || !recovered.estimate) return;
  recovered.smoothing_correction = recovered.estimate->value - as_fitted.estimate->value;
}

/// Where there is no line because the motion that it needs went against the stated launch, that is why.
void tell_launch(const std::vector<MemberClip>& members, ConfigurationResult& result) {
  std::string told, told_of_limit;
  for (const MemberClip& member : members) {
    const std::optional<AgainstLaunch>& against = member.clip->against_launch;
    if (!against || !against->until_s) continue;
    if (std::any_of(result.lines.begin(), result.lines.end(),
                    [&](const LineFit& line) { return line.direction == against->direction; })) {
      continue;
    }
    const std::string of_clip = fmt::format("; {}: {} (launched and downhill in experiment.toml say so)",
                                            member.clip->name, sentence(*against));
    told += of_clip;
    if (against->direction > 0) told_of_limit += of_clip;
  }
  if (!result.mu.estimate) result.mu.why += told;
  if (!result.alpha_deg.estimate) result.alpha_deg.why += told;
  if (!result.v_lim_m_s.estimate) result.v_lim_m_s.why += told_of_limit;
  if (!result.k_over_m_1_s.estimate) result.k_over_m_1_s.why += told;
}

ConfigurationResult join_members(const std::vector<MemberClip>& members, double gravity_m_s2, LineMethod lines) {
  ConfigurationResult result;
  result.mass_kg = members.front().setup->mass_kg;
  result.incline_deg = degrees_of(members.front().setup->incline_rad);
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
    recover(result.lines, gravity_m_s2, result);
    tell_launch(members, result);
    return result;
  }
  ConfigurationResult as_fitted;
  recover(result.lines, gravity_m_s2, as_fitted);
  recover(join_lines(members, lines, LawBiasIs::taken_off), gravity_m_s2, result);
  tell_launch(members, result);
  set_correction(as_fitted.k_over_m_1_s, result.k_over_m_1_s);
  set_correction(as_fitted.mu, result.mu);
  set_correction(as_fitted.alpha_deg, result.alpha_deg);
  set_correction(as_fitted.v_lim_m_s, result.v_lim_m_s);
  return result;
}

}  // namespace

std::vector<ConfigurationResult> join_configurations(const std::vector<ClipSetup>& setups,
                                                     const std::vector<ClipResult>& clips, double gravity_m_s2,
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
    results.push_back(join_members(members, gravity_m_s2, lines));
  }
  note_statements(results, gravity_m_s2);
  return results;
}

}  // namespace glidelab::core
