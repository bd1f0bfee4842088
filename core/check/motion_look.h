/// Whether positions can be those of a body that slides along a straight incline, from the positions alone.
///
/// Typical acceleration a: the median of |a| of parabolas through a tenth of the points each, or of one through all of
/// them where only that rises above the noise and passes each point to within a twentieth of the range; friction and
/// drag aside, no incline gives more than g. That median says nothing of a fall at its terminal speed. So the most by
/// which the body speeds up counts as well, over a metre or more: a body gains no more than g t, and a push that gains
/// more is shorter. A scale or a frame rate that is somewhat off makes a fall exceed g by some per cent; a wrong unit
/// makes it exceed g by far. An oscillation: a = -w² (x - x_c) explains four fifths of the variance of a over six turns
/// or more, or 95 % of it over two to five, of eight parabolas or more. Bend: the sagitta of the marker's path in the
/// image over its length, by a parabola. Smooth: the scatter about neighbouring positions is below 1e-7 of the
/// distance, which no camera or sensor reaches. Lost in noise: that scatter is above 0.4 of the distance and 1 cm, of
/// 40 positions or more. At rest: the spread about their mean is below 1.15 times that scatter, which is D/√12 and the
/// noise for a body that covers D at a steady speed, or 0. Counted: x changes by exactly 1, or by a multiple of a
/// quarter turn, from each row to the next. Pushed: at first it speeds up by more than gravity, in parabolas through
/// five points each, and has not moved the other way before.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/check/check_result.h"
#include "core/experiment/clip_setup.h"
#include "core/result/results.h"

namespace glidelab::core {

/// Nothing with fewer than 12 positions. Of a clip whose force was recorded, accelerations say nothing and are
/// not looked at.
MotionLook look_at_motion(std::span<const double> t_s, std::span<const double> x_m,
                          std::span<const MarkerSighting> sightings, bool forced);

/// Of an analysed clip, without what is stated not to be free.
MotionLook look_at_motion(const ClipResult& clip);

/// Whether the positions scatter about one place, 40 or more, or are all the same.
bool is_at_rest(const MotionLook& look);

/// Adds a note (NoRun) to each clip that is an oscillation, whose path in the image is curved, or in which nothing
/// moves. Units and inclinations that are wrong show in the lines.
void note_no_runs(AnalysisResults& results);

/// The faults of the motion; Severity::unusable if no diagnosis can judge it. One clip at rest among others that move
/// can be left out; a recording in which nothing moves (`any_moves` false) is unusable.
std::vector<Finding> motion_findings(const MotionLook& look, const ClipSetup& setup, double gravity_m_s2,
                                     bool any_moves = true);

}  // namespace glidelab::core
