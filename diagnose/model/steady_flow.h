/// The motion under a force that is linear in time and a drag in proportion to the speed, in closed form:
///
///     dv/dt = a + c t - b (v - v0),    x = x0 + v0 t + a t² p2(bt) + c t³ p3(bt),    v = v0 + a t p1(bt) + c t²
///     p2(bt),
///
/// with p1(z) = (1 - exp(-z))/z, p2 = (1 - p1)/z and p3 = (1/2 - p2)/z, t from the start of the step and a the
/// acceleration there. Near the start p3 is its power series: no exponential, no division, and nothing special about
/// b = 0. Farther away exponentials give all three. SI units.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace glidelab::diagnose {

/// Position in m and speed in m/s.
struct PlaceAndSpeed {
  double x = 0.0, v = 0.0;
};

class SteadyFlow {
 public:
  /// Largest |b t| of the series. The first term that it leaves out is 0.3^10/13! = 1e-15 there.
  static constexpr double kReach = 0.3;

  SteadyFlow(const PlaceAndSpeed& from, double a_m_s2, double change_m_s3, double rate_1_s)
      : from_(from), a_(a_m_s2), c_(change_m_s3), b_(rate_1_s) {}

  /// With |b t| up to kReach.
  PlaceAndSpeed at(double t) const {
    const double z = b_ * t;
    double p3 = kSeries.front();
    for (std::size_t k = 1; k < kSeries.size(); ++k) p3 = kSeries[k] - z * p3;
    const double p2 = 0.5 - z * p3, p1 = 1.0 - z * p2;
    return with(t, p1, p2, p3);
  }

  /// With any |b t|.
  PlaceAndSpeed far(double t) const {
    const double z = b_ * t;
    if (std::abs(z) <= kReach) return at(t);
    const double p1 = -std::expm1(-z) / z, p2 = (1.0 - p1) / z, p3 = (0.5 - p2) / z;
    return with(t, p1, p2, p3);
  }

  /// At many instants within kReach, `start_s` being that of the start.
  void fill(double start_s, std::span<const double> at_s, double* x_m, double* v_m_s) const {
    for (std::size_t i = 0; i < at_s.size(); ++i) {
      const PlaceAndSpeed s = at(at_s[i] - start_s);
      x_m[i] = s.x;
      v_m_s[i] = s.v;
    }
  }

  /// The same at any instants, up to the first beyond a turn of a motion in `direction`; returns how many were filled.
  std::size_t fill_far(double start_s, std::span<const double> at_s, int direction, double* x_m, double* v_m_s) const {
    for (std::size_t i = 0; i < at_s.size(); ++i) {
      const PlaceAndSpeed s = far(at_s[i] - start_s);
      if (!(s.v * direction > 0.0)) return i;
      x_m[i] = s.x;
      v_m_s[i] = s.v;
    }
    return at_s.size();
  }

  double acceleration() const { return a_; }

 private:
  PlaceAndSpeed with(double t, double p1, double p2, double p3) const {
    return {from_.x + t * (from_.v + t * (a_ * p2 + t * c_ * p3)), from_.v + t * (a_ * p1 + t * c_ * p2)};
  }

  /// 1/12!, 1/11!, ..., 1/3!
  static constexpr std::array<double, 10> kSeries = [] {
    std::array<double, 10> series{};
    double factorial = 2.0;
    for (std::size_t k = 0; k < series.size(); ++k) {
      factorial *= static_cast<double>(k + 3);
      series[series.size() - 1 - k] = 1.0 / factorial;
    }
    return series;
  }();

  PlaceAndSpeed from_;
  double a_, c_, b_;
};

}  // namespace glidelab::diagnose
