/// x(t) of one clip, as it enters the smoothing: from a video by tracking and restitution, or from a CSV.
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/result/picture_record.h"
#include "core/result/results.h"

namespace glidelab::core {

/// Fewer points than this say nothing about an acceleration: a local cubic has four coefficients, and as many points
/// again are left for their noise.
inline constexpr std::size_t kFewestTrackPoints = 8;

/// Positions along the line of motion, positive downhill. All vectors have one length; times rise strictly.
struct TrackData {
  std::vector<double> t_s;  ///< frames in which the marker was found, middle of exposure
  std::vector<double> x_m;
  std::vector<double> force_n;     ///< known applied force along x; empty where there is none
  std::vector<std::size_t> frame;  ///< the frame that each point comes from
  std::vector<double> frame_t_s;   ///< times of all frames, with and without marker
  double frame_rate_hz = 0.0;
  double scale_sd_relative = 0.0;  ///< relative uncertainty of one px_per_m
  /// How all positions change by one standard deviation of each independent error of the camera and the plane (the
  /// calibration's modes); one entry for every mode of the whole analysis, empty where it does not touch this track.
  std::vector<std::vector<double>> shared_m;
  std::vector<MarkerSighting> sightings;          ///< empty for a track from a file
  std::shared_ptr<const PictureRecord> pictures;  ///< where they were asked for
  bool dark_marker = false;  ///< seen as darker than its surroundings, without a colour that says so
  std::vector<std::string> notes;
};

/// Every point of a track from a file is a frame in which the object was seen; the frame rate is one over the median
/// time step.
void take_rows_as_frames(TrackData& track);

}  // namespace glidelab::core
