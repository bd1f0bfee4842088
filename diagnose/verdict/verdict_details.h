/// The details of a verdict: derived parameters, limits that a reader must know, and regions in which a gap lies.
#pragma once

#include <string>
#include <vector>

#include "diagnose/fit/motion_fit.h"
#include "diagnose/frames/frame_effects.h"
#include "diagnose/pictures/picture_evidence.h"
#include "diagnose/result/diagnosis.h"
#include "diagnose/tracks/track_set.h"
#include "diagnose/unnamed/unnamed_family.h"

namespace glidelab::diagnose {

/// An effect's parameters as a fit to the motion has them and files show them, with the standard deviations of its
/// covariance. A shutter's line time is the excess that the motion shows, added to `stated_line_s`.
std::vector<DiagnosedParameter> fitted_parameters(const TrackSet& set, const MotionFit& fit, std::size_t effect,
                                                  double stated_line_s);

/// Parameters that the list of effects states for an effect but that no fit has as such.
///
///     track_bow          x_mid_m: middle of the range of x of all clips of a set-up
///     damping_gradient   x_mid_m: the same; with one K(x) for set-ups at several places, where K is K itself,
///                        x_mid + w (x_mid of all - x_mid) with the fitted share w
///     camera_motion      amplitude_px = amplitude_m times the pixels of a metre along the motion
///
/// and those of own_sizes.h. Where there are several set-ups, x_mid_m has a key for each, "x_mid_m.NAME".
///
/// `known` are the effect's parameters so far. A key that is there already is left as it is. For tracks, whose camera
/// nobody knows, and for cameras whose pixels differ in size by more than 5 %, no pixels are stated.
std::vector<DiagnosedParameter> derived_parameters(const TrackSet& set, const MotionFit& fit, std::size_t effect,
                                                   const PictureEvidence& pictures,
                                                   const std::vector<DiagnosedParameter>& known);

/// Limits that a reader must know before the verdict, of the fit that the verdict rests on: which statements the data
/// contradict, and which part of the data is set aside.
///
/// Drag and friction take energy from a glider. A nominal fit in which they supply energy, by more than five standard
/// deviations, explains nothing, however well it follows the positions: the verdict is then not "nothing is missing",
/// and its probability goes to what has no name.
VerdictLimits limits_of(const TrackSet& set, const MotionFit& fit);

/// Where a gap lies: regions and curves of each variable in which something unnamed would act, of the families that are
/// worth it, corrected for as many looks. `nominal` is the fit of the nominal model, for what it lacks.
void add_regions(const TrackSet& set, const MotionFit& nominal, const std::vector<UnnamedFamily>& families,
                 Diagnosis& diagnosis);

/// What the nominal model lacks where it lacks most, noise included; the largest of all motions. A fit absorbs part of
/// what acts; a size far beyond these is inferred from what hardly shows.
struct Lacking {
  double position_m = 0.0;         ///< |r| of what the fit leaves of the positions
  double force_n = 0.0;            ///< m r'' + K r', as the accelerations show it
  double acceleration_m_s2 = 0.0;  ///< the same over the lightest mass
  double drag_n_s_m = 0.0;         ///< force_n over the top speed of the slowest motion
  double time_s = 0.0;             ///< position_m over that speed
  double scale = 0.0;              ///< position_m over the distance of the shortest motion
  /// By a region's unit: m, N, m/s², N s/m, s; otherwise a scale.
  double in(const std::string& unit) const;
};

Lacking most_lacking(const TrackSet& set, const MotionFit& nominal);

/// Where errors of single frames come together, if that says more than any unnamed function. Whether it does.
bool add_error_runs(const TrackSet& set, const std::vector<FrameEffect>& frames,
                    const std::vector<UnnamedFamily>& families, Diagnosis& diagnosis);

/// Where a gap lies: the regions of a named effect that only images show.
void add_picture_regions(const PictureEvidence& pictures, Diagnosis& diagnosis);

}  // namespace glidelab::diagnose
