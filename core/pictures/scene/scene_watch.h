/// Watches the resting scene of a clip: does it move in the image, does it change brightness, does it show a codec?
///
/// Some patches of 24 x 24 pixels are chosen in the first frame, those with most structure and some spread over the
/// image. In each frame a patch, blurred by 1 px, is compared with its mean R over the first frames, to first order
/// in a shift d, a gain a that changes from row to row (z = -1 to 1), for a rolling shutter sees light that flickers
/// as bands, and a contrast of its own: codes follow a tone curve, so that they are not proportional to the light, and
/// another light changes them by a gain and an offset. With the contrast C = R - mean of R,
///
///     I = R + (a0 + a1 z + a2 z²) R + (b0 + b1 z + b2 z²) C - d . grad R,
///
/// by least squares, with R shifted (cubic interpolation) by the last frame's shift. The gain is so that of the patch's
/// mean, whatever its contrast does. Patches through which something passes (residuals three times the usual ones, or a
/// shift that differs from the others') are not counted in that frame. The shift is that of all patches together,
/// weighted by their gradients. Gains are determined separately for bands of rows, which a rolling shutter exposes at
/// different times. Images of the first six frames are held until then, and of later ones only their patches.
#pragma once

#include <opencv2/core.hpp>

#include <cstddef>
#include <optional>
#include <vector>

#include "core/pictures/scene/camera_traces.h"
#include "core/result/image_record.h"

namespace glidelab::core {

inline constexpr int kPatchSide = 24;       ///< px
inline constexpr double kPatchNoise = 0.1;  ///< codes: rounding, blurred
inline constexpr double kPatchSofter =
    0.2873;  ///< noise of a pixel after the blur: sum of one direction's squared weights

class SceneWatch {
 public:
  /// `lossy`: the file says that its compression is lossy. The noise is then no longer new in every pixel and frame: a
  /// codec freezes it, so that even a plain wall has structure that rests and later jumps. Errors then count as at
  /// least one code, shared by a block of 8 x 8 pixels. finish() does the same if the file says nothing but the images
  /// show blocks (camera_traces.h).
  explicit SceneWatch(bool lossy = false) : lossy_(lossy) {}
  void add(const cv::Mat& grey, double t_s);
  /// Fills what it has seen into the record: scene, steps, noise.
  void finish(ImageRecord& record);

 private:
  static constexpr int kTerms = 8;
  using Terms = cv::Vec<double, kTerms>;
  using Normal = cv::Matx<double, kTerms, kTerms>;
  struct Patch {
    cv::Rect place;
    cv::Mat_<float> around;  ///< the mean of the first frames, with a margin for shifts
    std::vector<float> reference, gu, gv;
    double mean = 0.0;           ///< of the reference
    Normal inverse;              ///< of the normal matrix of the terms
    cv::Matx22d structure;       ///< of the shift, the light projected out
    double gain_variance = 0.0;  ///< of the gain for a pixel's variance of 1
    double noise_left = 1.0;     ///< of the noise's variance, by a fit of the terms
    double usual_rms = 0.0;
    std::vector<float> residual, before, before_that;  ///< of the last three frames
    int good = 0;                                      ///< frames in a row in which it counted
    std::vector<double> changed;                       ///< sum of squares of each pixel's changes
    double changes = 0.0;                              ///< from one frame to the next
  };
  /// A patch that counts in a frame.
  struct Moved {
    Patch* patch;
    Terms by;     ///< gain, shift (px) from where the reference stands, and the rest of the light
    double rest;  ///< mean square of what is left over, and of what the fit took of the noise
  };
  using Pixels = std::vector<std::vector<float>>;  ///< of each patch

  void choose(const cv::Mat& grey);
  Pixels cut(const cv::Mat& grey) const;
  void make_reference();
  static void shift_reference(Patch& patch, cv::Point2d shift);
  static double noise_left_by_fit(const Patch& patch);
  /// Of a pixel with the terms of Moved::by.
  static Terms derivatives_at(const Patch& patch, std::size_t pixel);
  SceneLook compare(const Pixels& pixels);
  static Terms fit_terms(Patch& patch, const std::vector<float>& pixels);
  std::optional<Moved> fit_patch(Patch& patch, const std::vector<float>& pixels) const;
  static void drop_odd(std::vector<Moved>& found, double variance);
  void tell_gains(const std::vector<Moved>& found, double variance, SceneLook& look) const;
  void tell_shift(const std::vector<Moved>& found, double variance, SceneLook& look) const;
  void add_changes(Patch& patch);
  void look(const cv::Mat& grey, double t_s);
  PixelChanges changes_by_level() const;
  void allow_for_codec(std::vector<SceneLook>& looks) const;

  cv::Size size_;
  std::vector<Patch> patches_;
  std::vector<cv::Mat> early_;
  std::vector<double> early_t_s_;
  bool lossy_ = false;
  bool ready_ = false;
  cv::Point2d shift_;  ///< at which the references stand
  std::vector<SceneLook> looks_;
  std::vector<double> variances_;  ///< of a pixel, that the looks' errors come from
  BlockStepSums steps_;
  double change_one_ = 0.0, change_two_ = 0.0;
  std::size_t changes_ = 0;
};

}  // namespace glidelab::core
