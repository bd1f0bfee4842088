#include "validate/blind/case/blind_outside.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace glidelab::validate {
namespace {

double bell(double z) {
  return std::exp(-0.5 * z * z);
}

BlindEffect force_effect(const char* variable, double largest, std::function<BlindChange(double)> change) {
  BlindEffect effect;
  effect.largest = largest;
  effect.variable = variable;
  effect.put = [change](double size, std::size_t, BlindFilm& film) { film.law.changes.push_back(change(size)); };
  return effect;
}

BlindEffect view_effect(const char* variable, double largest, std::function<double(double, double, double)> see) {
  BlindEffect effect;
  effect.largest = largest;
  effect.variable = variable;
  effect.put = [see](double size, std::size_t, BlindFilm& film) {
    film.seen.push_back([=](double x, double t) { return see(size, x, t); });
  };
  return effect;
}

/// More friction over a stretch of the track (dust, a damaged rail).
BlindEffect rough_patch(const BlindDesign&, BlindRandom& random) {
  const double at = uniform(random, -0.2, 0.4), width = log_uniform(random, 0.03, 0.12);
  return force_effect("x_m", 20.0, [=](double size) -> BlindChange {
    return [=](double x, double, double, BlindTerms& f) { f.friction_n *= 1.0 + size * bell((x - at) / width); };
  });
}

/// A row of magnets below the track: a force that oscillates along x.
BlindEffect cogging(const BlindDesign&, BlindRandom& random) {
  const double period = log_uniform(random, 0.04, 0.25), phase = uniform(random, 0.0, kTurn);
  return force_effect("x_m", 3.0, [=](double size) -> BlindChange {
    return [=](double x, double, double, BlindTerms& f) {
      f.drive_n += size * f.mass_kg * std::sin(kTurn * x / period + phase);
    };
  });
}

/// Two rails whose joint is not straight: the slope steps.
BlindEffect rail_joint(const BlindDesign& design, BlindRandom& random) {
  const double at = uniform(random, -0.15, 0.35), sign = either_sign(random);
  const double g = design.gravity_m_s2;
  return force_effect("x_m", 0.05, [=](double size) -> BlindChange {
    return [=](double x, double, double, BlindTerms& f) {
      f.drive_n += sign * size * g * f.mass_kg * (0.5 + 0.5 * std::tanh((x - at) / 0.01));
    };
  });
}

/// A seam with tape on it: a short, strong pull wherever the glider crosses it.
BlindEffect sticky_seam(const BlindDesign&, BlindRandom& random) {
  const double at = uniform(random, -0.15, 0.35);
  return force_effect("x_m", 2.0, [=](double size) -> BlindChange {
    return [=](double x, double, double, BlindTerms& f) { f.friction_n += size * bell((x - at) / 0.006); };
  });
}

/// A resonance at one speed, such as an unbalanced wheel in its bearing.
BlindEffect drag_hump(const BlindDesign&, BlindRandom& random) {
  const double speed = uniform(random, 0.25, 0.9), width = uniform(random, 0.05, 0.15);
  return force_effect("v_m_s", 2.0, [=](double size) -> BlindChange {
    return
        [=](double, double v, double, BlindTerms& f) { f.drag_n *= 1.0 + size * bell((std::abs(v) - speed) / width); };
  });
}

/// A bearing that warms up during each run: the friction falls with the time since the launch.
BlindEffect warming_up(const BlindDesign&, BlindRandom& random) {
  const double time = log_uniform(random, 0.15, 0.6);
  return force_effect("t_s", 6.0, [=](double size) -> BlindChange {
    return [=](double, double, double t, BlindTerms& f) { f.friction_n *= 1.0 + size * std::exp(-t / time); };
  });
}

/// A load that swings on the glider and decays: a damped wave after each launch, in phase with it.
BlindEffect swinging_load(const BlindDesign&, BlindRandom& random) {
  const double hz = uniform(random, 2.0, 5.0), time = uniform(random, 0.2, 0.5), phase = uniform(random, 0.0, kTurn);
  return force_effect("t_s", 3.0, [=](double size) -> BlindChange {
    return [=](double, double, double t, BlindTerms& f) {
      f.drive_n += size * f.mass_kg * std::exp(-t / time) * std::sin(kTurn * hz * t + phase);
    };
  });
}

/// Gusts: a random acceleration with a correlation time of a tenth or two of a second, different in each clip.
BlindEffect gusts(const BlindDesign& design, BlindRandom& random) {
  constexpr double kStep = 0.01;
  const double memory = uniform(random, 0.06, 0.2), keep = std::exp(-kStep / memory);
  std::vector<std::vector<double>> wind;
  for (const BlindClip& clip : design.clips) {
    const auto steps = static_cast<std::size_t>(1.5 * static_cast<double>(clip.frames) / clip.rate_hz / kStep) + 3;
    std::vector<double> at = {normal(random)};
    while (at.size() < steps) at.push_back(keep * at.back() + std::sqrt(1.0 - keep * keep) * normal(random));
    wind.push_back(std::move(at));
  }
  BlindEffect effect;
  effect.largest = 3.0;
  effect.variable = "t_s";
  effect.put = [=](double size, std::size_t clip, BlindFilm& film) {
    const std::vector<double>& at = wind[clip];
    film.law.changes.push_back([=](double, double, double t, BlindTerms& f) {
      const double place = std::clamp(t / kStep, 0.0, static_cast<double>(at.size()) - 1.001);
      const auto i = static_cast<std::size_t>(place);
      const double part = place - static_cast<double>(i);
      f.drive_n += size * f.mass_kg * ((1.0 - part) * at[i] + part * at[i + 1]);
    });
  };
  return effect;
}

/// The magnets' gap changes from run to run: each clip has its own drag.
BlindEffect drag_of_each_run(const BlindDesign& design, BlindRandom& random) {
  std::vector<double> factor;
  for (std::size_t c = 0; c < design.clips.size(); ++c) factor.push_back(normal(random));
  BlindEffect effect;
  effect.largest = 0.25;
  effect.variable = "clip";
  effect.put = [=](double size, std::size_t clip, BlindFilm& film) {
    const double times = 1.0 + size * std::clamp(factor[clip], -2.5, 2.5);
    film.law.changes.push_back([=](double, double, double, BlindTerms& f) { f.drag_n *= times; });
  };
  return effect;
}

/// A heavier glider sits lower over the magnets: the drag grows with the mass.
BlindEffect drag_by_load(const BlindDesign& design, BlindRandom&) {
  const double lightest = design.masses.front().true_kg;
  return force_effect("mass_kg", 0.5, [=](double size) -> BlindChange {
    return [=](double, double, double, BlindTerms& f) { f.drag_n *= std::pow(f.mass_kg / lightest, size); };
  });
}

/// A flawed pane in front of the track: everything seen through it is displaced.
BlindEffect flawed_pane(const BlindDesign&, BlindRandom& random) {
  const double at = uniform(random, -0.2, 0.4), width = uniform(random, 0.03, 0.12);
  return view_effect("x_m", 0.02, [=](double size, double x, double) { return x + size * bell((x - at) / width); });
}

/// Centres pulled towards the middle of a pixel: a displacement with the pixel's period.
BlindEffect pixel_locking(const BlindDesign&, BlindRandom& random) {
  const double pixel = uniform(random, 0.008, 0.03), phase = uniform(random, 0.0, kTurn);
  return view_effect("x_m", 0.003,
                     [=](double size, double x, double) { return x + size * std::sin(kTurn * x / pixel + phase); });
}

/// A sagging tripod: the image drifts, faster at first, differently in each clip.
BlindEffect sagging_tripod(const BlindDesign& design, BlindRandom& random) {
  std::vector<double> share;
  for (std::size_t c = 0; c < design.clips.size(); ++c) share.push_back(normal(random));
  const double time = uniform(random, 0.1, 0.3);
  BlindEffect effect;
  effect.largest = 0.02;
  effect.variable = "t_s";
  effect.put = [=](double size, std::size_t clip, BlindFilm& film) {
    const double all = size * share[clip];
    film.seen.push_back([=](double x, double t) { return x + all * (1.0 - std::exp(-t / time)); });
  };
  return effect;
}

/// A camera clock that slows down as it warms up: times stretch with the square of the time in the clip.
BlindEffect drifting_clock(const BlindDesign&, BlindRandom& random) {
  const double sign = either_sign(random);
  BlindEffect effect;
  effect.largest = 0.08;
  effect.variable = "t_s";
  effect.put = [=](double size, std::size_t, BlindFilm& film) {
    for (double& t : film.true_t_s) t += sign * size * t * t;
  };
  return effect;
}

// The last four were added when the diagnosis was finished: it was not tested with them before its last run.

/// A hump in the track, a few centimetres long: the slope swings up and down again.
BlindEffect bump_in_track(const BlindDesign& design, BlindRandom& random) {
  const double at = uniform(random, -0.15, 0.35), width = uniform(random, 0.03, 0.1), g = design.gravity_m_s2;
  return force_effect("x_m", 0.1, [=](double size) -> BlindChange {
    return [=](double x, double, double, BlindTerms& f) {
      const double z = (x - at) / width;
      f.drive_n += size * g * f.mass_kg * z * bell(z);
    };
  });
}

/// An air cushion that breaks down above some speed: friction sets in.
BlindEffect lost_cushion(const BlindDesign&, BlindRandom& random) {
  const double above = uniform(random, 0.35, 0.9);
  return force_effect("v_m_s", 4.0, [=](double size) -> BlindChange {
    return [=](double, double v, double, BlindTerms& f) {
      f.friction_n *= 1.0 + size * (0.5 + 0.5 * std::tanh((std::abs(v) - above) / 0.03));
    };
  });
}

/// A camera stand moved between clips: each clip has a different scale.
BlindEffect scale_of_each_clip(const BlindDesign& design, BlindRandom& random) {
  std::vector<double> share;
  for (std::size_t c = 0; c < design.clips.size(); ++c) share.push_back(normal(random));
  BlindEffect effect;
  effect.largest = 0.03;
  effect.variable = "clip";
  effect.put = [=](double size, std::size_t clip, BlindFilm& film) {
    const double by = size * share[clip];
    film.seen.push_back([=](double x, double) { return (1.0 + by) * x; });
  };
  return effect;
}

/// A tracker that lags: positions are those of a filter that follows the true ones.
BlindEffect lagging_tracker(const BlindDesign&, BlindRandom&) {
  BlindEffect effect;
  effect.largest = 0.2;
  effect.variable = "t_s";
  effect.put = [](double size, std::size_t, BlindFilm& film) {
    double followed = 0.0, last = 0.0;
    bool begun = false;
    film.seen.push_back([=](double x, double t) mutable {
      if (!begun) followed = x;
      if (begun && size > 0.0) followed += (1.0 - std::exp(-(t - last) / size)) * (x - followed);
      begun = true;
      last = t;
      return followed;
    });
  };
  return effect;
}

}  // namespace

const std::vector<DrawnEffect>& outside_library() {
  static const std::vector<DrawnEffect> list = {
      {"rough_patch", rough_patch},
      {"cogging", cogging},
      {"rail_joint", rail_joint},
      {"sticky_seam", sticky_seam},
      {"drag_hump", drag_hump},
      {"warming_up", warming_up},
      {"swinging_load", swinging_load},
      {"gusts", gusts},
      {"drag_of_each_run", drag_of_each_run},
      {"drag_by_load", drag_by_load},
      {"flawed_pane", flawed_pane},
      {"pixel_locking", pixel_locking},
      {"sagging_tripod", sagging_tripod},
      {"drifting_clock", drifting_clock},
      {"bump_in_track", bump_in_track},
      {"lost_cushion", lost_cushion},
      {"scale_of_each_clip", scale_of_each_clip},
      {"lagging_tracker", lagging_tracker},
  };
  return list;
}

}  // namespace glidelab::validate
