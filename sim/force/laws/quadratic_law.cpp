/// -c v |v|: air drag at high Reynolds number.
#include "sim/force/law_list.h"

namespace glidelab::sim {
namespace {

class QuadraticForce final : public ForceTerm {
 public:
  explicit QuadraticForce(double c_kg_m) : c_kg_m_(c_kg_m) {}
  // d v² rather than v |v|: the same on the side that counts, and smooth beyond v = 0.
  double force_n(double v_m_s, int direction, const Contact&) const override {
    return -direction * c_kg_m_ * v_m_s * v_m_s;
  }
  double slope_n_s_m(double v_m_s, int direction, const Contact&) const override {
    return -2.0 * direction * c_kg_m_ * v_m_s;
  }
  std::vector<double> by_parameter(double v_m_s, int direction, const Contact&) const override {
    return {-direction * v_m_s * v_m_s};
  }
  double exponent_at_rest() const override { return 2.0; }

 private:
  double c_kg_m_;
};

}  // namespace

const ForceLaw& laws::quadratic() {
  static const ForceLaw law{
      .id = "quadratic",
      .force = "-c v abs(v)",
      .parameters =
          {{.key = "c_kg_m", .range = base::at_least(0.0), .help = "c, the force per squared speed", .example = 0.7}},
      .make = [](std::span<const double> values) { return std::make_shared<QuadraticForce>(values[0]); }};
  return law;
}

}  // namespace glidelab::sim
