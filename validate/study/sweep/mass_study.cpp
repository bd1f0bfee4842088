#include "validate/study/sweep/mass_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "base/text/number_text.h"
#include "validate/study/coverage/naive_lines.h"
#include "validate/study/sweep/sweep_groups.h"

namespace glidelab::validate {
namespace {

const Axis* axis_of_masses(const Sweep& sweep) {
  for (const Axis& axis : sweep.axes) {
    const bool masses = axis.choices.empty() && std::all_of(axis.keys.begin(), axis.keys.end(),
                                                            [](const auto& key) { return key.ends_with("mass_kg"); });
    if (masses && !axis.source.drawn()) return &axis;
  }
  return nullptr;
}

std::string text_of(SqlStatement& rows, int column) {
  const auto number = rows.maybe_number(column);
  if (number && *number != 0.0) return base::number_text(*number);
  const std::string text = rows.text(column);  // a word (which is 0 as a number), or 0
  return text == "0.0" ? "0" : text;
}

/// Key of a row: configuration, values of the other axes, bandwidth (s).
using MassRows = std::map<std::tuple<std::string, std::string, double>, MassRow>;

/// For each configuration, mass and combination of the other axes: mean and mean square of mu, their number, the truth
/// and R². A run has one mu per configuration, and an R² for each of its clips, of which the smallest is taken.
std::string query_of(const Axis& masses, const std::vector<const Axis*>& others, std::size_t clips) {
  std::string columns;
  for (const Axis* other : others) columns += ", r." + sql_name(other->name);
  std::string marks;
  for (std::size_t i = 0; i < clips; i += 2) {
    marks += fmt::format("{}(?{}, ?{})", i == 0 ? "" : ", ", i + 2, i + 3);
  }
  return fmt::format(
      "WITH clip_of(clip, configuration) AS (VALUES {2}) SELECT s.configuration, r.{0}, avg(s.value), avg(s.value * "
      "s.value), count(s.value), max(s.truth), avg("
      "(SELECT min(min(coalesce(c.r2_up, 1), coalesce(c.r2_down, 1))) FROM clip c JOIN clip_of k ON k.clip = c.clip "
      "WHERE c.run = s.run AND c.estimator = s.estimator AND k.configuration = s.configuration)){1} FROM result s "
      "JOIN run r ON r.run = s.run WHERE s.quantity = 'mu' AND s.estimator = ?1 "
      "AND s.value IS NOT NULL AND s.truth IS NOT NULL GROUP BY s.configuration, r.{0}{1} ORDER BY 2",
      sql_name(masses.name), columns, marks);
}

MassPoint point_of(const SqlStatement& row) {
  MassPoint point;
  point.mass_kg = row.number(1);
  point.mu = row.number(2);
  const auto n = static_cast<double>(row.integer(4));
  const double variance = row.number(3) - point.mu * point.mu;
  constexpr double kRounding = 1e-12;  // of squares summed in double precision: exact replicates are equal
  if (n > 1.0 && variance > kRounding * point.mu * point.mu) point.se = std::sqrt(variance / (n - 1.0));
  point.r2 = row.number(6);
  return point;
}

/// Puts the result of the query into the rows of the bandwidth.
void take_points(SqlStatement& select, const std::vector<const Axis*>& others, double bandwidth_s, MassRows& rows) {
  while (select.step()) {
    std::string with;
    for (std::size_t i = 0; i < others.size(); ++i) {
      with += fmt::format("{}{} = {}", i == 0 ? "" : ", ", others[i]->name, text_of(select, 7 + static_cast<int>(i)));
    }
    MassRow& row = rows[{select.text(0), with, bandwidth_s}];
    row.configuration = select.text(0);
    row.others = with;
    row.bandwidth_s = bandwidth_s;
    row.truth = select.number(5);
    row.masses.push_back(point_of(select));
  }
}

/// Answers to a published fall, one for each combination of the other axes.
std::vector<FallAnswer> answers_of(const PublishedFall& published, const std::vector<MassRow>& rows) {
  std::map<std::string, std::vector<MassRow>> by_others;
  for (const MassRow& row : rows) {
    if (row.configuration == published.configuration) by_others[row.others].push_back(row);
  }
  std::vector<FallAnswer> answers;
  for (const auto& [with, of] : by_others) answers.push_back(answer_of(published, of));
  return answers;
}

/// Interpolates between two rows at the fraction `part`.
FallAt between(const MassRow& a, const MassRow& b, double part) {
  FallAt at;
  at.bandwidth_s = a.bandwidth_s + part * (b.bandwidth_s - a.bandwidth_s);
  at.fall = a.fall() + part * (b.fall() - a.fall());
  at.fall_se = std::hypot((1.0 - part) * a.fall_se(), part * b.fall_se());
  at.r2 = 1.0 - std::exp((1.0 - part) * std::log(1.0 - a.r2()) + part * std::log(1.0 - b.r2()));
  return at;
}

}  // namespace

double MassRow::fall_se() const {
  return std::hypot(masses.front().se, masses.back().se);
}

double MassRow::r2() const {
  double least = 1.0;
  for (const MassPoint& point : masses) least = std::min(least, point.r2);
  return least;
}

FallAnswer answer_of(const PublishedFall& published, const std::vector<MassRow>& rows) {
  FallAnswer answer;
  answer.published = published;
  answer.others = rows.back().others;
  answer.widest = rows.back();
  const double wanted = published.mu_lightest - published.mu_heaviest;
  for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
    const MassRow &a = rows[i], &b = rows[i + 1];
    if (!answer.whole && a.fall() < wanted && b.fall() >= wanted) {
      answer.whole = between(a, b, (wanted - a.fall()) / (b.fall() - a.fall()));
    }
    if (a.r2() >= published.r2 && b.r2() < published.r2 && a.r2() < 1.0) {  // the widest at which R² comes back
      const double from = std::log(1.0 - a.r2()), to = std::log(1.0 - b.r2());
      answer.at_r2 = between(a, b, (std::log(1.0 - published.r2) - from) / (to - from));
    }
  }
  return answer;
}

MassStudy study_masses(const Sweep& sweep, Database& database) {
  MassStudy study;
  const Axis* const masses = axis_of_masses(sweep);
  if (masses == nullptr) return study;
  std::vector<const Axis*> others;
  for (const Axis& axis : sweep.axes) {
    if (&axis != masses) others.push_back(&axis);
  }
  const std::vector<std::string> clips = clips_and_configurations(sweep, database);
  if (clips.empty()) return study;
  MassRows rows;
  for (const Analysis& analysis : sweep.analyses) {
    if (analysis.estimator != kAllPoints) continue;
    SqlStatement select = database.prepare(query_of(*masses, others, clips.size()));
    select.bind(1, std::string_view(analysis.name()));
    for (std::size_t i = 0; i < clips.size(); ++i) select.bind(2 + static_cast<int>(i), std::string_view(clips[i]));
    take_points(select, others, *analysis.bandwidth_s, rows);
  }
  for (auto& [key, row] : rows) {
    if (row.masses.size() >= 2) study.rows.push_back(std::move(row));
  }
  for (const PublishedFall& published : sweep.published_falls) {
    for (FallAnswer& answer : answers_of(published, study.rows)) study.answers.push_back(std::move(answer));
  }
  return study;
}

}  // namespace glidelab::validate
