/// What a codec that predicts each image from those before does to the positions of a moving marker, found from the
/// positions alone, and how well it is known.
///
/// Such a codec (H.264, HEVC, VP9, …) draws the marker where it was in the image before, displaced by a motion vector
/// from a coarse grid (quarters of a pixel; halves and whole ones are drawn more sharply and chosen more often; behind
/// a colour mosaic two pixels repeat the mosaic), and then codes what that lacks, except what is too small. A marker
/// that moves by d pixels a frame is so drawn towards the nearest such displacement: it runs ahead where d is a little
/// below it and lags where d is a little above it. The error is the same whenever the marker has the same speed, does
/// not average out, and just above rest or a terminal speed on the grid it looks like friction and damping. In pixels,
///
///     e(k) = (1 - r) sum_j r^j h(d(k - j)),    h(d) = sum_n b_n sin(pi n d),   n = 1 … 8,
///
/// along the columns and along the rows alike: odd in d, as left and right are alike, and repeating with two pixels. r
/// = 0.5 ± 0.2 is how much of its last error an image hands on. Where the marker hardly moves (d below 0.05 pixels a
/// frame), as where it turns, it is held where it was drawn last: e(k) = -c exp(-(d / 0.05)^2 / 2) in the direction
/// from which it came, in addition.
///
/// Found without a law of motion: the positions of free motion are a smooth motion (the integrated Wiener process of
/// order 4, its strength by likelihood: smoothing/wiener_smoother.h), plus e, plus white noise s of each track. With S
/// the smoother's matrix the inverse covariance of what is not e is (I - S) / s^2. b_n is normal with the standard
/// deviation p / sqrt(n), and c with p; p and s are the likeliest (expectation maximisation), p with what is known of
/// such codecs. The posterior's mean is taken off the positions; its covariance, in independent modes, is an error that
/// all tracks share.
///
/// Assumes that all tracks are from one camera and codec, and frames that follow each other. A codec that codes every
/// image by itself (MJPEG) drags nothing; what it adds is noise.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/experiment/clip_setup.h"
#include "core/track/track_data.h"

namespace glidelab::core {

/// A track with the place of the marker in the image at each of its points (TrackData::sightings).
struct DragTrack {
  const ClipSetup* setup = nullptr;
  const TrackData* track = nullptr;
};

struct CodecDrag {
  double rms_px = 0.0;                                    ///< of e at all points
  double log_evidence = 0.0;                              ///< for e, against none
  std::vector<std::vector<double>> drag_m;                ///< e at each point of each track, along x
  std::vector<std::vector<std::vector<double>>> error_m;  ///< its errors: of each mode, one standard deviation likewise
};

/// `predicts`: the codec is known to be one that predicts images from those before. Nothing where fewer than 60 points
/// of free motion are seen. Entries of tracks without sightings, or whose marker does not move, are empty.
std::optional<CodecDrag> find_codec_drag(const std::vector<DragTrack>& tracks, bool predicts);

}  // namespace glidelab::core
