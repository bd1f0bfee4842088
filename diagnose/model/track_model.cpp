#include "diagnose/model/track_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

#include "diagnose/effects/effect_library.h"
#include "diagnose/model/acting_laws.h"

namespace glidelab::diagnose {
namespace {

constexpr double kLongestStep = 0.0126;  // s: at 80 frames a second, one step a frame is enough
constexpr double kStepsOfFrame = 8.0;    // a frame needs no more steps than this, unless something is stiff
constexpr double kLongestTurn = 0.3;     // largest step times rate: k h, and whatever rate an effect asks for
constexpr int kMostTurns = 20;           // reversals within one step; more is chatter about rest
constexpr double kNoSpeed_m_s = 1e-300;  // has a direction but causes no motion
constexpr int kMostLeaving = 40;         // iterations to find the instant at which static friction gives way,
constexpr double kSameTime_s = 1e-13;    // to within this
// Most steps of a motion: a constant plus so many a frame. A rate k that takes more steps than this is past in a frame,
// exp(-k T) = 1e-7: such a motion is at its terminal velocity from the second frame on to within the least noise of a
// position (of the distance covered, track_set.cpp), and no larger rate differs from it. ln(1e7)/0.3 = 54.
constexpr double kMostSteps = 2500.0, kMostOfFrame = 16.1 / kLongestTurn;
constexpr std::size_t kMostWork = 2000;  // most steps a position, including those spent at turns;
constexpr std::size_t kFewTimes = 100;   // fewer positions than this count as this many

// What the integrator itself must know of time-dependent effects: the phase of a vibration, and when a hand lets go.
constexpr EffectSlot kShake = slot_of(ids::base_vibration, 0), kShakeHz = slot_of(ids::base_vibration, 1),
                     kShakePhase = slot_of(ids::base_vibration, 2);
constexpr EffectSlot kRelease = slot_of(ids::late_release, 0), kPush = slot_of(ids::late_release, 1);

GliderConstants constants_of(const TrackModel& model) {
  return {.mass_kg = model.mass_kg,
          .weight_n = model.mass_kg * model.gravity_m_s2,
          .cos_alpha = std::cos(model.alpha_rad),
          .mu = model.mu,
          .x_mid_m = model.x_mid_m,
          .x_mid_all_m = model.x_mid_all_m,
          .x_low_m = model.x_low_m,
          .x_high_m = model.x_high_m,
          .clip = static_cast<double>(model.clip),
          .driven = model.known != nullptr};
}

class Mover {
 public:
  Mover(const TrackModel& model, const ActingLaws& laws, const GliderConstants& glider, double frame_s)
      : m_(model),
        laws_(laws),
        glider_(glider),
        sin_(std::sin(model.alpha_rad)),
        by_inertia_(1.0 / (model.mass_kg + laws.inertia_kg)),
        shaken_(model.effects[kShake] != 0.0),
        wave_(model.effects[kShakeHz], model.effects[kShakePhase]) {
    double rate = std::abs(model.k_n_s_m) / model.mass_kg;
    for (const Acting& effect : laws.rates.all()) {
      rate = std::max(rate, effect.law->rate_1_s(effect.p, model.mass_kg));
    }
    step_ = std::max(kLongestStep, frame_s / kStepsOfFrame);
    if (rate > 0.0) step_ = std::min(step_, kLongestTurn / rate);
    hold();
  }

  /// The forces that do not depend on the direction of motion.
  double driving(double x, double v, double t) const {
    const EffectValues& e = m_.effects;
    return driving(x, v, t, shaken_ ? std::sin(2.0 * std::numbers::pi * e[kShakeHz] * t + e[kShakePhase]) : 0.0);
  }

  /// `wave`: the sine of the vibration at t.
  double driving(double x, double v, double t, double wave) const {
    const GliderState at{x, v, t, wave, pushed_};
    double viscous = m_.k_n_s_m * v, slope = sin_, against = 0.0;
    if (laws_.resistance.any()) {
      Resistance of{.slope = sin_};
      for (const Acting& effect : laws_.resistance.all()) effect.law->resistance(effect.p, glider_, at, of);
      if (of.drag_factor != 1.0) viscous *= of.drag_factor;
      if (of.drag_divisor != 1.0) viscous /= of.drag_divisor;  // a division costs as much as the rest
      if (of.drag_along != 1.0) viscous *= of.drag_along;
      viscous *= of.own_factor;
      slope = of.slope;
      against = of.against_n + of.own_factor * of.of_air_n;
    }
    double force = glider_.weight_n * slope - viscous;
    force -= against;
    for (const Acting& effect : laws_.force.all()) force += effect.law->force_n(effect.p, glider_, at);
    if (m_.known != nullptr) force += known_n_ + known_n_s_ * (t - known_t_);
    if (m_.unnamed != nullptr) force += (*m_.unnamed)(x, v, t);
    return force;
  }

  /// The friction, which acts against the motion.
  double friction(double x, double v, double t) const {
    DryFriction of{.mu = m_.mu};
    const GliderState at{x, v, t, 0.0, pushed_};
    for (const Acting& effect : laws_.friction.all()) effect.law->friction(effect.p, glider_, at, of);
    return of.mu * glider_.weight_n * glider_.cos_alpha + of.force_n;
  }

  double slide(double x, double v, double t, double wave) const {
    if (laws_.steady_driving) {
      const Held& held = held_[pushed_][direction_ > 0];
      double force = held.driving_n - held.drag_n_s_m * v;
      if (m_.known != nullptr) force += known_n_ + known_n_s_ * (t - known_t_);
      if (m_.unnamed != nullptr) force += (*m_.unnamed)(x, v, t);
      return (force - direction_ * (laws_.steady ? held.friction_n : friction(x, v, t))) * by_inertia_;
    }
    return (driving(x, v, t, wave) - direction_ * friction(x, v, t)) * by_inertia_;
  }

  /// Advances to t_end in one step, if that is short enough and nothing happens on the way (no turn, no release by a
  /// hand).
  std::optional<Stride> stride(const PlaceAndSpeed& s, double t, double t_end) {
    const double release_s = m_.effects[kRelease];
    const bool pushed = m_.effects[kPush] != 0.0 && t < release_s;
    if (flows_ || m_.known != nullptr || direction_ == 0 || (pushed && release_s < t_end)) return {};
    pushed_ = pushed;
    const Step step = step_from(s, t, t_end - t);
    if (!(step.end.v * direction_ > 0.0)) return {};
    const double a_end = slide(step.end.x, step.end.v, t_end, step.wave_end);
    last_ = {step.end, t_end, a_end, direction_, pushed_};
    return Stride(s, step.a_start, step.end, a_end, t_end - t);
  }

  /// Of a motion in closed form: its positions and speeds at all of these times that one step reaches before a turn or
  /// a release. Returns how many these are, and advances to the last of them. A series is enough for steps of several
  /// frames; if a drag is so strong that it does not reach the next frame, exponentials reach all of them.
  std::size_t flow(PlaceAndSpeed& s, double& t, std::span<const double> at, double* x_m, double* v_m_s) {
    if (!flows_ || m_.known != nullptr || direction_ == 0 || !std::isfinite(s.v)) return 0;
    const double release_s = m_.effects[kRelease];
    pushed_ = m_.effects[kPush] != 0.0 && t < release_s;
    const auto times_until = [&](double until) {
      if (pushed_) until = std::min(until, release_s);
      return static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), until) - at.begin());
    };
    std::size_t count = times_until(t + reach_);
    const bool is_near = count > 0;
    if (!is_near) count = times_until(std::numeric_limits<double>::infinity());
    if (count == 0) return 0;
    ++work_;
    const SteadyFlow flow = flow_from(s, t);
    if (is_near) {
      flow.fill(t, at.first(count), x_m, v_m_s);
    } else {
      count = flow.fill_far(t, at.first(count), direction_, x_m, v_m_s);
    }
    // The speed changes monotonically, so only the last of these can lie beyond a turn.
    while (count > 0 && !(v_m_s[count - 1] * direction_ > 0.0)) --count;
    if (count == 0) return 0;
    s = {x_m[count - 1], v_m_s[count - 1]};
    t = at[count - 1];
    return count;
  }

  double longest_step() const { return step_; }
  /// Whether a motion of so many frames takes no more steps than are allowed. In closed form it takes many only at a
  /// turn.
  bool can_follow(double duration_s, double frame_s, double most_steps) const {
    if (flows_ && m_.known == nullptr) return frame_s <= static_cast<double>(kMostWork) * reach_;
    return duration_s <= most_steps * step_;
  }
  /// Number of steps so far, including those spent on finding a turn.
  std::size_t work() const { return work_; }

  /// Advances to t_end, stopping at each sample of the known force, where it has corners. `stretch`: ratio of true to
  /// stated time.
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
  /// What acts as long as the direction and the hand stay as they are.
  struct Held {
    double driving_n = 0.0, drag_n_s_m = 0.0, friction_n = 0.0;
  };

  void hold() {
    flows_ = laws_.steady && m_.unnamed == nullptr;
    if (!laws_.steady_driving) return;
    double most = 0.0;
    for (const bool pushed : {false, true}) {
      if (pushed && m_.effects[kPush] == 0.0) continue;
      pushed_ = pushed;  // friction() asks for it
      for (const bool forward : {false, true}) {
        const GliderState at{0.0, forward ? kNoSpeed_m_s : -kNoSpeed_m_s, 0.0, 0.0, pushed};
        Resistance of{.slope = sin_};
        for (const Acting& effect : laws_.resistance.all()) effect.law->resistance(effect.p, glider_, at, of);
        Held& held = held_[pushed][forward];
        held.driving_n = glider_.weight_n * of.slope - of.against_n;  // a steady drag is K v alone
        for (const Acting& effect : laws_.force.all()) held.driving_n += effect.law->force_n(effect.p, glider_, at);
        held.drag_n_s_m = m_.k_n_s_m * of.own_factor * of.drag_factor / of.drag_divisor * of.drag_along;
        if (laws_.steady) held.friction_n = friction(at.x, at.v, at.t);
        most = std::max(most, std::abs(held.drag_n_s_m * by_inertia_));
      }
    }
    pushed_ = false;
    reach_ = most > 0.0 ? SteadyFlow::kReach / most : std::numeric_limits<double>::infinity();
  }

  /// The motion from here on until the direction, the hand or the piece of the known force changes.
  SteadyFlow flow_from(const PlaceAndSpeed& s, double t) const {
    const Held& held = held_[pushed_][direction_ > 0];
    const double change = m_.known != nullptr ? known_n_s_ * by_inertia_ : 0.0;
    return {s, slide(s.x, s.v, t, 0.0), change, held.drag_n_s_m * by_inertia_};
  }

  /// Sets the linear piece of the known force that holds from t on, and returns when that piece ends. Beyond its
  /// samples the force keeps its last value.
  double hold_force_at(double t, double stretch) {
    const std::vector<double>& at = m_.known->t_s;
    const std::vector<double>& force = m_.known->force_n;
    const double late = laws_.known_late_s, factor = laws_.known_factor;
    while (sample_ < at.size() && stretch * at[sample_] + late <= t) ++sample_;
    const std::size_t before = sample_ > 0 ? sample_ - 1 : 0, after = std::min(sample_, at.size() - 1);
    known_t_ = stretch * at[before] + late;
    known_n_ = factor * force[before];
    known_n_s_ = after > before ? factor * (force[after] - force[before]) / (stretch * (at[after] - at[before])) : 0.0;
    return sample_ < at.size() ? stretch * at[sample_] + late : std::numeric_limits<double>::infinity();
  }

  PlaceAndSpeed advance_forced(PlaceAndSpeed s, double t, double t_end) {
    const double release = m_.effects[kRelease];
    if (m_.effects[kPush] != 0.0 && t < release && release < t_end) {
      s = advance_smooth(s, t, release, true);
      return advance_smooth(s, release, t_end, false);
    }
    return advance_smooth(s, t, t_end, t < release);
  }

  PlaceAndSpeed advance_smooth(PlaceAndSpeed s, double t, double t_end, bool pushed) {
    pushed_ = pushed && m_.effects[kPush] != 0.0;
    const double longest = flows_ ? reach_ : step_;
    const int parts = std::max(1, static_cast<int>(std::ceil((t_end - t) / longest - 1e-9)));
    const double h = (t_end - t) / parts;
    for (int i = 0; i < parts; ++i) s = advance_part(s, t + i * h, h);
    return s;
  }

  struct Step {
    PlaceAndSpeed end;
    double a_start = 0.0, wave_end = 0.0;
  };

  /// An acceleration that was computed: the end of one step is the start of the next.
  struct Known {
    PlaceAndSpeed at;
    double t = std::numeric_limits<double>::quiet_NaN(), a = 0.0;
    int direction = 0;
    bool pushed = false;
  };

  bool knows(const PlaceAndSpeed& s, double t) const {
    return last_.t == t && last_.at.x == s.x && last_.at.v == s.v && last_.direction == direction_ &&
           last_.pushed == pushed_ && m_.known == nullptr;
  }

  Step step_from(const PlaceAndSpeed& s, double t, double h) {
    ++work_;
    return flows_ ? Step{flow_from(s, t).at(h)} : rk4(s, t, h);
  }

  Step rk4(const PlaceAndSpeed& s, double t, double h) {
    const std::array<double, 3> wave = shaken_ ? wave_.over(t, h) : std::array<double, 3>{};
    const double a1 = knows(s, t) ? last_.a : slide(s.x, s.v, t, wave[0]);
    last_ = {s, t, a1, direction_, pushed_};
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
      const PlaceAndSpeed next = step_from(s, t, h).end;
      if (next.v * direction_ >= 0.0 || !std::isfinite(next.v)) return next;
      // v = 0 on the way: first estimate of its time by regula falsi, then Newton steps.
      double at = h * std::abs(s.v) / (std::abs(s.v) + std::abs(next.v));
      PlaceAndSpeed stop = s;
      for (int i = 0; i < 6; ++i) {
        const Step step = step_from(s, t, at);
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

  /// At rest, static friction balances the driving force up to its limit in either direction. False: it holds for all
  /// of h. Otherwise t and h are advanced to where it gives way, and the direction becomes that in which the glider
  /// leaves.
  bool leave(const PlaceAndSpeed& s, double& t, double& h) {
    const auto up = [&](double at) { return driving(s.x, kNoSpeed_m_s, at) - friction(s.x, 0.0, at); };
    const auto down = [&](double at) { return -driving(s.x, -kNoSpeed_m_s, at) - friction(s.x, 0.0, at); };
    const auto beyond = [&](double at) { return std::max(up(at), down(at)); };
    double before = beyond(t);
    if (!(before > 0.0)) {
      double after = beyond(t + h);
      if (!(after > 0.0)) return false;
      double low = 0.0, high = h;  // regula falsi (Illinois): the value at the end that stays is halved
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
  const ActingLaws& laws_;
  GliderConstants glider_;
  double sin_, by_inertia_;
  bool shaken_;
  SineSteps wave_;
  std::array<std::array<Held, 2>, 2> held_;  // by whether the hand pushes, and by direction
  Known last_;
  bool flows_ = false;  // in closed form
  double step_ = kLongestStep, reach_ = 0.0;
  std::size_t work_ = 0;
  int direction_ = 0;
  bool pushed_ = false;
  std::size_t sample_ = 0;  // index of the known force's first sample later than now
  double known_t_ = 0.0, known_n_ = 0.0, known_n_s_ = 0.0;
};

double seen(const ActingLaws& laws, const GliderConstants& glider, double x, double t) {
  double measured = x;
  for (const Acting& effect : laws.seen.all()) measured = effect.law->seen_m(effect.p, glider, x, t, measured);
  return measured;
}

}  // namespace

namespace {

/// A motion that is not computed: nothing that can be filmed is so stiff or turns so often.
Moved not_followed(std::size_t count) {
  const std::vector<double> nowhere(count, std::numeric_limits<double>::quiet_NaN());
  return {nowhere, nowhere};
}

}  // namespace

Moved move(const TrackModel& model, std::span<const double> times_s, std::span<const double> late_s) {
  Moved moved;
  moved.x_m.resize(times_s.size());
  moved.v_m_s.resize(times_s.size());
  if (times_s.empty()) return moved;
  const GliderConstants glider = constants_of(model);
  const ActingLaws laws(model.effects, glider);
  const double frame_s =
      (times_s.back() - times_s.front()) / static_cast<double>(std::max<std::size_t>(1, times_s.size() - 1));
  Mover mover(model, laws, glider, frame_s);
  PlaceAndSpeed s{model.x0_m, model.v0_m_s};
  mover.start(s.v);
  const double stretch = laws.stretch;
  double t = stretch * times_s.front();
  std::vector<double> at(times_s.size());  // true times, never decreasing
  for (std::size_t i = 0; i < at.size(); ++i) {
    const double rows = model.row_px.empty() ? 0.0 : model.row_px[i] - model.row_px.front();
    at[i] = stretch * times_s[i] + (late_s.empty() ? 0.0 : late_s[i]) + laws.row_s * rows;
    at[i] = std::max(at[i], i > 0 ? at[i - 1] : t);
  }
  const auto put = [&](std::size_t i, const PlaceAndSpeed& state) {
    moved.x_m[i] = state.x;
    moved.v_m_s[i] = state.v;
  };
  const double most_steps = kMostSteps + kMostOfFrame * static_cast<double>(at.size());
  // A diverging fit asks for millions of steps; nothing that can be filmed is so stiff.
  if (!mover.can_follow(at.back() - t, frame_s, most_steps)) return not_followed(at.size());
  const std::size_t positions = std::max(at.size(), kFewTimes);
  for (std::size_t i = 0; i < at.size();) {
    if (mover.work() > kMostWork * positions || !std::isfinite(s.v)) return not_followed(at.size());
    if (const std::size_t reached = mover.flow(s, t, std::span(at).subspan(i), &moved.x_m[i], &moved.v_m_s[i])) {
      i += reached;
      continue;
    }
    // One step over several frames, if it reaches that far.
    std::size_t last = i;
    while (last + 1 < at.size() && at[last + 1] - t <= mover.longest_step()) ++last;
    if (last > i && at[last] > t) {
      if (const std::optional<Stride> stride = mover.stride(s, t, at[last])) {
        for (; i < last; ++i) put(i, stride->at(at[i] - t));
        s = stride->to();
        t = at[last];
        put(i++, s);
        continue;
      }
    }
    if (at[i] > t) s = mover.advance(s, t, at[i], stretch);
    t = at[i];
    put(i++, s);
  }
  if (laws.seen.any()) {
    for (std::size_t i = 0; i < at.size(); ++i) moved.x_m[i] = seen(laws, glider, moved.x_m[i], times_s[i]);
  }
  return moved;
}

bool shifts_as_a_whole(const TrackModel& model) {
  const ActingLaws laws(model.effects, constants_of(model));
  return laws.steady && model.unnamed == nullptr && !laws.seen.any();
}

OwnLaw own_law(const TrackModel& model) {
  const GliderConstants glider = constants_of(model);
  const GliderState middle{model.x_mid_m, 0.0, 0.0, 0.0, false};
  Resistance resistance{.slope = 0.0};
  DryFriction friction{.mu = model.mu};
  double along = 1.0;
  const std::vector<EffectInfo>& list = effect_list();
  for (std::size_t e = 0; e < list.size(); ++e) {
    const EffectLaw& law = list[e].law;
    const double* p = model.effects.of(e);
    if (!law.acts(p)) continue;
    const bool own = list[e].parameters[law.size].each == Each::configuration;
    if (own && law.friction != nullptr) law.friction(p, glider, middle, friction);
    if (law.resistance == nullptr) continue;
    if (own) law.resistance(p, glider, middle, resistance);
    Resistance here{.slope = 0.0};
    law.resistance(p, glider, middle, here);
    along *= here.drag_along;
  }
  return {.k_n_s_m = model.k_n_s_m * resistance.own_factor * along, .mu = friction.mu};
}

}  // namespace glidelab::diagnose
