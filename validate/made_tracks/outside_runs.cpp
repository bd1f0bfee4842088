#include "validate/made_tracks/outside_runs.h"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <vector>

#include "base/files/file_io.h"
#include "base/math/angles.h"
#include "core/motion/lines/line_fit.h"

namespace glidelab::validate {
namespace {

namespace fs = std::filesystem;

std::string csv_row(double t_s, double x_m) {
  return fmt::format("{},{}\n", t_s, x_m);
}

constexpr std::string_view kHeader = "t_s,x_m\n";

/// States in experiment.toml what Glidelab's own estimators assume of every clock: without it, an outside estimator
/// whose fit is exact states intervals that are too narrow. [extra] is ignored by all that read the folder.
void state_clock(const fs::path& folder) {
  constexpr double kPpm = 1e6;
  const fs::path file = folder / "experiment.toml";
  base::write_file(file,
                   fmt::format("{}\n[extra]\nclock_sd_ppm = {:.1f}  # standard deviation of the rate of the clock\n",
                               base::read_file(file), kPpm * core::kClockSdRelative));
}

}  // namespace

void write_track_folder(const MadeTracks& made, const fs::path& folder) {
  fs::create_directories(folder / "tracks");
  // The scenario's name is left out: it may reveal what is to be found.
  std::string toml = fmt::format(
      "format = 1\nname = \"tracks\"\ngravity_m_s2 = {}\ngravity_sd_m_s2 = 0.0\n\n[track]\ndownhill = \"+X\"\n",
      made.gravity_m_s2);
  for (std::size_t c = 0; c < made.setups.size(); ++c) {
    const core::ClipSetup& setup = made.setups[c];
    toml += fmt::format(
        "\n[[clip]]\nname = \"{0}\"\ntrack = \"tracks/{0}.csv\"\nmass_kg = {1}\nincline_deg = {2}\nlaunched = "
        "\"{3}\"\ngroup = \"{4}\"\n",
        setup.name, setup.mass_kg, setup.incline_rad * base::kDegreesPerRad, core::name_of(setup.launched),
        setup.group);
    if (setup.incline_sd_rad)
      toml += fmt::format("incline_sd_deg = {}\n", *setup.incline_sd_rad * base::kDegreesPerRad);
    if (setup.mass_sd_kg > 0.0) toml += fmt::format("mass_sd_kg = {}\n", setup.mass_sd_kg);
    std::string csv(kHeader);
    const core::TrackData& track = made.tracks[c];
    for (std::size_t i = 0; i < track.t_s.size(); ++i) csv += csv_row(track.t_s[i], track.x_m[i]);
    base::write_file(folder / "tracks" / (setup.name + ".csv"), csv);
  }
  base::write_file(folder / "experiment.toml", toml);
}

void write_measured_tracks(const core::AnalysisResults& measured, const fs::path& folder) {
  fs::create_directories(folder / "tracks");
  for (const core::ClipResult& clip : measured.clips) {
    std::string csv(kHeader);
    for (const core::MotionPoint& point : clip.motion) {
      if (point.measured_m) csv += csv_row(point.t_s, *point.measured_m);
    }
    base::write_file(folder / "tracks" / (clip.name + ".csv"), csv);
  }
}

fit::OutsideOutcome run_outside_on_tracks(const fit::OutsideEstimator& estimator, const MadeTracks& made) {
  const base::TemporaryFolder alone("experiment");
  write_track_folder(made, alone / "experiment");
  state_clock(alone / "experiment");
  return fit::run_outside(estimator, alone / "experiment");
}

fit::OutsideOutcome run_outside_on_film(const fit::OutsideEstimator& estimator, const fs::path& folder,
                                        const core::AnalysisResults& measured) {
  const base::TemporaryFolder alone("experiment");
  const fs::path copy = alone / "experiment";
  fs::copy(folder, copy, fs::copy_options::recursive);
  write_measured_tracks(measured, copy);
  state_clock(copy);
  return fit::run_outside(estimator, copy);
}

}  // namespace glidelab::validate
