/// The centre of a marker of any look (a ring, a bull's eye, quadrants, a sphere before the glider and its own shadow),
/// by what it looks like in the other frames of its clip.
///
///     I(p) = a + s T(q),    q = M (p - c)
///
/// T is the mean look of all frames, on a grid of about a pixel in q; M is the outline that the camera would show of a
/// marker there, so that a lens or a perspective that changes its size does not matter; a and s are the light of the
/// frame. Pixels in which frames differ (the background that passes by) count less, and so do those of a frame that do
/// not fit (what is in front of the marker). The look is sharpened until it gives the pixels back; the first guesses of
/// the centres may be off by a few pixels.
///
/// A look that is the same after half a turn has a centre of its own. Elsewhere the centre is that of the guesses on
/// average, so it may be off the marker's own by an amount that is the same in all frames. Assumes that the marker does
/// not turn and that its look changes slowly. Pixels; the centre of the first pixel is (0, 0).
#pragma once

#include <opencv2/core.hpp>

#include <optional>
#include <vector>

namespace glidelab::core {

/// A frame's pixels around the marker.
struct TemplateWindow {
  cv::Mat codes;      ///< of floats
  cv::Point corner;   ///< its first pixel in the image
  cv::Vec3d shape;    ///< the elements uu, uv, vv of M (1/px)
  cv::Point2d start;  ///< guess of the centre
};

struct TemplateFit {
  cv::Point2d centre;
  double sd_px = 0.0;  ///< of one coordinate
  double level = 0.0;  ///< a
  double gain = 1.0;   ///< s
  double rms = 0.0;    ///< of the residuals where the look is the same in all frames, in codes
};

class MarkerTemplate {
 public:
  static constexpr double kReach = 1.5;  ///< of the radius: how far the look is known

  /// The look that these frames have in common, each with the centre and the light of `fits`; those without one do not
  /// count. Nothing with fewer than eight.
  static std::optional<MarkerTemplate> of(const std::vector<TemplateWindow>& windows,
                                          const std::vector<std::optional<TemplateFit>>& fits);

  /// From the window's start. Nothing where it does not converge or moves by more than a radius.
  std::optional<TemplateFit> fit(const TemplateWindow& window) const;

  /// Root mean square of the look about its mean, in codes.
  double contrast() const { return contrast_; }

  /// Of what changes over the look (the square of its gradient), how much lies between 0.8 and 1.2 radii: a marker of
  /// the stated size has an edge there, whatever is within.
  double share_at_outline() const;

  /// The place about which the look is the same after half a turn, in q; nothing where there is none near 0.
  std::optional<cv::Point2d> centre_of_symmetry() const;

 private:
  struct Value {
    double value, x, y;  ///< T and its derivatives by q
  };
  Value at(double x, double y) const;
  double weight_at(double x, double y) const;
  double step() const { return 1.0 / nodes_per_radius_; }

  int nodes_per_radius_ = 0;
  cv::Mat look_;    ///< T, doubles
  cv::Mat weight_;  ///< 1 where frames are alike, less where they differ, 0 where the look is not known
  double contrast_ = 0.0;
};

}  // namespace glidelab::core
