/// The experiments of blind cases: the launches, what is stated about them, what is true, and what one effect alters.
///
/// The motion is the truth to which a diagnosis is compared, made with none of the diagnosis's code:
///
///     inertia dv/dt = drive - drag - sign(v) friction,        at v = 0 it stays while |drive| <= friction
///
/// drive = m g sin(alpha), drag = K v, friction = mu m g cos(alpha), inertia = m, each of which the effect may change
/// as a function of (x, v, t). SI, x downhill.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace glidelab::validate {

inline constexpr double kTurn = 2.0 * std::numbers::pi;  ///< a full turn

inline constexpr double kBlindGravity_m_s2 = 9.80665;  ///< standard gravity, the default of experiments

/// The engine of all random draws of blind cases.
using BlindRandom = std::mt19937_64;

/// Uniform in [low, high), uniform in the logarithm, and a standard normal deviate.
double uniform(BlindRandom& random, double low, double high);
double log_uniform(BlindRandom& random, double low, double high);
double normal(BlindRandom& random);

/// One of these words, all equally likely; there is at least one.
inline const std::string& one_of(const std::vector<std::string>& words, BlindRandom& random) {
  const auto drawn = static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(words.size())));
  return words[std::min(words.size() - 1, drawn)];
}

/// The same for values.
template <typename T, std::size_t N>
T one_of(BlindRandom& random, const T (&values)[N]) {
  return values[std::min(N - 1, static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(N))))];
}

struct BlindTerms {
  double drive_n = 0.0;
  double drag_n = 0.0;      ///< against the motion if it has v's sign
  double friction_n = 0.0;  ///< never negative
  double inertia_kg = 0.0;
  double mass_kg = 0.0;  ///< true; no change alters it
};

using BlindChange = std::function<void(double x_m, double v_m_s, double t_s, BlindTerms&)>;

struct BlindLaw {
  double mass_kg = 0.0;
  double k_n_s_m = 0.0;
  double mu = 0.0;
  double alpha_rad = 0.0;
  double gravity_m_s2 = kBlindGravity_m_s2;
  std::vector<BlindChange> changes;  ///< in this order
};

struct BlindSample {
  double x_m = 0.0;
  double v_m_s = 0.0;
};

/// The motion from (x0, v0) at the first of the rising times. NaN once it runs away (1 km), or beyond 200,000 steps,
/// which are added to `steps`. Boost.Odeint's Dormand-Prince pair with dense output (tolerance 1e-11 m, steps of at
/// most 2 ms, so that no narrow force is stepped over). v = 0 is found by bisection in the dense output.
std::vector<BlindSample> blind_motion(const BlindLaw& law, double x0_m, double v0_m_s, std::span<const double> times_s,
                                      std::size_t* steps = nullptr);

struct BlindGroup {
  std::string name;
  double stated_rad = 0.0;
  double true_rad = 0.0;
  std::optional<double> stated_sd_rad;
};

struct BlindMass {
  double stated_kg = 0.0;
  double true_kg = 0.0;
  double sd_kg = 0.0;  ///< 0: stated exactly
};

struct BlindClip {
  std::string name;
  std::size_t group = 0, mass = 0;
  double x0_m = 0.0, v0_m_s = 0.0;
  double rate_hz = 0.0;
  std::size_t frames = 0;
};

/// The calibration error of a position x, which is measured as x + a x + b x² + c x³: the standard deviations of a, b,
/// c, and their actual values (0: none, as in tracks).
struct BlindCalibration {
  double scale_sd = 0.0, bend_sd_1_m = 0.0, cubic_sd_1_m2 = 0.0;
  double scale = 0.0, bend_1_m = 0.0, cubic_1_m2 = 0.0;
};

/// An experiment: its launches, what is stated about them, and what is true.
struct BlindDesign {
  std::vector<BlindGroup> groups;
  std::vector<BlindMass> masses;
  std::vector<BlindClip> clips;
  double k_n_s_m = 0.0;
  double mu = 0.0;
  double noise_sd_m = 0.0;
  BlindCalibration calibration;
  double gravity_m_s2 = kBlindGravity_m_s2;
};

/// 2 to 12 clips of 0.8 to 2 s at 60 to 240 Hz, 1 to 3 masses, a level track, an inclined one or both; noise of 5 to
/// 300 µm.
BlindDesign draw_design(BlindRandom& random);

/// The set-ups of an experiment: the level track (kind 0), an inclined one of 2 to 7 degrees in tenths (1), or both
/// (2); inclinations are stated, with their standard deviation between these limits, in 85 of 100.
std::vector<BlindGroup> draw_groups(BlindRandom& random, int kind, double least_sd_deg, double most_sd_deg);

/// How the clips of an experiment are launched.
struct BlindLaunches {
  double origin_m = 0.0;    ///< the middle of the track
  double longest_m = 0.0;   ///< longest run, extending equally to both sides of it; the shortest is 0.6 m
  std::size_t repeats = 1;  ///< of each up-down pair
  double rate_hz = 0.0;
};

/// Clip `number` of a group and a mass, every other one uphill: with 0.4 to 1.5 m/s towards the middle. Its duration is
/// not set.
BlindClip draw_clip(BlindRandom& random, const BlindDesign& design, const BlindLaunches& launches, std::size_t group,
                    std::size_t mass, std::size_t number);

/// The conditions of one clip: effects alter them before the motion is computed.
struct BlindFilm {
  BlindLaw law;
  std::vector<double> true_t_s;                                     ///< of each frame; the stated time is k / rate
  std::vector<std::function<double(double x_m, double t_s)>> seen;  ///< effects of camera and restitution, in this
                                                                    ///< order
  std::vector<double> off_m;                                        ///< added to each position in addition to the noise
};

/// The nominal film: linear drag and dry friction, frames at uniform times, positions seen without error.
BlindFilm nominal_film(const BlindDesign& design, const BlindClip& clip);

/// Positions as the camera sees them, without noise; NaN once the glider has come to rest.
std::vector<double> seen_positions(const BlindClip& clip, const BlindFilm& film, std::size_t* steps = nullptr);

/// One effect of a blind case: what it alters, by a size that can be changed with everything else fixed.
///
/// Each effect is written independently, in intuitive ratios (a fraction of the drag, of the friction, of a frame), as
/// an alteration of forces, frame times or positions. None of the diagnosis' models is used. Everything random in an
/// effect is drawn when it is made.
struct BlindEffect {
  std::string id;
  double largest = 0.0;  ///< largest size, in the effect's own unit; 0 is absence
  /// Alters the film of clip number `clip`.
  std::function<void(double size, std::size_t clip, BlindFilm& film)> put;
  /// The parameters of effects.md at a given size; empty for effects outside the library.
  std::function<std::map<std::string, double>(double size)> truth;
  /// For effects that are random from point to point (jitter, outliers): the expected gain in log likelihood at a given
  /// size, from the noise of a position and the speed at each frame. Not set for effects that displace positions
  /// smoothly.
  std::function<double(double size, double noise_sd_m, const std::vector<std::vector<double>>& speed_m_s)> gain;
  std::string variable;  ///< in which it lies: x_m, v_m_s, t_s, clip, mass_kg; for outside effects
};

/// An id, and the function that draws such an effect.
using DrawnEffect = std::pair<std::string, std::function<BlindEffect(const BlindDesign&, BlindRandom&)>>;

/// +1 or -1, equally likely.
double either_sign(BlindRandom& random);
/// An angle for each clip, in [0, 2 pi).
std::vector<double> phases(const BlindDesign& design, BlindRandom& random);
/// A frequency with at least three periods per clip, at most 0.35 of the frame rate and 40 Hz.
double wave_hz(const BlindDesign& design, BlindRandom& random);

}  // namespace glidelab::validate
