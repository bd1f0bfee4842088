#include "report/characterize/measured_words.h"

#include <fmt/format.h>
#include <variant>

namespace glidelab::report {

namespace {

namespace unmeasured = core::unmeasured;

/// A reason for every kind; a kind without one does not compile.
struct Reason {
  double limit = 0.0;

  std::string operator()(const unmeasured::NoGain&) const { return "the gain is needed, and it is not known"; }
  std::string operator()(const unmeasured::DarkLevelCut& of) const {
    return fmt::format(
        "{:.3g} % of the dark samples are at code 0: the dark level is clipped; raise the camera's black "
        "level",
        100.0 * of.at_zero);
  }
  std::string operator()(const unmeasured::FewPoints& of) const {
    return fmt::format(
        "{} usable point{} in the diagram; at least 3 are needed: levels above the quantisation noise and below 70 % "
        "of saturation{}",
        of.points, of.points == 1 ? "" : "s",
        of.dark_shown ? "" : " (the dark frames show no noise beyond the quantisation)");
  }
  std::string operator()(const unmeasured::PixelsTogether& of) const {
    return fmt::format(
        "the noise of neighbouring pixels is correlated ({:.2f}), an effect of demosaicing, denoising, scaling or "
        "lossy compression; raw images are needed",
        of.correlation);
  }
  std::string operator()(const unmeasured::FramesTogether& of) const {
    return fmt::format(
        "the noise of successive frames is correlated (their differences have {:.0f} % of the variance of frames two "
        "apart), an effect of denoising over time; raw images are needed",
        100.0 * of.ratio);
  }
  std::string operator()(const unmeasured::NotLinear& of) const {
    return departure(of) +
           ": the codes are not linear in the light (gamma, tone curve, video range), or the light is not constant; "
           "linear or raw images are needed";
  }
  std::string operator()(const unmeasured::UncertainGain& of) const {
    return fmt::format("it is {:.2g} with a standard deviation of {:.2g}: more light, frames or pixels are needed",
                       of.gain_dn_per_e, of.sd);
  }
  std::string operator()(const unmeasured::BelowQuantisation&) const {
    return fmt::format("hidden by the quantisation: less than {:.3g} e-", limit);
  }
  std::string operator()(const unmeasured::NoLargestVariance&) const {
    return "no level is brighter than that of the largest variance";
  }
  std::string operator()(const unmeasured::Knee& of) const {
    return fmt::format(
        "between 75 and 90 % of saturation the variance is {:.0f} % of the line's: the output is compressed there (a "
        "knee or a tone curve), or the light is uneven on a scale of a few pixels",
        100.0 * of.of_line);
  }
  std::string operator()(const unmeasured::NotSaturated&) const {
    return fmt::format("no level reaches saturation: more than {:.4g} e-, the brightest level", limit);
  }
  std::string operator()(const unmeasured::NoDarkExposures&) const {
    return "it requires dark frames at two or more exposures (folders dark-…, exposures_s)";
  }
  std::string operator()(const unmeasured::NoExposures&) const {
    return "it requires three or more levels, 5 to 95 % of saturation, taken with different exposures to the same "
           "light (exposures_s)";
  }
  std::string operator()(const unmeasured::PatternNotSeen& of) const {
    return fmt::format("not seen above noise and quantisation: less than {:.2g}{}", limit, of.electrons ? " e-" : "");
  }
  std::string operator()(const unmeasured::NoPattern&) const {
    return "the dark frames show no pattern above the quantisation, and fewer than 3 levels show one";
  }

 private:
  static std::string departure(const unmeasured::NotLinear& of) {
    using Shown = unmeasured::NotLinear::Shown;
    switch (of.shown) {
      case Shown::variance_falls:
        return "the variance does not rise with the mean";
      case Shown::variance_bends:
        return fmt::format("the variance departs from a straight line over the mean by {:.0f} %", 100.0 * of.bend);
      case Shown::line_above_dark:
        return "the line of variance over mean meets the dark level far above the dark frames' noise";
      case Shown::line_below_zero:
        return "the line of variance over mean meets the dark level below zero";
      case Shown::mean_bends:
        return fmt::format("the mean departs from a straight line over the exposure by {:.0f} %", 100.0 * of.bend);
    }
    return "";
  }
};

}  // namespace

std::string how_words(const core::Measured& measured) {
  if (!measured.how) return "";
  using By = core::HowMeasured::By;
  switch (measured.how->by) {
    case By::zero_exposure:
      return "extrapolated to zero exposure";
    case By::dark_frames:
      return "from the dark frames";
    case By::line_at_dark:
      return "from the line extrapolated to the dark level; the dark frames show none above the quantisation";
    case By::largest_variance:
      return "the level of largest variance, known to within the steps between levels";
    case By::largest_code:
      return "the converter reaches its largest code; the pixel may hold more, which the codes cannot show";
    case By::plateau:
      return "from the level at which the output stops rising";
    case By::all_levels:
      return "regression over the levels; the dark frames show no pattern above the quantisation";
    case By::one_level:
      return fmt::format("at {:.0f} % of saturation", 100.0 * measured.how->of_saturation);
    case By::insignificant:
      return "not significant";
  }
  return "";
}

std::string why_words(const core::Measured& measured) {
  return measured.why ? std::visit(Reason{measured.limit.value_or(0.0)}, *measured.why) : "";
}

namespace {

/// A sentence for every kind; a kind without one does not compile.
struct CameraSentence {
  std::string operator()(const core::ColourMosaic&) const {
    return "The pixels of the 2 x 2 mosaic differ in brightness: these are raw codes of a colour sensor. PRNU is "
           "measured for each colour.";
  }
  std::string operator()(const core::BentVariance& of) const {
    return fmt::format(
        "The variance departs from a straight line over the mean by up to {:.1f} %: the sensor is not quite linear, or "
        "the light is not constant.",
        100.0 * of.part);
  }
  std::string operator()(const core::BentMean& of) const {
    return fmt::format(
        "The mean departs from a straight line over the exposure by {:.1f} %: if a tone curve causes this, and not the "
        "lamp or the shutter, the gain is wrong by several times as much.",
        100.0 * of.part);
  }
  std::string operator()(const core::CorrelatedPixels& of) const {
    return fmt::format(
        "The noise of neighbouring pixels is correlated by {:.3f}: the gain may be too small by a few per cent.",
        of.correlation);
  }
  std::string operator()(const core::SuccessiveFramesAlike& of) const {
    return fmt::format("Differences of successive frames have {:.1f} % of the variance of frames two apart.",
                       100.0 * of.ratio);
  }
  std::string operator()(const core::Flicker& of) const {
    return fmt::format(
        "The light changes from frame to frame by up to {:.1f} %, in {} of {} levels: the lamp flickers, or the "
        "exposure is automatic. The gain is not affected.",
        100.0 * of.part, of.levels, of.of_levels);
  }
  std::string operator()(const core::CorrelatedDark& of) const {
    return fmt::format(
        "The noise of the dark frames is correlated by {:.2f} between neighbouring pixels: rows or columns have "
        "readout noise of their own.",
        of.correlation);
  }
  std::string operator()(const core::ManyOutlyingPixels&) const {
    return "More than 1 % of the pixels are outliers: the fixed patterns are not normally distributed, and PRNU and "
           "DSNU describe their cores.";
  }
};

}  // namespace

std::string note_words(const core::CameraNote& note) {
  return std::visit(CameraSentence{}, note);
}

std::vector<std::string> notes_words(const std::vector<core::CameraNote>& notes) {
  std::vector<std::string> sentences;
  for (const core::CameraNote& note : notes) sentences.push_back(note_words(note));
  return sentences;
}

}  // namespace glidelab::report
