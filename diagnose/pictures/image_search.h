/// What the searches in images share: the clips that they read, waves in series, and where their findings go.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/result/image_record.h"
#include "diagnose/pictures/twin_camera.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// A clip's images, with what the folder states of the camera.
struct FilmedClip {
  std::string name;
  std::size_t view = 0;  ///< in clips of one view (folder and set-up) a point is at the same pixel
  std::shared_ptr<const core::ImageRecord> record;
  core::CameraSettings camera;
  double px_per_m = 0.0;  ///< along the motion; 0 if unknown
  bool down = false;      ///< whether the marker moves more vertically in the image than horizontally
};

struct ImageEvidence {
  std::vector<ImageFinding> findings;
  std::vector<ImageCurve> curves;
  std::vector<FilmedClip> clips;
  double fastest_px_s = 0.0;   ///< of the marker
  double stated_line_s = 0.0;  ///< of the camera whose clips show the shutter best; of the first if none does
  std::optional<Filming> filming;
};

inline constexpr double kSeenInImages = 3.0;  ///< log evidence above which a finding counts as seen

/// An empty finding of an effect of the list.
ImageFinding finding_of(std::string_view id);

/// Time from one row to the next below, as stated: 0 for a global shutter, negative if the bottom row is first.
double stated_line_s(const core::CameraSettings& camera);

/// Log evidence of a deviation of z standard deviations, equal odds for each factor of ten from 1 to `largest`.
double log_deviation_evidence(double z, double largest);

/// The same of a deviation that may have either sign, each with a probability of a half.
double log_either_sign_evidence(double z, double largest);

struct Series {
  std::vector<double> t_s, value;
};

struct SeriesWave {
  double log_evidence = 0.0;
  double f_hz = 0.0, sd_hz = 0.0;
  double amplitude = 0.0, sd = 0.0;  ///< root mean square over the series
};

/// The strongest wave, between 3 periods a series and half the sampling rate, that the series of several clips have in
/// common: brightness that flickers, a scene that sways in the image.
///
/// Least squares of const + slope t + curve t² + a cos + b sin over each series at each frequency, with a and b free in
/// every series. The gain of a frequency is sum (n/2) ln(RSS without/RSS with), so that no noise level need be known.
/// Its evidence is reduced by Schwarz's penalty for what is free, and by four times the median gain over all
/// frequencies, which is the gain if the noise is not white.
SeriesWave strongest_wave(const std::vector<Series>& series);

/// Amplitude at one frequency and its standard deviation (of a component), of one series.
struct Amplitude {
  double size = 0.0, sd = 0.0;
};
Amplitude amplitude_at(const Series& series, double f_hz);

}  // namespace glidelab::diagnose
