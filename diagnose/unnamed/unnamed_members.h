/// Families of unnamed.h that differ between clips, masses or set-ups.
#pragma once

#include <vector>

#include "diagnose/unnamed/unnamed_family.h"

namespace glidelab::diagnose {

void add_member_families(const ScoreSpace& space, std::vector<UnnamedFamily>& families);

}  // namespace glidelab::diagnose
