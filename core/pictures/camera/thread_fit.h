/// A thread in an image, fitted as a whole: a stripe with blurred edges whose course is known except for a shift and a
/// rotation.
///
/// With c_k + p + q (r_k - r) the thread's middle in row r_k, d the distance along the row from it, and E the response
/// of a square pixel to a blurred edge (core/pictures/image/pixel_signal.h),
///
///     I_k(u) = b_k + g_k d + a_k [E(s + w/2) - E(s - w/2)] / w,     s = d n_u
///
/// n the thread's normal in the image; the width w, the blur, p and q are one for all rows, the background b_k, g_k
/// and the strength a_k each row's own (eliminated, row by row). A sharp thread inside one column of pixels does not
/// show where in the column it is, so that the middles of single rows, however fitted, follow the phase of the pixels;
/// along an upright thread this phase drifts slowly and would turn the line. Here the rows in which the thread passes
/// from one pixel to the next determine it.
#pragma once

#include <optional>
#include <vector>

namespace glidelab::core {

struct ThreadRow {
  double row = 0.0;
  std::vector<double> values;  ///< the pixels of the row
  double middle = 0.0;         ///< c_k: an index into the values, good to a pixel
};

struct ThreadFit {
  double shift = 0.0;     ///< p, pixels
  double turn = 0.0;      ///< q, pixels a row
  double mean_row = 0.0;  ///< r
  double sd_turn = 0.0;   ///< from the scatter of blocks of rows, if that is larger than for independent pixels
  double width_px = 0.0;
  double blur_px = 0.0;
  std::size_t rows = 0;  ///< used; those with a residual of four times the median's are left out
};

/// Nothing if fewer than 10 rows can be used or the fit does not converge. `slant`: change of the middle from one row
/// to the next; `width_px` a first guess.
std::optional<ThreadFit> fit_thread(const std::vector<ThreadRow>& rows, double slant, double width_px);

}  // namespace glidelab::core
