/// The families of unnamed.h over position, speed and time.
#pragma once

#include <vector>

#include "diagnose/unnamed/unnamed_family.h"

namespace glidelab::diagnose {

/// `space` must outlive the searches.
void add_place_families(const ScoreSpace& space, std::vector<FamilySearch>& searches);

}  // namespace glidelab::diagnose
