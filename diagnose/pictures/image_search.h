/// What the searches in images share: the clips that they read, waves in series, and where their findings go.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/math/strongest_wave.h"
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

using core::Amplitude;
using core::amplitude_at;
using core::Series;
using core::SeriesWave;
using core::strongest_wave;

}  // namespace glidelab::diagnose
