/// The effect of a predictive codec (each image predicted from earlier ones) on the positions of a moving marker: found
/// from the positions alone, with its uncertainty.
///
/// Such a codec (H.264, HEVC, VP9, …) draws the marker where it was in the previous image, displaced by a motion vector
/// from a coarse grid. (The grid has quarters of a pixel; half and whole pixels are drawn more sharply and chosen more
/// often; behind a colour mosaic, two pixels repeat the mosaic.) It then codes the remaining difference, except where
/// that is too small. A marker that moves by d pixels per frame is thus pulled towards the nearest such displacement:
/// it runs ahead if d is slightly smaller and lags if d is slightly larger. The error is the same whenever the marker
/// has the same speed, so it does not average out. Just above rest, or just above a terminal speed on the grid, it
/// looks like friction and damping. In pixels,
///
///     e(k) = (1 - r) sum_j r^j h(d(k - j)),    h(d) = sum_n b_n sin(pi n d),   n = 1 … 8,
///
/// along the columns and along the rows alike: odd in d, since left and right are equivalent, and periodic with two
/// pixels. r = 0.5 ± 0.2 is the fraction of its error that an image passes on to the next. If the marker hardly moves
/// (d below 0.05 pixels per frame), as at a reversal, it is held where it was drawn last: e(k) = -c exp(-(d / 0.05)^2 /
/// 2) in addition, in the direction from which it came.
///
/// e is found without a law of motion. The positions of free motion are a smooth motion (the integrated Wiener process
/// of order 4, its strength by likelihood: smoothing/wiener_smoother.h), plus e, plus white noise s of each track. With
/// S the smoother's matrix, the inverse covariance of everything but e is (I - S) / s^2. b_n is normal with the
/// standard deviation p / sqrt(n), and c with p; p and s are the most likely values (expectation maximisation), p with
/// prior knowledge of such codecs. The posterior mean is subtracted from the positions; its covariance, in independent
/// modes, is an error that all tracks share.
///
/// Assumes that all tracks are from one camera and codec, and that frames are consecutive. A codec that codes every
/// image on its own (MJPEG) causes no drag; it adds noise.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// A track with the position of the marker in the image at each of its points (TrackData::sightings).
struct DragTrack {
  const ClipSetup* setup = nullptr;
  const TrackData* track = nullptr;
};

struct CodecDrag {
  double rms_px = 0.0;                                    ///< of e at all points
  double log_evidence = 0.0;                              ///< for e, against no drag
  std::vector<std::vector<double>> drag_m;                ///< e at each point of each track, along x
  std::vector<std::vector<std::vector<double>>> error_m;  ///< errors of e: for each mode one standard deviation,
                                                          ///< likewise
};

/// `predicts`: the codec is known to predict images from earlier ones. Empty if fewer than 60 points of free motion are
/// seen. Also empty if the codec is not known and no marker moves by the two pixels per frame with which h recurs:
/// below that, any error that changes with the speed looks like h (at 1000 frames per second a marker seldom gets
/// there). Entries of tracks without sightings, or whose marker does not move, are empty.
std::optional<CodecDrag> find_codec_drag(const std::vector<DragTrack>& tracks, bool predicts);

}  // namespace glidelab::core
