#include "report/simulation/simulation_report.h"

#include <fmt/format.h>

#include "base/text/csv.h"
#include "report/text/display_text.h"
#include "report/text/json_numbers.h"

namespace glidelab::report {
namespace {

bool is_reversal(const sim::ModeChange& change) {
  return change.from != sim::Mode::stick && change.to != sim::Mode::stick && change.from != change.to;
}

Json changes_json(const std::vector<sim::ModeChange>& changes, bool reversals_only) {
  Json list = Json::array();
  for (const sim::ModeChange& change : changes) {
    if (reversals_only && !is_reversal(change)) continue;
    list.push_back({{"t_s", change.t_s},
                    {"x_m", change.x_m},
                    {"from", sim::name_of(change.from)},
                    {"to", sim::name_of(change.to)}});
  }
  return list;
}

/// "1.1246 stops", "0.6030 turns downhill", "0.2000 starts uphill".
std::string change_words(const sim::ModeChange& change) {
  if (change.to == sim::Mode::stick) return fmt::format("{:.4f} stops", change.t_s);
  return fmt::format("{:.4f} {} {}", change.t_s, change.from == sim::Mode::stick ? "starts" : "turns",
                     change.to == sim::Mode::slide_down ? "downhill" : "uphill");
}

}  // namespace

std::string trajectory_csv(const sim::Trajectory& trajectory) {
  base::CsvWriter table("t_s,x_m,v_m_s,a_m_s2,mode");
  for (const sim::State& state : trajectory.states) {
    table.number(state.t_s).number(state.x_m).number(state.v_m_s).number(state.a_m_s2);
    table.text(sim::name_of(state.mode));
    table.end_row();
  }
  return table.str();
}

std::string simulation_json(const std::vector<SimulatedClip>& clips) {
  Json document{{"format", 1}, {"clips", Json::array()}};
  for (const SimulatedClip& clip : clips) {
    document["clips"].push_back({{"name", clip.name},
                                 {"configuration", clip.configuration},
                                 {"states", clip.trajectory.states.size()},
                                 {"file", clip.file},
                                 {"reversals", changes_json(clip.trajectory.changes, true)},
                                 {"mode_changes", changes_json(clip.trajectory.changes, false)},
                                 {"dissipated_j", clip.trajectory.dissipated_j}});
  }
  return json_text(document);
}

std::string simulation_text(const std::vector<SimulatedClip>& clips) {
  std::vector<std::vector<std::string>> rows = {
      {"clip", "configuration", "states", "from x (m)", "to x (m)", "last v (m/s)", "stops and turns at (s)"}};
  for (const SimulatedClip& clip : clips) {
    std::string changes;
    for (const sim::ModeChange& change : clip.trajectory.changes) {
      changes += (changes.empty() ? "" : ", ") + change_words(change);
    }
    const std::vector<sim::State>& states = clip.trajectory.states;
    rows.push_back({clip.name, clip.configuration, fmt::format("{}", states.size()),
                    fmt::format("{:.4f}", states.front().x_m), fmt::format("{:.4f}", states.back().x_m),
                    fmt::format("{:+.4f}", states.back().v_m_s), changes});
  }
  return text_table(rows, 2);
}

}  // namespace glidelab::report
