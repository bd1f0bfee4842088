#include "core/characterize/linearity.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/line_sums.h"

namespace glidelab::core {
namespace {

constexpr double kLinearityFrom = 0.05;  // of saturation
constexpr double kLinearityTo = 0.95;
constexpr double kMostClippedForLinearity = 1e-3;

struct ExposedLevel {
  double exposure_s;
  double mean_dn;
  double sd_dn;  // of the mean, from the scatter of the frames
};

double scatter(const FlatFieldStack& flat) {
  const auto frames = static_cast<double>(flat.frames);
  double mean = 0.0;
  for (const double value : flat.frame_means_dn) mean += value / frames;
  double squares = 0.0;
  for (const double value : flat.frame_means_dn) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / (frames - 1.0) / frames);
}

}  // namespace

Measured linearity_error(const Evidence& evidence, const FlatFieldFolder& folder, double saturation_dn) {
  std::vector<ExposedLevel> levels;
  const double dark_dn = evidence.darks.front().all.mean_dn;
  for (std::size_t i = 0; i < evidence.flats.size(); ++i) {
    const FlatFieldStack& flat = evidence.flats[i];
    const double mean_dn = flat.all.mean_dn - dark_dn;
    if (!folder.flats[i].exposure_s || flat.all.at_largest > kMostClippedForLinearity) continue;
    if (mean_dn < kLinearityFrom * saturation_dn || mean_dn > kLinearityTo * saturation_dn) continue;
    levels.push_back({*folder.flats[i].exposure_s, mean_dn, scatter(flat)});
  }
  Measured result;
  LineSums line;
  for (const ExposedLevel& level : levels) {
    line.add(1.0 / (level.mean_dn * level.mean_dn), level.exposure_s, level.mean_dn);
  }
  if (levels.size() < 3 || !line.is_regular(1e-9)) {
    result.why =
        "it requires three or more levels, 5 to 95 % of saturation, taken with different exposures to the same light "
        "(exposures_s)";
    return result;
  }
  const double slope = line.slope(), intercept = line.intercept();
  const auto count = static_cast<double>(levels.size());
  double sum = 0.0;
  double variance = 0.0;
  for (const ExposedLevel& level : levels) {
    sum += std::abs(level.mean_dn / (intercept + slope * level.exposure_s) - 1.0);
    variance += level.sd_dn * level.sd_dn / (level.mean_dn * level.mean_dn);
  }
  result.value = sum / count;
  result.sd = std::sqrt(variance) / count;
  return result;
}

}  // namespace glidelab::core
