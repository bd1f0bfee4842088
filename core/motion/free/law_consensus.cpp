#include "core/motion/free/law_consensus.h"

#include <algorithm>
#include <cmath>

#include "core/math/quantile.h"

namespace glidelab::core {
namespace {

constexpr std::size_t kFewestPoints = 6;
constexpr std::size_t kEnoughPoints = 400;  // more are thinned: the candidates times the points are looked at
constexpr double kPartOfSize = 0.25;        // of the line's size that a point may lie off
constexpr double kDeviations = 5.0;         // standard deviations that a point may lie off

/// Least squares through the points for which `counts(i)`; a level line where their v hardly differ.
template <typename Counts>
std::optional<ConsensusLine> fit(const LawPoints& points, std::size_t from, std::size_t to, const Counts& counts) {
  double n = 0.0, v = 0.0, a = 0.0, vv = 0.0, va = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    if (!counts(i)) continue;
    n += 1.0;
    v += points.v_m_s[i];
    a += points.a_m_s2[i];
    vv += points.v_m_s[i] * points.v_m_s[i];
    va += points.v_m_s[i] * points.a_m_s2[i];
  }
  if (n < static_cast<double>(kFewestPoints)) return {};
  ConsensusLine line;
  const double spread = vv - v * v / n;
  if (spread > 1e-4 * vv) line.k_1_s = -(va - v * a / n) / spread;
  line.a0_m_s2 = (a + line.k_1_s * v) / n;
  return line;
}

bool agrees(const LawPoints& points, const ConsensusLine& line, std::size_t i) {
  return std::abs(points.a_m_s2[i] - line.at(points.v_m_s[i])) <= line.tolerance(points.sd_m_s2[i]);
}

/// Size and scatter over the points that agree with the line at a scatter of 1: taken over what a wider tolerance lets
/// in, both would feed on themselves.
void measure(const LawPoints& points, ConsensusLine& line) {
  std::vector<double> sizes, offs;
  line.scatter = 1.0;
  for (std::size_t i = 0; i < points.v_m_s.size(); ++i) {
    if (!agrees(points, line, i)) continue;
    sizes.push_back(std::abs(line.at(points.v_m_s[i])));
    offs.push_back(std::abs(points.a_m_s2[i] - line.at(points.v_m_s[i])) / points.sd_m_s2[i]);
  }
  if (sizes.size() < kFewestPoints) return;
  line.size_m_s2 = quantile(sizes, 0.9);
  line.scatter = std::max(1.0, kSdOverMedian * quantile(offs, 0.5));
}

LawPoints thinned(const LawPoints& points) {
  const std::size_t stride = (points.v_m_s.size() + kEnoughPoints - 1) / kEnoughPoints;
  LawPoints few;
  for (std::size_t i = 0; i < points.v_m_s.size(); i += stride) {
    few.v_m_s.push_back(points.v_m_s[i]);
    few.a_m_s2.push_back(points.a_m_s2[i]);
    few.sd_m_s2.push_back(points.sd_m_s2[i]);
  }
  return few;
}

}  // namespace

double ConsensusLine::tolerance(double sd_m_s2) const {
  return std::max(kPartOfSize * size_m_s2, kDeviations * scatter * sd_m_s2);
}

std::optional<ConsensusLine> find_consensus(const LawPoints& all) {
  if (all.v_m_s.size() < kFewestPoints) return {};
  const LawPoints points = thinned(all);
  const std::size_t n = points.v_m_s.size();
  std::vector<double> magnitudes;
  for (const double a : points.a_m_s2) magnitudes.push_back(std::abs(a));
  const double typical = quantile(magnitudes, 0.5);
  std::optional<ConsensusLine> best;
  std::size_t most = 0;
  for (std::size_t length = std::max(kFewestPoints, n / 10); length <= n;
       length = std::max(length + 1, 3 * length / 2)) {
    for (std::size_t from = 0; from + length <= n; from += std::max<std::size_t>(1, length / 4)) {
      auto line = fit(points, from, from + length, [](std::size_t) { return true; });
      line->size_m_s2 = typical;  // one size for all candidates: a steep one must not buy agreement with it
      std::size_t agree = 0;
      for (std::size_t i = 0; i < n; ++i) agree += agrees(points, *line, i);
      if (agree > most) {
        most = agree;
        best = line;
      }
    }
  }
  if (!best) return {};
  for (int again = 0; again < 4; ++again) {
    const ConsensusLine before = *best;
    auto refit = fit(points, 0, n, [&](std::size_t i) { return agrees(points, before, i); });
    if (!refit) break;
    refit->size_m_s2 = before.size_m_s2;
    measure(points, *refit);
    best = refit;
  }
  return best;
}

}  // namespace glidelab::core
