#include "diagnose/lines/line_weighing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/math/dense.h"

namespace glidelab::diagnose {
namespace {

constexpr double kPriorNone = 0.3, kPriorOne = 0.4, kPriorTwo = 0.1;
constexpr double kUnnamedBeside = 0.25;  // odds of something without a name: 0.2 to 0.8

Eigen::VectorXd column(const LineTerm& term, double sd_log_k, double sd_a0) {
  Eigen::VectorXd both(2 * term.of_a0.size());
  both << term.of_log_k / sd_log_k, term.of_a0 / sd_a0;
  return both;
}

/// What the nominal model and the terms cannot take up of the column.
Eigen::VectorXd beside(const LineData& data, const std::vector<LineTerm>& terms, const Eigen::VectorXd& of,
                       double sd_log_k, double sd_a0) {
  const auto n = data.a0.size();
  const auto pk = data.base_log_k.cols(), pa = data.base_a0.cols();
  Eigen::MatrixXd x = Eigen::MatrixXd::Zero(2 * n, pk + pa + static_cast<Eigen::Index>(terms.size()));
  x.block(0, 0, n, pk) = data.base_log_k / sd_log_k;
  x.block(n, pk, n, pa) = data.base_a0 / sd_a0;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    x.col(pk + pa + static_cast<Eigen::Index>(t)) = column(terms[t], sd_log_k, sd_a0);
  }
  return of - base::product(x, base::least_squares(x, of));
}

}  // namespace

Isolability line_isolability(const LineData& data, const std::vector<LineTerm>& terms, double sd_log_k, double sd_a0) {
  Isolability alike;
  std::vector<Eigen::VectorXd> columns;
  for (const LineTerm& term : terms) {
    const Eigen::VectorXd seen = beside(data, {}, column(term, sd_log_k, sd_a0), sd_log_k, sd_a0);
    if (!(seen.norm() > 0.0)) continue;
    alike.ids.push_back(term.id);
    alike.least_seen.push_back(1.0 / seen.norm());
    columns.push_back(seen.normalized());
  }
  for (const Eigen::VectorXd& a : columns) {
    std::vector<double> row;
    for (const Eigen::VectorXd& b : columns) row.push_back(std::min(1.0, std::abs(a.dot(b))));
    alike.cosine.push_back(std::move(row));
  }
  return alike;
}

bool taken_up(const LineData& data, const LineTerm& term, const std::vector<LineTerm>& by, double sd_log_k,
              double sd_a0) {
  const Eigen::VectorXd whole = beside(data, {}, column(term, sd_log_k, sd_a0), sd_log_k, sd_a0);
  const Eigen::VectorXd rest = beside(data, by, whole, sd_log_k, sd_a0);
  return rest.squaredNorm() <= (1.0 - kAlike * kAlike) * whole.squaredNorm();
}

std::vector<LineExplanation> weigh_lines(const LineData& data, const std::vector<LineTerm>& named,
                                         const std::vector<LineFamily>& families) {
  std::vector<LineExplanation> all;
  const auto add = [&](const std::vector<std::size_t>& ids, std::optional<std::size_t> family, double prior) {
    std::vector<LineTerm> terms;
    for (const std::size_t t : ids) terms.push_back(named[t]);
    if (family) terms.insert(terms.end(), families[*family].terms.begin(), families[*family].terms.end());
    LineExplanation explanation{ids, family, solve_lines(data, terms), 0.0, prior};
    if (!all.empty()) {
      explanation.log_evidence = log_evidence_of(data, terms, explanation.solution, all.front().solution);
    }
    all.push_back(std::move(explanation));
  };
  const auto many = static_cast<double>(named.size());
  std::vector<std::pair<std::vector<std::size_t>, double>> together = {{{}, kPriorNone}};
  for (std::size_t t = 0; t < named.size(); ++t) {
    together.push_back({{t}, kPriorOne / many});
    for (std::size_t u = 0; u < t; ++u) together.push_back({{u, t}, kPriorTwo / (0.5 * many * (many - 1.0))});
  }
  for (const auto& [ids, prior] : together) add(ids, {}, prior);
  const LineSolution nominal = all.front().solution;
  for (const auto& [ids, prior] : together) {
    for (std::size_t f = 0; f < families.size(); ++f) {
      const bool says = std::none_of(ids.begin(), ids.end(), [&](std::size_t t) {
        return taken_up(data, named[t], families[f].terms, nominal.sd_k, nominal.sd_a);
      });
      if (says) add(ids, f, prior * kUnnamedBeside * families[f].share);
    }
  }
  double most = 0.0, sum = 0.0;
  for (const LineExplanation& e : all) {
    if (!e.solution.left_out) most = std::max(most, e.log_evidence);
  }
  for (LineExplanation& e : all) {
    e.probability *= !e.solution.left_out ? std::exp(e.log_evidence - most) : 0.0;
    sum += e.probability;
  }
  for (LineExplanation& e : all) e.probability /= sum;
  return all;
}

}  // namespace glidelab::diagnose
