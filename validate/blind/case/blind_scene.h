/// The scene and the camera of a filmed blind case: drawn at random and written as a scenario of the renderer, together
/// with altered statements of experiment.toml and later changes to the images.
///
/// A small experiment: 640 x 240 pixels 1.2 to 1.4 m from the track, 100 to 240 Hz, 2 to 6 clips of 40 to 150 frames,
/// one or two masses, a level track, an inclined one or both; a sensor of 8,000 to 60,000 electrons, sometimes a tone
/// curve or a rolling shutter (stated), and a file with little or no loss.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "validate/blind/case/blind_design.h"

namespace glidelab::validate {

struct BlindCamera {
  int width_px = 640, height_px = 240;
  double rate_hz = 0.0;
  double exposure_s = 0.0;
  double focal_px = 0.0;
  double x_m = 0.0, y_m = 0.0, z_m = 0.0;  ///< position; it looks at (0, 0.03, 0)
  double k1 = 0.0;                         ///< of the lens, included in the calibration
  double line_s = 0.0;                     ///< above 0: rolling
  double full_well_e = 0.0, read_noise_e = 0.0, prnu = 0.0;
  std::string tone;   ///< "linear", "gamma" or "bt709"
  std::string codec;  ///< "magicyuv", "mjpeg" or "h264"
  int quality = 95;   ///< of mjpeg
  double crf = 18.0;  ///< of h264

  bool lossy() const { return codec != "magicyuv"; }
  double px_per_m() const { return focal_px / z_m; }
};

/// The forces of one clip, as laws of the renderer.
struct BlindForces {
  double k_n_s_m = 0.0, mu = 0.0;
  std::string drag_law = "viscous", drag_keys;          ///< keys besides k_n_s_m, whole lines
  std::string friction_law = "coulomb", friction_keys;  ///< besides mu
  std::string more;                                     ///< further tables of forces
};

/// A line of experiment.toml that differs from what the camera did.
struct BlindStated {
  std::string key;
  std::string value;  ///< as TOML; empty: the line is removed
};

/// Changes to the images after they were taken and before they are stored.
struct BlindRetouch {
  bool rewritten = false;  ///< the clips are rewritten without loss
  /// By clip: the position at which a point at x (on the track) is shown instead. Empty: not displaced.
  std::vector<std::function<double(double x_m)>> shown_at;
  /// By clip and frame: 1 if the frame is not stored. Empty: all are stored.
  std::vector<std::vector<char>> lost;
};

struct BlindScene {
  /// Its noise is the bound set by the sensor, plus the observed contribution of tracker and codec; the uncertainty of
  /// its calibration is typical of such scenes.
  BlindDesign motion;
  BlindCamera camera;
  std::vector<BlindForces> forces;  ///< of each clip
  double gradient_1_m = 0.0, flicker_depth = 0.0, flicker_hz = 100.0;
  double jitter_s = 0.0, rate_error = 0.0;  ///< relative excess of the camera's rate over the stated one
  std::string mount;                        ///< tables of mount motions
  std::size_t spare_frames = 0;             ///< filmed in addition to the design's, to replace lost ones
  std::vector<BlindStated> stated;
  BlindRetouch retouch;
};

/// `lossless`: the file is stored without loss.
BlindScene draw_scene(BlindRandom& random, bool lossless);

/// The scenario of a scene, for `glidelab render`.
std::string scenario_text(const BlindScene& scene, const std::string& name, std::uint64_t seed);

}  // namespace glidelab::validate
