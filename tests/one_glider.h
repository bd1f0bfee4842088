/// The part of a scenario that says what moves: one glider of 0.335 kg under viscous friction (and Coulomb's, where mu
/// is not 0), launched once or more often. What films it differs from test to test and stands there.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace glidelab::tests {

struct Launch {
  std::string name;
  double x0_m = 0.0;
  double v0_m_s = 0.0;  ///< positive downhill
  double duration_s = 0.0;
};

inline std::string one_glider(double incline_deg, double k_over_m_1_s, double mu, const std::vector<Launch>& launches) {
  std::string text = fmt::format(
      "[[configuration]]\nname = \"m1\"\nmass_kg = 0.335\nincline_deg = {}\n"
      "[[configuration.force]]\nlaw = \"viscous\"\nk_over_m_1_s = {}\n",
      incline_deg, k_over_m_1_s);
  if (mu != 0.0) text += fmt::format("[[configuration.force]]\nlaw = \"coulomb\"\nmu = {}\n", mu);
  for (const Launch& launch : launches) {
    text += fmt::format(
        "[[configuration.clip]]\nname = \"{}\"\nlaunched = \"{}\"\nx0_m = {}\nv0_m_s = {}\nduration_s = {}\n",
        launch.name, launch.v0_m_s < 0.0 ? "up" : "down", launch.x0_m, launch.v0_m_s, launch.duration_s);
  }
  return text;
}

}  // namespace glidelab::tests
