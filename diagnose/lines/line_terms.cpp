#include "diagnose/lines/line_terms.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

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
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(count(lines));
  Eigen::VectorXd per_mass = zero, square = zero, inertia_k = zero, inertia_a = zero;
  for (Eigen::Index i = 0; i < count(lines); ++i) {
    const TableLine& line = at(lines, i);
    per_mass[i] = -line.direction / line.mass_kg;
    square[i] = -line.direction * line.k_over_m_1_s * line.k_over_m_1_s;
    inertia_k[i] = -1.0 / line.mass_kg;
    inertia_a[i] = -line.a0_m_s2 / line.mass_kg;
  }
  std::vector<LineTerm> terms = {
      {"load_independent_friction", "force_n", "dynamics", "a dry friction that does not depend on the load", zero,
       per_mass, false, 1.0},
      {"smoothing_bias", "intercept_s2_m_s2", "analysis",
       "the smoothing's own bias, which bends a(v) near v = 0 as (K/m)²", zero, square, false, 1.0},
      {"rotational_inertia", "mass_kg", "dynamics", "inertia that is not in the weighed mass, such as wheels'",
       inertia_k, inertia_a, false, 0.3}};
  std::erase_if(terms, [&](const LineTerm& term) { return contains(without, term.id); });
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
  std::vector<std::string> ids = {"eddy_rolloff", "power_law_drag"};
  std::erase_if(ids, [&](const std::string& id) { return contains(without, id); });
  return ids;
}

}  // namespace glidelab::diagnose
