/// Weighted least squares of a straight line y = intercept + slope x, by its sums:
///
///     slope = (W Sxy - Sx Sy) / D,    intercept = (Sxx Sy - Sx Sxy) / D,    D = W Sxx - Sx^2
#pragma once

namespace glidelab::core {

struct LineSums {
  double w = 0.0;
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;

  void add(double weight, double at, double value) {
    w += weight;
    x += weight * at;
    y += weight * value;
    xx += weight * at * at;
    xy += weight * at * value;
  }
  double determinant() const { return w * xx - x * x; }
  /// Where all x are alike rounding alone leaves D of about 1e-16 of W Sxx; `least` of that is asked for.
  bool is_regular(double least) const { return determinant() > least * w * xx; }
  double slope() const { return (w * xy - x * y) / determinant(); }
  double intercept() const { return (xx * y - x * xy) / determinant(); }
};

/// The square of the correlation of pairs, by Welford's update: no cancellation.
class PairCorrelation {
 public:
  void add(double x, double y) {
    n_ += 1.0;
    const double dx = x - mean_x_, dy = y - mean_y_;
    mean_x_ += dx / n_;
    mean_y_ += dy / n_;
    xx_ += dx * (x - mean_x_);
    xy_ += dx * (y - mean_y_);
    yy_ += dy * (y - mean_y_);
  }
  /// 0 where all x or all y are one.
  double squared() const { return xx_ > 0.0 && yy_ > 0.0 ? xy_ * xy_ / (xx_ * yy_) : 0.0; }

 private:
  double n_ = 0.0, mean_x_ = 0.0, mean_y_ = 0.0, xx_ = 0.0, xy_ = 0.0, yy_ = 0.0;
};

}  // namespace glidelab::core
