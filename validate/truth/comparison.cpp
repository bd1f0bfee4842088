#include "validate/truth/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.h"
#include "core/result/quantity.h"
#include "validate/truth/cramer_rao.h"

namespace glidelab::validate {
namespace {

QuantityComparison compare_quantity(std::string name, const std::optional<double>& truth,
                                    const core::Quantity& quantity) {
  QuantityComparison compared;
  compared.quantity = std::move(name);
  compared.truth = truth;
  compared.why = quantity.why;
  if (!quantity.estimate) return compared;
  compared.value = quantity.estimate->value;
  compared.sd = quantity.estimate->sd;
  compared.noise_sd = quantity.noise_sd;
  if (truth) compared.error = quantity.estimate->value - *truth;
  return compared;
}

bool share_a_clip(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  return std::any_of(a.begin(), a.end(),
                     [&](const std::string& name) { return std::find(b.begin(), b.end(), name) != b.end(); });
}

}  // namespace

std::vector<QuantityComparison> compare_quantities(const core::AnalysisResults& results, const Truth& truth) {
  std::vector<QuantityComparison> quantities;
  for (const TrueConfiguration& expected : truth.configurations) {
    for (const core::ConfigurationResult& found : results.configurations) {
      if (!share_a_clip(expected.clips, found.clips)) continue;
      for (const core::QuantityName& quantity : core::kQuantities) {
        QuantityComparison compared = compare_quantity(
            std::string(quantity.key), core::value_of(expected, quantity.which), core::value_of(found, quantity.which));
        compared.configuration = expected.name;
        compared.mass_kg = found.mass_kg;
        compared.incline_deg = found.incline_deg;
        compared.estimator = results.estimator;
        quantities.push_back(std::move(compared));
      }
    }
  }
  return quantities;
}

std::vector<QuantityComparison> with_bounds(std::vector<QuantityComparison> quantities,
                                            const std::vector<LeastSd>& bounds) {
  for (QuantityComparison& compared : quantities) {
    const auto bound = std::find_if(bounds.begin(), bounds.end(), [&](const LeastSd& candidate) {
      return candidate.configuration == compared.configuration;
    });
    if (bound == bounds.end()) continue;
    compared.cramer_rao_sd = least_sd_of(*bound, compared.quantity);
    if (!compared.cramer_rao_sd || !compared.noise_sd || !(*compared.noise_sd > 0.0)) continue;
    compared.efficiency = std::pow(*compared.cramer_rao_sd / *compared.noise_sd, 2);
  }
  return quantities;
}

std::vector<QuantityComparison> join_estimators(std::vector<QuantityComparison> first,
                                                const std::vector<QuantityComparison>& second) {
  for (const QuantityComparison& compared : second) {
    const auto same = std::find_if(first.rbegin(), first.rend(), [&](const QuantityComparison& candidate) {
      return candidate.configuration == compared.configuration;
    });
    first.insert(same == first.rend() ? first.end() : same.base(), compared);
  }
  return first;
}

namespace {

const TrueClip& truth_of(const core::ClipResult& clip, const Truth& truth) {
  const auto found = std::find_if(truth.clips.begin(), truth.clips.end(),
                                  [&](const TrueClip& candidate) { return candidate.name == clip.name; });
  if (found == truth.clips.end()) {
    throw base::InputError(base::Issue{"truth.json", 0, "clips", fmt::format("no clip \"{}\"", clip.name),
                                       "the truth of the experiment that was analysed"});
  }
  if (clip.motion.size() > found->x_m.size()) {
    throw base::InputError(base::Issue{"truth.json", 0, fmt::format("clip \"{}\"", clip.name),
                                       fmt::format("{} frames", found->x_m.size()),
                                       fmt::format("the {} frames that were analysed", clip.motion.size())});
  }
  return *found;
}

RestitutionComparison compare_positions(const core::AnalysisResults& results, const Truth& truth) {
  RestitutionComparison compared;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  double sum_of_squares = 0.0;
  for (std::size_t c = 0; c < results.clips.size(); ++c) {
    const core::ClipResult& clip = results.clips[c];
    const TrueClip& expected = truth_of(clip, truth);
    for (std::size_t frame = 0; frame < clip.motion.size(); ++frame) {
      const core::MotionPoint& point = clip.motion[frame];
      // With a rolling shutter a marker off the middle row is seen slightly before or after the frame's time.
      const double late_s = point.t_s - expected.t_s[frame];
      const double x_m = expected.x_m[frame] +
                         late_s * (expected.v_m_s[frame] + 0.5 * late_s * expected.a_m_s2[frame]) - expected.x_origin_m;
      low = std::min(low, x_m);
      high = std::max(high, x_m);
      if (!point.measured_m) continue;
      const double error_m = *point.measured_m - x_m;
      sum_of_squares += error_m * error_m;
      compared.max_m = std::max(compared.max_m, std::abs(error_m));
      compared.points.push_back({c, expected.t_s[frame], x_m, error_m, frame});
    }
  }
  if (!compared.points.empty())
    compared.rms_m = std::sqrt(sum_of_squares / static_cast<double>(compared.points.size()));
  if (high > low) compared.field_m = high - low;
  return compared;
}

}  // namespace

Comparison compare(const core::AnalysisResults& results, const Truth& truth) {
  for (const TrueClip& clip : truth.clips) {
    const bool analysed = std::any_of(results.clips.begin(), results.clips.end(),
                                      [&](const core::ClipResult& found) { return found.name == clip.name; });
    if (!analysed) {
      throw base::InputError(base::Issue{"truth.json", 0, "clips", fmt::format("a clip \"{}\"", clip.name),
                                         "only clips of the experiment that was analysed"});
    }
  }
  Comparison comparison;
  comparison.restitution = compare_positions(results, truth);
  comparison.quantities = compare_quantities(results, truth);
  for (const core::ClipResult& clip : results.clips) {
    comparison.frames += clip.frames;
    comparison.detected += clip.detected;
    for (const core::LineFit& line : clip.segments) comparison.lines.push_back({clip.name, line.direction, line.r2});
  }
  return comparison;
}

}  // namespace glidelab::validate
