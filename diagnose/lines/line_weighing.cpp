#include "diagnose/lines/line_weighing.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/lines/line_isolability.h"

namespace glidelab::diagnose {
namespace {

constexpr double kPriorNone = 0.3, kPriorOne = 0.4, kPriorTwo = 0.1;
constexpr double kUnnamedBeside = 0.25;  // odds of something without a name: 0.2 to 0.8

}  // namespace

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
    if (e.solution.left_out.empty()) most = std::max(most, e.log_evidence);
  }
  for (LineExplanation& e : all) {
    e.probability *= e.solution.left_out.empty() ? std::exp(e.log_evidence - most) : 0.0;
    sum += e.probability;
  }
  for (LineExplanation& e : all) e.probability /= sum;
  return all;
}

}  // namespace glidelab::diagnose
