#include "sim/oracle/closed_forms.h"

#include <cmath>
#include <limits>

namespace glidelab::sim {

namespace {

// log(1 + z) / z, 1 at z = 0; no cancellation for z > -1.
double log1p_over(double z) {
  return z == 0.0 ? 1.0 : std::log1p(z) / z;
}

int sign_of(double value) {
  return value < 0.0 ? -1 : 1;
}

// A motion along its own direction: distance and speed count forward, acceleration too.
struct Run {
  double distance_m = 0.0;
  double speed_m_s = 0.0;
  double acceleration_m_s2 = 0.0;
};

// speed' = a - k speed.
Run linear_run(double a, double k, double speed0, double t) {
  const Kinematics at = linear_motion(a, k, 0.0, speed0, t);
  return {at.x_m, at.v_m_s, at.a_m_s2};
}

// speed' = a - q speed². With r = sqrt(|a| q), and T = tan(rt)/r for a < 0 or tanh(rt)/r for a > 0 (t for r = 0),
//     speed = (speed0 + a T) / (1 + q speed0 T),     distance = ln(C + q speed0 S) / q,
// C = cos or cosh of rt, S = sin(rt)/r or sinh(rt)/r. For small q the distance is taken as log1p(q u) / q with
//     u = (C - 1)/q + speed0 S,     (C - 1)/q = a/2 (sin or sinh of (rt/2) / (r/2))².
Run quadratic_run(double a, double q, double speed0, double t) {
  const double r = std::sqrt(std::abs(a) * q);
  const double z = r * t;
  const auto over_r = [&](double value, double limit) { return r == 0.0 ? limit : value / r; };
  const double big_t = a < 0.0 ? over_r(std::tan(z), t) : over_r(std::tanh(z), t);
  Run run;
  run.speed_m_s = (speed0 + a * big_t) / (1.0 + q * speed0 * big_t);
  run.acceleration_m_s2 = a - q * run.speed_m_s * run.speed_m_s;
  if (a > 0.0 && z > 1.0) {  // cosh would overflow for large z
    const double b = q * speed0 / r;
    run.distance_m = (z + std::log(0.5 * ((1.0 + b) + (1.0 - b) * std::exp(-2.0 * z)))) / q;
    return run;
  }
  const double half = a < 0.0 ? std::sin(z / 2.0) : std::sinh(z / 2.0);
  const double full = a < 0.0 ? std::sin(z) : std::sinh(z);
  const double root = over_r(2.0 * half, t);
  const double u = 0.5 * a * root * root + speed0 * over_r(full, t);
  run.distance_m = u * log1p_over(q * u);
  return run;
}

// atan(z) / r = speed0 / |a| atan(z) / z with z = r speed0 / |a|.
std::optional<double> quadratic_run_stop(double a, double q, double speed0) {
  if (speed0 == 0.0) return 0.0;
  if (a >= 0.0) return std::nullopt;
  const double z = speed0 * std::sqrt(q / -a);
  return speed0 / -a * (z == 0.0 ? 1.0 : std::atan(z) / z);
}

template <class StopTime>
std::optional<double> first_stop(const DryTrack& track, double v0, StopTime&& stop_time) {
  if (v0 == 0.0) return std::nullopt;
  return stop_time(sign_of(v0) * track.drive_m_s2 - track.friction_m_s2, std::abs(v0));
}

// Runs up to v = 0, and from there back or stays.
template <class RunFrom, class StopTime>
State piecewise(const DryTrack& track, double x0, double v0, double t, RunFrom&& run_from, StopTime&& stop_time) {
  const auto slide = [&](int direction, double start_s, double from_m, double speed0) -> State {
    const Run run = run_from(direction * track.drive_m_s2 - track.friction_m_s2, speed0, t - start_s);
    return {t, from_m + direction * run.distance_m, direction * run.speed_m_s, direction * run.acceleration_m_s2,
            direction < 0 ? Mode::slide_up : Mode::slide_down};
  };
  double rest_s = 0.0;
  double rest_m = x0;
  if (v0 != 0.0) {
    const int direction = sign_of(v0);
    const std::optional<double> stop_s = first_stop(track, v0, stop_time);
    if (!stop_s || t < *stop_s) return slide(direction, 0.0, x0, std::abs(v0));
    const double a = direction * track.drive_m_s2 - track.friction_m_s2;
    rest_s = *stop_s;
    rest_m = x0 + direction * run_from(a, std::abs(v0), rest_s).distance_m;
  }
  const double held = track.holding_m_s2 * (1.0 + 8.0 * std::numeric_limits<double>::epsilon());
  if (std::abs(track.drive_m_s2) <= held) return {t, rest_m, 0.0, 0.0, Mode::stick};
  return slide(sign_of(track.drive_m_s2), rest_s, rest_m, 0.0);
}

}  // namespace

double phi1(double z) {
  return z == 0.0 ? 1.0 : std::expm1(z) / z;
}

double phi2(double z) {
  // (expm1(z) - z) / z² loses digits below |z| = 1; the series to z^18 / 20! loses none there (1 / 21! < 1e-19).
  if (std::abs(z) > 1.0) return (std::expm1(z) - z) / (z * z);
  double sum = 0.0;
  for (int n = 20; n >= 2; --n) sum = (1.0 + z * sum) / n;  // Horner: 1/2 (1 + z/3 (1 + z/4 (…)))
  return sum;
}

namespace {

constexpr double kSeries = 0.5;  // |z| below which a series has all digits in 15 terms: 0.5^15 / 15! < 1e-16

/// 1/n! + z/(n + 1)! + z²/(n + 2)! + …, `first` = 1/n!.
double series_of_phi(int n, double first, double z) {
  double term = first, sum = term;
  for (int m = n + 1; m < n + 16; ++m) sum += term *= z / m;
  return sum;
}

}  // namespace

double phi3(double z) {
  return std::abs(z) < kSeries ? series_of_phi(3, 1.0 / 6.0, z) : (phi2(z) - 0.5) / z;
}

double phi4(double z) {
  return std::abs(z) < kSeries ? series_of_phi(4, 1.0 / 24.0, z) : (phi3(z) - 1.0 / 6.0) / z;
}

DryTrack dry_track(double incline_rad, double mu, double mu_static, double gravity_m_s2) {
  const double normal = gravity_m_s2 * std::cos(incline_rad);
  return {gravity_m_s2 * std::sin(incline_rad), mu * normal, mu_static * normal};
}

Kinematics viscous_motion(double k_1_s, double v_lim_m_s, double x0_m, double v0_m_s, double t_s) {
  const double decay = std::exp(-k_1_s * t_s);
  const double decayed = -std::expm1(-k_1_s * t_s);
  return {x0_m + (v0_m_s - v_lim_m_s) / k_1_s * decayed + v_lim_m_s * t_s, v_lim_m_s * decayed + v0_m_s * decay,
          k_1_s * (v_lim_m_s - v0_m_s) * decay};
}

Kinematics uniform_motion(double a_m_s2, double x0_m, double v0_m_s, double t_s) {
  return {x0_m + v0_m_s * t_s + 0.5 * a_m_s2 * t_s * t_s, v0_m_s + a_m_s2 * t_s, a_m_s2};
}

Kinematics linear_motion(double a0_m_s2, double k_1_s, double x0_m, double v0_m_s, double t_s) {
  const double z = -k_1_s * t_s;
  const double decay = std::exp(z);
  return {x0_m + v0_m_s * t_s * phi1(z) + a0_m_s2 * t_s * t_s * phi2(z), v0_m_s * decay + a0_m_s2 * t_s * phi1(z),
          (a0_m_s2 - k_1_s * v0_m_s) * decay};
}

std::optional<double> linear_stop_time_s(double a0_m_s2, double k_1_s, double v0_m_s) {
  if (v0_m_s == 0.0) return 0.0;
  if (a0_m_s2 * v0_m_s >= 0.0) return std::nullopt;
  return -v0_m_s / a0_m_s2 * log1p_over(-k_1_s * v0_m_s / a0_m_s2);
}

State viscous_coulomb_motion(const DryTrack& track, double k_1_s, double x0_m, double v0_m_s, double t_s) {
  return piecewise(
      track, x0_m, v0_m_s, t_s, [&](double a, double speed0, double t) { return linear_run(a, k_1_s, speed0, t); },
      [&](double a, double speed0) { return linear_stop_time_s(a, k_1_s, speed0); });
}

std::optional<double> viscous_coulomb_stop_time_s(const DryTrack& track, double k_1_s, double v0_m_s) {
  return first_stop(track, v0_m_s, [&](double a, double speed0) { return linear_stop_time_s(a, k_1_s, speed0); });
}

State quadratic_coulomb_motion(const DryTrack& track, double q_1_m, double x0_m, double v0_m_s, double t_s) {
  return piecewise(
      track, x0_m, v0_m_s, t_s, [&](double a, double speed0, double t) { return quadratic_run(a, q_1_m, speed0, t); },
      [&](double a, double speed0) { return quadratic_run_stop(a, q_1_m, speed0); });
}

std::optional<double> quadratic_coulomb_stop_time_s(const DryTrack& track, double q_1_m, double v0_m_s) {
  return first_stop(track, v0_m_s, [&](double a, double speed0) { return quadratic_run_stop(a, q_1_m, speed0); });
}

State power_law_motion(double k_1_s, double n, double x0_m, double v0_m_s, double t_s) {
  if (v0_m_s == 0.0) return {t_s, x0_m, 0.0, 0.0, Mode::stick};
  const int direction = sign_of(v0_m_s);
  const double speed0 = std::abs(v0_m_s);
  const std::optional<double> stop_s = power_law_stop_time_s(k_1_s, n, v0_m_s);
  if (stop_s && t_s >= *stop_s) {
    const double distance = std::pow(speed0, 2.0 - n) / (k_1_s * (2.0 - n));
    return {t_s, x0_m + direction * distance, 0.0, 0.0, Mode::stick};
  }
  // speed^(1-n) = speed0^(1-n) (1 - (1-n) f t), f the initial rate of decay.
  const double f = k_1_s * std::pow(speed0, n - 1.0);
  const double log_ratio = -f * t_s * log1p_over(-(1.0 - n) * f * t_s);
  const double speed = speed0 * std::exp(log_ratio);
  // distance = (speed0^(2-n) - speed^(2-n)) / ((2-n) k)
  const double distance = std::pow(speed0, 2.0 - n) / k_1_s * -log_ratio * phi1((2.0 - n) * log_ratio);
  return {t_s, x0_m + direction * distance, direction * speed, -direction * k_1_s * std::pow(speed, n),
          direction < 0 ? Mode::slide_up : Mode::slide_down};
}

std::optional<double> power_law_stop_time_s(double k_1_s, double n, double v0_m_s) {
  if (n >= 1.0 || v0_m_s == 0.0) return std::nullopt;
  return std::pow(std::abs(v0_m_s), 1.0 - n) / ((1.0 - n) * k_1_s);
}

double eddy_rolloff_time_s(double k_1_s, double v_c_m_s, double v0_m_s, double v_m_s) {
  return (std::log(v0_m_s / v_m_s) + (v0_m_s - v_m_s) * (v0_m_s + v_m_s) / (2.0 * v_c_m_s * v_c_m_s)) / k_1_s;
}

double eddy_rolloff_distance_m(double k_1_s, double v_c_m_s, double v0_m_s, double v_m_s) {
  const double squares = v0_m_s * v0_m_s + v0_m_s * v_m_s + v_m_s * v_m_s;
  return (v0_m_s - v_m_s) * (1.0 + squares / (3.0 * v_c_m_s * v_c_m_s)) / k_1_s;
}

}  // namespace glidelab::sim
