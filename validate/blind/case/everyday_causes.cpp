#include "validate/blind/case/everyday_causes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "diagnose/effects/effect_list.h"
#include "validate/blind/case/blind_effects.h"

namespace glidelab::validate {
namespace {

using Parameters = std::map<std::string, double>;

constexpr double kLeastFactor = 0.15;  // of a separate friction or drag: it must remain one

double direction_of_motion(double v) {
  return v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0;
}

/// Deviates of mean 0 and sd 1.
std::vector<double> deviates_of(std::size_t many, BlindRandom& random) {
  std::vector<double> z;
  for (std::size_t i = 0; i < many; ++i) z.push_back(std::clamp(normal(random), -2.0, 2.0));
  double mean = 0.0, square = 0.0;
  for (const double one : z) mean += one / static_cast<double>(many);
  for (double& one : z) {
    one -= mean;
    square += one * one / static_cast<double>(many);
  }
  for (double& one : z) one /= std::sqrt(std::max(square, 1e-12));
  return z;
}

double largest_for(const std::vector<double>& z, double most) {
  const double least = *std::min_element(z.begin(), z.end());
  return least < 0.0 ? std::min(most, (1.0 - kLeastFactor) / -least) : most;
}

std::size_t configurations(const BlindDesign& design) {
  return design.groups.size() * design.masses.size();
}

BlindEffect drag_of_direction(const BlindDesign&, BlindRandom& random) {
  const double sign = either_sign(random);
  BlindEffect effect;
  effect.largest = 0.7;
  effect.put = [=](double size, std::size_t, BlindFilm& film) {
    film.law.changes.push_back(
        [=](double, double v, double, BlindTerms& f) { f.drag_n *= 1.0 + sign * size * direction_of_motion(v); });
  };
  effect.truth = [=](double size) { return Parameters{{"d", sign * size}}; };
  return effect;
}

/// Mean over all frames of the nominal motions.
double mean_over_design(const BlindDesign& design, const std::function<double(double)>& of_x) {
  double sum = 0.0, many = 0.0;
  for (const BlindClip& clip : design.clips) {
    const BlindFilm film = nominal_film(design, clip);
    for (const BlindSample& s : blind_motion(film.law, clip.x0_m, clip.v0_m_s, film.true_t_s)) {
      sum += of_x(s.x_m);
      many += 1.0;
    }
  }
  return sum / many;
}

BlindEffect friction_of_place(const BlindDesign& design, BlindRandom& random) {
  const auto waves = random_waves(0.3, 1.6, random);
  const double mean = mean_over_design(design, waves);
  BlindEffect effect;
  effect.largest = 0.6;
  effect.put = [=](double size, std::size_t, BlindFilm& film) {
    film.law.changes.push_back(
        [=](double x, double, double, BlindTerms& f) { f.friction_n *= 1.0 + size * (waves(x) - mean); });
  };
  effect.truth = [](double size) { return Parameters{{"sd", size}}; };
  return effect;
}

BlindEffect drifting_friction(const BlindDesign& design, BlindRandom& random) {
  const double sign = either_sign(random), clips = static_cast<double>(design.clips.size());
  BlindEffect effect;
  effect.largest = (sign > 0.0 ? 2.0 : 1.0 - kLeastFactor) / (clips - 1.0);
  effect.put = [=](double size, std::size_t clip, BlindFilm& film) {
    const double factor = 1.0 + sign * size * static_cast<double>(clip);
    film.law.changes.push_back([=](double, double, double, BlindTerms& f) { f.friction_n *= factor; });
  };
  effect.truth = [=](double size) { return Parameters{{"r_1_clip", sign * size}}; };
  return effect;
}

BlindEffect of_configuration(const BlindDesign& design, BlindRandom& random, double BlindTerms::*force, const char* key,
                             double unit) {
  const std::vector<double> z = deviates_of(configurations(design), random);
  std::vector<std::size_t> of;
  for (const BlindClip& clip : design.clips) of.push_back(configuration_of(design, clip));
  BlindEffect effect;
  effect.largest = z.size() > 1 ? largest_for(z, 0.8) : 0.0;
  effect.put = [=](double size, std::size_t clip, BlindFilm& film) {
    const double factor = 1.0 + size * z[of[clip]];
    film.law.changes.push_back([=](double, double, double, BlindTerms& f) { f.*force *= factor; });
  };
  effect.truth = [=](double size) { return Parameters{{key, size * unit}}; };
  return effect;
}

BlindEffect friction_of_configuration(const BlindDesign& design, BlindRandom& random) {
  return of_configuration(design, random, &BlindTerms::friction_n, "sd", 1.0);
}

BlindEffect drag_of_configuration(const BlindDesign& design, BlindRandom& random) {
  return of_configuration(design, random, &BlindTerms::drag_n, "sd_n_s_m", design.k_n_s_m);
}

BlindEffect scatter_of_clips(const BlindDesign& design, BlindRandom& random) {
  std::vector<double> z, y;
  for (std::size_t c = 0; c < design.clips.size(); ++c) {
    z.push_back(std::clamp(normal(random), -2.0, 2.0));
    y.push_back(std::clamp(normal(random), -2.0, 2.0));
  }
  const double of_drag = uniform(random, 0.0, 1.0) < 0.5 ? 0.0 : uniform(random, 0.2, 1.0);
  const double mu = design.mu, k = design.k_n_s_m;
  BlindEffect effect;
  effect.largest = (1.0 - kLeastFactor) / 2.0;
  effect.put = [=](double size, std::size_t clip, BlindFilm& film) {
    const double friction = 1.0 + size * z[clip], drag = 1.0 + of_drag * size * y[clip];
    film.law.changes.push_back([=](double, double, double, BlindTerms& f) {
      f.friction_n *= friction;
      f.drag_n *= drag;
    });
  };
  effect.truth = [=](double size) { return Parameters{{"sd_mu", size * mu}, {"sd_k_n_s_m", of_drag * size * k}}; };
  return effect;
}

/// Placed in the outer part of the range of the nominal motions, so that some clips reach it and come back.
BlindEffect bumper(const BlindDesign& design, BlindRandom& random) {
  const double end = either_sign(random), share = uniform(random, 0.72, 0.93);
  std::vector<double> x;
  for (const BlindClip& clip : design.clips) {
    const BlindFilm film = nominal_film(design, clip);
    for (const BlindSample& s : blind_motion(film.law, clip.x0_m, clip.v0_m_s, film.true_t_s)) x.push_back(end * s.x_m);
  }
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const double from = end * (*low + share * (*high - *low));
  BlindEffect effect;
  effect.largest = 60.0;
  effect.put = [=](double size, std::size_t, BlindFilm& film) {
    film.law.changes.push_back(
        [=](double at, double, double, BlindTerms& f) { f.drive_n -= size * end * std::max(0.0, end * (at - from)); });
  };
  effect.truth = [=](double size) { return Parameters{{"k_n_m", size}, {"x_b_m", from}, {"end", end}}; };
  return effect;
}

const std::vector<DrawnEffect>& rig_library() {
  static const std::vector<DrawnEffect> list = {
      {diagnose::ids::direction_dependent_drag, drag_of_direction},
      {diagnose::ids::place_friction, friction_of_place},
      {diagnose::ids::friction_drift, drifting_friction},
      {diagnose::ids::configuration_friction, friction_of_configuration},
      {diagnose::ids::configuration_drag, drag_of_configuration},
      {diagnose::ids::clip_scatter, scatter_of_clips},
      {diagnose::ids::end_stop, bumper},
  };
  return list;
}

std::vector<std::string> less(const std::vector<std::string>& ids, const std::set<std::string>& without) {
  std::vector<std::string> left;
  for (const std::string& id : ids) {
    if (!without.contains(id)) left.push_back(id);
  }
  return left;
}

}  // namespace

const std::vector<std::string>& everyday_effects() {
  static const std::vector<std::string> ids = [] {
    std::vector<std::string> all =
        less(library_effects(), {diagnose::ids::timestamp_jitter, diagnose::ids::heavy_tailed_noise});
    for (const auto& [id, draw] : rig_library()) {
      if (std::find(all.begin(), all.end(), id) == all.end()) all.push_back(id);
    }
    return all;
  }();
  return ids;
}

const std::vector<std::string>& everyday_outside() {
  static const std::vector<std::string> ids =
      less(outside_effects(), {"rough_patch", "sticky_seam", "drag_of_each_run", "drag_by_load", "lagging_tracker"});
  return ids;
}

BlindEffect draw_everyday_effect(const std::string& id, const BlindDesign& design, BlindRandom& random) {
  for (const auto& [known, draw] : rig_library()) {
    if (known != id) continue;
    BlindEffect effect = draw(design, random);
    effect.id = id;
    return effect;
  }
  return draw_effect(id, design, random);
}

std::size_t configuration_of(const BlindDesign& design, const BlindClip& clip) {
  return clip.group * design.masses.size() + clip.mass;
}

std::vector<std::string> equals_of(const std::string& id, const BlindDesign& design, bool down) {
  std::vector<std::string> equal;
  const auto add = [&](const char* one, const char* other) {
    if (id == one) equal.emplace_back(other);
    if (id == other) equal.emplace_back(one);
  };
  add(diagnose::ids::scale_error, diagnose::ids::frame_rate_error);
  add(diagnose::ids::camera_motion, diagnose::ids::base_vibration);
  if (id == diagnose::ids::tether || down) add(diagnose::ids::tether, diagnose::ids::end_stop);
  // Two frictions of two configurations on the same slope: mu_j m_j g cos(alpha) is mu m_j g cos(alpha) + F_0.
  if (design.groups.size() == 1 && design.masses.size() == 2)
    add(diagnose::ids::load_independent_friction, diagnose::ids::configuration_friction);
  return equal;
}

std::function<double(double)> random_waves(double shortest_m, double longest_m, BlindRandom& random) {
  constexpr std::size_t kWaves = 4;
  std::array<double, kWaves> number{}, phase{}, height{};
  double square = 0.0;
  for (std::size_t w = 0; w < kWaves; ++w) {
    number[w] = kTurn / log_uniform(random, shortest_m, longest_m);
    phase[w] = uniform(random, 0.0, kTurn);
    height[w] = uniform(random, 0.4, 1.0);
    square += 0.5 * height[w] * height[w];
  }
  return [=](double x) {
    double sum = 0.0;
    for (std::size_t w = 0; w < kWaves; ++w) sum += height[w] * std::sin(number[w] * x + phase[w]);
    return sum / std::sqrt(square);
  };
}

}  // namespace glidelab::validate
