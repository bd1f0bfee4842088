#include "diagnose/model/track_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "diagnose/model/track_stride.h"

namespace glidelab::diagnose {
namespace {

constexpr double kLongestStep = 0.0126;  // s: 80 frames a second need one step a frame
constexpr double kLongestTurn = 0.3;     // of k h, and of omega h of what the cable makes
constexpr double kLongestWave = 0.9;     // of a shaking's omega h: Simpson's rule errs by (omega h)^4 / 2880 of it
constexpr int kMostTurns = 20;           // reversals within one step; more is chatter about rest
constexpr double kBarely = 1e-300;       // m/s: which way, and no faster
constexpr int kMostLeaving = 40;         // steps to the instant at which friction gives way,
constexpr double kSameTime_s = 1e-13;    // to this
constexpr double kStiff = 0.1;           // of the longest step: from there on a motion takes no more
constexpr double kMostSteps = 1e5;       // than these

class Mover {
 public:
  explicit Mover(const TrackModel& model)
      : m_(model),
        sin_(std::sin(model.alpha_rad)),
        weight_(model.mass_kg * model.gravity_m_s2),
        cos_(std::cos(model.alpha_rad)),
        by_inertia_(1.0 / (model.mass_kg + model.effects.wheels_kg)),
        wave_(model.effects.shake_hz, model.effects.shake_phase) {
    const double shake = model.effects.shake_m_s2 != 0.0 ? 2.0 * std::numbers::pi * model.effects.shake_hz : 0.0;
    const double rate = std::max({std::abs(model.k_n_s_m) / model.mass_kg, kLongestTurn / kLongestWave * shake,
                                  std::sqrt(std::max(0.0, model.effects.tether_n_m) / model.mass_kg)});
    step_ = rate > 0.0 ? std::min(kLongestStep, kLongestTurn / rate) : kLongestStep;
  }

  /// What acts whichever way it moves.
  double driving(double x, double v, double t) const {
    const EffectValues& e = m_.effects;
    return driving(x, v, t,
                   e.shake_m_s2 == 0.0 ? 0.0 : std::sin(2.0 * std::numbers::pi * e.shake_hz * t + e.shake_phase));
  }

  /// `wave`: the shaking's sine at t.
  double driving(double x, double v, double t, double wave) const {
    const EffectValues& e = m_.effects;
    double viscous = m_.k_n_s_m * v;
    if (e.power != 0.0) viscous *= v == 0.0 ? 0.0 : std::pow(std::abs(v), e.power);
    if (e.rolloff_s2_m2 != 0.0) viscous /= 1.0 + e.rolloff_s2_m2 * v * v;
    const double off = x - m_.x_mid_m;
    if (e.gradient_1_m != 0.0) {
      viscous *= 1.0 + e.gradient_1_m * (off - e.gradient_about * (m_.x_mid_all_m - m_.x_mid_m));
    }
    double force = weight_ * (sin_ + e.bow_1_m * off) - viscous;
    force -= e.c_kg_m * v * std::abs(v) + e.asymmetry * m_.mu * weight_ * cos_;
    if (x > e.tether_x_m) force -= e.tether_n_m * (x - e.tether_x_m);
    force += m_.mass_kg * e.shake_m_s2 * wave;
    if (pushed_) force += m_.mass_kg * e.push_m_s2;
    if (m_.known != nullptr) force += known_n_ + known_n_s_ * (t - known_t_);
    if (m_.unnamed != nullptr) force += (*m_.unnamed)(x, v, t);
    return force;
  }

  /// Against the motion.
  double friction(double v) const {
    const EffectValues& e = m_.effects;
    double mu = m_.mu;
    if (e.stribeck != 0.0) mu *= 1.0 + e.stribeck * std::exp(-(v * v) / (e.stribeck_m_s * e.stribeck_m_s));
    return mu * weight_ * cos_ + e.force_n;
  }

  double slide(double x, double v, double t, double wave) const {
    return (driving(x, v, t, wave) - direction_ * friction(v)) * by_inertia_;
  }

  /// To t_end by one step, where that is short enough and nothing happens on the way: no turn, no hand that lets go.
  std::optional<Stride> stride(const PlaceAndSpeed& s, double t, double t_end) {
    const EffectValues& e = m_.effects;
    const bool pushed = e.push_m_s2 != 0.0 && t < e.release_s;
    if (m_.known != nullptr || direction_ == 0 || (pushed && e.release_s < t_end)) return {};
    pushed_ = pushed;
    const Step step = rk4(s, t, t_end - t);
    if (!(step.end.v * direction_ > 0.0)) return {};
    return Stride(s, step.a_start, step.end, slide(step.end.x, step.end.v, t_end, step.wave_end), t_end - t);
  }

  double longest_step() const { return step_; }

  /// To t_end, by way of the known force's samples: it has corners there. `stretch`: true over stated time.
  PlaceAndSpeed advance(PlaceAndSpeed s, double t, double t_end, double stretch) {
    while (m_.known != nullptr && t < t_end) {
      const double until = std::min(t_end, hold_force_at(t, stretch));
      s = advance_forced(s, t, until);
      t = until;
    }
    return m_.known != nullptr ? s : advance_forced(s, t, t_end);
  }

  void start(double v) { direction_ = v > 0.0 ? 1 : v < 0.0 ? -1 : 0; }

 private:
  /// The known force from t on; returns how far it goes on like this. Beyond its samples it stays as at the last one.
  double hold_force_at(double t, double stretch) {
    const std::vector<double>& at = m_.known->t_s;
    const std::vector<double>& force = m_.known->force_n;
    while (sample_ < at.size() && stretch * at[sample_] <= t) ++sample_;
    const std::size_t before = sample_ > 0 ? sample_ - 1 : 0, after = std::min(sample_, at.size() - 1);
    known_t_ = stretch * at[before];
    known_n_ = force[before];
    known_n_s_ = after > before ? (force[after] - force[before]) / (stretch * (at[after] - at[before])) : 0.0;
    return sample_ < at.size() ? stretch * at[sample_] : std::numeric_limits<double>::infinity();
  }

  PlaceAndSpeed advance_forced(PlaceAndSpeed s, double t, double t_end) {
    const double release = m_.effects.release_s;
    if (m_.effects.push_m_s2 != 0.0 && t < release && release < t_end) {
      s = advance_smooth(s, t, release, true);
      return advance_smooth(s, release, t_end, false);
    }
    return advance_smooth(s, t, t_end, t < release);
  }

  PlaceAndSpeed advance_smooth(PlaceAndSpeed s, double t, double t_end, bool pushed) {
    pushed_ = pushed && m_.effects.push_m_s2 != 0.0;
    const int parts = std::max(1, static_cast<int>(std::ceil((t_end - t) / step_ - 1e-9)));
    const double h = (t_end - t) / parts;
    for (int i = 0; i < parts; ++i) s = advance_part(s, t + i * h, h);
    return s;
  }

  struct Step {
    PlaceAndSpeed end;
    double a_start = 0.0, wave_end = 0.0;
  };

  Step rk4(const PlaceAndSpeed& s, double t, double h) {
    const std::array<double, 3> wave = m_.effects.shake_m_s2 == 0.0 ? std::array<double, 3>{} : wave_.over(t, h);
    const double a1 = slide(s.x, s.v, t, wave[0]);
    const double v2 = s.v + 0.5 * h * a1;
    const double a2 = slide(s.x + 0.5 * h * s.v, v2, t + 0.5 * h, wave[1]);
    const double v3 = s.v + 0.5 * h * a2;
    const double a3 = slide(s.x + 0.5 * h * v2, v3, t + 0.5 * h, wave[1]);
    const double v4 = s.v + h * a3;
    const double a4 = slide(s.x + h * v3, v4, t + h, wave[2]);
    return {{s.x + h / 6.0 * (s.v + 2.0 * v2 + 2.0 * v3 + v4), s.v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)},
            a1,
            wave[2]};
  }

  PlaceAndSpeed advance_part(PlaceAndSpeed s, double t, double h) {
    for (int turn = 0; turn < kMostTurns && h > 0.0; ++turn) {
      if (direction_ == 0 && !leave(s, t, h)) return s;
      const PlaceAndSpeed next = rk4(s, t, h).end;
      if (next.v * direction_ >= 0.0 || !std::isfinite(next.v)) return next;
      // v = 0 on the way: the time by regula falsi, then Newton's steps.
      double at = h * std::abs(s.v) / (std::abs(s.v) + std::abs(next.v));
      PlaceAndSpeed stop = s;
      for (int i = 0; i < 6; ++i) {
        const Step step = rk4(s, t, at);
        stop = step.end;
        const double a = slide(stop.x, stop.v, t + at, step.wave_end);
        const double change = a != 0.0 ? -stop.v / a : 0.0;
        if (!(std::abs(change) > 1e-15)) break;
        at = std::clamp(at + change, 0.0, h);
      }
      s = {stop.x, 0.0};
      t += at;
      h -= at;
      direction_ = 0;
    }
    return s;
  }

  /// At rest friction takes up what acts, up to its limit either way. False: it holds for all of h. Else t and h go on
  /// to where it gives way, and the direction is that in which the glider leaves.
  bool leave(const PlaceAndSpeed& s, double& t, double& h) {
    const auto up = [&](double at) { return driving(s.x, kBarely, at) - friction(0.0); };
    const auto down = [&](double at) { return -driving(s.x, -kBarely, at) - friction(0.0); };
    const auto beyond = [&](double at) { return std::max(up(at), down(at)); };
    double before = beyond(t);
    if (!(before > 0.0)) {
      double after = beyond(t + h);
      if (!(after > 0.0)) return false;
      double low = 0.0, high = h;  // regula falsi, the end that stays halved
      for (int i = 0; i < kMostLeaving && high - low > kSameTime_s; ++i) {
        const double middle = low + (high - low) * before / (before - after);
        const double there = beyond(t + middle);
        if (there > 0.0) {
          high = middle;
          after = there;
          before *= 0.5;
        } else {
          low = middle;
          before = there;
          after *= 0.5;
          if (!(there < 0.0)) break;
        }
      }
      const double at = before < 0.0 ? high : low;
      t += at;
      h -= at;
    }
    direction_ = up(t) > down(t) ? 1 : -1;
    return true;
  }

  const TrackModel& m_;
  double sin_, weight_, cos_, by_inertia_;
  SineSteps wave_;
  double step_ = kLongestStep;
  int direction_ = 0;
  bool pushed_ = false;
  std::size_t sample_ = 0;  // of the known force: the first one later than now
  double known_t_ = 0.0, known_n_ = 0.0, known_n_s_ = 0.0;
};

double seen(const TrackModel& model, double x, double t) {
  const EffectValues& e = model.effects;
  const double off = x - model.x_mid_all_m;
  if (e.lens_1_m2 != 0.0) x *= 1.0 + e.lens_1_m2 * (x - e.lens_x_m) * (x - e.lens_x_m);
  if (e.perspective_1_m != 0.0) x /= 1.0 + e.perspective_1_m * x;
  x *= 1.0 + e.scale_error;
  if (e.camera_m != 0.0) {
    const double size = e.camera_m * (1.0 + e.camera_slope_1_m * off + e.camera_bend_1_m2 * off * off);
    x += size * std::sin(2.0 * std::numbers::pi * e.camera_hz * t + e.camera_phase);
  }
  return x;
}

}  // namespace

Moved move(const TrackModel& model, std::span<const double> times_s, std::span<const double> late_s) {
  Moved moved;
  moved.x_m.reserve(times_s.size());
  moved.v_m_s.reserve(times_s.size());
  if (times_s.empty()) return moved;
  Mover mover(model);
  PlaceAndSpeed s{model.x0_m, model.v0_m_s};
  mover.start(s.v);
  const double stretch = 1.0 + model.effects.rate_error;
  double t = stretch * times_s.front();
  std::vector<double> at(times_s.size());  // true times, never before the one before
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double rows = model.row_px.empty() ? 0.0 : model.row_px[i] - model.row_px.front();
    at[i] = stretch * times_s[i] + (late_s.empty() ? 0.0 : late_s[i]) + model.effects.line_s * rows;
    at[i] = std::max(at[i], i > 0 ? at[i - 1] : t);
  }
  const auto add = [&](const PlaceAndSpeed& state) {
    moved.x_m.push_back(seen(model, state.x, times_s[moved.x_m.size()]));
    moved.v_m_s.push_back(state.v);
  };
  if (mover.longest_step() < kStiff * kLongestStep && !(at.back() - t <= kMostSteps * mover.longest_step())) {
    // A fit that has lost its way asks for millions of steps; nothing that was filmed is as stiff as that.
    moved.x_m.assign(at.size(), std::numeric_limits<double>::quiet_NaN());
    moved.v_m_s = moved.x_m;
    return moved;
  }
  for (std::size_t i = 0; i < at.size();) {
    // Several frames by one step where it reaches so far.
    std::size_t last = i;
    while (last + 1 < at.size() && at[last + 1] - t <= mover.longest_step()) ++last;
    if (last > i && at[last] > t) {
      if (const std::optional<Stride> stride = mover.stride(s, t, at[last])) {
        for (; i < last; ++i) add(stride->at(at[i] - t));
        s = stride->to();
        t = at[last];
        add(s);
        ++i;
        continue;
      }
    }
    if (at[i] > t) s = mover.advance(s, t, at[i], stretch);
    t = at[i];
    add(s);
    ++i;
  }
  return moved;
}

}  // namespace glidelab::diagnose
