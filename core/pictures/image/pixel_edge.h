/// What a square pixel sees of a straight edge that a lens has blurred.
///
/// An ideal edge, bright where s > 0, convolved with a Gaussian of standard deviation `blur` and averaged over the
/// pixel's square of side 1. Along the edge's normal n the square is two boxes of widths a = |n_u| and b = |n_v|, so
/// that
///
///     E(s) = [H(s + (a+b)/2) - H(s + (a-b)/2) - H(s - (a-b)/2) + H(s - (a+b)/2)] / (a b),
///     H(t) = ((t^2 + blur^2) Phi(t / blur) + t blur phi(t / blur)) / 2,      H'' = Phi(t / blur)
///
/// exact for straight edges. Where the smaller of a and b is below 0.1, its box is taken as a Gaussian of the same
/// variance (b^2 / 12), which changes E by less than 1e-6.
#pragma once

namespace glidelab::core {

struct PixelEdge {
  double value;  ///< E, from 0 to 1
  double slope;  ///< dE / ds
  double bend;   ///< d2E / ds2; dE / d(blur) = blur * bend
};

/// `s` distance of the pixel's centre inside the edge, (nu, nv) the edge's unit normal, lengths in pixels; blur > 0.
PixelEdge pixel_edge(double s, double nu, double nv, double blur);

}  // namespace glidelab::core
