/// The cases used to teach friction: motions of a scenario, the curve a(v) that each of them follows, with its
/// equilibria, and a small film of them.
///
///     a(v) = (m g sin(alpha) + forces(v, sign v)) / m     for v < 0 and v > 0 (the paper's figures 1 to 3)
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/force/force_law.h"

namespace glidelab::teach {

/// A zero of a glider's a(v), and whether the glider returns to it after a small push.
///
/// The equilibrium is stable if a(v) falls through zero, unstable if it rises. v = 0 is an equilibrium if static
/// friction holds the glider, or if a(0) = 0.
struct Equilibrium {
  double v_m_s = 0.0;
  bool stable = true;
  bool stops = false;  ///< v = 0 is reached in finite time: friction stops the glider. Otherwise it is only approached
};

/// Equilibria from `lowest_m_s` to `highest_m_s`, rising; none if a is zero on a whole interval. For each sign of v
/// they are found by bisection to the last bit between neighbours of a logarithmic grid, 256 speeds per decade from
/// 1e-9 m/s on: zeros closer than that, and zeros that a(v) only touches, are missed.
std::vector<Equilibrium> equilibria(const sim::Body& body, double lowest_m_s, double highest_m_s);

struct LawMotion {
  std::string clip;
  std::string configuration;
  std::vector<double> t_s, x_m, v_m_s, a_m_s2;  ///< kFramesPerSecond samples per second
};

struct LawCurve {
  std::string configuration;
  double incline_deg = 0.0;
  std::vector<double> up_v_m_s, up_a_m_s2;      ///< v from the lowest of the motions to 0
  std::vector<double> down_v_m_s, down_a_m_s2;  ///< v from 0 to the highest, or to v_lim if that is more
  std::vector<Equilibrium> equilibria;          ///< on that piece of the curve, v rising
  std::vector<std::size_t> motions;             ///< indices of the motions on this curve
  sim::Body body = {};                          ///< the body to which a(v) belongs
};

struct LawStudy {
  std::string name;
  std::string text;  ///< the comment at the head of the scenario's file
  std::vector<LawCurve> curves;
  std::vector<LawMotion> motions;
  /// If there are just two motions, of equal length and one on each curve: the largest difference of x, and of a at the
  /// same v.
  std::optional<double> x_apart_m, a_apart_m_s2;
};

inline constexpr double kFramesPerSecond = 50.0;

/// InputError for any error in the scenario.
LawStudy study_law(const std::filesystem::path& scenario);

/// A small film of a scenario's motions, one above the other, each from its own start.
///
/// The renderer draws them (render/) as a perfect camera would record them (render/film/truth_files.h), from 3 m in
/// front of the middle of the track and perpendicular to it, so that the track and all motions are in the image.
/// Motions, track, glider and light are those of the scenario; its camera is not used. Frame k shows k / frame_rate_hz
/// after the start; a motion that ends before the longest one keeps its last image.
struct LawFilm {
  std::string mp4;  ///< H.264, playable in browsers: the file's bytes
  int width_px = 0;
  int height_px = 0;
  std::size_t frames = 0;
  double frame_rate_hz = 0.0;
  std::vector<std::string> clips;  ///< names of the rows, from the top; all have the same height
};

struct LawFilmOptions {
  int width_px = 800;  ///< even
  double frame_rate_hz = 25.0;
  int jobs = 1;  ///< threads that draw the static scene
};

/// InputError for any error in the scenario; EnvironmentError if there is no encoder, or no room for a temporary file.
LawFilm film_law(const std::filesystem::path& scenario, const LawFilmOptions& options = {});

}  // namespace glidelab::teach
