#include <algorithm>
#include <cmath>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/fit_neighbourhood.h"
#include "diagnose/fit/nominal_fit.h"
#include "diagnose/scan/effect_scan.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/weigh/hypothesis.h"
#include "tests/catch.h"
#include "tests/diagnose/made_motions.h"

using namespace glidelab;

namespace {

std::size_t place_friction() {
  return diagnose::effect_index(diagnose::ids::place_friction);
}

/// One launch on the level that viscous drag alone slows down, and its nominal fit.
struct Rolling {
  Rolling() {
    tests::MadeGlider glider;
    glider.mu = 0.0;
    made = tests::made_experiment({{0.4, 0.0, 0.0, 1.0}}, {}, 3, 1e-4, 150, 100.0, 0.05, 0.0, glider);
    set = diagnose::track_set(made.results, made.setups, true);
    nominal = diagnose::fit_nominal(set);
  }
  /// A fit of friction along x around a friction of this size.
  diagnose::MotionFit fit_with_friction(double mu) const {
    diagnose::FitPoint at = diagnose::with_effect(set, nominal, place_friction(), {}, {});
    const diagnose::ParameterLayout layout(set, {place_friction()});
    const auto& globals = layout.globals();
    for (std::size_t g = 0; g < globals.size(); ++g) {
      if (globals[g].kind == diagnose::ParameterLayout::Global::Kind::mu) at.global[static_cast<Eigen::Index>(g)] = mu;
    }
    return diagnose::linearise_at(set, {place_friction()}, at);
  }
  tests::MadeExperiment made;
  diagnose::TrackSet set;
  diagnose::MotionFit nominal;
};

}  // namespace

TEST_CASE("friction that varies along x has its price where the fit has friction, however little the nominal one has") {
  const Rolling rolling;
  const double price = diagnose::price_of_spread(rolling.fit_with_friction(0.05), place_friction());
  // One size that is seen well costs at least log(1 + 2²)/2, half of the prior's decades of it more.
  CHECK(price < -2.0);
  CHECK(std::isfinite(price));
  // Without friction there is nothing to vary.
  CHECK(diagnose::price_of_spread(rolling.fit_with_friction(0.0), place_friction()) == Approx(0.0).margin(1e-6));
  // What has one size is priced by its scan.
  CHECK(diagnose::price_of_spread(rolling.nominal, diagnose::effect_index(diagnose::ids::quadratic_drag)) == 0.0);
}
