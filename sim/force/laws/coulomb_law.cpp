/// -d mu N while sliding, up to mu_static N at rest; mu_static >= mu.
#include "sim/force/law_list.h"

namespace glidelab::sim {
namespace {

class CoulombForce final : public ForceTerm {
 public:
  CoulombForce(double mu, double mu_static) : mu_(mu), mu_static_(mu_static) {}
  double force_n(double, int direction, const Contact& contact) const override {
    return -direction * mu_ * contact.normal_n;
  }
  double slope_n_s_m(double, int, const Contact&) const override { return 0.0; }
  std::vector<double> by_parameter(double, int direction, const Contact& contact) const override {
    return {-direction * contact.normal_n, 0.0};
  }
  double holding_n(const Contact& contact) const override { return mu_static_ * contact.normal_n; }
  std::optional<LinearShare> linear() const override { return LinearShare{.mu = mu_}; }

 private:
  double mu_, mu_static_;
};

}  // namespace

const ForceLaw& laws::coulomb() {
  static const ForceLaw law{
      .id = "coulomb",
      .force = "-d mu N",
      .holds = "mu_static N",
      .parameters = {{.key = "mu",
                      .range = base::between(0.0, 10.0),
                      .help = "friction coefficient while sliding",
                      .example = 0.0071},
                     {.key = "mu_static",
                      .range = base::between(0.0, 10.0),
                      .help = "friction coefficient at rest",
                      .example = 0.009,
                      .not_below = "mu"}},
      .make = [](std::span<const double> values) { return std::make_shared<CoulombForce>(values[0], values[1]); }};
  return law;
}

}  // namespace glidelab::sim
