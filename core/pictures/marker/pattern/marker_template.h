/// The centre of a marker of any appearance (a ring, a bull's eye, quadrants, a sphere in front of the glider and its
/// own shadow), by its mean appearance, the look, in all frames of its clip.
///
///     I(p) = a + s T(q),    q = M (p - c)
///
/// T is the look, on a grid of about one pixel in q. M is the outline that the camera would show of the marker at that
/// place, so that changes of its size by the lens or by perspective do not matter. a and s describe the light of the
/// frame. Pixels that differ between frames (the background that passes by) have less weight, and so have pixels of one
/// frame that do not fit (an object in front of the marker). The look is sharpened in four steps, after which it
/// reproduces the pixels to a hundredth of its contrast. The first guesses of the centres may be off by a few pixels.
///
/// A look that is the same after half a turn has a centre of its own. Otherwise the centre is, on average, that of the
/// guesses, so it may differ from the marker's own by an offset that is the same in all frames. Assumes that the marker
/// does not turn and that its look changes slowly. Lengths are in pixels, and the centre of the first pixel is (0, 0).
#pragma once

#include <opencv2/core.hpp>

#include <optional>
#include <vector>

namespace glidelab::core {

/// The pixels of one frame around the marker.
struct TemplateWindow {
  cv::Mat codes;      ///< CV_32F
  cv::Point corner;   ///< its first pixel in the image
  cv::Vec3d shape;    ///< the elements uu, uv, vv of M (1/px)
  cv::Point2d start;  ///< guess of the centre
};

struct TemplateFit {
  cv::Point2d centre;
  double sd_px = 0.0;  ///< of one coordinate
  double level = 0.0;  ///< a
  double gain = 1.0;   ///< s
  double rms = 0.0;    ///< weighted root mean square of the residuals, in codes
};

class MarkerTemplate {
 public:
  static constexpr double kReach = 1.5;  ///< in radii: how far out the look is known

  /// The look that these frames have in common, each with the centre and the light of its fit in `fits`; frames without
  /// a fit do not count. Empty for fewer than eight frames with a fit.
  static std::optional<MarkerTemplate> of(const std::vector<TemplateWindow>& windows,
                                          const std::vector<std::optional<TemplateFit>>& fits);

  /// The fit of a window, from its start. Empty if it does not converge, moves by more than a radius, reaches too few
  /// pixels (less than 60 % of those that the look covers), or if s leaves 0.3 to 3.
  std::optional<TemplateFit> fit(const TemplateWindow& window) const;

  /// The root mean square of the look about its mean, in codes.
  double contrast() const { return contrast_; }

  /// The part of the look's squared gradient that lies between 0.8 and 1.2 radii. A marker of the stated size has an
  /// edge there, whatever is inside.
  double share_at_outline() const;

  /// The place about which the look is the same after half a turn, in q; nothing where there is none near 0.
  std::optional<cv::Point2d> centre_of_symmetry() const;

 private:
  struct Value {
    double value, x, y;  ///< T and its derivatives with respect to q
  };
  Value at(double x, double y) const;
  double value_at(double x, double y) const;  ///< T alone
  double weight_at(double x, double y) const;
  double step() const { return 1.0 / nodes_per_radius_; }

  int nodes_per_radius_ = 0;
  cv::Mat look_;    ///< T, CV_64F
  cv::Mat weight_;  ///< 1 where frames agree, less where they differ, 0 where the look is unknown
  double contrast_ = 0.0;
};

}  // namespace glidelab::core
