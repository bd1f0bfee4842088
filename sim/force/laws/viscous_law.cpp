/// -K v: the eddy-current brake at low speed, and air drag at low Reynolds number.
#include "sim/force/law_list.h"

namespace glidelab::sim {
namespace {

class ViscousForce final : public ForceTerm {
 public:
  explicit ViscousForce(double k_n_s_m) : k_n_s_m_(k_n_s_m) {}
  double force_n(double v_m_s, int, const Contact&) const override { return -k_n_s_m_ * v_m_s; }
  double slope_n_s_m(double, int, const Contact&) const override { return -k_n_s_m_; }
  std::vector<double> by_parameter(double v_m_s, int, const Contact&) const override { return {-v_m_s}; }
  std::optional<LinearShare> linear() const override { return LinearShare{.k_n_s_m = k_n_s_m_}; }

 private:
  double k_n_s_m_;
};

}  // namespace

const ForceLaw& laws::viscous() {
  static const ForceLaw law{
      .id = "viscous",
      .force = "-K v",
      .parameters = {{.key = "k_n_s_m",
                      .range = base::at_least(0.0),
                      .help = "K, the force per speed",
                      .example = 0.927,
                      .over_mass = "k_over_m_1_s"}},
      .make = [](std::span<const double> values) { return std::make_shared<ViscousForce>(values[0]); }};
  return law;
}

}  // namespace glidelab::sim
