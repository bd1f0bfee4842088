/// A track experiment from the closed form of equation (8): thrown uphill, turns, comes back. No image is needed.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>

#include "base/files/file_io.h"
#include "base/text/csv.h"

namespace glidelab::tests {

struct TrackTruth {
  double k_over_m_1_s = 2.768;
  double alpha_rad = 4.311 * 3.14159265358979323846 / 180.0;
  double mu = 0.0071;
  double g_m_s2 = 9.80665;
};

/// Position of a glider that starts at 0.2 m with -1.2 m/s; v' = a0 - (K/m) v with a0 = g (sin alpha ± mu cos alpha).
inline double position(const TrackTruth& truth, double t_s) {
  const double k = truth.k_over_m_1_s;
  const double up = truth.g_m_s2 * (std::sin(truth.alpha_rad) + truth.mu * std::cos(truth.alpha_rad));
  const double down = truth.g_m_s2 * (std::sin(truth.alpha_rad) - truth.mu * std::cos(truth.alpha_rad));
  const double v0 = -1.2;
  const double turn_s = std::log(1.0 - v0 * k / up) / k;
  const auto x = [&](double x0, double v, double a0, double t) {
    return x0 + a0 / k * t + (v - a0 / k) / k * (1.0 - std::exp(-k * t));
  };
  if (t_s <= turn_s) return x(0.2, v0, up, t_s);
  return x(x(0.2, v0, up, turn_s), 0.0, down, t_s - turn_s);
}

/// Writes `folder` with one clip "up", 340 frames at 200 Hz, with a ripple of 10 µm as noise.
inline void write_track_experiment(const std::filesystem::path& folder, const std::string& clip_name = "up") {
  std::filesystem::create_directories(folder / "tracks");
  base::write_file(folder / "experiment.toml",
                   "format = 1\nname = \"made track\"\n[track]\ndownhill = \"+X\"\n[[clip]]\nname = \"" + clip_name +
                       "\"\ntrack = \"tracks/up.csv\"\nmass_kg = 0.335\nincline_deg = 4.0\nincline_sd_deg = 0.3\n"
                       "launched = \"up\"\n");
  base::CsvWriter table("t_s,x_m");
  for (int k = 0; k < 340; ++k) {
    table.number(k / 200.0).number(position({}, k / 200.0) + 1e-5 * std::sin(12.9898 * k * k)).end_row();
  }
  base::write_file(folder / "tracks/up.csv", table.str());
}

}  // namespace glidelab::tests
