/// What the searches in images share: the clips that they read, and where their findings go.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/experiment/experiment.h"
#include "core/result/picture_record.h"
#include "diagnose/pictures/twin_camera.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// A clip's images, with what the folder states of the camera.
struct FilmedClip {
  std::string name;
  std::size_t view = 0;  ///< clips of one view (folder and set-up) see a place at the same pixel
  std::shared_ptr<const core::PictureRecord> record;
  core::CameraSettings camera;
  double px_per_m = 0.0;  ///< along the motion; 0 where unknown
};

struct PictureEvidence {
  std::vector<PictureFinding> findings;
  std::vector<PictureCurve> curves;
  std::vector<FilmedClip> clips;
  double fastest_px_s = 0.0;   ///< of the marker
  double stated_line_s = 0.0;  ///< of the camera whose clips show the shutter best; of the first where none does
  std::optional<Filming> filming;
};

inline constexpr double kSeenInPictures = 3.0;  ///< log evidence from which a finding counts as seen

/// An empty finding of an effect of the list.
PictureFinding finding_of(std::string_view id);

/// Time from one row to the next below, as stated: 0 for a global shutter, below 0 where the bottom row is first.
double stated_line_s(const core::CameraSettings& camera);

/// Log evidence of a deviation of z standard deviations, equal odds for each factor of ten from 1 to `largest`.
double log_evidence_of(double z, double largest);

}  // namespace glidelab::diagnose
