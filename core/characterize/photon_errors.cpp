#include "core/characterize/photon_errors.h"

#include <algorithm>
#include <cmath>

namespace glidelab::core {
namespace {

/// How far the dark level moves from frame to frame beyond its pixels' noise, as a variance of the mean of the frames.
double drift_variance(const FlatFieldStack& stack) {
  const auto frames = static_cast<double>(stack.frames);
  double mean = 0.0;
  for (const double value : stack.frame_means_dn) mean += value / frames;
  double squares = 0.0;
  for (const double value : stack.frame_means_dn) squares += square(value - mean) / (frames - 1.0);
  return std::max(0.0, squares - stack.all.temporal_dn2 / stack.all.pixels) / frames;
}

/// Of the line of dark levels over exposure, from each set's own error, and from their scatter where three or more
/// show it.
void dark_line(const Evidence& evidence, const PhotonNumbers& numbers, const std::vector<double>& variance,
               SharedErrors& errors) {
  const auto sets = static_cast<double>(variance.size());
  double mean_s = 0.0;
  for (const auto& exposure : evidence.exposure_s) mean_s += *exposure / sets;
  double lever = 0.0;
  double scatter = 0.0;
  for (std::size_t d = 0; d < variance.size(); ++d) {
    lever += square(*evidence.exposure_s[d] - mean_s);
    scatter +=
        square(evidence.darks[d].all.mean_dn - numbers.offset_dn - numbers.dark_slope_dn_s * *evidence.exposure_s[d]);
  }
  double slope = 0.0;
  double offset = 0.0;
  for (std::size_t d = 0; d < variance.size(); ++d) {
    const double arm = (*evidence.exposure_s[d] - mean_s) / lever;
    slope += square(arm) * variance[d];
    offset += square(1.0 / sets - arm * mean_s) * variance[d];
  }
  if (sets > 2.0) {
    const double residual = scatter / (sets - 2.0);
    slope = std::max(slope, residual / lever);
    offset = std::max(offset, residual * (1.0 / sets + square(mean_s) / lever));
  }
  errors.dark_slope_dn_s = std::sqrt(slope);
  errors.offset_dn = std::sqrt(offset);
}

}  // namespace

SharedErrors shared_errors(const Evidence& evidence, const PhotonNumbers& numbers) {
  SharedErrors errors;
  std::vector<double> variance;
  for (const FlatFieldStack& set : evidence.darks) {
    variance.push_back(drift_variance(set) + square(rounding_of_mean(spread_dn2(set))));
  }
  errors.offset_dn = std::sqrt(variance.front());
  if (std::isfinite(numbers.dark_slope_dn_s)) dark_line(evidence, numbers, variance, errors);

  const LineSensitivity sensitivity = line_sensitivity(evidence);
  for (std::size_t i = 0; i < sensitivity.gain.size(); ++i) {
    const FlatFieldStack& stack = i < evidence.flats.size() ? evidence.flats[i] : evidence.darks.front();
    const double temporal = std::max(0.0, stack.all.temporal_dn2 - kQuantisation);
    const double rounding = 0.5 * square(rounding_of_variance(temporal, spread_dn2(stack)));
    errors.gain_variance += square(sensitivity.gain[i]) * rounding;
    errors.intercept_variance += square(sensitivity.intercept[i]) * rounding;
  }
  // Without the dark frames' variance the line is carried on to their mean, which may be off.
  if (evidence.dark_weight == 0.0) errors.intercept_variance += square(numbers.gain * errors.offset_dn);
  return errors;
}

}  // namespace glidelab::core
