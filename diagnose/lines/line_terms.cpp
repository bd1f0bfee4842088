#include "diagnose/lines/line_terms.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "diagnose/effects/effect_library.h"

namespace glidelab::diagnose {
namespace {

constexpr double kUnlimited = 1e9;  // a size that no table reaches

Eigen::Index count(const std::vector<TableLine>& lines) {
  return static_cast<Eigen::Index>(lines.size());
}

const TableLine& at(const std::vector<TableLine>& lines, Eigen::Index i) {
  return lines[static_cast<std::size_t>(i)];
}

bool contains(const std::vector<std::string>& ids, const std::string& id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

/// Mass and inclination by which lines are put together; a member that does not matter is 0.
using Cell = std::pair<double, double>;

/// A friction, or a drag, of each cell by itself but for the first, which is mu or K.
std::vector<LineTerm> of_each(const std::vector<TableLine>& lines, const std::vector<Cell>& cells, bool friction) {
  std::map<Cell, std::size_t> seen;
  std::vector<LineTerm> terms;
  for (Eigen::Index i = 0; i < count(lines); ++i) {
    const auto [found, first] = seen.emplace(cells[static_cast<std::size_t>(i)], terms.size());
    if (first) {
      terms.push_back({"", friction ? "friction" : "drag", "dynamics", "", Eigen::VectorXd::Zero(count(lines)),
                       Eigen::VectorXd::Zero(count(lines)), true, kUnlimited});
    }
    LineTerm& term = terms[found->second];
    if (friction) term.of_a0[i] = -at(lines, i).direction;
    if (!friction) term.of_log_k[i] = 1.0;
  }
  terms.erase(terms.begin());
  return terms;
}

}  // namespace

std::vector<LineTerm> named_terms(const std::vector<TableLine>& lines, const std::vector<std::string>& without) {
  if (different(lines, &TableLine::mass_kg).size() < 2) return {};
  std::vector<LineTerm> terms;
  for (const EffectInfo& effect : all_effects()) {
    if (effect.lines.change == nullptr || contains(without, std::string(effect.id))) continue;
    LineTerm term{std::string(effect.id),    std::string(effect.lines.key), std::string(to_text(effect.stage)),
                  std::string(effect.words), Eigen::VectorXd(count(lines)), Eigen::VectorXd(count(lines)),
                  effect.both_signs,         effect.lines.largest};
    for (Eigen::Index i = 0; i < count(lines); ++i) {
      const TableLine& line = at(lines, i);
      const LineChange change =
          effect.lines.change({line.mass_kg, static_cast<double>(line.direction), line.a0_m_s2, line.k_over_m_1_s});
      term.of_log_k[i] = change.of_log_k;
      term.of_a0[i] = change.of_a0_m_s2;
    }
    terms.push_back(std::move(term));
  }
  // What moves intercepts alone comes first.
  std::stable_partition(terms.begin(), terms.end(), [](const LineTerm& term) { return term.of_log_k.isZero(0.0); });
  return terms;
}

std::vector<LineFamily> unnamed_families(const std::vector<TableLine>& lines) {
  std::vector<LineFamily> families;
  const auto add = [&](UnnamedInLines::Over over, const auto& cell_of) {
    std::vector<Cell> cells;
    for (const TableLine& line : lines) cells.push_back(cell_of(line));
    for (const bool friction : {true, false}) {
      const auto what = friction ? UnnamedInLines::What::friction : UnnamedInLines::What::drag;
      families.push_back({{what, over}, 0.5, of_each(lines, cells, friction)});
    }
  };
  const bool masses = different(lines, &TableLine::mass_kg).size() > 1;
  const bool setups = different(lines, &TableLine::incline_deg).size() > 1;
  if (masses) add(UnnamedInLines::Over::mass, [](const TableLine& l) { return Cell{l.mass_kg, 0.0}; });
  if (setups) add(UnnamedInLines::Over::set_up, [](const TableLine& l) { return Cell{0.0, l.incline_deg}; });
  if (masses && setups) {
    add(UnnamedInLines::Over::mass_and_set_up, [](const TableLine& l) { return Cell{l.mass_kg, l.incline_deg}; });
  }
  LineTerm ways{
      "",   "drag",    "dynamics", "", Eigen::VectorXd::Zero(count(lines)), Eigen::VectorXd::Zero(count(lines)),
      true, kUnlimited};
  for (Eigen::Index i = 0; i < count(lines); ++i) ways.of_log_k[i] = at(lines, i).direction;
  families.push_back({{UnnamedInLines::What::drag, UnnamedInLines::Over::direction}, 1.0, {ways}});
  std::set<UnnamedInLines::Over> variables;
  for (const LineFamily& family : families) variables.insert(family.of.over);
  for (LineFamily& family : families) family.share /= static_cast<double>(variables.size());
  return families;
}

std::vector<std::string> alike_friction_force(const std::vector<std::string>& without) {
  std::vector<std::string> alike;
  for (const EffectInfo& effect : all_effects()) {
    if (effect.lines.same_as == ids::load_independent_friction) alike.emplace_back(effect.id);
  }
  std::erase_if(alike, [&](const std::string& id) { return contains(without, id); });
  return alike;
}

}  // namespace glidelab::diagnose
