#include "core/characterize/photon_checks.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/least_squares.h"

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
    result.why = unmeasured::NoExposures{};
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

namespace {

constexpr double kCorrelationNoted = 0.015;
constexpr double kCorrelationRefused = 0.05;  // lowers the variance by 10 to 20 %
constexpr double kSuccessiveNoted = 0.98;
constexpr double kSuccessiveRefused = 0.95;
constexpr double kBendNoted = 0.02;
constexpr double kBendRefused = 0.10;
constexpr double kLinearityNoted = 0.01;
constexpr double kLinearityRefused = 0.05;
constexpr double kLevelSignificance = 5.0;  // standard deviations; there may be a hundred levels
constexpr double kMisfitSignificance = 3.0;
constexpr double kMostRelativeGainSd = 0.2;
constexpr double kFlickerNoted = 0.01;
constexpr double kKneeFrom = 0.75;  // of saturation: above the linear range
constexpr double kKneeTo = 0.90;    // above this a full well of a few hundred electrons clips the noise itself
constexpr double kKneeVariance = 0.5;

double neighbour_correlation(const FlatFieldStack& stack) {
  return std::max(std::abs(stack.correlation_right), std::abs(stack.correlation_below));
}

/// Mean variance over that of the line, of the cells between 75 and 90 % of saturation; empty if there are none.
std::optional<double> variance_below_saturation(const CameraEvidence& gathered, const PhotonNumbers& numbers) {
  const Evidence& evidence = gathered.evidence;
  double seen = 0.0;
  double expected = 0.0;
  for (const FlatFieldStack& flat : evidence.flats) {
    for (std::size_t c = 0; c < flat.cells.size(); ++c) {
      const CellStatistics& cell = flat.cells[c];
      const double light = cell.mean_dn - evidence.darks.front().cells[c].mean_dn;
      if (light < kKneeFrom * evidence.saturation.level_dn || light > kKneeTo * evidence.saturation.level_dn) continue;
      seen += cell.pixels * (cell.temporal_dn2 - kQuantisation);
      expected += cell.pixels * (numbers.intercept_dn2 + numbers.gain * light);
    }
  }
  if (expected <= 0.0) return std::nullopt;
  return seen / expected;
}

TransferPoint point_of(const Evidence& evidence, const FrameSet& set, std::size_t level) {
  const FlatFieldStack& flat = evidence.flats[level];
  LevelPoint point = level_point(evidence, level, std::nullopt);
  const double image_dn = flat.all.mean_dn - evidence.darks.front().all.mean_dn;
  const bool used = evidence.weight[level] > 0.0;
  if (!used) {
    point.mean_dn = image_dn;
    point.variance_dn2 = flat.all.temporal_dn2 - kQuantisation;
    point.sampling_dn4 = 2.0 * square(flat.all.temporal_dn2) / (flat.all.pixels * static_cast<double>(flat.frames - 1));
  }
  return {set.name,
          set.exposure_s,
          point.mean_dn,
          image_dn,
          point.variance_dn2,
          std::sqrt(point.sampling_dn4),
          flat.all.at_largest,
          used};
}

}  // namespace

LineQuality line_quality(const CameraEvidence& gathered, const FlatFieldFolder& folder, const PhotonNumbers& numbers) {
  const Evidence& evidence = gathered.evidence;
  LineQuality quality;
  double chi2 = 0.0;
  for (std::size_t level = 0; level < evidence.flats.size(); ++level) {
    const TransferPoint point = point_of(evidence, folder.flats[level], level);
    quality.curve.push_back(point);
    if (!point.used) continue;
    ++quality.points;
    quality.most_dn = std::max(quality.most_dn, point.mean_dn);
    const double line = numbers.intercept_dn2 + numbers.gain * point.mean_dn;
    const double off2 = square(point.variance_dn2 - line);
    chi2 += off2 * evidence.weight[level];
    if (off2 * evidence.weight[level] > square(kLevelSignificance)) {
      quality.bend = std::max(quality.bend, std::sqrt(off2) / std::max(line, point.sd_dn2));
    }
  }
  if (evidence.dark_weight > 0.0) {
    ++quality.points;
    chi2 +=
        square(evidence.darks.front().all.temporal_dn2 - kQuantisation - numbers.intercept_dn2) * evidence.dark_weight;
  }
  const double degrees = quality.points - 2.0;
  if (degrees > 0.0 && chi2 > degrees + kMisfitSignificance * std::sqrt(2.0 * degrees))
    quality.misfit = std::sqrt(chi2 / degrees);
  std::sort(quality.curve.begin(), quality.curve.end(),
            [](const TransferPoint& a, const TransferPoint& b) { return a.mean_dn < b.mean_dn; });
  const std::optional<double> ratio = variance_below_saturation(gathered, numbers);
  if (ratio && *ratio < kKneeVariance) quality.knee = *ratio;
  return quality;
}

std::optional<WhyUnmeasured> why_no_gain(const CameraEvidence& gathered, const LineQuality& quality,
                                         const FittedLine& line, const Measured& linearity) {
  const Evidence& evidence = gathered.evidence;
  const bool dark_in_line = evidence.dark_weight > 0.0;
  if (quality.points < 3) return unmeasured::FewPoints{quality.points, dark_in_line};
  const FlatFieldStack& bright = evidence.flats[*gathered.middle_level];
  if (neighbour_correlation(bright) > kCorrelationRefused) {
    return unmeasured::PixelsTogether{neighbour_correlation(bright)};
  }
  if (bright.successive_ratio && *bright.successive_ratio < kSuccessiveRefused) {
    return unmeasured::FramesTogether{*bright.successive_ratio};
  }
  using Shown = unmeasured::NotLinear::Shown;
  if (!(line.gain > 0.0)) return unmeasured::NotLinear{Shown::variance_falls};
  if (quality.bend > kBendRefused) return unmeasured::NotLinear{Shown::variance_bends, quality.bend};
  const double at_half = 0.5 * line.gain * quality.most_dn;
  const double slack = kBendRefused * at_half + kMisfitSignificance * line.intercept_sd_dn2;
  if (!dark_in_line && !gathered.dark_clipped && line.intercept_dn2 > square(kHiddenNoise_dn) + slack) {
    return unmeasured::NotLinear{Shown::line_above_dark};
  }
  if (line.intercept_dn2 < -slack) return unmeasured::NotLinear{Shown::line_below_zero};
  if (linearity.value && *linearity.value > kLinearityRefused) {
    return unmeasured::NotLinear{Shown::mean_bends, *linearity.value};
  }
  if (line.gain_sd > kMostRelativeGainSd * line.gain) return unmeasured::UncertainGain{line.gain, line.gain_sd};
  return std::nullopt;
}

namespace {

std::optional<Flicker> flicker_of(const Evidence& evidence) {
  Flicker flicker;
  for (const FlatFieldStack& flat : evidence.flats) {
    const auto [low, high] = std::minmax_element(flat.frame_means_dn.begin(), flat.frame_means_dn.end());
    const double change = (*high - *low) / (flat.all.mean_dn - evidence.darks.front().all.mean_dn);
    if (!(change > kFlickerNoted) || *high - *low < 0.5) continue;  // half a code: the dark level moves by as much
    flicker.part = std::max(flicker.part, change);
    ++flicker.levels;
  }
  if (flicker.levels == 0) return std::nullopt;
  flicker.of_levels = evidence.flats.size();
  return flicker;
}

/// Whether the noise of neighbouring pixels is correlated by more than `limit` and by more than chance explains.
bool is_correlated(const FlatFieldStack& level, double limit) {
  return neighbour_correlation(level) > std::max(limit, kLevelSignificance / std::sqrt(level.all.pixels));
}

}  // namespace

std::vector<CameraNote> condition_notes(const CameraEvidence& gathered, const LineQuality& quality,
                                        const Measured& linearity, bool gain_known) {
  const Evidence& evidence = gathered.evidence;
  const FlatFieldStack& dark = evidence.darks.front();
  std::vector<CameraNote> notes;
  if (gathered.mosaic) notes.emplace_back(ColourMosaic{});
  if (gain_known) {
    const FlatFieldStack& bright = evidence.flats[*gathered.middle_level];
    if (quality.bend > kBendNoted) notes.emplace_back(BentVariance{quality.bend});
    if (linearity.value && *linearity.value > kLinearityNoted) notes.emplace_back(BentMean{*linearity.value});
    if (is_correlated(bright, kCorrelationNoted)) notes.emplace_back(CorrelatedPixels{neighbour_correlation(bright)});
    if (bright.successive_ratio && *bright.successive_ratio < kSuccessiveNoted) {
      notes.emplace_back(SuccessiveFramesAlike{*bright.successive_ratio});
    }
  }
  if (const auto flicker = flicker_of(evidence)) notes.emplace_back(*flicker);
  if (is_correlated(dark, kCorrelationRefused)) notes.emplace_back(CorrelatedDark{neighbour_correlation(dark)});
  if (static_cast<double>(gathered.outlying_pixels) > 0.01 * gathered.grid.size().area()) {
    notes.emplace_back(ManyOutlyingPixels{});
  }
  return notes;
}

}  // namespace glidelab::core
