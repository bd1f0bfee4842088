/// How large the gap is in each domain, before and after: positions (held_out.h), phase plane (phase_gap.h), parameters
/// (held_out.h, parameter_gap.h), images.
#pragma once

#include <string>
#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// The gap of held-out clips, by the nominal fit and by the best one, with intervals over clips (clip_interval.h).
/// `best` has a named effect, the likeliest function without a name (`unnamed`), or nothing more. A single clip is cut
/// into stretches that are fitted anew; a note says so. The domains are left empty.
GapSizes gap_of(const TrackSet& set, const MotionFit& nominal, const MotionFit& best, bool unnamed,
                std::vector<Note>& notes);

/// Each domain that the data have. Positions: the gap of held-out clips. Phase plane and parameters: the root mean
/// square of the differences over their standard deviations. Images: sqrt(2 log evidence) of what shows most, 1 at
/// least; after, of what is not named. What a file states of itself does not count.
std::vector<GapDomain> gap_domains(const GapSizes& gap, const std::vector<PictureFinding>& pictures,
                                   const std::vector<DiagnosedEffect>& named);

/// Some 250 residuals of every motion, of either fit to all clips, in metres.
std::vector<ResidualCurve> residuals_of(const TrackSet& set, const MotionFit& nominal, const MotionFit& best);

}  // namespace glidelab::diagnose
