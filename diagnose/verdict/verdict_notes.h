/// Notes on what a verdict names.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/result/diagnosis.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

/// The buoyancy that would slow a fall as a named effect does: with the ratio r of the densities of fluid and body, g
/// becomes (1 - r) g. It becomes (1 + e) g by a wrong scale, (1 + e)² g by a wrong frame rate, and g m/(m + m_w) by an
/// inertia without weight. Empty if none is named; if the fall is faster; if r is below 0.01, which is more than in
/// air; or if the inertia may be that of the air, less than the mass beside a drag of air.
std::optional<BuoyancyLooksAlike> buoyancy_like(const TrackSet& set, const Diagnosis& diagnosis);

/// The named effects that a motion sensor cannot have.
std::vector<std::string> named_of_camera(const Diagnosis& diagnosis);

/// Adds to the traces the scatter of single positions that is certain and that the verdict does not name.
void add_clear_scatter(const Comparison& comparison, Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
