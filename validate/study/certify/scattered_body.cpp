#include "validate/study/certify/scattered_body.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "core/experiment/clip_setup.h"
#include "sim/force/law_list.h"

namespace glidelab::validate {
namespace {

/// c of a term -c v |v|; 0 for any other.
double quadratic_kg_m(const sim::ForceTerm& term, const sim::Contact& contact) {
  const bool is_quadratic = !term.linear() && term.exponent_at_rest() == 2.0 && term.holding_n(contact) == 0.0;
  return is_quadratic ? -term.force_n(1.0, 1, contact) : 0.0;
}

}  // namespace

bool falls(const sim::Body& body) {
  return core::is_fall(body.incline_rad);
}

sim::Body scattered(sim::Body body, ClipScatter by) {
  const sim::Contact contact = sim::contact_of(body);
  const bool fall = falls(body);
  const double drag = std::max(0.0, 1.0 - by.drag);
  for (auto& term : body.forces) {
    const std::optional<sim::LinearShare> share = term->linear();
    if (share && share->mu > 0.0 && !fall) {
      const double by_mu = by.friction_m_s2 * contact.mass_kg / contact.normal_n;
      term = sim::laws::coulomb().with({std::max(0.0, share->mu - by_mu)});
      by.friction_m_s2 = 0.0;  // one term takes it all
    } else if (share && share->k_n_s_m > 0.0) {
      term = sim::laws::viscous().with({share->k_n_s_m * drag});
    } else if (const double c = quadratic_kg_m(*term, contact); fall && c > 0.0) {
      term = sim::laws::quadratic().with({c * drag});
    }
  }
  const double constant_m_s2 = by.incline_m_s2 + (fall ? by.friction_m_s2 : 0.0);
  body.forces.push_back(sim::laws::constant().with({body.mass_kg * constant_m_s2}));
  return body;
}

double drag_rate_1_s(const sim::Body& body, double v_m_s) {
  const sim::Contact contact = sim::contact_of(body);
  double rate_n_s_m = 0.0;
  for (const auto& term : body.forces) {
    if (const auto share = term->linear()) rate_n_s_m += share->k_n_s_m;
    rate_n_s_m += 2.0 * quadratic_kg_m(*term, contact) * std::abs(v_m_s);
  }
  return rate_n_s_m / body.mass_kg;
}

}  // namespace glidelab::validate
