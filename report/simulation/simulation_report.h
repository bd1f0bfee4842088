/// The output of `glidelab simulate` on true motions: a table for each clip's states, JSON, and text for a terminal.
#pragma once

#include <string>
#include <vector>

#include "sim/motion/simulate.h"

namespace glidelab::report {

struct SimulatedClip {
  std::string name;
  std::string configuration;
  std::string file;  ///< of the table of its states
  sim::Trajectory trajectory;
};

/// `t_s,x_m,v_m_s,a_m_s2,mode`, a row for each state.
std::string trajectory_csv(const sim::Trajectory& trajectory);

/// The document, with a newline at its end: for each clip its name, the number of its states, its file, its reversals
/// and changes of mode, and the energy dissipated by friction.
std::string simulation_json(const std::vector<SimulatedClip>& clips);

/// A row for each clip, which has at least one state.
std::string simulation_text(const std::vector<SimulatedClip>& clips);

}  // namespace glidelab::report
