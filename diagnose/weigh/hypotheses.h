/// Which explanation the data support: nothing, one effect of the list, two, or something without a name.
///
/// Score tests make a short list. Each effect on it is fitted in full, alone and with a second one; so are pairs that
/// show only together (effect_scan.h). The log evidence is that of the linear neighbourhood (sizes and shapes averaged
/// over their prior), with the gain of the full fit in place of the linear one. Something unnamed competes (unnamed.h),
/// alone and beside each leading explanation: what an effect leaves unexplained counts against its name, unless it
/// shows weakly in a filmed experiment and is worth less than a hundredth of the effect.
///
/// Prior odds: nothing 0.3, one effect 0.4 (shared by those that these data can show), two 0.1, unnamed 0.2. A drag
/// with an arbitrary power of the speed has two fifths of another effect's prior odds, since powers with a theory are
/// on the list themselves. If the explanation found leaves a gap, causes/cause_odds.h replaces these probabilities, and
/// verdict/probabilities_by_share.h has the last word.
#pragma once

#include <functional>
#include <set>
#include <vector>

#include "diagnose/weigh/hypothesis.h"

namespace glidelab::diagnose {

struct ImageEvidence;

/// `without` are effects that are not considered; `images` is what the images of filmed clips show (null for tracks).
/// `done` is called before each fit, from any thread, with the fraction that is done (0 to 1); an exception from it
/// ends the comparison.
Comparison compare_hypotheses(
    const TrackSet& set, const std::vector<std::size_t>& without = {}, int jobs = 1,
    const ImageEvidence* images = nullptr, const std::function<void(double)>& done = [](double) {});

/// Probabilities of all hypotheses from their evidence and the prior odds. Sorts them by decreasing probability.
void weigh(const TrackSet& set, const std::set<std::size_t>& without, Comparison& comparison);

}  // namespace glidelab::diagnose
