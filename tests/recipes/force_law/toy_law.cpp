/// -c v |v| log(1 + |v| / v_0): the example of docs/extending.md.
#include <cmath>

#include "sim/force/law_list.h"

namespace glidelab::sim {
namespace {

class ToyForce final : public ForceTerm {
 public:
  ToyForce(double c_kg_m, double v_0_m_s) : c_kg_m_(c_kg_m), v_0_m_s_(v_0_m_s) {}
  double force_n(double v_m_s, int direction, const Contact&) const override {
    return -direction * c_kg_m_ * v_m_s * v_m_s * std::log1p(std::abs(v_m_s) / v_0_m_s_);
  }
  double slope_n_s_m(double v_m_s, int direction, const Contact&) const override {
    const double speed = std::abs(v_m_s);
    return -direction * c_kg_m_ * v_m_s * (2.0 * std::log1p(speed / v_0_m_s_) + speed / (v_0_m_s_ + speed));
  }
  std::vector<double> by_parameter(double v_m_s, int direction, const Contact&) const override {
    const double speed = std::abs(v_m_s), square = direction * speed * speed;
    return {-square * std::log1p(speed / v_0_m_s_), c_kg_m_ * square * speed / (v_0_m_s_ * (v_0_m_s_ + speed))};
  }
  double exponent_at_rest() const override { return 3.0; }

 private:
  double c_kg_m_, v_0_m_s_;
};

}  // namespace

const ForceLaw& laws::toy() {
  static const ForceLaw law{
      .id = "toy",
      .force = "-c v abs(v) log(1 + abs(v)/v_0)",
      .parameters = {{.key = "c_kg_m", .range = base::at_least(0.0), .help = "c, the size", .example = 0.7},
                     {.key = "v_0_m_s", .range = base::above(0.0), .help = "v_0, a speed", .example = 0.4}},
      .make = [](std::span<const double> values) { return std::make_shared<ToyForce>(values[0], values[1]); }};
  return law;
}

}  // namespace glidelab::sim
