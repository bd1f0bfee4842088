#include <algorithm>
#include <cmath>
#include <string>

#include "base/errors.h"
#include "base/toml/strict_toml.h"
#include "sim/motion/motion_scenario.h"
#include "sim/motion/simulate.h"
#include "test_paths.h"
#include "tests/catch.h"

using namespace glidelab;

namespace {

// The motions only: the other sections ([camera], …) are render's, and unknown here.
sim::MotionScenario read(const std::string& name) {
  const base::TomlFile file =
      base::TomlFile::load(std::string(tests::kSourceDir) + "/scenarios/paper/" + name + ".toml");
  sim::MotionScenario scenario = sim::read_motions(file.root());
  try {
    file.finish();
  } catch (const base::InputError& error) {
    for (const base::Issue& issue : error.issues()) {
      INFO(base::describe(issue));
      CHECK(issue.found == "an unknown key");
      CHECK(issue.key.find("configuration") == std::string::npos);
    }
  }
  return scenario;
}

std::vector<double> frame_times(double duration_s) {
  std::vector<double> times_s;
  for (int frame = 0; frame / 200.0 <= duration_s; ++frame) times_s.push_back(frame / 200.0);
  return times_s;
}

}  // namespace

TEST_CASE("the paper's twelve motions stay in a field of 1.6 m and do what section 3 says") {
  std::size_t motions = 0;
  for (const std::string name : {"level", "inclined"}) {
    const sim::MotionScenario scenario = read(name);
    REQUIRE(scenario.configurations.size() == 3);
    for (const sim::ConfigurationSetup& setup : scenario.configurations) {
      for (const sim::MotionSetup& motion : setup.motions) {
        INFO(name << " " << motion.name);
        ++motions;
        const sim::Trajectory trajectory =
            sim::simulate(setup.body, motion.x0_m, motion.v0_m_s, frame_times(motion.duration_s));
        for (const sim::State& state : trajectory.states) {
          CHECK(std::abs(state.x_m) < 0.7);
          CHECK(state.mode != sim::Mode::stick);
        }
        const sim::State& last = trajectory.states.back();
        if (name == "level") {
          CHECK(trajectory.changes.empty());   // one direction only,
          CHECK(std::abs(last.v_m_s) < 0.03);  // and nearly stopped
          CHECK(std::abs(motion.v0_m_s) > 0.9);
        } else if (motion.launched == sim::Launched::up) {
          REQUIRE(trajectory.changes.size() == 1);
          CHECK(trajectory.changes[0].to == sim::Mode::slide_down);
          CHECK(last.v_m_s > 0.2);
          CHECK(last.a_m_s2 > 0.0);  // still below v_lim
        } else {
          CHECK(trajectory.changes.empty());
          CHECK(last.a_m_s2 < 0.0);  // still above v_lim
        }
      }
    }
  }
  CHECK(motions == 12);
}
