#include "validate/blind/case/blind_design.h"

#include <fmt/format.h>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/math/angles.h"

namespace glidelab::validate {

// The C++ standard leaves distributions to each library; only the engine is the same everywhere.
double uniform(BlindRandom& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random() >> 11) * 0x1p-53;
}

double log_uniform(BlindRandom& random, double low, double high) {
  return std::exp(uniform(random, std::log(low), std::log(high)));
}

double normal(BlindRandom& random) {
  const double u = uniform(random, 0.0, 1.0), angle = uniform(random, 0.0, 2.0 * std::numbers::pi);
  return std::sqrt(-2.0 * std::log1p(-u)) * std::cos(angle);  // Box-Muller
}

namespace {

namespace odeint = boost::numeric::odeint;
using State = std::array<double, 2>;  // x, v

constexpr double kTolerance = 1e-11;                                        // m, m/s: a millionth of the smallest noise
constexpr double kLongestStep = 2e-3, kFirstStep = 1e-4, kRestStep = 2e-4;  // s
constexpr std::size_t kHalvings = 60;                                       // of 2 ms: to rounding
constexpr double kFarthest_m = 1e3;                                         // m
constexpr std::size_t kMostSteps =
    200'000;  // of one motion: 40 s at rest; a vanishing mass under drag would take billions
constexpr double kFirstSpeed_m_s = 1e-12;  // m/s: a speed that has a direction and moves nothing

BlindTerms terms_of(const BlindLaw& law, double x, double v, double t) {
  const double weight = law.mass_kg * law.gravity_m_s2;
  BlindTerms terms{weight * std::sin(law.alpha_rad), law.k_n_s_m * v, law.mu * weight * std::cos(law.alpha_rad),
                   law.mass_kg, law.mass_kg};
  for (const BlindChange& change : law.changes) change(x, v, t, terms);
  terms.friction_n = std::max(0.0, terms.friction_n);
  return terms;
}

/// The direction in which it leaves rest, 1 or -1; 0: it stays. The friction that holds it is that of the direction in
/// which it would leave. If neither direction's friction held it, it would set off, stop at once, and so on.
int direction_from_rest(const BlindLaw& law, double x, double t) {
  const BlindTerms at_rest = terms_of(law, x, 0.0, t);
  const int direction = at_rest.drive_n - at_rest.drag_n > 0.0 ? 1 : -1;
  const BlindTerms terms = terms_of(law, x, direction * kFirstSpeed_m_s, t);
  return direction * (terms.drive_n - terms.drag_n) > terms.friction_n ? direction : 0;
}

class Glider {
 public:
  Glider(const BlindLaw& law, State start, double t) : law_(law), s_(start), t_(t) {
    direction_ = s_[1] > 0.0 ? 1 : s_[1] < 0.0 ? -1 : 0;
  }

  std::size_t steps() const { return steps_; }

  BlindSample at(double t) {
    while (t_ < t) {
      if (++steps_ > kMostSteps) {
        lose();
      } else if (direction_ == 0) {
        rest_until(t);
      } else {
        slide_until(t);
      }
    }
    return {s_[0], s_[1]};
  }

 private:
  void rest_until(double t) {
    direction_ = direction_from_rest(law_, s_[0], t_);
    if (direction_ == 0) t_ = std::min(t, t_ + kRestStep);
  }

  void slide_until(double t) {
    const auto derivative = [this](const State& s, State& d, double at) {
      const BlindTerms terms = terms_of(law_, s[0], s[1], at);
      d = {s[1], (terms.drive_n - terms.drag_n - direction_ * terms.friction_n) / terms.inertia_kg};
    };
    auto stepper = odeint::make_dense_output(kTolerance, kTolerance, kLongestStep, odeint::runge_kutta_dopri5<State>());
    stepper.initialize(s_, t_, std::min(kFirstStep, t - t_));
    while (t_ < t) {
      stepper.do_step(derivative);
      const double end = std::min(t, stepper.current_time());
      State next;
      stepper.calc_state(end, next);
      if (!(std::abs(next[0]) < kFarthest_m) || ++steps_ > kMostSteps) return lose();
      if (next[1] * direction_ < 0.0) {
        stop_within(stepper, t_, end);
        return;
      }
      s_ = next;
      t_ = end;
    }
  }

  void lose() {
    s_ = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    t_ = std::numeric_limits<double>::infinity();
  }

  template <typename Stepper>
  void stop_within(Stepper& stepper, double from, double to) {
    State s;
    steps_ += kHalvings;
    for (std::size_t i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (from + to);
      stepper.calc_state(middle, s);
      (s[1] * direction_ < 0.0 ? to : from) = middle;
    }
    stepper.calc_state(to, s);
    s_ = {s[0], 0.0};
    t_ = to;
    direction_ = direction_from_rest(law_, s_[0], t_);
  }

  const BlindLaw& law_;
  State s_;
  double t_ = 0.0;
  int direction_ = 0;
  std::size_t steps_ = 0;
};

}  // namespace

std::vector<BlindSample> blind_motion(const BlindLaw& law, double x0_m, double v0_m_s, std::span<const double> times_s,
                                      std::size_t* steps) {
  std::vector<BlindSample> samples;
  if (times_s.empty()) return samples;
  samples.reserve(times_s.size());
  Glider glider(law, {x0_m, v0_m_s}, times_s.front());
  for (const double t : times_s) samples.push_back(glider.at(t));
  if (steps != nullptr) *steps += glider.steps();
  return samples;
}

namespace {

constexpr std::size_t kMostFrames = 260;  // of a clip

}  // namespace

std::vector<BlindGroup> draw_groups(BlindRandom& random, int kind, double least_sd_deg, double most_sd_deg) {
  constexpr int kLevel = 0, kInclined = 1;
  const bool stated = uniform(random, 0.0, 1.0) < 0.85;
  const double sd = log_uniform(random, least_sd_deg, most_sd_deg) * base::kRadPerDegree;
  std::vector<BlindGroup> groups;
  const auto add = [&](const char* name, double degrees) {
    const double stated_rad = degrees * base::kRadPerDegree;
    BlindGroup group{name, stated_rad, stated_rad + sd * normal(random), {}};
    if (stated) group.stated_sd_rad = sd;
    groups.push_back(group);
  };
  if (kind != kInclined) add("level", 0.0);
  if (kind != kLevel) add("inclined", std::round(10.0 * uniform(random, 2.0, 7.0)) / 10.0);
  return groups;
}

BlindClip draw_clip(BlindRandom& random, const BlindDesign& design, const BlindLaunches& launches, std::size_t group,
                    std::size_t mass, std::size_t number) {
  const bool up = number % 2 == 0;
  BlindClip clip{"", group, mass, 0.0, 0.0, launches.rate_hz, 0};
  clip.name = fmt::format("{}-m{}-{}{}", design.groups[group].name, mass + 1, up ? "up" : "down",
                          launches.repeats > 1 ? std::to_string(number / 2 + 1) : std::string());
  clip.v0_m_s = (up ? -1.0 : 1.0) * uniform(random, 0.4, 1.5);
  clip.x0_m = launches.origin_m + (up ? 0.5 : -0.5) * uniform(random, 0.6, launches.longest_m);
  return clip;
}

BlindDesign draw_design(BlindRandom& random) {
  BlindDesign design;
  design.k_n_s_m = log_uniform(random, 0.15, 1.6);
  design.mu = log_uniform(random, 0.0015, 0.02);
  design.noise_sd_m = log_uniform(random, 5e-6, 3e-4);

  const int kind = one_of(random, {0, 1, 1, 2, 2, 2});
  design.groups = draw_groups(random, kind, 0.01, 0.3);

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
  const std::size_t repeats =
      design.groups.size() * design.masses.size() <= 2 && uniform(random, 0.0, 1.0) < 0.5 ? 2 : 1;
  const BlindLaunches launches{origin, 1.2, repeats, rate};
  for (std::size_t g = 0; g < design.groups.size(); ++g) {
    for (std::size_t m = 0; m < design.masses.size(); ++m) {
      for (std::size_t r = 0; r < 2 * repeats; ++r) {
        BlindClip clip = draw_clip(random, design, launches, g, m, r);
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

std::vector<double> seen_positions(const BlindClip& clip, const BlindFilm& film, std::size_t* steps) {
  const std::vector<BlindSample> motion = blind_motion(film.law, clip.x0_m, clip.v0_m_s, film.true_t_s, steps);
  std::vector<double> seen;
  for (std::size_t k = 0; k < motion.size(); ++k) {
    double x = motion[k].x_m;
    for (const auto& see : film.seen) x = see(x, film.true_t_s[k]);
    seen.push_back(motion[k].v_m_s == 0.0 && k > 0 ? std::numeric_limits<double>::quiet_NaN() : x + film.off_m[k]);
  }
  return seen;
}

double either_sign(BlindRandom& random) {
  return uniform(random, 0.0, 1.0) < 0.5 ? -1.0 : 1.0;
}

std::vector<double> phases(const BlindDesign& design, BlindRandom& random) {
  std::vector<double> phase;
  for (std::size_t c = 0; c < design.clips.size(); ++c) phase.push_back(uniform(random, 0.0, kTurn));
  return phase;
}

double wave_hz(const BlindDesign& design, BlindRandom& random) {
  const BlindClip& clip = design.clips.front();
  const double longest = static_cast<double>(clip.frames) / clip.rate_hz;
  return log_uniform(random, 3.0 / longest, std::min(0.35 * clip.rate_hz, 40.0));
}

}  // namespace glidelab::validate
