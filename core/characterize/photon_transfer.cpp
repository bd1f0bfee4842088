#include "core/characterize/photon_transfer.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/characterize/camera_evidence.h"
#include "core/characterize/photon_checks.h"
#include "core/characterize/photon_numbers.h"

namespace glidelab::core {
namespace {

constexpr double kLeastSignificance = 3.0;  // standard deviations above which a quantity is not just noise

class Measurer {
 public:
  Measurer(const FlatFieldFolder& folder, CameraEvidence gathered)
      : gathered_(std::move(gathered)),
        evidence_(gathered_.evidence),
        numbers_(photon_numbers(evidence_)),
        sd_(jackknife_sd(evidence_, gathered_.grid.tiles())),
        shared_(shared_errors(evidence_, numbers_)),
        quality_(line_quality(gathered_, folder, numbers_)) {
    result_.folder = folder;
    result_.width_px = gathered_.grid.size().width;
    result_.height_px = gathered_.grid.size().height;
    result_.frames = gathered_.frames;
    result_.mosaic = gathered_.mosaic;
    result_.saturation_dn = evidence_.saturation.level_dn;
    result_.hot_pixels = gathered_.hot_pixels;
    result_.dead_pixels = gathered_.dead_pixels;
    result_.outlying_pixels = gathered_.outlying_pixels;
    result_.curve = quality_.curve;
    widen_by_misfit();
  }

  CameraMeasurement measure() {
    result_.linearity_error = linearity_error(evidence_, result_.folder, evidence_.saturation.level_dn);
    offset();
    gain();
    if (result_.gain_dn_per_e.value) {
      result_.intercept_dn2 = numbers_.intercept_dn2;
      read_noise();
      saturation_capacity();
      full_well();
      dark_signal();
      patterns();
    } else {
      for (Measured* missing : {&result_.read_noise_e, &result_.full_well_e, &result_.saturation_capacity_e,
                                &result_.dark_signal_e_s, &result_.dsnu_e, &result_.prnu}) {
        missing->why = unmeasured::NoGain{};
      }
    }
    result_.notes =
        condition_notes(gathered_, quality_, result_.linearity_error, result_.gain_dn_per_e.value.has_value());
    return std::move(result_);
  }

 private:
  using By = HowMeasured::By;

  const FlatFieldStack& dark() const { return evidence_.darks.front(); }

  /// A line that the levels do not follow within their noise is less certain than the jackknife says: its curvature is
  /// common to all tiles.
  void widen_by_misfit() {
    const double more = square(quality_.misfit) - 1.0;
    shared_.gain_variance += more * square(sd_.gain);
    shared_.intercept_variance += more * square(sd_.intercept_dn2);
  }

  void offset() {
    Measured& offset = result_.offset_dn;
    if (gathered_.dark_clipped) {
      offset.why = unmeasured::DarkLevelCut{dark().all.at_zero};
      return;
    }
    offset.value = numbers_.offset_dn;
    offset.sd = std::hypot(sd_.offset_dn, shared_.offset_dn);
    if (std::isfinite(numbers_.dark_slope_dn_s)) offset.how = HowMeasured{By::zero_exposure};
  }

  void gain() {
    Measured& gain = result_.gain_dn_per_e;
    const double sd = std::sqrt(square(sd_.gain) + shared_.gain_variance);
    gain.why = why_no_gain(
        gathered_, quality_,
        {numbers_.gain, sd, numbers_.intercept_dn2, std::sqrt(square(sd_.intercept_dn2) + shared_.intercept_variance)},
        result_.linearity_error);
    if (gain.why) return;
    gain.value = numbers_.gain;
    gain.sd = sd;
  }

  /// The standard deviation of a number that scales as gain^-power, from its jackknife and the gain's shared error.
  double with_gain_error(double value, double sd, double power) const {
    return std::sqrt(square(sd) + square(power * value / numbers_.gain) * shared_.gain_variance);
  }

  /// Neither noise nor pattern of the dark frames exceeds the spread of all their codes plus the width of one code.
  double dark_spread_e() const { return std::sqrt(dark().all.total_dn2 + kQuantisation) / numbers_.gain; }

  void read_noise() {
    Measured& read = result_.read_noise_e;
    const double variance = numbers_.read_variance_e2;
    double shared_dn4 = shared_.intercept_variance;
    if (evidence_.read_noise_from_dark) {
      const double dark_dn2 = dark().all.temporal_dn2 - kQuantisation;
      shared_dn4 = 0.5 * square(rounding_of_variance(dark_dn2, spread_dn2(dark())));
    }
    if (evidence_.exposure_s.front()) {
      shared_dn4 += square(numbers_.gain * shared_.dark_slope_dn_s * *evidence_.exposure_s.front());
    }
    const double sd =
        std::hypot(with_gain_error(variance, sd_.read_variance_e2, 2.0), std::sqrt(shared_dn4) / square(numbers_.gain));
    if (variance > kLeastSignificance * sd) {
      read.value = std::sqrt(variance);
      read.sd = sd / (2.0 * *read.value);
      read.how = HowMeasured{evidence_.read_noise_from_dark ? By::dark_frames : By::line_at_dark};
      return;
    }
    const double limit = std::sqrt(std::max(0.0, variance) + kLeastSignificance * sd);
    const double most = gathered_.dark_clipped ? limit : std::min(kHiddenNoise_dn / numbers_.gain, dark_spread_e());
    read.limit = std::min(limit, most);
    read.why = unmeasured::BelowQuantisation{};
  }

  void saturation_capacity() {
    Measured& capacity = result_.saturation_capacity_e;
    if (!evidence_.saturation.peak) {
      capacity.why = unmeasured::NoLargestVariance{};
      return;
    }
    capacity.value = numbers_.saturation_capacity_e;
    // The largest variance may lie anywhere between the neighbours of the observed maximum.
    capacity.sd = std::hypot(with_gain_error(*capacity.value, sd_.saturation_capacity_e, 1.0),
                             evidence_.saturation.peak->step_dn / std::sqrt(12.0) / numbers_.gain);
    capacity.how = HowMeasured{By::largest_variance};
  }

  void full_well() {
    Measured& well = result_.full_well_e;
    if (quality_.knee) {
      well.why = result_.saturation_capacity_e.why = unmeasured::Knee{*quality_.knee};
      result_.saturation_capacity_e.value.reset();
      return;
    }
    if (evidence_.saturation.plateau_level || evidence_.saturation.top_dn) {
      const double rounding = evidence_.saturation.plateau_level && !evidence_.saturation.converter_clips
                                  ? rounding_of_mean(spread_dn2(evidence_.flats[*evidence_.saturation.plateau_level]))
                                  : 0.0;
      well.value = numbers_.full_well_e;
      well.sd = std::hypot(with_gain_error(*well.value, sd_.full_well_e, 1.0),
                           std::hypot(rounding, shared_.offset_dn) / numbers_.gain);
      well.how = HowMeasured{evidence_.saturation.converter_clips ? By::largest_code : By::plateau};
      return;
    }
    if (result_.saturation_capacity_e.value) {
      well = result_.saturation_capacity_e;
      return;
    }
    double most = 0.0;
    for (const TransferPoint& point : result_.curve) most = std::max(most, point.mean_dn);
    well.limit = most / numbers_.gain;
    well.why = unmeasured::NotSaturated{};
  }

  void dark_signal() {
    Measured& signal = result_.dark_signal_e_s;
    if (!std::isfinite(numbers_.dark_signal_e_s)) {
      signal.why = unmeasured::NoDarkExposures{};
      return;
    }
    if (gathered_.dark_clipped) {
      signal.why = result_.offset_dn.why;
      return;
    }
    signal.value = numbers_.dark_signal_e_s;
    signal.sd =
        std::hypot(with_gain_error(*signal.value, sd_.dark_signal_e_s, 1.0), shared_.dark_slope_dn_s / numbers_.gain);
    if (*signal.value < kLeastSignificance * signal.sd) signal.how = HowMeasured{By::insignificant};
  }

  /// A pattern's standard deviation from its variance; a limit if it does not exceed its error significantly. `most` is
  /// an upper limit known by other means.
  static void set_pattern(Measured& result, double variance, double sd, double most, bool electrons) {
    if (variance > kLeastSignificance * sd) {
      result.value = std::sqrt(variance);
      result.sd = sd / (2.0 * *result.value);
      return;
    }
    result.limit = std::min(most, std::sqrt(std::max(variance, 0.0) + kLeastSignificance * sd));
    result.why = unmeasured::PatternNotSeen{electrons};
  }

  void patterns() {
    const bool regression = !evidence_.dark_pattern_shown;
    if (regression && evidence_.pattern_levels.size() < 3) {
      result_.prnu.why = result_.dsnu_e.why = unmeasured::NoPattern{};
      return;
    }
    // Rounding leaves an error in each dark pixel's mean that looks like a pattern.
    const double dark_dn2 = std::max(0.0, dark().all.temporal_dn2 - kQuantisation);
    const double rounding_dn2 = regression ? 0.0 : square(rounding_of_mean(dark_dn2));
    const double light_dn = level_point(evidence_, *gathered_.middle_level, std::nullopt).mean_dn;
    set_pattern(result_.prnu, numbers_.prnu_squared, std::hypot(sd_.prnu_squared, rounding_dn2 / square(light_dn)), 1.0,
                false);
    set_pattern(result_.dsnu_e, numbers_.dsnu_squared_e2,
                std::hypot(with_gain_error(numbers_.dsnu_squared_e2, sd_.dsnu_squared_e2, 2.0),
                           rounding_dn2 / square(numbers_.gain)),
                dark_spread_e(), true);
    const HowMeasured how =
        regression ? HowMeasured{By::all_levels} : HowMeasured{By::one_level, light_dn / evidence_.saturation.level_dn};
    if (result_.prnu.value) result_.prnu.how = how;
    if (result_.dsnu_e.value && regression) result_.dsnu_e.how = how;
  }

  CameraEvidence gathered_;
  const Evidence& evidence_;
  PhotonNumbers numbers_;
  PhotonNumbers sd_;
  SharedErrors shared_;
  LineQuality quality_;
  CameraMeasurement result_;
};

}  // namespace

CameraMeasurement measure_camera(const FlatFieldFolder& folder, const base::Progress& progress) {
  return Measurer(folder, gather_evidence(folder, progress)).measure();
}

}  // namespace glidelab::core
