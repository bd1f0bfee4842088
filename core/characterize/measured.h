/// One number of a measured camera as data: its value, how it was found, or why there is none.
/// report/characterize/measured_words.h puts it into words.
#pragma once

#include <optional>
#include <variant>

namespace glidelab::core {

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

}  // namespace glidelab::core
