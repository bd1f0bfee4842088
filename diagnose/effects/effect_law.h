/// How an effect changes the motion and its observation, as functions that the model calls while it acts.
///
///     (m + m_w) dv/dt = W slope - K v factor / divisor along - against + forces - sign(v) (mu W cos(alpha) + F_0)
///
/// with the weight W = m g; slope, factor, divisor, along, against, mu and F_0 are those of the nominal model (sin
/// alpha, 1, 1, 1, 0, mu, 0) until an effect changes them. `p` are the effect's parameters in the order of its file. SI
/// units, x and v positive downhill, t true time from the clip's first frame.
#pragma once

#include <cstddef>

namespace glidelab::diagnose {

/// What of a motion does not change while it lasts.
struct GliderConstants {
  double mass_kg = 0.0;
  double weight_n = 0.0;
  double cos_alpha = 1.0;
  double mu = 0.0;
  double x_mid_m = 0.0;      ///< of the set-up
  double x_mid_all_m = 0.0;  ///< of all set-ups
};

struct GliderState {
  double x, v, t;
  double wave;  ///< sine of base_vibration's phase at t
  bool pushed;  ///< before late_release's end
};

/// All but dry friction and what only adds a force.
struct Resistance {
  double slope;  ///< sin(alpha)
  double drag_factor = 1.0, drag_divisor = 1.0;
  double drag_along = 1.0;  ///< factor by the place
  double against_n = 0.0;   ///< against x, whichever way it moves
};

struct DryFriction {
  double mu;
  double force_n = 0.0;  ///< whatever the load
};

/// The order in which changes of the measured position follow each other.
enum class SeenBy { lens, plane, scale, mount };

struct EffectLaw {
  std::size_t size = 0;  ///< the parameter that is 0 where the effect is absent
  void (*resistance)(const double* p, const GliderConstants& glider, const GliderState& at, Resistance& of) = nullptr;
  double (*force_n)(const double* p, const GliderConstants& glider, const GliderState& at) = nullptr;
  void (*friction)(const double* p, double v, DryFriction& of) = nullptr;
  double (*inertia_kg)(const double* p) = nullptr;  ///< beside the mass that weighs
  /// As fast as it makes the motion change: a step is at most 0.3 of its inverse.
  double (*rate_1_s)(const double* p, double mass_kg) = nullptr;
  /// The measured x of what stands at `x_m` and was seen at `seen_m` so far.
  double (*seen_m)(const double* p, const GliderConstants& glider, double x_m, double t_s, double seen_m) = nullptr;
  SeenBy seen_by = SeenBy::lens;
  double (*stretch)(const double* p) = nullptr;  ///< true time over stated time
  double (*row_s)(const double* p) =
      nullptr;  ///< how much later a row is exposed than the one above, over what is stated

  bool moves() const {
    return resistance != nullptr || force_n != nullptr || friction != nullptr || inertia_kg != nullptr;
  }
};

}  // namespace glidelab::diagnose
