/// What a clip's images show besides the marker's centre, as plain data: evidence of how the camera recorded, not of
/// how the glider moved. Measured while the clip streams, a few hundred bytes per frame. Pixels and seconds; the centre
/// of the first pixel is (0, 0), rows count downwards.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace glidelab::core {

/// The marker's image in one frame, as fitted by marker_fit.h.
struct MarkerLook {
  std::size_t frame = 0;
  double t_s = 0.0;  ///< of the frame
  double u_px = 0.0, v_px = 0.0;
  /// Second moment along u minus that along v of the signal above the background, px²: L²/12 for a smear L along u.
  double stretch_px2 = 0.0;
  double uv_px2 = 0.0, vv_px2 = 0.0;  ///< second moments of the outline's area (0 and r²/4 for a disc)
  double blur_px = 0.0;
  double amplitude = 0.0, background = 0.0;   ///< codes
  double slope_u = 0.0, slope_v = 0.0;        ///< of the background, codes/px
  double light_u_px = 0.0, light_v_px = 0.0;  ///< centroid of the signal, minus the outline's centre
};

inline constexpr std::size_t kRowBands = 4;  ///< equal parts of the image's height, from its top

/// The fixed scene in one frame, compared with the clip's first frames (scene_watch.h).
struct SceneLook {
  std::size_t frame = 0;
  double t_s = 0.0;
  double u_px = 0.0, v_px = 0.0;            ///< displacement in the image
  double sd_u_px = 0.0, sd_v_px = 0.0;      ///< from the pixels' noise; 0: no structure that would show a motion
  std::array<double, kRowBands> gain{};     ///< brightness over that of the first frames, minus 1
  std::array<double, kRowBands> gain_sd{};  ///< 0: no patch in that band
};

/// Size of the steps between neighbouring pixels of a row, by the column of the right pixel modulo 8 (camera_traces.h):
/// a codec with 8 x 8 blocks leaves larger steps at 0.
struct BlockSteps {
  std::array<double, 8> mean{};
  double count = 0.0;  ///< number of steps of each
};

/// How much pixels at rest of about equal brightness change from frame to frame (camera_traces.h), in codes.
struct NoiseAtLevel {
  double level_code = 0.0;  ///< their mean
  double sd_code = 0.0;     ///< of one pixel
  double known_to = 0.0;    ///< standard deviation of sd_code
};

/// Of the combs that go on (ImageRecord::combs): above it a film is interlaced.
inline constexpr double kInterlacedShare = 0.12;

struct ImageRecord {
  int width_px = 0, height_px = 0;
  double full_code = 255.0;        ///< largest code
  std::string codec;               ///< four letters as stored in the container; empty: a folder of frames
  std::optional<bool> lossy;       ///< empty if the codec is not known
  std::size_t stamps_missing = 0;  ///< frames for which the container's time stamps leave a gap
  std::vector<MarkerLook> marker;
  std::vector<SceneLook> scene;
  BlockSteps steps;
  double combs = 0.0;  ///< share of combs at the edges of what moves that go on over rows (interlacing.h)
  /// Variance of a pixel's change over two frames, over that from one to the next: 1 if the noise is new in every
  /// frame.
  std::optional<double> noise_memory;
  double noise_code = 0.0;                 ///< standard deviation of a resting pixel from frame to frame, codes
  std::vector<NoiseAtLevel> noise_levels;  ///< the same by brightness, darkest first
};

}  // namespace glidelab::core
