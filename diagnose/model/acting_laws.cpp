#include "diagnose/model/acting_laws.h"

#include <algorithm>
#include <vector>

namespace glidelab::diagnose {

ActingLaws::ActingLaws(const EffectValues& values, const GliderConstants& glider) {
  const std::vector<EffectInfo>& list = effect_list();
  for (std::size_t e = 0; e < list.size(); ++e) {
    const EffectLaw& law = list[e].law;
    const double* p = values.of(e);
    if (!law.acts(p)) continue;
    steady = steady && (law.steady || !law.changes_forces());
    steady_driving = steady_driving && (law.steady || (law.resistance == nullptr && law.force_n == nullptr));
    if (law.resistance != nullptr) resistance.add(law, p);
    if (law.force_n != nullptr) force.add(law, p);
    if (law.friction != nullptr) friction.add(law, p);
    if (law.seen_m != nullptr) seen.add(law, p);
    if (law.inertia_kg != nullptr) inertia_kg += law.inertia_kg(p, glider);
    if (law.known_factor != nullptr) known_factor *= law.known_factor(p);
    if (law.known_late_s != nullptr) known_late_s += law.known_late_s(p);
    if (law.stretch != nullptr) stretch *= law.stretch(p);
    if (law.row_s != nullptr) row_s += law.row_s(p);
    if (law.rate_1_s != nullptr) rates.add(law, p);
  }
  const std::span<Acting> by_camera = seen.all();
  if (by_camera.size() < 2) return;
  std::stable_sort(by_camera.begin(), by_camera.end(),
                   [](const Acting& a, const Acting& b) { return a.law->seen_by < b.law->seen_by; });
}

}  // namespace glidelab::diagnose
