/// Force laws along the track: the terms that add up on a glider, and what a scenario can say about each law.
///
/// Frame: x positive downhill, v = dx/dt. Forces in newtons along x. A term may depend on v only through smooth
/// functions on each side of v = 0; a term that jumps at v = 0 (Coulomb, Stribeck) gives its value for either side and
/// the largest force that it holds at rest. Each law is one file in sim/force/laws; law_list.h names them all.
#pragma once

#include <functional>
#include <initializer_list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/toml/strict_toml.h"

namespace glidelab::sim {

/// What a force may depend on.
struct Contact {
  double mass_kg = 0.0;
  double normal_n = 0.0;  ///< m g cos(alpha)
};

/// K and mu of a term that is viscous or Coulomb friction.
struct LinearShare {
  double k_n_s_m = 0.0;
  double mu = 0.0;
};

class ForceTerm {
 public:
  virtual ~ForceTerm() = default;
  /// Force at speed v while sliding in `direction` (+1, -1); at v = 0 the limit from that side. Beyond v = 0 (v of the
  /// other sign) it is continued without a jump, because a solver steps there before it finds the root.
  virtual double force_n(double v_m_s, int direction, const Contact& contact) const = 0;
  /// d force / dv on that side; may be infinite at v = 0.
  virtual double slope_n_s_m(double v_m_s, int direction, const Contact& contact) const = 0;
  /// Derivatives of the force by each parameter, in the law's order (ForceLaw::parameters). v is not 0 if the slope is
  /// infinite there.
  virtual std::vector<double> by_parameter(double v_m_s, int direction, const Contact& contact) const = 0;
  /// Largest force with which the term opposes motion at rest (static friction); 0 for a term that does not hold. Not
  /// less than |force_n(0, direction)| for a term that holds.
  virtual double holding_n(const Contact&) const { return 0.0; }
  /// The exponent p of |force(v) - force(0)| ~ |v|^p as v -> 0. Below 1 the slope at rest is infinite, and the term
  /// alone stops a glider in finite time; at 1 or above it never does.
  virtual double exponent_at_rest() const { return 1.0; }
  /// What the term adds to m dv/dt = m g sin(alpha) - K v - sign(v) mu N; nothing for any other law.
  virtual std::optional<LinearShare> linear() const { return std::nullopt; }
};

/// One number of a law: its key in [[configuration.force]], which carries the unit, and the values allowed.
struct ForceParameter {
  std::string key;
  base::Range range;
  std::string help;            ///< what it is, for the reader
  double example = 0.0;        ///< a value as on a laboratory's track
  std::string over_mass = {};  ///< a second key for the value divided by the mass; a table has exactly one of the two
  /// An earlier parameter: its value is taken if this key is left out, and this one is never below it.
  std::string not_below = {};
};

/// A force law that a scenario can name.
struct ForceLaw {
  std::string id;          ///< "viscous"
  std::string force;       ///< along x, as docs write it; d is the direction of sliding, N the normal force
  std::string holds = {};  ///< the force it holds at rest, likewise; empty for none
  std::vector<ForceParameter> parameters;
  /// Makes the term from one number for each parameter, which are not checked.
  std::function<std::shared_ptr<const ForceTerm>(std::span<const double>)> make;

  /// The term with these values, in the order of `parameters`. If the last one is left out, it is taken from its
  /// `not_below`. std::logic_error if the number of values is wrong or a value is out of its range.
  std::shared_ptr<const ForceTerm> with(std::initializer_list<double> values) const;
};

/// A glider on its track, moved by gravity and the sum of `forces`.
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
