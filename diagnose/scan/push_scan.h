/// A hand that pushes at the start of clips until one moment: a size in each motion that begins with its clip.
///
/// Nine times in ten it is one hand: its pushes are a common size along the motions and, from clip to clip, half as
/// much again (one standard deviation), all along the motions or, one time in ten of these, all against them. Else they
/// are of any size and sign. The evidence is averaged over both, over the sizes and over the moment.
#pragma once

#include <cstddef>

#include "diagnose/scan/scanned_effect.h"

namespace glidelab::diagnose {

EffectScan scan_pushes(const ScoreSpace& space, std::size_t effect);

}  // namespace glidelab::diagnose
