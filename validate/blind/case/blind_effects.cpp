#include "validate/blind/case/blind_effects.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "diagnose/effects/effect_list.h"
#include "validate/blind/case/blind_outside.h"
#include "validate/blind/case/blind_seen_effects.h"

namespace glidelab::validate {
namespace {

double sign_of(double v) {
  return v > 0.0 ? 1.0 : v < 0.0 ? -1.0 : 0.0;
}

/// A change of the forces, the same in all clips.
BlindEffect force_effect(double largest, std::function<BlindChange(double)> change,
                         std::function<std::map<std::string, double>(double)> truth) {
  BlindEffect effect;
  effect.largest = largest;
  effect.put = [change](double size, std::size_t, BlindFilm& film) { film.law.changes.push_back(change(size)); };
  effect.truth = std::move(truth);
  return effect;
}

BlindEffect drag_power(const BlindDesign&, BlindRandom& random) {
  const double sign = either_sign(random);
  return force_effect(
      0.6,
      [=](double size) -> BlindChange {
        return [=](double, double v, double, BlindTerms& f) {
          f.drag_n *= v == 0.0 ? 0.0 : std::exp(sign * size * std::log(std::abs(v)));
        };
      },
      [=](double size) {
        return std::map<std::string, double>{{"n", 1.0 + sign * size}};
      });
}

BlindEffect stribeck(const BlindDesign&, BlindRandom& random) {
  const double v_s = log_uniform(random, 0.03, 0.25);
  return force_effect(
      5.0,
      [=](double size) -> BlindChange {
        return [=](double, double v, double, BlindTerms& f) {
          const double z = v / v_s;
          f.friction_n += size * f.friction_n * std::exp(-z * z);
        };
      },
      [=](double size) {
        return std::map<std::string, double>{{"s", 1.0 + size}, {"v_s_m_s", v_s}};
      });
}

BlindEffect fixed_friction(const BlindDesign& design, BlindRandom&) {
  const double of_one = design.mu * design.masses.front().true_kg * design.gravity_m_s2;
  return force_effect(
      design.masses.size() > 1 ? 3.0 : 0.0,  // with one mass it is mu
      [=](double size) -> BlindChange {
        return [=](double, double, double, BlindTerms& f) { f.friction_n += size * of_one; };
      },
      [=](double size) {
        return std::map<std::string, double>{{"force_n", size * of_one}};
      });
}

BlindEffect asymmetry(const BlindDesign&, BlindRandom& random) {
  const double sign = either_sign(random);
  return force_effect(
      0.6,
      [=](double size) -> BlindChange {
        return [=](double, double v, double, BlindTerms& f) { f.friction_n *= 1.0 + sign * size * sign_of(v); };
      },
      [=](double size) {
        return std::map<std::string, double>{{"d", sign * size}};
      });
}

BlindEffect bow(const BlindDesign& design, BlindRandom& random) {
  const double sign = either_sign(random), g = design.gravity_m_s2, middle = uniform(random, -0.2, 0.4);
  return force_effect(
      0.08,
      [=](double size) -> BlindChange {
        return
            [=](double x, double, double, BlindTerms& f) { f.drive_n += sign * size * (x - middle) * g * f.mass_kg; };
      },
      [=](double size) {
        return std::map<std::string, double>{{"slope_1_m", sign * size}};
      });
}

BlindEffect drag_gradient(const BlindDesign&, BlindRandom& random) {
  const double sign = either_sign(random), middle = uniform(random, -0.1, 0.3);
  return force_effect(
      0.8,
      [=](double size) -> BlindChange {
        return [=](double x, double, double, BlindTerms& f) { f.drag_n *= 1.0 + sign * size * (x - middle); };
      },
      [=](double size) {
        return std::map<std::string, double>{{"b_1_m", sign * size}};
      });
}

BlindEffect tether(const BlindDesign&, BlindRandom& random) {
  const double from = uniform(random, -0.5, 0.6);
  return force_effect(
      20.0,
      [=](double size) -> BlindChange {
        return [=](double x, double, double, BlindTerms& f) { f.drive_n -= size * std::max(0.0, x - from); };
      },
      [=](double size) {
        return std::map<std::string, double>{{"k_n_m", size}, {"x_t_m", from}};
      });
}

BlindEffect vibration(const BlindDesign& design, BlindRandom& random) {
  const double hz = wave_hz(design, random);
  const std::vector<double> phase = phases(design, random);
  BlindEffect effect;
  effect.largest = 8.0;
  effect.put = [=](double size, std::size_t clip, BlindFilm& film) {
    const double m = film.law.mass_kg, at = phase[clip];
    film.law.changes.push_back(
        [=](double, double, double t, BlindTerms& f) { f.drive_n += m * size * std::sin(kTurn * hz * t + at); });
  };
  effect.truth = [=](double size) { return std::map<std::string, double>{{"a_m_s2", size}, {"f_hz", hz}}; };
  return effect;
}

BlindEffect hand(const BlindDesign& design, BlindRandom& random) {
  const double until = uniform(random, 0.07, 0.25);
  std::vector<double> push;
  for (const BlindClip& clip : design.clips) push.push_back(sign_of(clip.v0_m_s) * uniform(random, 0.3, 1.0));
  BlindEffect effect;
  effect.largest = 5.0;
  effect.put = [=](double size, std::size_t clip, BlindFilm& film) {
    const double force = film.law.mass_kg * size * push[clip];
    film.law.changes.push_back([=](double, double, double t, BlindTerms& f) { f.drive_n += t < until ? force : 0.0; });
  };
  effect.truth = [=](double) { return std::map<std::string, double>{{"t_r_s", until}}; };
  return effect;
}

BlindEffect wheels(const BlindDesign& design, BlindRandom&) {
  const double lightest = design.masses.front().true_kg;
  return force_effect(
      0.4,
      [=](double size) -> BlindChange {
        return [=](double, double, double, BlindTerms& f) { f.inertia_kg += size * lightest; };
      },
      [=](double size) {
        return std::map<std::string, double>{{"mass_kg", size * lightest}};
      });
}

const std::vector<DrawnEffect>& force_library() {
  static const std::vector<DrawnEffect> list = {
      {diagnose::ids::quadratic_drag,
       [](const BlindDesign& design, BlindRandom&) {
         const double k = design.k_n_s_m;
         return force_effect(
             2.0,
             [=](double size) -> BlindChange {
               return [=](double, double v, double, BlindTerms& f) { f.drag_n += size * k * v * std::abs(v); };
             },
             [=](double size) {
               return std::map<std::string, double>{{"c_kg_m", size * k}};
             });
       }},
      {diagnose::ids::eddy_rolloff,
       [](const BlindDesign&, BlindRandom&) {
         return force_effect(
             6.0,
             [](double size) -> BlindChange {
               return [=](double, double v, double, BlindTerms& f) { f.drag_n /= 1.0 + size * v * v; };
             },
             [](double size) {
               return std::map<std::string, double>{{"v_c_m_s", 1.0 / std::sqrt(size)}};
             });
       }},
      {diagnose::ids::power_law_drag, drag_power},
      {diagnose::ids::stribeck, stribeck},
      {diagnose::ids::load_independent_friction, fixed_friction},
      {diagnose::ids::direction_asymmetry, asymmetry},
      {diagnose::ids::track_bow, bow},
      {diagnose::ids::damping_gradient, drag_gradient},
      {diagnose::ids::rotational_inertia, wheels},
      {diagnose::ids::tether, tether},
      {diagnose::ids::base_vibration, vibration},
      {diagnose::ids::late_release, hand},
  };
  return list;
}

std::vector<std::string> ids_of(const std::vector<const std::vector<DrawnEffect>*>& lists) {
  std::vector<std::string> ids;
  for (const auto* list : lists) {
    for (const auto& [id, draw] : *list) ids.push_back(id);
  }
  return ids;
}

}  // namespace

const std::vector<std::string>& library_effects() {
  static const std::vector<std::string> ids = ids_of({&force_library(), &seen_library()});
  return ids;
}

const std::vector<std::string>& outside_effects() {
  static const std::vector<std::string> ids = ids_of({&outside_library()});
  return ids;
}

BlindEffect draw_effect(const std::string& id, const BlindDesign& design, BlindRandom& random) {
  for (const auto* list : {&force_library(), &seen_library(), &outside_library()}) {
    for (const auto& [known, draw] : *list) {
      if (known != id) continue;
      BlindEffect effect = draw(design, random);
      effect.id = id;
      return effect;
    }
  }
  throw std::out_of_range("no such effect: " + id);
}

}  // namespace glidelab::validate
