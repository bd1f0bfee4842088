#include "report/characterize/camera_note_words.h"

#include <fmt/format.h>

namespace glidelab::report {
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
