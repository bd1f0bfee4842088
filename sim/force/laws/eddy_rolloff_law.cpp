/// -K v / (1 + (v / v_c)²): an eddy-current brake, strongest at v_c and weaker above it.
#include "sim/force/law_list.h"

namespace glidelab::sim {
namespace {

class EddyRolloffForce final : public ForceTerm {
 public:
  EddyRolloffForce(double k_n_s_m, double v_c_m_s) : k_n_s_m_(k_n_s_m), v_c_m_s_(v_c_m_s) {}
  double force_n(double v_m_s, int, const Contact&) const override {
    const double u = v_m_s / v_c_m_s_;
    return -k_n_s_m_ * v_m_s / (1.0 + u * u);
  }
  double slope_n_s_m(double v_m_s, int, const Contact&) const override {
    const double u2 = v_m_s / v_c_m_s_ * (v_m_s / v_c_m_s_);
    return -k_n_s_m_ * (1.0 - u2) / ((1.0 + u2) * (1.0 + u2));
  }
  std::vector<double> by_parameter(double v_m_s, int, const Contact&) const override {
    const double u2 = v_m_s / v_c_m_s_ * (v_m_s / v_c_m_s_);
    return {-v_m_s / (1.0 + u2), -k_n_s_m_ * v_m_s * 2.0 * u2 / v_c_m_s_ / ((1.0 + u2) * (1.0 + u2))};
  }

 private:
  double k_n_s_m_, v_c_m_s_;
};

}  // namespace

const ForceLaw& laws::eddy_rolloff() {
  static const ForceLaw law{
      .id = "eddy_rolloff",
      .force = "-K v / (1 + (v/v_c)²)",
      .parameters = {{.key = "k_n_s_m",
                      .range = base::at_least(0.0),
                      .help = "K, the force per speed well below v_c",
                      .example = 1.1,
                      .over_mass = "k_over_m_1_s"},
                     {.key = "v_c_m_s",
                      .range = base::above(0.0),
                      .help = "v_c, the speed of the strongest braking",
                      .example = 0.4}},
      .make = [](std::span<const double> values) { return std::make_shared<EddyRolloffForce>(values[0], values[1]); }};
  return law;
}

}  // namespace glidelab::sim
