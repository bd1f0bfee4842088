#include "validate/blind/case/blind_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace glidelab::validate {
namespace {

constexpr double kRad = std::numbers::pi / 180.0;
constexpr std::size_t kMostFrames = 260;  // of a clip

}  // namespace

BlindDesign draw_design(BlindRandom& random) {
  BlindDesign design;
  design.k_n_s_m = log_uniform(random, 0.15, 1.6);
  design.mu = log_uniform(random, 0.0015, 0.02);
  design.noise_sd_m = log_uniform(random, 5e-6, 3e-4);

  const int kind = one_of(random, {0, 1, 1, 2, 2, 2});  // level, inclined, both
  const bool stated = uniform(random, 0.0, 1.0) < 0.85;
  const double sd = log_uniform(random, 0.01, 0.3) * kRad;
  const auto add_group = [&](const char* name, double degrees) {
    BlindGroup group{name, degrees * kRad, degrees * kRad + sd * normal(random), {}};
    if (stated) group.stated_sd_rad = sd;
    design.groups.push_back(group);
  };
  if (kind != 1) add_group("level", 0.0);
  if (kind != 0) add_group("inclined", std::round(10.0 * uniform(random, 2.0, 7.0)) / 10.0);

  const int masses = one_of(random, {1, 2, 2, 3});
  const double mass_sd = uniform(random, 0.0, 1.0) < 0.3 ? 5e-4 : 0.0;
  double mass = uniform(random, 0.2, 0.4);
  for (int m = 0; m < masses; ++m) {
    const double grams = std::round(1e3 * mass) * 1e-3;
    design.masses.push_back({grams, grams + mass_sd * normal(random), mass_sd});
    mass += uniform(random, 0.08, 0.2);
  }

  const double rate = one_of(random, {60.0, 100.0, 120.0, 200.0, 240.0});
  const double duration = uniform(random, 0.8, 2.0), origin = uniform(random, -0.3, 0.5);
  const int repeats = design.groups.size() * design.masses.size() <= 2 && uniform(random, 0.0, 1.0) < 0.5 ? 2 : 1;
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    for (std::size_t m = 0; m < design.masses.size(); ++m) {
      for (int r = 0; r < 2 * repeats; ++r) {
        BlindClip clip{"", g, m, 0.0, 0.0, rate, 0};
        const bool up = r % 2 == 0;
        clip.name = fmt::format("{}-m{}-{}{}", design.groups[g].name, m + 1, up ? "up" : "down",
                                repeats > 1 ? std::to_string(r / 2 + 1) : std::string());
        clip.v0_m_s = (up ? -1.0 : 1.0) * uniform(random, 0.4, 1.5);
        clip.x0_m = origin + (up ? 0.5 : -0.5) * uniform(random, 0.6, 1.2);
        clip.frames = std::min(kMostFrames, static_cast<std::size_t>(duration * rate));
        design.clips.push_back(clip);
      }
    }
  }
  return design;
}

BlindFilm nominal_film(const BlindDesign& design, const BlindClip& clip) {
  BlindFilm film;
  film.law = {design.masses[clip.mass].true_kg,   design.k_n_s_m,      design.mu,
              design.groups[clip.group].true_rad, design.gravity_m_s2, {}};
  for (std::size_t k = 0; k < clip.frames; ++k) film.true_t_s.push_back(static_cast<double>(k) / clip.rate_hz);
  film.off_m.assign(clip.frames, 0.0);
  if (const BlindCalibration& of = design.calibration; of.scale != 0.0 || of.bend_1_m != 0.0 || of.cubic_1_m2 != 0.0) {
    film.seen.push_back(
        [of](double x, double) { return x * (1.0 + of.scale + x * (of.bend_1_m + x * of.cubic_1_m2)); });
  }
  return film;
}

std::vector<double> seen_positions(const BlindClip& clip, const BlindFilm& film) {
  const std::vector<BlindSample> motion = blind_motion(film.law, clip.x0_m, clip.v0_m_s, film.true_t_s);
  std::vector<double> seen;
  for (std::size_t k = 0; k < motion.size(); ++k) {
    double x = motion[k].x_m;
    for (const auto& see : film.seen) x = see(x, film.true_t_s[k]);
    seen.push_back(motion[k].v_m_s == 0.0 && k > 0 ? std::numeric_limits<double>::quiet_NaN() : x + film.off_m[k]);
  }
  return seen;
}

}  // namespace glidelab::validate
