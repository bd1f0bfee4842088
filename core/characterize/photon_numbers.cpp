#include "core/characterize/photon_numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/math/least_squares.h"

namespace glidelab::core {
namespace {

constexpr double kPi = std::numbers::pi;

bool is_out(std::size_t cell, std::optional<std::size_t> without_tile) {
  return without_tile && cell / 4 == *without_tile;
}

/// Mean over the pixels of a set's cells.
template <typename Value>
double mean_over(const FlatFieldStack& stack, std::optional<std::size_t> without_tile, Value value) {
  double sum = 0.0;
  double pixels = 0.0;
  for (std::size_t c = 0; c < stack.cells.size(); ++c) {
    if (is_out(c, without_tile) || stack.cells[c].pixels == 0.0) continue;
    sum += stack.cells[c].pixels * value(stack.cells[c]);
    pixels += stack.cells[c].pixels;
  }
  return sum / pixels;
}

double mean_of(const FlatFieldStack& stack, std::optional<std::size_t> without_tile) {
  return mean_over(stack, without_tile, [](const CellStatistics& cell) { return cell.mean_dn; });
}

double variance_of(const FlatFieldStack& stack, std::optional<std::size_t> without_tile) {
  return mean_over(stack, without_tile, [](const CellStatistics& cell) { return cell.temporal_dn2 - kQuantisation; });
}

/// Level of the dark frames as a line in the exposure; without several exposures its slope is not known.
void dark_level(const Evidence& evidence, std::optional<std::size_t> without_tile, PhotonNumbers& numbers) {
  LineSums sums;
  for (std::size_t d = 0; d < evidence.darks.size(); ++d) {
    if (evidence.exposure_s[d]) sums.add(1.0, *evidence.exposure_s[d], mean_of(evidence.darks[d], without_tile));
  }
  if (evidence.darks.size() > 1 && sums.is_regular(1e-9)) {
    numbers.dark_slope_dn_s = sums.slope();
    numbers.offset_dn = sums.intercept();
  } else {
    numbers.offset_dn = mean_of(evidence.darks.front(), without_tile);
  }
}

/// Spatial variance of a set, without the temporal noise that remains in the mean of the frames, and mean square of the
/// light above dark, summed over the pixels of the pattern.
struct PatternSums {
  double pixels = 0.0;
  double spatial_dn2 = 0.0;
  double light_squared_dn2 = 0.0;
};

PatternSums pattern_sums(const Evidence& evidence, const std::vector<CellPattern>& pattern,
                         const std::vector<char>* counts, std::optional<std::size_t> without_tile) {
  PatternSums sums;
  for (std::size_t c = 0; c < pattern.size(); ++c) {
    if (is_out(c, without_tile) || pattern[c].pixels == 0.0) continue;
    if (counts != nullptr && (*counts)[c] == 0) continue;
    const double light = pattern[c].mean_dn - evidence.dark_pattern[c].mean_dn;
    sums.pixels += pattern[c].pixels;
    sums.spatial_dn2 += pattern[c].squares_dn2 - pattern[c].noise_dn2;
    sums.light_squared_dn2 += pattern[c].pixels * light * light;
  }
  return sums;
}

void fixed_pattern(const Evidence& evidence, std::optional<std::size_t> without_tile, PhotonNumbers& numbers) {
  if (evidence.pattern_levels.empty()) return;
  const auto flat_sums = [&](std::size_t i) {
    return pattern_sums(evidence, evidence.flat_pattern[i], &evidence.counts[evidence.pattern_levels[i]], without_tile);
  };
  double dsnu_squared_dn2 = PhotonNumbers::kNone;
  if (evidence.dark_pattern_shown) {
    const PatternSums dark = pattern_sums(evidence, evidence.dark_pattern, nullptr, without_tile);
    dsnu_squared_dn2 = dark.spatial_dn2 / dark.pixels;
    // The dark pattern of the same cells over which the flat field's sums are taken.
    const std::vector<char>& counts = evidence.counts[evidence.pattern_levels.front()];
    const PatternSums same = pattern_sums(evidence, evidence.dark_pattern, &counts, without_tile);
    const PatternSums flat = flat_sums(0);
    numbers.prnu_squared = (flat.spatial_dn2 - same.spatial_dn2) / flat.light_squared_dn2;
  } else if (evidence.pattern_levels.size() > 1) {
    LineSums line;
    for (std::size_t i = 0; i < evidence.pattern_levels.size(); ++i) {
      const PatternSums sums = flat_sums(i);
      line.add(evidence.pattern_weight[i], sums.light_squared_dn2 / sums.pixels, sums.spatial_dn2 / sums.pixels);
    }
    numbers.prnu_squared = line.slope();
    dsnu_squared_dn2 = line.intercept();
  }
  numbers.dsnu_squared_e2 = dsnu_squared_dn2 / (numbers.gain * numbers.gain);
}

/// Codes above the offset at which the output stops rising.
double saturation_above_offset(const Evidence& evidence, const PhotonNumbers& numbers,
                               std::optional<std::size_t> without_tile) {
  if (evidence.saturation.top_dn) return *evidence.saturation.top_dn - numbers.offset_dn;
  if (!evidence.saturation.plateau_level) return PhotonNumbers::kNone;
  const FlatFieldStack& flat = evidence.flats[*evidence.saturation.plateau_level];
  const FlatFieldStack& dark = evidence.darks.front();
  double sum = 0.0;
  double pixels = 0.0;
  for (std::size_t c = 0; c < flat.cells.size(); ++c) {
    if (is_out(c, without_tile) || evidence.saturation.plateau_cells[c] == 0) continue;
    sum += flat.cells[c].pixels * (flat.cells[c].mean_dn - dark.cells[c].mean_dn);
    pixels += flat.cells[c].pixels;
  }
  return sum / pixels + mean_of(dark, without_tile) - numbers.offset_dn;
}

LineSums line_sums(const Evidence& evidence, std::optional<std::size_t> without_tile) {
  LineSums line;
  for (std::size_t level = 0; level < evidence.flats.size(); ++level) {
    if (evidence.weight[level] == 0.0) continue;
    const LevelPoint point = level_point(evidence, level, without_tile);
    if (point.pixels > 0.0) line.add(evidence.weight[level], point.mean_dn, point.variance_dn2);
  }
  if (evidence.dark_weight > 0.0) {
    line.add(evidence.dark_weight, 0.0, variance_of(evidence.darks.front(), without_tile));
  }
  return line;
}

constexpr std::array kMembers = {&PhotonNumbers::gain,
                                 &PhotonNumbers::intercept_dn2,
                                 &PhotonNumbers::offset_dn,
                                 &PhotonNumbers::dark_slope_dn_s,
                                 &PhotonNumbers::dark_signal_e_s,
                                 &PhotonNumbers::read_variance_e2,
                                 &PhotonNumbers::full_well_e,
                                 &PhotonNumbers::saturation_capacity_e,
                                 &PhotonNumbers::prnu_squared,
                                 &PhotonNumbers::dsnu_squared_e2};

}  // namespace

double rounding_of_variance(double variance_dn2, double spread_dn2) {
  return (4.0 * variance_dn2 + 1.0 / (kPi * kPi)) * std::exp(-2.0 * kPi * kPi * std::max(spread_dn2, 0.0));
}

double rounding_of_mean(double spread_dn2) {
  // The error of the mean is sum over k of (-1)^k sin(2 pi k mu) / (pi k) exp(-2 pi² k² spread²).
  double variance = 0.0;
  for (int k = 1; k <= 1000; ++k) {
    const double harmonic = std::exp(-2.0 * kPi * kPi * k * k * std::max(spread_dn2, 0.0)) / (kPi * k);
    variance += 0.5 * harmonic * harmonic;
    if (harmonic < 1e-6) break;
  }
  return std::sqrt(variance);
}

LevelPoint level_point(const Evidence& evidence, std::size_t level, std::optional<std::size_t> without_tile) {
  const FlatFieldStack& flat = evidence.flats[level];
  const FlatFieldStack& dark = evidence.darks.front();
  LevelPoint point;
  double squares = 0.0;
  for (std::size_t c = 0; c < flat.cells.size(); ++c) {
    if (is_out(c, without_tile) || evidence.counts[level][c] == 0) continue;
    const CellStatistics& cell = flat.cells[c];
    point.pixels += cell.pixels;
    point.mean_dn += cell.pixels * (cell.mean_dn - dark.cells[c].mean_dn);
    point.variance_dn2 += cell.pixels * (cell.temporal_dn2 - kQuantisation);
    squares += cell.pixels * cell.temporal_dn2 * cell.temporal_dn2;
  }
  if (point.pixels == 0.0) return point;
  point.mean_dn /= point.pixels;
  point.variance_dn2 /= point.pixels;
  point.sampling_dn4 = 2.0 * squares / point.pixels / (point.pixels * static_cast<double>(flat.frames - 1));
  return point;
}

LineSensitivity line_sensitivity(const Evidence& evidence) {
  const LineSums line = line_sums(evidence, std::nullopt);
  LineSensitivity result;
  const auto add = [&](double weight, double at) {
    result.gain.push_back(weight * (line.w * at - line.x) / line.determinant());
    result.intercept.push_back(weight * (line.xx - line.x * at) / line.determinant());
  };
  for (std::size_t level = 0; level < evidence.flats.size(); ++level) {
    add(evidence.weight[level], level_point(evidence, level, std::nullopt).mean_dn);
  }
  add(evidence.dark_weight, 0.0);
  return result;
}

PhotonNumbers photon_numbers(const Evidence& evidence, std::optional<std::size_t> without_tile) {
  PhotonNumbers numbers;
  dark_level(evidence, without_tile, numbers);
  const LineSums line = line_sums(evidence, without_tile);
  if (line.determinant() > 0.0) {
    numbers.gain = line.slope();
    numbers.intercept_dn2 = line.intercept();
  }
  const double gain2 = numbers.gain * numbers.gain;
  numbers.dark_signal_e_s = numbers.dark_slope_dn_s / numbers.gain;
  double dark_variance_dn2 =
      evidence.read_noise_from_dark ? variance_of(evidence.darks.front(), without_tile) : numbers.intercept_dn2;
  if (std::isfinite(numbers.dark_slope_dn_s) && evidence.exposure_s.front()) {
    dark_variance_dn2 -= numbers.gain * numbers.dark_slope_dn_s * *evidence.exposure_s.front();  // its shot noise
  }
  numbers.read_variance_e2 = dark_variance_dn2 / gain2;
  numbers.full_well_e = saturation_above_offset(evidence, numbers, without_tile) / numbers.gain;
  if (evidence.saturation.peak) numbers.saturation_capacity_e = evidence.saturation.peak->mean_dn / numbers.gain;
  fixed_pattern(evidence, without_tile, numbers);
  return numbers;
}

PhotonNumbers jackknife_sd(const Evidence& evidence, std::size_t tiles) {
  std::vector<PhotonNumbers> without;
  for (std::size_t tile = 0; tile < tiles; ++tile) without.push_back(photon_numbers(evidence, tile));
  PhotonNumbers sd;
  const auto count = static_cast<double>(tiles);
  for (double PhotonNumbers::*member : kMembers) {
    double mean = 0.0;
    for (const PhotonNumbers& numbers : without) mean += numbers.*member / count;
    double squares = 0.0;
    for (const PhotonNumbers& numbers : without) squares += (numbers.*member - mean) * (numbers.*member - mean);
    sd.*member = std::sqrt((count - 1.0) / count * squares);
  }
  return sd;
}

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

/// Errors of the line of dark levels over exposure, from each set's own error, and from their scatter if there are
/// three or more sets.
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
  // Without the dark frames' variance the line is extrapolated to their mean, which may be off.
  if (evidence.dark_weight == 0.0) errors.intercept_variance += square(numbers.gain * errors.offset_dn);
  return errors;
}

}  // namespace glidelab::core
