#include "sim/sensitivity/driven_track.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/errors.h"
#include "sim/oracle/closed_forms.h"

namespace glidelab::sim {
namespace {

using ByLawAndStart = Eigen::Matrix<double, 2, 5>;  // derivatives by k, d, f, x0, v0
constexpr int kMostEvents = 100000;
constexpr double kRounding = 1e-12;  // of the accelerations: a net one below this counts as zero

/// The state at one instant: position, direction of motion (0: it sticks), and how both depend on the parameters.
struct Instant {
  double t_s = 0.0, x_m = 0.0, v_m_s = 0.0;
  int direction = 0;
  ByLawAndStart by;
};

/// The law while the glider moves in one direction, on one piece of the drive.
struct Sliding {
  double k, a0_m_s2, b_m_s3;
  int direction;

  double speed(double v0, double t) const {
    const double z = -k * t;
    return v0 * std::exp(z) + a0_m_s2 * t * phi1(z) + b_m_s3 * t * t * phi2(z);
  }

  /// The first time in [0, until] at which v = 0 and the glider would turn. `v0` is in this direction or 0.
  std::optional<double> stop(double v0, double until, double least_m_s2) const {
    if (v0 == 0.0 && direction * a0_m_s2 < -least_m_s2) return 0.0;  // it stopped where the last piece ended
    const auto against = [&](double t) { return direction * speed(v0, t) < 0.0; };
    double low = 0.0, high = until;
    // Where dv/dt = a' e + b phi is 0, a' = a0 - k v0.
    const double slope = a0_m_s2 - k * v0;
    const double ratio = -slope / b_m_s3;
    const double at = b_m_s3 == 0.0 || !(1.0 + k * ratio > 0.0) ? -1.0 : k == 0.0 ? ratio : std::log1p(k * ratio) / k;
    const bool inside = at > 0.0 && at < until;
    if (inside && against(at)) {
      high = at;
    } else if (against(until)) {
      if (inside) low = at;
    } else {
      return {};
    }
    // It has set off from rest: v = 0 at time 0 is not a stop.
    if (low == 0.0 && v0 == 0.0) return {};
    for (int i = 0; i < 200 && high - low > 4.0 * std::numeric_limits<double>::epsilon() * high; ++i) {
      // Newton's step, if it stays within the bracket.
      const double middle = 0.5 * (low + high);
      const double value = speed(v0, middle), by_t = slope_at(v0, middle);
      double next = by_t != 0.0 ? middle - value / by_t : middle;
      if (!(next > low && next < high)) next = middle;
      (against(middle) ? high : low) = middle;
      if (next > low && next < high) (against(next) ? high : low) = next;
    }
    return high;
  }

  double slope_at(double v0, double t) const { return a0_m_s2 + b_m_s3 * t - k * speed(v0, t); }

  Instant after(const Instant& from, double t) const {
    const double z = -k * t, one = phi1(z), two = phi2(z), three = phi3(z);
    const double e = std::exp(z), phi = t * one, psi = t * t * two, chi = t * t * t * three;
    // phi_n' = phi_n - n phi_{n+1}, and z' = -t
    const double phi_k = -t * t * (one - two), psi_k = -t * t * t * (two - 2.0 * three);
    const double chi_k = -t * t * t * t * (three - 3.0 * phi4(z));
    Instant to;
    to.t_s = from.t_s + t;
    to.x_m = from.x_m + from.v_m_s * phi + a0_m_s2 * psi + b_m_s3 * chi;
    to.v_m_s = from.v_m_s * e + a0_m_s2 * phi + b_m_s3 * psi;
    to.direction = direction;
    to.by.row(0) = from.by.row(0) + phi * from.by.row(1);
    to.by.row(1) = e * from.by.row(1);
    to.by(0, 0) += from.v_m_s * phi_k + a0_m_s2 * psi_k + b_m_s3 * chi_k;
    to.by(1, 0) += -t * e * from.v_m_s + a0_m_s2 * phi_k + b_m_s3 * psi_k;
    to.by(0, 1) += psi;
    to.by(1, 1) += phi;
    to.by(0, 2) -= direction * psi;
    to.by(1, 2) -= direction * phi;
    return to;
  }
};

class DrivenMotion {
 public:
  DrivenMotion(double k, double drive, double friction, const RecordedDrive& recorded)
      : k_(k), drive_(drive), friction_(friction), recorded_(recorded) {}

  std::vector<SensitiveState> run(double x0_m, double v0_m_s, std::span<const double> times_s) {
    at_.x_m = x0_m;
    at_.v_m_s = v0_m_s;
    at_.by.setZero();
    at_.by(0, 3) = at_.by(1, 4) = 1.0;
    at_.direction = v0_m_s > 0.0 ? 1 : v0_m_s < 0.0 ? -1 : direction_at_rest(pull(0.0));
    std::vector<SensitiveState> states;
    states.reserve(times_s.size());
    for (const double t_s : times_s) {
      while (at_.t_s < t_s) advance(t_s);
      if (!std::isfinite(at_.x_m)) {
        throw base::NumericalError(fmt::format("a motion with K/m = {} 1/s runs away by t = {} s", k_, t_s));
      }
      states.push_back({t_s, at_.x_m, at_.v_m_s, static_cast<Mode>(at_.direction), at_.by});
      if (at_.direction == 0) states.back().by_parameter.row(1).setZero();
    }
    return states;
  }

 private:
  /// The end of the piece of the drive that contains t, or infinity.
  double end_of_piece(double t) {
    while (next_ < recorded_.t_s.size() && recorded_.t_s[next_] <= t) ++next_;
    return next_ < recorded_.t_s.size() ? recorded_.t_s[next_] : std::numeric_limits<double>::infinity();
  }

  /// dp/dt right after t; 0 outside the samples.
  double rise(double t) {
    const double end = end_of_piece(t);
    if (next_ == 0 || !std::isfinite(end)) return 0.0;
    return (recorded_.p_m_s2[next_] - recorded_.p_m_s2[next_ - 1]) / (end - recorded_.t_s[next_ - 1]);
  }

  /// d + p(t)
  double pull(double t) {
    end_of_piece(t);
    if (next_ == 0) return drive_ + recorded_.p_m_s2.front();
    return drive_ + recorded_.p_m_s2[next_ - 1] + rise(t) * (t - recorded_.t_s[next_ - 1]);
  }

  int direction_at_rest(double pull) const { return std::abs(pull) <= friction_ ? 0 : pull > 0.0 ? 1 : -1; }

  /// Advances to `until`, the end of the piece, or the next event, whichever comes first.
  void advance(double until) {
    const double to = std::min(until, end_of_piece(at_.t_s)), length = to - at_.t_s;
    const double p = pull(at_.t_s), b = rise(at_.t_s);
    if (at_.direction == 0) return stay(p, b, to);
    const Sliding sliding{k_, p - at_.direction * friction_, b, at_.direction};
    const std::optional<double> stop = sliding.stop(at_.v_m_s, length, kRounding * (std::abs(p) + std::abs(friction_)));
    at_ = sliding.after(at_, stop.value_or(length));
    if (!stop) {
      at_.t_s = to;
      return;
    }
    count_event();
    const double there = p + b * *stop, before = there - at_.direction * friction_;
    at_.v_m_s = 0.0;
    at_.direction = direction_at_rest(there);
    const double after = at_.direction == 0 ? 0.0 : there - at_.direction * friction_;
    at_.by.row(1) *= before != 0.0 ? after / before : 0.0;
  }

  /// Stays at rest until the drive exceeds the friction.
  void stay(double p, double b, double to) {
    const double end = p + b * (to - at_.t_s);
    at_.by.row(1).setZero();
    if (direction_at_rest(end) == 0) {
      at_.t_s = to;
      return;
    }
    count_event();
    at_.direction = end > 0.0 ? 1 : -1;
    const double off = b != 0.0 ? (at_.direction * friction_ - p) / b : 0.0;
    at_.t_s = std::clamp(at_.t_s + off, at_.t_s, to);
  }

  void count_event() {
    if (++events_ > kMostEvents) {
      throw base::NumericalError(fmt::format("a motion with K/m = {} 1/s turns without end", k_));
    }
  }

  double k_, drive_, friction_;
  const RecordedDrive& recorded_;
  std::size_t next_ = 0;  ///< index of the first sample after the current instant
  int events_ = 0;
  Instant at_;
};

}  // namespace

std::vector<SensitiveState> driven_track_sensitive(double k_1_s, double drive_m_s2, double friction_m_s2, double x0_m,
                                                   double v0_m_s, std::span<const double> times_s,
                                                   const RecordedDrive& recorded) {
  if (recorded.t_s.empty()) return track_motion_sensitive(k_1_s, drive_m_s2, friction_m_s2, x0_m, v0_m_s, times_s);
  if (!std::isfinite(k_1_s + drive_m_s2 + friction_m_s2 + x0_m + v0_m_s)) {
    throw base::NumericalError(
        fmt::format("a driven motion with K/m = {} 1/s, drive {} m/s², friction {} m/s², from x0 = {} m, v0 = {} m/s",
                    k_1_s, drive_m_s2, friction_m_s2, x0_m, v0_m_s));
  }
  return DrivenMotion(k_1_s, drive_m_s2, friction_m_s2, recorded).run(x0_m, v0_m_s, times_s);
}

}  // namespace glidelab::sim
