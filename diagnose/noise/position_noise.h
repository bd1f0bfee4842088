/// The noise of positions, measured: how much is white, how much neighbouring frames share (whitening.h), and how much
/// grows with the speed.
///
/// Restricted maximum likelihood: those amplitudes and lengths that make most likely what the positions hold besides
/// everything slow (noise_chunks.h: bumps are projected out, and, where one shows, a wave with what the fit made of
/// it), so that neither the nominal model nor what it lacks goes in. The white part may differ between motions by some
/// 30
/// %. Of what was tracked elsewhere nobody knows the pixels: its noise may last for some frames, as a tracker's does
/// that follows its own last image, and is white unless that shows beyond doubt. What lasts for four frames or longer
/// may be what the model lacks, and is left to it.
#pragma once

#include "diagnose/fit/motion_fit.h"

namespace glidelab::diagnose {

/// Sets the noise of a set (position_noise) and of its motions (sd_m, wider, whitening). False, and nothing changed,
/// where a filmed marker hardly moves, in tracks whose noise is white, or with fewer than 80 points.
bool find_position_noise(TrackSet& set, const MotionFit& fit);

}  // namespace glidelab::diagnose
