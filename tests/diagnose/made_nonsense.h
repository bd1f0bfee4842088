/// Small experiments that no law of friction follows: two clips of 48 and 60 positions every 0.01 s, launched up on
/// -3 degrees and down on 0, with a motion of a random kind each. A seed gives the same tracks everywhere: only
/// std::mt19937_64 and arithmetic, no library's distributions.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace glidelab::tests {

struct NonsenseClip {
  std::string name;
  std::string kind;  ///< of its motion
  double mass_kg = 0.335;
  double incline_deg = 0.0;
  double incline_sd_deg = 0.3;
  bool up = false;
  std::vector<double> t_s, x_m;
};

class NonsenseMaker {
 public:
  explicit NonsenseMaker(std::uint64_t seed) : random_(seed * 1'000'003u + 7u) {}

  std::vector<NonsenseClip> experiment() {
    NonsenseClip up{"up", {}, 0.335, -3.0, 0.3, true, {}, {}}, down{"down", {}, 0.335, 0.0, 0.3, false, {}, {}};
    if (chance(0.3)) down.mass_kg = 0.535;
    if (chance(0.5)) up.incline_sd_deg = down.incline_sd_deg = 0.05;
    fill(up, 48, 0.3, -between(0.3, 1.5));
    fill(down, 60, -0.5, between(0.1, 1.2));
    return {up, down};
  }

 private:
  static constexpr double kStep_s = 0.01;
  static constexpr double kLargest_m_s2 = 6.0;  ///< below what a diagnosis refuses as no motion on an incline

  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * unit(); }
  double decades(double low, double high) { return std::pow(10.0, between(low, high)); }
  bool chance(double part) { return unit() < part; }
  /// Of variance 1, the sum of twelve: near enough to a normal number.
  double spread() {
    double sum = -6.0;
    for (int i = 0; i < 12; ++i) sum += unit();
    return sum;
  }

  void fill(NonsenseClip& clip, std::size_t count, double x0_m, double v0_m_s) {
    constexpr std::array<const char*, 8> kKinds = {
        "law", "polynomial", "walk of the speed", "wave", "exponential", "steps", "jerks", "noise"};
    clip.kind = kKinds[static_cast<std::size_t>(between(0.0, 7.99))];
    const double duration_s = kStep_s * static_cast<double>(count);
    const double push = between(-kLargest_m_s2, kLargest_m_s2), drag = decades(-2.0, 2.5), dry = decades(-3.0, 0.0);
    const double rate = between(-6.0, 6.0), hz = decades(-0.3, 1.3), phase = between(0.0, 7.0);
    const double swing_m = kLargest_m_s2 * unit() / std::pow(2.0 * std::numbers::pi * hz, 2);
    const double jolt = decades(-3.0, 0.0), cubic = between(-1.0, 1.0), quartic = between(-1.0, 1.0);
    double x = x0_m, v = v0_m_s;
    for (std::size_t i = 0; i < count; ++i) {
      const double t = kStep_s * static_cast<double>(i), s = t / duration_s;
      double seen = x;
      if (clip.kind == "polynomial")
        seen = x0_m + v0_m_s * t + 0.5 * push * t * t * (1.0 + cubic * s + quartic * s * s);
      if (clip.kind == "wave") seen = x0_m + v0_m_s * t + swing_m * std::sin(2.0 * std::numbers::pi * hz * t + phase);
      if (clip.kind == "exponential") seen = x0_m + v0_m_s * (std::exp(rate * t) - 1.0) / rate;
      clip.t_s.push_back(t);
      clip.x_m.push_back(seen);
      double a = 0.0;
      if (clip.kind == "law") a = 0.2 * push - 0.03 * drag * v - dry * (v > 0.0 ? 1.0 : -1.0);
      if (clip.kind == "walk of the speed") a = 4.0 * jolt * spread() / std::sqrt(kStep_s);
      if (clip.kind == "jerks" && chance(0.1)) v += jolt * spread();
      if (clip.kind == "steps" && chance(0.1)) x += 0.03 * jolt * spread();
      if (clip.kind == "noise") x += 0.01 * jolt * spread();
      v += kStep_s * a;
      x += kStep_s * v;
    }
    const double noise_m = decades(-6.5, -3.0), rounding_m = chance(0.25) ? decades(-4.5, -2.5) : 0.0;
    for (double& seen : clip.x_m) {
      seen += noise_m * spread();
      if (rounding_m > 0.0) seen = rounding_m * std::round(seen / rounding_m);
      if (chance(0.003)) seen += 0.1 * spread();
    }
  }

  std::mt19937_64 random_;
};

}  // namespace glidelab::tests
