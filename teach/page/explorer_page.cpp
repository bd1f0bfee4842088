#include "teach/page/explorer_page.h"

#include <fmt/format.h>

#include "report/html/html.h"
#include "teach/page/page_texts.h"

namespace glidelab::teach {
namespace {

/// With the digits that a distance needs: up to 20, scaled by 2e4 m where k is small.
std::string array_of(const std::vector<double>& values) {
  return fmt::format("[{:.15g}]", fmt::join(values, ","));
}

std::string orbit_json(const Orbit& orbit) {
  std::vector<double> tau, u, way, slope, bend;
  for (const OrbitPoint& point : orbit) {
    tau.push_back(point.tau);
    u.push_back(point.u);
    way.push_back(point.way);
    slope.push_back(point.slope);
    bend.push_back(point.bend);
  }
  return fmt::format("[{},{},{},{},{}]", array_of(tau), array_of(u), array_of(way), array_of(slope), array_of(bend));
}

std::string data_of(const PhaseExplorer& explorer) {
  std::string laws, references;
  for (const LawOrbits& law : explorer.laws) {
    laws += fmt::format("{}{{n:{},rising:{},falling:{},braking:{},free:{}}}", laws.empty() ? "" : ",\n", law.exponent,
                        orbit_json(law.rising), orbit_json(law.falling), orbit_json(law.braking), orbit_json(law.free));
  }
  for (const ReferenceMotion& motion : explorer.references) {
    references += fmt::format("{}{{law:{},k:{:.17g},mu:{:.17g},alpha:{:.17g},v0:{:.17g},t:{},x:{},v:{},a:{}}}",
                              references.empty() ? "" : ",\n", motion.law, motion.drag, motion.mu, motion.alpha_deg,
                              motion.v0_m_s, array_of(motion.t_s), array_of(motion.x_m), array_of(motion.v_m_s),
                              array_of(motion.a_m_s2));
  }
  return fmt::format("const DATA={{g:{:.17g},laws:[{}],references:[{}]}};\n", explorer.gravity_m_s2, laws, references);
}

}  // namespace

report::Page explorer_page(const PhaseExplorer& explorer) {
  std::string body = fmt::format("<style>\n{}</style>\n{}", kExplorerStyle, kExplorerBody);
  body += "<script>\n'use strict';\n" + data_of(explorer);
  for (const std::string_view script : {kExplorerMotion, kExplorerWords, kExplorerView})
    body.append("\n").append(script);
  return report::page("Friction in the phase plane", body + "</script>\n");
}

}  // namespace glidelab::teach
