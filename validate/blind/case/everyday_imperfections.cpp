#include "validate/blind/case/everyday_imperfections.h"

#include <algorithm>
#include <cmath>

#include "diagnose/effects/effect_list.h"
#include "validate/blind/case/everyday_causes.h"

namespace glidelab::validate {
namespace {

constexpr double kDecade = 0.1;  // of the maximum: the smallest amplitude drawn

using ImperfectionPut = std::function<void(double amplitude, std::size_t clip, BlindFilm& film)>;

EverydayImperfection imperfection_of(const char* id, double most, const char* unit, std::vector<std::string> effects,
                                     ImperfectionPut put, BlindRandom& random) {
  EverydayImperfection imperfection{id, log_uniform(random, kDecade * most, most), unit, std::move(effects), {}};
  const double amplitude = imperfection.amplitude;
  imperfection.effect.id = id;
  imperfection.effect.largest = most / amplitude;
  imperfection.effect.put = [=](double size, std::size_t clip, BlindFilm& film) { put(size * amplitude, clip, film); };
  return imperfection;
}

std::vector<double> of_each_clip(const BlindDesign& design, BlindRandom& random) {
  std::vector<double> z;
  for (std::size_t c = 0; c < design.clips.size(); ++c) z.push_back(std::clamp(normal(random), -2.0, 2.0));
  return z;
}

void add_force(BlindFilm& film, BlindChange change) {
  film.law.changes.push_back(std::move(change));
}

EverydayImperfection scattered_friction(const BlindDesign& design, BlindRandom& random) {
  const auto z = of_each_clip(design, random);
  return imperfection_of(
      "scattered_friction", 0.15, "1", {diagnose::ids::clip_scatter},
      [=](double a, std::size_t clip, BlindFilm& film) {
        const double factor = 1.0 + a * z[clip];
        add_force(film, [=](double, double, double, BlindTerms& f) { f.friction_n *= factor; });
      },
      random);
}

EverydayImperfection wavy_track(const BlindDesign& design, BlindRandom& random) {
  const auto waves = random_waves(0.15, 1.2, random);
  const double g = design.gravity_m_s2;
  return imperfection_of(
      "wavy_track", 4e-3, "rad", {diagnose::ids::track_bow},
      [=](double a, std::size_t, BlindFilm& film) {
        add_force(film, [=](double x, double, double, BlindTerms& f) { f.drive_n += a * g * f.mass_kg * waves(x); });
      },
      random);
}

EverydayImperfection lag(const BlindDesign& design, BlindRandom& random) {
  const auto z = of_each_clip(design, random);
  return imperfection_of(
      "lagging_tracker", 2.0 / design.clips.front().rate_hz, "s", {},
      [=](double a, std::size_t clip, BlindFilm& film) {
        const double lag_s = a * (1.0 + 0.4 * z[clip]);
        double followed = 0.0, last = 0.0;
        bool begun = false;
        film.seen.push_back([=](double x, double t) mutable {
          if (!begun) followed = x;
          if (begun && lag_s > 0.0) followed += (1.0 - std::exp(-(t - last) / lag_s)) * (x - followed);
          if (!(lag_s > 0.0)) followed = x;
          begun = true;
          last = t;
          return followed;
        });
      },
      random);
}

EverydayImperfection draught(const BlindDesign& design, BlindRandom& random) {
  const auto phase = phases(design, random), second = phases(design, random);
  const double slow = uniform(random, 3.0, 6.0), fast = uniform(random, 1.2, 3.0);  // periods, s
  return imperfection_of(
      "draught", 0.015, "N", {},
      [=](double a, std::size_t clip, BlindFilm& film) {
        const double p = phase[clip], q = second[clip];
        add_force(film, [=](double, double, double t, BlindTerms& f) {
          f.drive_n += a * (std::sin(kTurn * t / slow + p) + 0.5 * std::sin(kTurn * t / fast + q));
        });
      },
      random);
}

EverydayImperfection wrong_mass(const BlindDesign& design, BlindRandom& random) {
  const BlindClip& one =
      design.clips[std::min(design.clips.size() - 1,
                            static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(design.clips.size()))))];
  const std::size_t wrong = configuration_of(design, one);
  const double sign = either_sign(random);
  std::vector<bool> has;
  for (const BlindClip& clip : design.clips) has.push_back(configuration_of(design, clip) == wrong);
  return imperfection_of(
      "wrong_mass", 0.03, "1", {},
      [=](double a, std::size_t clip, BlindFilm& film) {
        if (has[clip]) film.law.mass_kg *= 1.0 + sign * a;
      },
      random);
}

EverydayImperfection unfree_start(const BlindDesign& design, BlindRandom& random) {
  const auto z = of_each_clip(design, random);
  const double until = uniform(random, 0.02, 0.08);
  return imperfection_of(
      "unfree_start", 3.0, "m/s²", {diagnose::ids::late_release},
      [=](double a, std::size_t clip, BlindFilm& film) {
        const double push = 0.6 * a * z[clip];
        add_force(film,
                  [=](double, double, double t, BlindTerms& f) { f.drive_n += t < until ? push * f.mass_kg : 0.0; });
      },
      random);
}

EverydayImperfection bad_clip(const BlindDesign& design, BlindRandom& random) {
  const auto bad = std::min(design.clips.size() - 1,
                            static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(design.clips.size()))));
  const BlindClip& clip_of = design.clips[bad];
  const double length = static_cast<double>(clip_of.frames) / clip_of.rate_hz;
  const double from = uniform(random, 0.2, 0.7) * length, until = from + uniform(random, 0.03, 0.08);
  const double sign = either_sign(random);
  if (uniform(random, 0.0, 1.0) < 0.5) {
    return imperfection_of(
        "bad_clip", 4.0, "m/s²", {},
        [=](double a, std::size_t clip, BlindFilm& film) {
          if (clip != bad) return;
          add_force(film, [=](double, double, double t, BlindTerms& f) {
            f.drive_n += t > from && t < until ? sign * a * f.mass_kg : 0.0;
          });
        },
        random);
  }
  return imperfection_of(
      "bad_clip", 1.5, "1", {diagnose::ids::clip_scatter},
      [=](double a, std::size_t clip, BlindFilm& film) {
        if (clip != bad) return;
        add_force(film, [=](double, double, double, BlindTerms& f) { f.friction_n *= 1.0 + a; });
      },
      random);
}

bool is_fair(const EverydayImperfection& imperfection, const std::vector<std::string>& names) {
  return std::any_of(names.begin(), names.end(), [&](const std::string& id) {
    return std::find(imperfection.effects.begin(), imperfection.effects.end(), id) != imperfection.effects.end();
  });
}

}  // namespace

std::vector<EverydayImperfection> draw_imperfections(std::size_t many, const std::vector<std::string>& without,
                                                     const BlindDesign& design, BlindRandom& random) {
  std::vector<EverydayImperfection> left;
  for (const auto draw : {scattered_friction, wavy_track, lag, draught, wrong_mass, unfree_start, bad_clip}) {
    EverydayImperfection imperfection = draw(design, random);
    if (!is_fair(imperfection, without)) left.push_back(std::move(imperfection));
  }
  std::vector<EverydayImperfection> chosen;
  while (chosen.size() < many && !left.empty()) {
    const auto at =
        std::min(left.size() - 1, static_cast<std::size_t>(uniform(random, 0.0, static_cast<double>(left.size()))));
    chosen.push_back(std::move(left[at]));
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
  }
  return chosen;
}

BlindEffect all_of_imperfections(const std::vector<EverydayImperfection>& imperfections) {
  BlindEffect all;
  all.id = "dirt";
  for (const EverydayImperfection& one : imperfections)
    all.largest = std::max(all.largest, one.effect.largest / one.part);
  all.put = [imperfections](double size, std::size_t clip, BlindFilm& film) {
    for (const EverydayImperfection& one : imperfections) one.effect.put(one.size_at(size), clip, film);
  };
  return all;
}

EverydayNoise draw_noise(double noise_sd_m, bool clicked, bool rounded, BlindRandom& random) {
  constexpr double kFinest = 5e-4, kCoarsest = 5e-3;  // steps of rulers and motion sensors
  EverydayNoise noise;
  double left = noise_sd_m * noise_sd_m;
  if (rounded) {
    // Up to the point where noise hardly carries a position over a step: the sd of a step's uniform error is 0.9 of the
    // total.
    const double most = std::min(kCoarsest, 0.9 * std::sqrt(12.0) * noise_sd_m);
    if (most > kFinest) {
      noise.rounded_m = log_uniform(random, std::max(kFinest, 0.3 * most), most);
      left -= noise.rounded_m * noise.rounded_m / 12.0;
    }
  }
  if (clicked) {
    const double part = uniform(random, 0.2, 0.6);
    noise.clicked_sd_m = std::sqrt(part * left);
    noise.clicked_frames = uniform(random, 0.7, 2.5);
    left *= 1.0 - part;
  }
  noise.white_sd_m = std::sqrt(left);
  return noise;
}

std::vector<double> with_noise(std::vector<double> x_m, const EverydayNoise& noise, BlindRandom& random) {
  const double keep = noise.clicked_frames > 0.0 ? std::exp(-1.0 / noise.clicked_frames) : 0.0;
  double hand = normal(random);
  for (double& x : x_m) {
    x += noise.white_sd_m * normal(random) + noise.clicked_sd_m * hand;
    hand = keep * hand + std::sqrt(1.0 - keep * keep) * normal(random);
    if (noise.rounded_m > 0.0) x = noise.rounded_m * std::round(x / noise.rounded_m);
  }
  return x_m;
}

}  // namespace glidelab::validate
