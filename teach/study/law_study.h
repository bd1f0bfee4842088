/// The cases by which friction is taught: motions of a scenario, the curve a(v) on which each of them runs, with its
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

/// Where a glider's a(v) passes through zero, and whether it comes back from there when it is pushed.
///
/// Where a(v) falls through zero the equilibrium is stable, where it rises unstable. v = 0 is one where static friction
/// holds the glider, or where a(0) = 0.
struct Equilibrium {
  double v_m_s = 0.0;
  bool stable = true;
  bool stops = false;  ///< v = 0 is reached in a finite time: friction stops the glider. Else it is only tended to
};

/// Those from `lowest_m_s` to `highest_m_s`, rising; none where a is nothing on a whole interval. Of each sign of v
/// they are found by bisection to the last bit between neighbours of a logarithmic grid, 256 speeds a decade from 1e-9
/// m/s on: zeros closer than that, and those that a(v) only touches, are missed.
std::vector<Equilibrium> equilibria(const sim::Body& body, double lowest_m_s, double highest_m_s);

struct LawMotion {
  std::string clip;
  std::string configuration;
  std::vector<double> t_s, x_m, v_m_s, a_m_s2;  ///< kFramesPerSecond a second
};

struct LawCurve {
  std::string configuration;
  double incline_deg = 0.0;
  std::vector<double> up_v_m_s, up_a_m_s2;      ///< v from the lowest of the motions to 0
  std::vector<double> down_v_m_s, down_a_m_s2;  ///< v from 0 to the highest, or to v_lim if that is more
  std::vector<Equilibrium> equilibria;          ///< on that piece of the curve, v rising
  std::vector<std::size_t> motions;             ///< on this curve
  sim::Body body = {};                          ///< whose a(v) it is
};

struct LawStudy {
  std::string name;
  std::string text;  ///< the comment at the head of the scenario's file
  std::vector<LawCurve> curves;
  std::vector<LawMotion> motions;
  /// Where there are just two motions, of one length and one on each curve: the largest difference of x, and of a at
  /// the same v.
  std::optional<double> x_apart_m, a_apart_m_s2;
};

inline constexpr double kFramesPerSecond = 50.0;

/// InputError for what is wrong with the scenario.
LawStudy study_law(const std::filesystem::path& scenario);

/// A small film of a scenario's motions, one above the other, each from its own start.
///
/// The renderer draws them (render/) as a perfect camera would take them (render/film/truth_files.h), from 3 m before
/// the middle of the track and square to it, so that the track and all of the motions are in the image. Motions, track,
/// glider and light are the scenario's; its camera is not. Frame k shows k / frame_rate_hz after the start; a motion
/// that ends before the longest one keeps its last image.
struct LawFilm {
  std::string mp4;  ///< H.264, as browsers play it: the file's bytes
  int width_px = 0;
  int height_px = 0;
  std::size_t frames = 0;
  double frame_rate_hz = 0.0;
  std::vector<std::string> clips;  ///< of the rows, from above; all are of one height
};

struct LawFilmOptions {
  int width_px = 800;  ///< even
  double frame_rate_hz = 25.0;
  int jobs = 1;  ///< threads that draw what stands still
};

/// InputError for what is wrong with the scenario; EnvironmentError where there is no encoder, or no place for a
/// temporary file.
LawFilm film_law(const std::filesystem::path& scenario, const LawFilmOptions& options = {});

}  // namespace glidelab::teach
