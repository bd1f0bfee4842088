#include "diagnose/verdict/derived_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "diagnose/gap/held_out.h"

namespace glidelab::diagnose {
namespace {

constexpr double kSameScale = 1.05;

/// The group's name, with its inclination where another set-up has that name.
std::string own_name(const TrackSet& set, std::size_t group) {
  const auto named = [&](const TrackGroup& other) { return other.name == set.groups[group].name; };
  if (std::count_if(set.groups.begin(), set.groups.end(), named) == 1) return set.groups[group].name;
  return fmt::format("{} ({:.6g} deg)", set.groups[group].name,
                     set.groups[group].stated_rad * 180.0 / std::numbers::pi);
}

/// `share` of the way from the set-up's own middle to that of all.
std::vector<DiagnosedParameter> middles(const TrackSet& set, double share, double share_sd) {
  std::vector<DiagnosedParameter> parameters;
  for (std::size_t g = 0; g < set.groups.size(); ++g) {
    const double way = set.x_mid_m - set.groups[g].x_mid_m;
    parameters.push_back({set.groups.size() == 1 ? "x_mid_m" : "x_mid_m." + own_name(set, g),
                          set.groups[g].x_mid_m + share * way, way == 0.0 ? 0.0 : std::abs(way) * share_sd});
  }
  return parameters;
}

/// Pixels of a metre along the motion; 0 where the clips do not have one.
double px_per_m(const PictureEvidence& pictures) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const FilmedClip& clip : pictures.clips) {
    least = std::min(least, clip.px_per_m);
    most = std::max(most, clip.px_per_m);
  }
  return most > 0.0 && most < kSameScale * least ? 0.5 * (least + most) : 0.0;
}

}  // namespace

std::vector<DiagnosedParameter> derived_parameters(const TrackSet& set, const MotionFit& fit, std::size_t effect,
                                                   const PictureEvidence& pictures,
                                                   const std::vector<DiagnosedParameter>& known) {
  const auto& globals = fit.layout->globals();
  const auto at = [&](const EffectSlot& slot) {
    return std::find_if(globals.begin(), globals.end(), [&](const ParameterLayout::Global& global) {
      return global.parameter != nullptr && global.effect == effect && global.parameter->slot == slot;
    });
  };
  const auto index = [&](auto global) { return static_cast<Eigen::Index>(global - globals.begin()); };
  if (at(slot_of(ids::track_bow)) != globals.end()) return middles(set, 0.0, 0.0);
  if (const auto about = at(slot_of(ids::damping_gradient, 1)); about != globals.end()) {
    const Eigen::MatrixXd covariance = common_covariance(fit);
    const double variance = covariance(index(about), index(about));
    return middles(set, fit.at.global[index(about)], std::sqrt(std::max(0.0, variance)));
  }
  const auto in_metres = std::find_if(known.begin(), known.end(), [](const auto& p) { return p.key == "amplitude_m"; });
  const bool in_pixels = std::any_of(known.begin(), known.end(), [](const auto& p) { return p.key == "amplitude_px"; });
  const double scale = px_per_m(pictures);
  if (in_metres == known.end() || in_pixels || scale == 0.0) return {};
  return {{"amplitude_px", in_metres->value * scale, in_metres->sd * scale}};
}

}  // namespace glidelab::diagnose
