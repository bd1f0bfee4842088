#include "diagnose/lines/line_isolability.h"

#include <algorithm>
#include <cmath>

#include "base/math/dense.h"
#include "diagnose/next/plan.h"

namespace glidelab::diagnose {
namespace {

Eigen::VectorXd column(const LineTerm& term, double sd_log_k, double sd_a0) {
  Eigen::VectorXd both(2 * term.of_a0.size());
  both << term.of_log_k / sd_log_k, term.of_a0 / sd_a0;
  return both;
}

/// What the usual model and the terms cannot take up of the column.
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

}  // namespace glidelab::diagnose
