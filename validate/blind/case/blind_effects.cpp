#include "validate/blind/case/blind_effects.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "diagnose/effects/effect_list.h"
#include "validate/blind/case/blind_outside.h"

namespace glidelab::validate {
namespace {

/// A change of the seen positions, the same in all clips.
BlindEffect view_effect(double largest, std::function<double(double size, double x)> see,
                        std::function<std::map<std::string, double>(double)> truth) {
  BlindEffect effect;
  effect.largest = largest;
  effect.put = [see](double size, std::size_t, BlindFilm& film) {
    film.seen.push_back([=](double x, double) { return see(size, x); });
  };
  effect.truth = std::move(truth);
  return effect;
}

BlindEffect shaking_camera(const BlindDesign& design, BlindRandom& random) {
  const double hz = wave_hz(design, random);
  const std::vector<double> phase = phases(design, random);
  BlindEffect effect;
  effect.largest = 0.01;
  effect.put = [=](double size, std::size_t clip, BlindFilm& film) {
    const double at = phase[clip];
    film.seen.push_back([=](double x, double t) { return x + size * std::sin(kTurn * hz * t + at); });
  };
  effect.truth = [=](double size) { return std::map<std::string, double>{{"amplitude_m", size}, {"f_hz", hz}}; };
  return effect;
}

BlindEffect clock_rate(const BlindDesign&, BlindRandom& random) {
  const double sign = either_sign(random);
  BlindEffect effect;
  effect.largest = 0.2;
  effect.put = [=](double size, std::size_t, BlindFilm& film) {
    for (double& t : film.true_t_s) t += sign * size * t;
  };
  effect.truth = [=](double size) { return std::map<std::string, double>{{"e", sign * size}}; };
  return effect;
}

/// A number in [0, 1) for each frame of each clip.
std::vector<std::vector<double>> lots(const BlindDesign& design, BlindRandom& random) {
  std::vector<std::vector<double>> drawn;
  for (const BlindClip& clip : design.clips) {
    drawn.emplace_back();
    for (std::size_t k = 0; k < clip.frames; ++k) drawn.back().push_back(uniform(random, 0.0, 1.0));
  }
  return drawn;
}

BlindEffect missing_frames(const BlindDesign& design, BlindRandom& random) {
  const auto lot = lots(design, random);
  const double rate = design.clips.front().rate_hz;
  BlindEffect effect;
  effect.largest = 0.03;
  effect.put = [=](double size, std::size_t clip, BlindFilm& film) {
    double late = 0.0;
    for (std::size_t k = 1; k < film.true_t_s.size(); ++k) {
      if (lot[clip][k] < size) late += 1.0 / rate;
      film.true_t_s[k] += late;
    }
  };
  effect.truth = [](double size) { return std::map<std::string, double>{{"fraction", size}}; };
  return effect;
}

BlindEffect jitter(const BlindDesign& design, BlindRandom& random) {
  std::vector<std::vector<double>> deviates;
  for (const BlindClip& clip : design.clips) {
    deviates.emplace_back();
    for (std::size_t k = 0; k < clip.frames; ++k) deviates.back().push_back(std::clamp(normal(random), -3.5, 3.5));
  }
  BlindEffect effect;
  effect.largest = 0.12 / design.clips.front().rate_hz;  // 3.5 of them on either side keep the frames in order
  effect.put = [=](double size, std::size_t clip, BlindFilm& film) {
    for (std::size_t k = 1; k < film.true_t_s.size(); ++k) film.true_t_s[k] += size * deviates[clip][k];
  };
  effect.truth = [](double size) { return std::map<std::string, double>{{"sd_s", size}}; };
  effect.gain = [](double size, double noise, const std::vector<std::vector<double>>& speed) {
    // Normal deviates of variance w_k against one variance for all: (n log mean w - sum log w) / 2.
    double n = 0.0, sum = 0.0, logs = 0.0;
    for (const auto& clip : speed) {
      for (const double v : clip) {
        const double w = 1.0 + std::pow(size * v / noise, 2);
        n += 1.0;
        sum += w;
        logs += std::log(w);
      }
    }
    return 0.5 * (n * std::log(sum / n) - logs);
  };
  return effect;
}

BlindEffect tails(const BlindDesign& design, BlindRandom& random) {
  const auto lot = lots(design, random);
  std::vector<std::vector<double>> deviates;
  for (const BlindClip& clip : design.clips) {
    deviates.emplace_back();
    for (std::size_t k = 0; k < clip.frames; ++k) deviates.back().push_back(normal(random));
  }
  const double wide = log_uniform(random, 4.0, 15.0), noise_sd = design.noise_sd_m;
  BlindEffect effect;
  effect.largest = 0.1;
  effect.put = [=](double size, std::size_t clip, BlindFilm& film) {
    for (std::size_t k = 0; k < film.off_m.size(); ++k) {
      if (lot[clip][k] < size) film.off_m[k] += wide * noise_sd * deviates[clip][k];
    }
  };
  effect.truth = [](double size) { return std::map<std::string, double>{{"fraction", size}}; };
  effect.gain = [=](double size, double, const std::vector<std::vector<double>>&) {
    // Those off by z0 = 3.5 and more (in units of the noise) are seen: log of the two densities' ratio, on average
    // over the wide part, minus the loss of the narrow part.
    double n = 0.0, gain = 0.0, square = 0.0;
    for (std::size_t c = 0; c < lot.size(); ++c) {
      for (std::size_t k = 0; k < lot[c].size(); ++k) {
        const bool out = lot[c][k] < size;
        const double spread = out ? std::sqrt(1.0 + wide * wide) : 1.0, z = spread * deviates[c][k];
        const double w2 = 1.0 + wide * wide;
        n += 1.0;
        square += z * z;
        gain += std::log((1.0 - size) * std::exp(-0.5 * z * z) + size / std::sqrt(w2) * std::exp(-0.5 * z * z / w2));
      }
    }
    return gain + 0.5 * n * (std::log(square / n) + 1.0);
  };
  return effect;
}

BlindEffect lens(const BlindDesign&, BlindRandom& random) {
  const double sign = either_sign(random), axis = uniform(random, -0.2, 0.4);
  return view_effect(
      0.2, [=](double size, double x) { return x + sign * size * x * (x - axis) * (x - axis); },
      [=](double size) {
        return std::map<std::string, double>{{"k_1_m2", sign * size}, {"x_c_m", axis}};
      });
}

}  // namespace

const std::vector<DrawnEffect>& seen_library() {
  static const std::vector<DrawnEffect> list = {
      {diagnose::ids::frame_rate_error, clock_rate},
      {diagnose::ids::dropped_frames, missing_frames},
      {diagnose::ids::timestamp_jitter, jitter},
      {diagnose::ids::scale_error,
       [](const BlindDesign&, BlindRandom& random) {
         const double sign = either_sign(random);
         return view_effect(
             0.15, [=](double size, double x) { return x + sign * size * x; },
             [=](double size) {
               return std::map<std::string, double>{{"e", sign * size}};
             });
       }},
      {diagnose::ids::perspective_error,
       [](const BlindDesign&, BlindRandom& random) {
         const double sign = either_sign(random);
         return view_effect(
             0.2, [=](double size, double x) { return x / (1.0 + sign * size * x); },
             [=](double size) {
               return std::map<std::string, double>{{"p_1_m", sign * size}};
             });
       }},
      {diagnose::ids::lens_distortion, lens},
      {diagnose::ids::camera_motion, shaking_camera},
      {diagnose::ids::heavy_tailed_noise, tails},
  };
  return list;
}

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
