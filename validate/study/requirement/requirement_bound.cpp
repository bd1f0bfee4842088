#include "validate/study/requirement/requirement_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/math/quantile.h"
#include "validate/tracks/camera_noise.h"
#include "validate/truth/cramer_rao.h"

namespace glidelab::validate {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

std::vector<double> noise_without(const Setting& setting, const Truth& truth, const WithoutLimit& without) {
  if (setting.given_noise_m) return std::vector<double>(truth.clips.size(), *setting.given_noise_m);
  return predicted_noise_m(setting.scenario, truth, without);
}

double need_of(const Setting& setting, const WithoutLimit& without, const std::vector<Target>& targets) {
  const MadeTracks made = make_tracks(setting.scenario, 1);
  return hardest(bounds(made, noise_without(setting, made.truth, without), targets), targets);
}

}  // namespace

std::vector<double> noise_of(const Setting& setting, const Truth& truth) {
  return noise_without(setting, truth, {});
}

std::vector<TargetResult> bounds(const MadeTracks& made, const std::vector<double>& noise_m,
                                 const std::vector<Target>& targets) {
  std::vector<TargetResult> results(targets.size());
  if (std::any_of(noise_m.begin(), noise_m.end(), [](double noise) { return !std::isfinite(noise); })) {
    for (TargetResult& result : results) result.bound = kNever;
    return results;
  }
  const std::vector<LeastSd> all = least_sds(made.truth, noise_m, made.gravity_m_s2);
  for (std::size_t t = 0; t < targets.size(); ++t) {
    for (const LeastSd& least : all) {
      const std::optional<double> sd = least_sd_of(least, targets[t].quantity);
      if (!sd) continue;
      const double factor = targets[t].measure == Target::Measure::sd        ? 1.0
                            : targets[t].measure == Target::Measure::error95 ? core::kNormal95
                                                                             : 0.0;
      results[t].bound = std::max(results[t].bound.value_or(0.0), factor * *sd);
    }
  }
  return results;
}

double hardest(const std::vector<TargetResult>& results, const std::vector<Target>& targets) {
  double need = 0.0;
  for (std::size_t t = 0; t < targets.size(); ++t) {
    need = std::max(need, results[t].bound ? *results[t].bound / targets[t].value : kNever);
  }
  return need;
}

std::vector<Limit> limits_of(const Setting& setting, double need, const std::vector<Target>& targets) {
  std::vector<Limit> limits;
  const auto try_without = [&](const std::string& name, const Setting& changed, const WithoutLimit& without) {
    const double then = need_of(changed, without, targets);
    if (std::isfinite(then) && then > 0.0) limits.push_back({name, need / then});
  };
  constexpr double kFast_hz = 1000.0;
  if (setting.scenario.recording.frame_rate_hz < kFast_hz) {
    Setting fast = setting;
    fast.scenario.recording.frame_rate_hz = kFast_hz;
    try_without("frame rate (1000 Hz instead, the same exposure)", fast, {});
  }
  if (!setting.given_noise_m) {
    try_without("light (no shot noise)", setting, {.shot_noise = true});
    try_without("the camera's own noise (none)", setting, {.camera_noise = true});
    try_without("motion blur (none)", setting, {.motion_blur = true});
    try_without("resolution (4 times finer)", setting, {.finer = 4.0});
  }
  std::sort(limits.begin(), limits.end(), [](const Limit& a, const Limit& b) { return a.gain > b.gain; });
  return limits;
}

}  // namespace glidelab::validate
