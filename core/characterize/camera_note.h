/// What a reader of a measured camera should know about how the images were taken, as data;
/// report/characterize/camera_note_words.h puts it into words.
#pragma once

#include <cstddef>
#include <variant>

namespace glidelab::core {

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

}  // namespace glidelab::core
