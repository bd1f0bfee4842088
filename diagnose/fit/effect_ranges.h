/// The ranges of the effects' parameters in given data: one range for the scan, which averages evidence over it, and
/// for the fit. A fit that went further would gain by what its evidence was never asked to pay for: a wave slower than
/// the clips is any drift, a cable that tightens before the first position or a lens whose axis is out of the image
/// is any bend.
#pragma once

#include "diagnose/effects/effect.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

struct ParameterRange {
  double low = 0.0, high = 0.0;
};

/// Sizes as the effects state them, those that go with the mass for the heaviest glider; a place within the positions,
/// a frequency of at least two turns in the longest motion, a release after four frames and in the first two fifths of
/// the longest one, a Stribeck speed above that at which a codec may hold the marker (TrackSet::held_m_s).
ParameterRange range_of(const TrackSet& set, const EffectParameter& parameter);

/// From the least to the largest position.
ParameterRange range_of_places(const TrackSet& set);

/// Whether a motion begins with its clip, so that a hand could be in it.
bool begins_with_its_clip(const TrackSet& set, const TrackedMotion& motion);

}  // namespace glidelab::diagnose
