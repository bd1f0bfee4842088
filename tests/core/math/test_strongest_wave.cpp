#include "core/math/strongest_wave.h"

#include <cmath>
#include <numbers>
#include <random>

#include "tests/catch.h"

using namespace glidelab;

namespace {

/// Four series of 200 values at 100 Hz with waves of one frequency and any phase, in white noise.
std::vector<core::Series> waves(double f_hz, double amplitude, double noise, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, noise);
  std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi);
  std::vector<core::Series> all(4);
  for (core::Series& one : all) {
    const double at = phase(random);
    for (int i = 0; i < 200; ++i) {
      one.t_s.push_back(0.01 * i);
      one.value.push_back(3.0 + 0.2 * one.t_s.back() +
                          amplitude * std::cos(2.0 * std::numbers::pi * f_hz * one.t_s.back() + at) + normal(random));
    }
  }
  return all;
}

}  // namespace

TEST_CASE("a wave between the frequencies of the search has its own frequency, to within the standard deviation") {
  double chi2 = 0.0;
  constexpr int kWaves = 40;
  for (int k = 0; k < kWaves; ++k) {
    const double f_hz = 2.3 + 0.0137 * k;  // the search has steps of 0.125 Hz
    CAPTURE(f_hz);
    const core::SeriesWave wave = core::strongest_wave(waves(f_hz, 1.0, 0.1, static_cast<unsigned>(k)));
    CHECK(std::abs(wave.f_hz - f_hz) < 5.0 * wave.sd_hz);
    CHECK(std::abs(wave.amplitude - 1.0) < 0.02);
    chi2 += std::pow((wave.f_hz - f_hz) / wave.sd_hz, 2) / kWaves;
  }
  // A mean of 40 squares of normal numbers: 1 with a standard deviation of 0.22.
  CHECK(chi2 < 2.0);
  CHECK(chi2 > 0.3);
}

TEST_CASE("near half the sampling rate a wave is as large as the samples show it, not as its sine would be") {
  // Alternating values, as those of the predicted and the key frames of a codec, and a slow change of their size.
  std::vector<core::Series> all(1);
  for (int i = 0; i < 240; ++i) {
    all[0].t_s.push_back(i / 60.0);
    all[0].value.push_back(1.0 + (i % 2 == 0 ? 4e-4 : -4e-4) * (1.0 + 0.3 * std::sin(0.02 * i)));
  }
  const core::SeriesWave wave = core::strongest_wave(all);
  CHECK(wave.f_hz > 29.5);
  CHECK(std::abs(wave.amplitude - 4e-4) < 0.3 * 4e-4);
  CHECK(std::abs(core::amplitude_at(all[0], 29.9997).size - 4e-4) < 0.3 * 4e-4);
}
