/// How large the gap is in each domain, before and after: positions (held_out.h), phase plane (phase_gap.h), parameters
/// (held_out.h, parameter_gap.h), picture.
#pragma once

#include <string>
#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

/// Of clips held out, by the nominal model's fit and by the best one's, with intervals over clips (clip_interval.h):
/// `best` has a named effect, the likeliest function without a name (`unnamed`), or nothing more. A single clip is cut
/// into stretches that are fitted anew; a note says so. Without the domains.
GapSizes gap_of(const TrackSet& set, const MotionFit& nominal, const MotionFit& best, bool unnamed,
                std::vector<Note>& notes);

/// Each domain that the data have: of positions the gap of held-out clips, of the phase plane and the parameters the
/// root mean square of the differences over their standard deviations, of the picture sqrt(2 log evidence) of what
/// shows most, 1 at least; after: of what is not named. What a file states of itself does not count.
std::vector<GapDomain> gap_domains(const GapSizes& gap, const std::vector<PictureFinding>& pictures,
                                   const std::vector<DiagnosedEffect>& named);

/// Of every motion some 250 residuals of either fit to all clips, in metres.
std::vector<ResidualCurve> residuals_of(const TrackSet& set, const MotionFit& nominal, const MotionFit& best);

}  // namespace glidelab::diagnose
