/// The same force at every speed and at rest: a hanging weight, wind. Positive downhill.
#include "sim/force/law_list.h"

namespace glidelab::sim {
namespace {

class ConstantForce final : public ForceTerm {
 public:
  explicit ConstantForce(double force_n) : force_n_(force_n) {}
  double force_n(double, int, const Contact&) const override { return force_n_; }
  double slope_n_s_m(double, int, const Contact&) const override { return 0.0; }
  std::vector<double> by_parameter(double, int, const Contact&) const override { return {1.0}; }

 private:
  double force_n_;
};

}  // namespace

const ForceLaw& laws::constant() {
  static const ForceLaw law{
      .id = "constant",
      .force = "F",
      .parameters = {{.key = "force_n", .range = base::any_number(), .help = "F, positive downhill", .example = -0.2}},
      .make = [](std::span<const double> values) { return std::make_shared<ConstantForce>(values[0]); }};
  return law;
}

}  // namespace glidelab::sim
