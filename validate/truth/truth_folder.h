/// The truth that a scenario put into an experiment, as the renderer writes it beside the experiment folder.
///
///     NAME.truth/truth.json             {"format": 1, "name", "seed", "configurations": […], "clips": […],
///                                        "camera": {…}}
///     NAME.truth/trajectory-<clip>.csv  t_s,x_m,v_m_s,a_m_s2,mode; row k is frame k, middle of its exposure
///
/// Only this room reads it. Angles stay in degrees, because they are compared with values shown to the user.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glidelab::validate {

/// One mass on one inclination. A quantity that the scenario does not have (v_lim on a level track, mu without Coulomb
/// friction, K/m for a law that is not linear) is empty.
struct TrueConfiguration {
  std::string name;
  double mass_kg = 0.0;
  double stated_incline_deg = 0.0;
  std::string group;
  std::optional<double> k_over_m_1_s;
  std::optional<double> mu;
  std::optional<double> alpha_deg;
  std::optional<double> v_lim_m_s;
  std::vector<std::string> clips;
};

struct TrueClip {
  std::string name;
  std::string configuration;
  double x_origin_m = 0.0;  ///< origin of the analysis' x on the track's axis: x_analysis = x_track - x_origin
  std::vector<double> t_s;  ///< one for each frame
  std::vector<double> x_m;  ///< on the track's axis
  std::vector<double> v_m_s;
  std::vector<double> a_m_s2;
};

struct Truth {
  std::string name;
  std::uint64_t seed = 0;
  std::vector<TrueConfiguration> configurations;
  std::vector<TrueClip> clips;
};

/// Reads `truth_dir`/truth.json and the trajectories that it names. Keys not listed above are ignored. InputError with
/// file and key for everything that is missing, of the wrong type, not finite, or inconsistent.
Truth read_truth(const std::filesystem::path& truth_dir);

}  // namespace glidelab::validate
