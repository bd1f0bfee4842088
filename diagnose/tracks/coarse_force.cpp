#include "diagnose/tracks/coarse_force.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace glidelab::diagnose {
namespace {

constexpr std::size_t kFewestSamples = 64;  // fewer cost little time

/// Every k-th sample, and the last one, as the weighted mean around it.
KnownForce means_of(const KnownForce& force, std::size_t k) {
  const std::size_t n = force.t_s.size();
  KnownForce means;
  for (std::size_t at = 0; at < n; at += k) {
    const std::size_t centre = at + k < n ? at : n - 1;
    if (centre != at) {  // the last interval keeps its length
      means.t_s.push_back(force.t_s[at]);
      means.force_n.push_back(force.force_n[at]);
    }
    const std::size_t reach = std::min({k, centre + 1, n - centre});  // symmetric about the sample
    double sum = 0.0, weights = 0.0;
    for (std::size_t i = centre + 1 - reach; i < centre + reach; ++i) {
      const double off = static_cast<double>(i) - static_cast<double>(centre);
      const double weight = 1.0 - std::abs(off) / static_cast<double>(reach);
      sum += weight * force.force_n[i];
      weights += weight;
    }
    means.t_s.push_back(force.t_s[centre]);
    means.force_n.push_back(sum / weights);
    if (centre == n - 1) break;
  }
  return means;
}

double value_at(const KnownForce& force, double t, std::size_t& before) {
  while (before + 2 < force.t_s.size() && force.t_s[before + 1] <= t) ++before;
  const double part = (t - force.t_s[before]) / (force.t_s[before + 1] - force.t_s[before]);
  return force.force_n[before] + part * (force.force_n[before + 1] - force.force_n[before]);
}

/// The largest |d|.
double moved_by(const KnownForce& force, const KnownForce& means, double mass_kg) {
  const std::size_t n = force.t_s.size();
  std::vector<double> d(n, 0.0);
  double v = 0.0, last = 0.0;
  std::size_t before = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double a = (force.force_n[i] - value_at(means, force.t_s[i], before)) / mass_kg;
    if (i > 0) {
      const double h = force.t_s[i] - force.t_s[i - 1];
      d[i] = d[i - 1] + h * v + h * h * (last / 3.0 + a / 6.0);
      v += 0.5 * h * (last + a);
    }
    last = a;
  }
  const double length = force.t_s.back() - force.t_s.front();
  double most = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    most = std::max(most, std::abs(d[i] - d[n - 1] * (force.t_s[i] - force.t_s.front()) / length));
  }
  return most;
}

}  // namespace

void coarsen_force(TrackedMotion& motion, double mass_kg, double within_m) {
  for (const std::size_t k : {20u, 12u, 8u, 5u, 3u, 2u}) {
    if (motion.known.t_s.size() < kFewestSamples + k) continue;
    KnownForce means = means_of(motion.known, k);
    if (!(moved_by(motion.known, means, mass_kg) < within_m)) continue;
    motion.known = std::move(means);
    return;
  }
}

}  // namespace glidelab::diagnose
