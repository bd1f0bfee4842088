#include "report/explorer_page.h"

#include <fmt/format.h>

#include "report/explorer_script.h"
#include "report/html.h"

namespace glidelab::report {
namespace {

/// With the digits that a way needs: up to 20, scaled by 2e4 m where k is small.
std::string array_of(const std::vector<double>& values) {
  return fmt::format("[{:.15g}]", fmt::join(values, ","));
}

std::string orbit_json(const validate::Orbit& orbit) {
  std::vector<double> tau, u, way, slope, bend;
  for (const validate::OrbitPoint& point : orbit) {
    tau.push_back(point.tau);
    u.push_back(point.u);
    way.push_back(point.way);
    slope.push_back(point.slope);
    bend.push_back(point.bend);
  }
  return fmt::format("[{},{},{},{},{}]", array_of(tau), array_of(u), array_of(way), array_of(slope), array_of(bend));
}

std::string data_of(const validate::PhaseExplorer& explorer) {
  std::string laws, references;
  for (const validate::LawOrbits& law : explorer.laws) {
    laws += fmt::format("{}{{n:{},rising:{},falling:{},braking:{},free:{}}}", laws.empty() ? "" : ",\n", law.exponent,
                        orbit_json(law.rising), orbit_json(law.falling), orbit_json(law.braking), orbit_json(law.free));
  }
  for (const validate::ReferenceMotion& motion : explorer.references) {
    references += fmt::format("{}{{law:{},k:{:.17g},mu:{:.17g},alpha:{:.17g},v0:{:.17g},t:{},x:{},v:{},a:{}}}",
                              references.empty() ? "" : ",\n", motion.law, motion.drag, motion.mu, motion.alpha_deg,
                              motion.v0_m_s, array_of(motion.t_s), array_of(motion.x_m), array_of(motion.v_m_s),
                              array_of(motion.a_m_s2));
  }
  return fmt::format("const DATA={{g:{:.17g},laws:[{}],references:[{}]}};\n", explorer.gravity_m_s2, laws, references);
}

}  // namespace

Page explorer_page(const validate::PhaseExplorer& explorer) {
  std::string body(kExplorerBody);
  body += "<script>\n'use strict';\n" + data_of(explorer);
  body += kExplorerMotion;
  body += kExplorerWords;
  body += kExplorerView;
  return page("Friction in the phase plane", body + "</script>\n");
}

}  // namespace glidelab::report
