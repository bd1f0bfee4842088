/// The details of a verdict: fitted and derived parameters, limits that a reader must know, and the regions in which a
/// gap lies.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/causes/remainder.h"
#include "diagnose/fit/motion_fit.h"
#include "diagnose/pictures/image_evidence.h"
#include "diagnose/result/diagnosis.h"
#include "diagnose/single_frames/frame_effects.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/unnamed/unnamed_family.h"

namespace glidelab::diagnose {

/// The fitted parameters of an effect as files show them, with the standard deviations of the fit's covariance. The
/// line time of a shutter is the fitted excess plus `stated_line_s`.
std::vector<DiagnosedParameter> fitted_parameters(const TrackSet& set, const MotionFit& fit, std::size_t effect,
                                                  double stated_line_s);

/// Parameters that are stated for an effect but that are not parameters of a fit.
///
///     track_bow          x_mid_m: middle of the range of x of all clips of a set-up
///     damping_gradient   x_mid_m: the same; with one K(x) for set-ups at several places, where K is K itself,
///                        x_mid + w (x_mid of all - x_mid) with the fitted share w
///     camera_motion      amplitude_px = amplitude_m times the pixels per metre along the motion
///
/// and those of own_sizes.h. With several set-ups, x_mid_m has a key for each, "x_mid_m.NAME".
///
/// `known` are the parameters of the effect so far; a key that is among them is not stated again. Nothing is stated in
/// pixels for tracks, whose camera is unknown, nor if the scales of the clips differ by more than 5 %.
std::vector<DiagnosedParameter> derived_parameters(const TrackSet& set, const MotionFit& fit, std::size_t effect,
                                                   const ImageEvidence& images,
                                                   const std::vector<DiagnosedParameter>& known);

/// Drag and friction that a fit has below zero, by more than three standard deviations if it is the nominal one, and by
/// more than five beside effects.
std::vector<NegativeLoss> what_drives(const MotionFit& fit);

/// What makes an explanation impossible: such a drag or friction beside its effects, or a size of theirs at an end of
/// its range. Empty if nothing does.
std::optional<ImpossibleSizes> impossible_sizes(const MotionFit& fit);

/// Replaces the negative drags and frictions that the noise alone gave by those beside this remainder, since
/// `recovered` counts the remainder too. `fit` is linearised with the noise alone.
void count_remainder(const TrackSet& set, const MotionFit& fit, const RemainderSizes& sizes, Diagnosis& diagnosis);

/// Limits that a reader must know before the verdict, for the fit on which it rests: a negative drag or friction,
/// statements that the data contradict, and the part of the data that is set aside.
///
/// Drag and friction take energy from a glider. A nominal fit in which K or mu is negative by more than three standard
/// deviations explains nothing, however well it follows the positions: the verdict is then not "nothing is missing",
/// and the probability of that goes to the unknown.
VerdictLimits limits_of(const TrackSet& set, const MotionFit& fit);

/// Adds to `diagnosis` where a gap lies: the regions and curves of each variable in which something without a name
/// would act, for families with enough evidence, corrected for the number of looks. `nominal` is the fit of the nominal
/// model, for what it lacks.
void add_regions(const TrackSet& set, const MotionFit& nominal, const std::vector<UnnamedFamily>& families,
                 Diagnosis& diagnosis);

/// The most that the nominal model lacks, noise included; the largest over all motions. A fit absorbs part of an
/// effect, but a size far beyond these is inferred from an effect that hardly shows.
struct Lacking {
  double position_m = 0.0;         ///< |r|, r the residual of a position
  double force_n = 0.0;            ///< m |r''| + |K| |r'|, each at its largest
  double acceleration_m_s2 = 0.0;  ///< force_n over the smallest mass
  double drag_n_s_m = 0.0;         ///< force_n over the top speed of the slowest motion
  double time_s = 0.0;             ///< position_m over that speed
  double scale = 0.0;              ///< position_m over the length of the shortest motion
  /// The quantity of a region's unit: m, N, m/s², N s/m, s; for any other unit the scale.
  double in(const std::string& unit) const;
};

Lacking most_lacking(const TrackSet& set, const MotionFit& nominal);

/// Adds the runs in which errors of single frames come together, if their evidence is higher than that of any function
/// without a name. Returns whether it is.
bool add_error_runs(const TrackSet& set, const std::vector<FrameEffect>& frames,
                    const std::vector<UnnamedFamily>& families, Diagnosis& diagnosis);

/// Adds where a gap lies, for named effects that only images show.
void add_image_regions(const ImageEvidence& images, Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
