#include <cmath>
#include <vector>

#include "sim/force/law_list.h"
#include "tests/catch.h"
#include "tests/sim/bodies.h"

using namespace glidelab;

TEST_CASE("a scenario names the toy law, and its force at v_0 is c v_0² log 2") {
  const base::TomlFile file =
      base::TomlFile::parse("[[force]]\nlaw = \"toy\"\nc_kg_m = 0.5\nv_0_m_s = 0.3\n", "s.toml");
  const auto term = sim::read_force(file.root().tables("force").front(), 0.4);
  file.finish();
  CHECK(term->force_n(0.3, +1, {}) == Approx(-0.5 * 0.09 * std::log(2.0)).epsilon(1e-14));
  CHECK(term->force_n(-0.3, -1, {}) == Approx(0.5 * 0.09 * std::log(2.0)).epsilon(1e-14));
}

TEST_CASE("far below v_0 the toy law brakes by the cube of the speed, 1/v² growing by 2 c t / (m v_0)") {
  // log(1 + u) = u - u²/2: the motion differs by a part of v / v_0 = 1e-6.
  const double c_kg_m = 1e6, v_0_m_s = 1e6, mass_kg = 0.4, t_s = 0.8;
  const sim::Body body = tests::body(mass_kg, 0.0, sim::laws::toy().with({c_kg_m, v_0_m_s}));
  const sim::Trajectory motion = sim::simulate(body, 0.0, 1.0, std::vector<double>{0.0, t_s});
  CHECK(motion.states.back().v_m_s == Approx(1.0 / std::sqrt(1.0 + 2.0 * t_s / mass_kg)).epsilon(1e-6));
}
