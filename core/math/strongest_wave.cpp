#include "core/math/strongest_wave.h"

#include <Eigen/Core>

#include <boost/math/tools/minima.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/math/quantile.h"

namespace glidelab::core {

namespace {

constexpr std::size_t kFewestSamples = 24;      // points of a series
constexpr double kFineness = 4.0;               // frequencies a width of the peak
constexpr double kFewestPeriods = 3.0;          // a series
constexpr double kMedianGainsSubtracted = 4.0;  // of the gains at all frequencies: what noise may reach
constexpr std::size_t kMostFrequencies = 6000;  // frequencies
constexpr double kNearLimit = 0.4;              // of the sampling rate
constexpr double kApart = 0.1;                  // of the determinant of a cosine and a sine that are independent

/// A series minus its mean, slope and curvature, and the orthonormal terms that were removed.
class Flat {
 public:
  explicit Flat(const Series& series)
      : t_(series.t_s), rest_(Eigen::Map<const Eigen::VectorXd>(series.value.data(), std::ssize(series.value))) {
    const auto n = std::ssize(t_);
    terms_.resize(n, 3);
    const double middle = 0.5 * (t_.front() + t_.back()), half = std::max(1e-9, 0.5 * (t_.back() - t_.front()));
    for (Eigen::Index i = 0; i < n; ++i) {
      const double z = (t_[static_cast<std::size_t>(i)] - middle) / half;
      terms_(i, 0) = 1.0;
      terms_(i, 1) = z;
      terms_(i, 2) = z * z;
    }
    for (Eigen::Index c = 0; c < 3; ++c) {
      for (Eigen::Index before = 0; before < c; ++before) {
        terms_.col(c) -= terms_.col(before).dot(terms_.col(c)) * terms_.col(before);
      }
      terms_.col(c).normalize();
    }
    rest_ = without(rest_);
    squares_ = rest_.squaredNorm();
  }

  struct At {
    double explained = 0.0, a = 0.0, b = 0.0, variance = 0.0;  ///< variance of a component
    double squared = 0.0;                                      ///< amplitude
  };
  At at(double f_hz) const {
    const auto n = rest_.size();
    Eigen::VectorXd c(n), s(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const double phase = 2.0 * std::numbers::pi * f_hz * (t_[static_cast<std::size_t>(i)] - t_.front());
      c[i] = std::cos(phase);
      s[i] = std::sin(phase);
    }
    c = without(c);
    s = without(s);
    const double cc = c.squaredNorm(), ss = s.squaredNorm(), cs = c.dot(s), cr = c.dot(rest_), sr = s.dot(rest_);
    const double determinant = cc * ss - cs * cs;
    At at;
    if (!(determinant >
          1e-6 * static_cast<double>(n * n))) {  // at half the sampling rate one of the two is all there is
      if (!(cc > 0.1 * static_cast<double>(n))) return at;
      at.a = cr / cc;
      at.explained = at.a * cr;
    } else {
      at.a = (ss * cr - cs * sr) / determinant;
      at.b = (cc * sr - cs * cr) / determinant;
      at.explained = at.a * cr + at.b * sr;
    }
    at.explained = std::clamp(at.explained, 0.0, squares_);
    // Near half the sampling rate the sine is all but zero in every sample, and a and b are large and cancel: a wave is
    // as large as what the samples show of it.
    const bool apart = determinant > kApart * 0.25 * static_cast<double>(n * n) || f_hz < kNearLimit * rate();
    const double seen =
        0.5 * (cc + ss + std::hypot(cc - ss, 2.0 * cs));  // by the samples, of the phase that shows most
    at.squared = apart ? at.a * at.a + at.b * at.b : at.explained / seen;
    at.variance = 2.0 * (squares_ - at.explained) / static_cast<double>(n * n);
    return at;
  }
  double squares() const { return squares_; }
  double count() const { return static_cast<double>(rest_.size()); }
  double span() const { return t_.back() - t_.front(); }
  double rate() const { return (count() - 1.0) / span(); }

 private:
  Eigen::VectorXd without(Eigen::VectorXd column) const {
    for (Eigen::Index c = 0; c < 3; ++c) column -= terms_.col(c).dot(column) * terms_.col(c);
    return column;
  }
  const std::vector<double>& t_;
  Eigen::VectorXd rest_;
  Eigen::MatrixXd terms_;
  double squares_ = 0.0;
};

}  // namespace

SeriesWave strongest_wave(const std::vector<Series>& all) {
  std::vector<Flat> series;
  double span = 0.0, rate = 0.0, shortest = std::numeric_limits<double>::infinity();
  for (const Series& one : all) {
    if (one.t_s.size() < kFewestSamples) continue;
    series.emplace_back(one);
    if (!(series.back().squares() > 0.0)) {
      series.pop_back();
      continue;
    }
    span = std::max(span, series.back().span());
    shortest = std::min(shortest, series.back().span());
    rate = std::max(rate, series.back().rate());
  }
  SeriesWave wave;
  if (series.empty()) return wave;
  const double lowest = kFewestPeriods / shortest, highest = 0.5 * rate;
  const auto many =
      std::min<std::size_t>(kMostFrequencies, static_cast<std::size_t>(std::max(8.0, kFineness * span * highest)));
  const auto gain_at = [&](double f_hz) {
    double gain = 0.0;
    for (const Flat& one : series) {
      const double left = std::max(1e-9, 1.0 - one.at(f_hz).explained / one.squares());
      gain -= 0.5 * one.count() * std::log(left);
    }
    return gain;
  };
  const double step = (highest - lowest) / static_cast<double>(many);
  std::vector<double> gains;
  double best = 0.0;
  for (std::size_t k = 0; k <= many; ++k) {
    const double f = lowest + step * static_cast<double>(k), gain = gain_at(f);
    gains.push_back(gain);
    if (gain <= best) continue;
    best = gain;
    wave.f_hz = f;
  }
  if (best > 0.0) {  // the peak between the frequencies tried
    constexpr int kBits = 30;
    const auto [f, loss] = boost::math::tools::brent_find_minima([&](double at) { return -gain_at(at); },
                                                                 std::max(lowest, wave.f_hz - step),
                                                                 std::min(highest, wave.f_hz + step), kBits);
    if (-loss > best) {
      best = -loss;
      wave.f_hz = f;
    }
  }
  double penalty = std::log(static_cast<double>(many) / kFineness), squares = 0.0, variance = 0.0;
  for (const Flat& one : series) {
    penalty += std::log(one.count());
    const Flat::At at = one.at(wave.f_hz);
    squares += at.squared / static_cast<double>(series.size());
    variance += at.variance / static_cast<double>(series.size() * series.size());
  }
  wave.log_evidence = best - penalty - kMedianGainsSubtracted * median_of(gains);
  wave.amplitude = std::sqrt(squares);
  wave.sd = std::sqrt(variance);
  // Standard deviation of the frequency of a wave in white noise: sqrt(6) sd(component) / (pi span amplitude).
  wave.sd_hz = std::sqrt(6.0) * wave.sd / (std::numbers::pi * span * std::max(1e-300, wave.amplitude));
  return wave;
}

Amplitude amplitude_at(const Series& series, double f_hz) {
  if (series.t_s.size() < kFewestSamples) return {};
  const Flat flat(series);
  const Flat::At at = flat.at(f_hz);
  return {std::sqrt(at.squared), std::sqrt(at.variance)};
}

}  // namespace glidelab::core
