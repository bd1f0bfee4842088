/// -d mu N (1 + (s - 1) exp(-(v / v_s)²)), s >= 1: friction that falls from s mu N at rest to mu N well above v_s. At
/// rest it holds s mu N.
#include <cmath>

#include "sim/force/law_list.h"

namespace glidelab::sim {
namespace {

class StribeckForce final : public ForceTerm {
 public:
  StribeckForce(double mu, double s, double v_s_m_s) : mu_(mu), s_(s), v_s_m_s_(v_s_m_s) {}
  double force_n(double v_m_s, int direction, const Contact& contact) const override {
    const double u = v_m_s / v_s_m_s_;
    return -direction * mu_ * contact.normal_n * (1.0 + (s_ - 1.0) * std::exp(-u * u));
  }
  double slope_n_s_m(double v_m_s, int direction, const Contact& contact) const override {
    const double u = v_m_s / v_s_m_s_;
    return direction * mu_ * contact.normal_n * (s_ - 1.0) * std::exp(-u * u) * 2.0 * u / v_s_m_s_;
  }
  std::vector<double> by_parameter(double v_m_s, int direction, const Contact& contact) const override {
    const double u = v_m_s / v_s_m_s_, fall = std::exp(-u * u), friction_n = direction * mu_ * contact.normal_n;
    return {-direction * contact.normal_n * (1.0 + (s_ - 1.0) * fall), -friction_n * fall,
            -friction_n * (s_ - 1.0) * fall * 2.0 * u * u / v_s_m_s_};
  }
  double holding_n(const Contact& contact) const override { return s_ * mu_ * contact.normal_n; }

 private:
  double mu_, s_, v_s_m_s_;
};

}  // namespace

const ForceLaw& laws::stribeck() {
  static const ForceLaw law{.id = "stribeck",
                            .force = "-d mu N (1 + (s-1) exp(-(v/v_s)²))",
                            .holds = "s mu N",
                            .parameters = {{.key = "mu",
                                            .range = base::between(0.0, 10.0),
                                            .help = "friction coefficient well above v_s",
                                            .example = 0.02},
                                           {.key = "s",
                                            .range = base::between(1.0, 100.0),
                                            .help = "how many times mu at rest",
                                            .example = 2.5},
                                           {.key = "v_s_m_s",
                                            .range = base::above(0.0),
                                            .help = "v_s, the speed by which the friction has fallen",
                                            .example = 0.15}},
                            .make = [](std::span<const double> values) {
                              return std::make_shared<StribeckForce>(values[0], values[1], values[2]);
                            }};
  return law;
}

}  // namespace glidelab::sim
