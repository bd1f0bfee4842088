/// A measured camera, the result of photon transfer, as plain data. report/ writes it as a file with the keys of a
/// scenario's [sensor], as JSON, table and page.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>
#include "core/characterize/flat_field_folder.h"

namespace glidelab::core {

/// One number of a measured camera as data: its value, how it was found, or why there is none.
/// report/characterize/measured_words.h puts it into words.
///
/// How a number was found, where there is more than one way, or what limits it.
struct HowMeasured {
  enum class By {
    zero_exposure,     ///< extrapolated to it
    dark_frames,       ///< from them
    line_at_dark,      ///< from the line of variance over mean, extrapolated to the dark level
    largest_variance,  ///< from the level that has it
    largest_code,      ///< which the converter reaches
    plateau,           ///< from the level at which the output stops rising
    all_levels,        ///< by a regression over them
    one_level,         ///< at `of_saturation`
    insignificant      ///< not above its uncertainty
  } by = By::dark_frames;
  double of_saturation = 0.0;  ///< of By::one_level
};

namespace unmeasured {

/// The number requires the gain, which is not known.
struct NoGain {};

struct DarkLevelCut {
  double at_zero = 0.0;  ///< share of the dark samples at code 0
};

struct FewPoints {
  int points = 0;           ///< in the photon-transfer diagram
  bool dark_shown = false;  ///< the dark frames show noise beyond the quantisation
};

/// Noise of neighbouring pixels.
struct PixelsTogether {
  double correlation = 0.0;
};

/// Noise of successive frames: variance of their differences over that of frames two apart.
struct FramesTogether {
  double ratio = 1.0;
};

/// The codes are not linear in the light.
struct NotLinear {
  enum class Shown {
    variance_falls,
    variance_bends,
    line_above_dark,
    line_below_zero,
    mean_bends
  } shown = Shown::variance_bends;
  double bend = 0.0;  ///< relative departure from a straight line
};

struct UncertainGain {
  double gain_dn_per_e = 0.0, sd = 0.0;
};

/// Read noise below the quantisation: less than the limit.
struct BelowQuantisation {};

/// No level is brighter than that of the largest variance.
struct NoLargestVariance {};

/// The variance falls off the line below saturation.
struct Knee {
  double of_line = 0.0;
};

/// More than the limit.
struct NotSaturated {};

/// Dark frames at two or more exposures are needed.
struct NoDarkExposures {};

/// Levels taken with different exposures to the same light are needed.
struct NoExposures {};

/// A pattern within noise and quantisation: less than the limit.
struct PatternNotSeen {
  bool electrons = false;  ///< the unit of the limit; otherwise it is relative
};

/// Neither the dark frames nor enough levels show a pattern.
struct NoPattern {};

}  // namespace unmeasured

using WhyUnmeasured =
    std::variant<unmeasured::NoGain, unmeasured::DarkLevelCut, unmeasured::FewPoints, unmeasured::PixelsTogether,
                 unmeasured::FramesTogether, unmeasured::NotLinear, unmeasured::UncertainGain,
                 unmeasured::BelowQuantisation, unmeasured::NoLargestVariance, unmeasured::Knee,
                 unmeasured::NotSaturated, unmeasured::NoDarkExposures, unmeasured::NoExposures,
                 unmeasured::PatternNotSeen, unmeasured::NoPattern>;

/// A number with its standard deviation, or the reason why there is none.
struct Measured {
  std::optional<double> value;
  double sd = 0.0;
  std::optional<HowMeasured> how = {};    ///< empty if there is only one way
  std::optional<WhyUnmeasured> why = {};  ///< why there is no value
  std::optional<double> limit = {};       ///< if there is no value: its upper or lower limit
};

/// What a reader of a measured camera should know about how the images were taken, as data;
/// report/characterize/measured_words.h puts it into words.
///
/// Raw codes of a colour sensor: PRNU is measured for each colour.
struct ColourMosaic {};

/// The variance departs from a straight line as a function of the mean.
struct BentVariance {
  double part = 0.0;  ///< largest departure, as a fraction of the variance
};

/// The mean departs from a straight line as a function of the exposure.
struct BentMean {
  double part = 0.0;
};

/// Noise of neighbouring pixels of a bright level is correlated.
struct CorrelatedPixels {
  double correlation = 0.0;
};

/// Differences of successive frames vary less than those of frames two apart.
struct SuccessiveFramesAlike {
  double ratio = 1.0;  ///< of the variances
};

/// The light changes from frame to frame.
struct Flicker {
  double part = 0.0;  ///< largest change, as a fraction of the mean
  std::size_t levels = 0, of_levels = 0;
};

/// Noise of neighbouring pixels of the dark frames is correlated.
struct CorrelatedDark {
  double correlation = 0.0;
};

/// More than 1 % of the pixels are outliers.
struct ManyOutlyingPixels {};

using CameraNote = std::variant<ColourMosaic, BentVariance, BentMean, CorrelatedPixels, SuccessiveFramesAlike, Flicker,
                                CorrelatedDark, ManyOutlyingPixels>;

/// One level of light in the photon-transfer diagram.
struct TransferPoint {
  std::string set;
  std::optional<double> exposure_s;
  double mean_dn = 0.0;       ///< above the dark frames; for a level in the fit over the cells that count, otherwise
                              ///< over all
  double image_dn = 0.0;      ///< above the dark frames, over the whole image
  double variance_dn2 = 0.0;  ///< quantisation (1/12) subtracted
  double sd_dn2 = 0.0;        ///< of the variance
  double at_largest = 0.0;    ///< fraction of the samples at the largest code
  bool used = false;          ///< in the fit of the line
};

struct CameraMeasurement {
  FlatFieldFolder folder;
  int width_px = 0, height_px = 0;  ///< of a frame
  std::size_t frames = 0;
  bool mosaic = false;  ///< raw codes of a colour sensor

  Measured gain_dn_per_e;
  Measured read_noise_e;
  Measured offset_dn;              ///< of the dark frames; extrapolated to zero exposure if there are several exposures
  Measured full_well_e;            ///< electrons at which the output stops rising, in the pixel or in the converter
  Measured saturation_capacity_e;  ///< EMVA 1288: where the variance is largest
  Measured dark_signal_e_s;
  Measured prnu;  ///< relative, 0.01 is 1 %
  Measured dsnu_e;
  Measured linearity_error;  ///< mean of the relative deviations from a line, 0.01 is 1 %

  std::size_t hot_pixels = 0;   ///< far above their neighbourhood in the dark
  std::size_t dead_pixels = 0;  ///< respond to light less than half as much as their neighbourhood
  std::size_t outlying_pixels =
      0;  ///< all outliers of the pattern, including hot and dead pixels; excluded from the numbers

  std::vector<TransferPoint> curve;     ///< by rising mean
  std::optional<double> intercept_dn2;  ///< of the line, at the dark level
  double saturation_dn = 0.0;           ///< above dark; the 70 % refer to it
  std::vector<CameraNote> notes;        ///< what a reader should know
};

}  // namespace glidelab::core
