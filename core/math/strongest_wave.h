/// The strongest wave that several series of values have in common.
#pragma once

#include <vector>

namespace glidelab::core {

struct Series {
  std::vector<double> t_s, value;
};

struct SeriesWave {
  double log_evidence = 0.0;
  double f_hz = 0.0, sd_hz = 0.0;
  double amplitude = 0.0, sd = 0.0;  ///< root mean square over the series
};

/// The strongest wave, between 3 periods a series and half the sampling rate, that the series of several clips have in
/// common: brightness that flickers, a scene that sways in the image.
///
/// Least squares of const + slope t + curve t² + a cos + b sin over each series at each frequency, with a and b free in
/// every series. The gain of a frequency is sum (n/2) ln(RSS without/RSS with), so that no noise level need be known.
/// Its evidence is reduced by Schwarz's penalty for what is free, and by four times the median gain over all
/// frequencies, which is the gain if the noise is not white.
SeriesWave strongest_wave(const std::vector<Series>& series);

/// Amplitude at one frequency and its standard deviation (of a component), of one series.
struct Amplitude {
  double size = 0.0, sd = 0.0;
};
Amplitude amplitude_at(const Series& series, double f_hz);

}  // namespace glidelab::core
