#include "validate/blind/case/blind_seen_effects.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "diagnose/effects/effect_list.h"

namespace glidelab::validate {
namespace {

/// A change of what is seen, the same in all clips.
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
    // over the wide part, less what the narrow part loses.
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

}  // namespace glidelab::validate
