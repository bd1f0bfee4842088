/// A wave in time, one amplitude and one frequency for all motions and a free phase in each: how much of a fit's
/// residuals it would explain. The evidence is averaged over amplitudes (three decades), frequencies and phases.
#pragma once

#include <cstddef>

#include "diagnose/scan/scanned_effect.h"

namespace glidelab::diagnose {

/// The best wave of all, as a displacement. f_hz is 0 where nothing swings.
struct Wave {
  double gain = 0.0, log_evidence = 0.0, size_m = 0.0, f_hz = 0.0;
};

/// Over the frequencies of range_of(): the slowest of all scans, and the same for every effect that is a wave.
Wave find_wave(const ScoreSpace& space);

/// That wave as an effect's: a camera's sway, or the acceleration of a base that shakes, which moves the glider so.
EffectScan scan_waves(const ScoreSpace& space, std::size_t effect, const Wave& wave);

}  // namespace glidelab::diagnose
