/// -K v |v / (1 m/s)|^(n-1), n > 0. For n < 1 the slope at v = 0 is minus infinity, and the term alone stops a glider
/// in finite time.
#include <cmath>

#include "sim/force/law_list.h"

namespace glidelab::sim {
namespace {

class PowerLawForce final : public ForceTerm {
 public:
  PowerLawForce(double k_n_s_m, double n) : k_n_s_m_(k_n_s_m), n_(n) {}
  double force_n(double v_m_s, int, const Contact&) const override {
    return -k_n_s_m_ * std::copysign(std::pow(std::abs(v_m_s), n_), v_m_s);
  }
  double slope_n_s_m(double v_m_s, int, const Contact&) const override {
    return k_n_s_m_ == 0.0 ? 0.0 : -k_n_s_m_ * n_ * std::pow(std::abs(v_m_s), n_ - 1.0);
  }
  std::vector<double> by_parameter(double v_m_s, int, const Contact&) const override {
    if (v_m_s == 0.0) return {0.0, 0.0};
    const double power = std::copysign(std::pow(std::abs(v_m_s), n_), v_m_s);
    return {-power, -k_n_s_m_ * power * std::log(std::abs(v_m_s))};
  }
  double exponent_at_rest() const override { return k_n_s_m_ == 0.0 ? 1.0 : n_; }

 private:
  double k_n_s_m_, n_;
};

}  // namespace

const ForceLaw& laws::power_law() {
  static const ForceLaw law{
      .id = "power_law",
      .force = "-K v abs(v / (1 m/s))^(n-1)",
      .parameters =
          {{.key = "k_n_s_m", .range = base::at_least(0.0), .help = "K, the force per speed at 1 m/s", .example = 0.5},
           {.key = "n", .range = base::between(0.1, 5.0), .help = "exponent of the speed", .example = 1.5}},
      .make = [](std::span<const double> values) { return std::make_shared<PowerLawForce>(values[0], values[1]); }};
  return law;
}

}  // namespace glidelab::sim
