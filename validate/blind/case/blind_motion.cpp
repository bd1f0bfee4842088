#include "validate/blind/case/blind_motion.h"

#include <algorithm>
#include <array>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <limits>

namespace glidelab::validate {
namespace {

namespace odeint = boost::numeric::odeint;
using State = std::array<double, 2>;  // x, v

constexpr double kTolerance = 1e-11;                                        // m, m/s: a millionth of the smallest noise
constexpr double kLongestStep = 2e-3, kFirstStep = 1e-4, kRestStep = 2e-4;  // s
constexpr int kHalvings = 60;                                               // of 2 ms: to rounding
constexpr double kRunsAway = 1e3;                                           // m
constexpr int kMostSteps = 1'000'000;  // of one motion: 200 s at rest; a mass of nothing under a drag takes billions

BlindTerms terms_of(const BlindLaw& law, double x, double v, double t) {
  const double weight = law.mass_kg * law.gravity_m_s2;
  BlindTerms terms{weight * std::sin(law.alpha_rad), law.k_n_s_m * v, law.mu * weight * std::cos(law.alpha_rad),
                   law.mass_kg, law.mass_kg};
  for (const BlindChange& change : law.changes) change(x, v, t, terms);
  terms.friction_n = std::max(0.0, terms.friction_n);
  return terms;
}

/// 1 or -1: which way it leaves from rest; 0: it stays.
int way_from_rest(const BlindLaw& law, double x, double t) {
  const BlindTerms terms = terms_of(law, x, 0.0, t);
  const double net = terms.drive_n - terms.drag_n;
  return std::abs(net) <= terms.friction_n ? 0 : net > 0.0 ? 1 : -1;
}

class Glider {
 public:
  Glider(const BlindLaw& law, State start, double t) : law_(law), s_(start), t_(t) {
    way_ = s_[1] > 0.0 ? 1 : s_[1] < 0.0 ? -1 : 0;
  }

  BlindSample at(double t) {
    while (t_ < t) {
      if (++steps_ > kMostSteps) {
        lose();
      } else if (way_ == 0) {
        rest_until(t);
      } else {
        slide_until(t);
      }
    }
    return {s_[0], s_[1]};
  }

 private:
  void rest_until(double t) {
    way_ = way_from_rest(law_, s_[0], t_);
    if (way_ == 0) t_ = std::min(t, t_ + kRestStep);
  }

  void slide_until(double t) {
    const auto derivative = [this](const State& s, State& d, double at) {
      const BlindTerms terms = terms_of(law_, s[0], s[1], at);
      d = {s[1], (terms.drive_n - terms.drag_n - way_ * terms.friction_n) / terms.inertia_kg};
    };
    auto stepper = odeint::make_dense_output(kTolerance, kTolerance, kLongestStep, odeint::runge_kutta_dopri5<State>());
    stepper.initialize(s_, t_, std::min(kFirstStep, t - t_));
    while (t_ < t) {
      stepper.do_step(derivative);
      const double end = std::min(t, stepper.current_time());
      State next;
      stepper.calc_state(end, next);
      if (!(std::abs(next[0]) < kRunsAway) || ++steps_ > kMostSteps) return lose();
      if (next[1] * way_ < 0.0) {
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
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (from + to);
      stepper.calc_state(middle, s);
      (s[1] * way_ < 0.0 ? to : from) = middle;
    }
    stepper.calc_state(to, s);
    s_ = {s[0], 0.0};
    t_ = to;
    way_ = way_from_rest(law_, s_[0], t_);
  }

  const BlindLaw& law_;
  State s_;
  double t_ = 0.0;
  int way_ = 0;
  int steps_ = 0;
};

}  // namespace

std::vector<BlindSample> blind_motion(const BlindLaw& law, double x0_m, double v0_m_s,
                                      std::span<const double> times_s) {
  std::vector<BlindSample> samples;
  if (times_s.empty()) return samples;
  samples.reserve(times_s.size());
  Glider glider(law, {x0_m, v0_m_s}, times_s.front());
  for (const double t : times_s) samples.push_back(glider.at(t));
  return samples;
}

}  // namespace glidelab::validate
