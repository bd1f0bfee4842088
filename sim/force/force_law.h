/// Force laws along the track, as terms that add up.
///
/// Frame: x positive downhill, v = dx/dt, a = dv/dt. Forces in newtons along x. A term may depend on v only through
/// smooth functions on each side of v = 0; what jumps at v = 0 (Coulomb, Stribeck) says its value for either side and
/// how much force it can hold at rest. The terms themselves stand in sim/force_terms.h.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace glidelab::sim {

/// What a force may depend on.
struct Contact {
  double mass_kg = 0.0;
  double normal_n = 0.0;  ///< m g cos(alpha)
};

class ForceTerm {
 public:
  virtual ~ForceTerm() = default;
  /// Force at speed v while sliding in `direction` (+1, -1); at v = 0 the limit from that side. Beyond v = 0 (v of the
  /// other sign) a continuation without a jump, which a solver steps on before it finds the root.
  virtual double force_n(double v_m_s, int direction, const Contact& contact) const = 0;
  /// d force / dv on that side; may be infinite at v = 0.
  virtual double slope_n_s_m(double v_m_s, int direction, const Contact& contact) const = 0;
  /// Largest force that the term opposes to motion at rest (static friction); 0 for what does not hold. Not less than
  /// |force_n(0, direction)| of a term that holds.
  virtual double holding_n(const Contact&) const { return 0.0; }
  /// The p of |force(v) - force(0)| ~ |v|^p as v -> 0. Below 1 the slope at rest is infinite, and the term alone stops
  /// a glider in finite time; from 1 on it never does.
  virtual double exponent_at_rest() const { return 1.0; }
  /// Its name in a scenario: "viscous", "coulomb", …
  virtual std::string law() const = 0;
};

/// A glider on its track. The sum of `forces` and of gravity moves it (equation 8 with K v and mu as two of the terms).
struct Body {
  double mass_kg = 0.0;
  double incline_rad = 0.0;
  double gravity_m_s2 = 9.80665;
  std::vector<std::shared_ptr<const ForceTerm>> forces;
};

Contact contact_of(const Body& body);

/// m g sin(alpha).
double weight_along_track_n(const Body& body);

/// Gravity and all terms, while sliding in `direction` at speed v; at v = 0 the limit from that side.
double net_force_n(const Body& body, double v_m_s, int direction);

/// Gravity and the terms that do not hold, at v = 0: what static friction has to balance.
double load_at_rest_n(const Body& body);

/// What static friction can balance, all terms together.
double holding_n(const Body& body);

}  // namespace glidelab::sim
