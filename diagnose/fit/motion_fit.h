/// Least-squares fit of the nominal model with any set of effects to all motions at once.
///
///     x_ij = x(t_ij; K, mu, alpha_group, masses, effects; x0_i, v0_i, own_i) + sum_k c_k shared_k(t_ij) + noise
///
/// weighted with the noise of each motion. Statements are further data: inclinations and masses with their standard
/// deviations, the errors of camera and plane with c_k ~ N(0, 1). The fit takes Gauss-Newton steps with
/// Levenberg-Marquardt damping; derivatives are by finite differences, and each motion's own parameters are eliminated.
/// An effect's common parameter stays within its range (fit_model.h): it stops at the edge, while the others go on.
#pragma once

#include <vector>

#include "diagnose/fit/fit_model.h"
#include "diagnose/fit/fit_result.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// Whether a fit leaves so much that the motion counts as not explained: chi² per position above 1.5.
bool is_misfit(const TrackSet& set, const MotionFit& fit);

/// What the inclinations that the experimenter states add to chi² at a fit.
double chi2_of_stated(const MotionFit& fit);

inline constexpr double kClearInStated = 20.0;  ///< of that chi²: some 4.5 standard deviations of one statement

/// By how much less stated inclinations contradict `fit` than `base`, in chi². A scale or a clock that is off, or a
/// friction that differs between the directions, shifts the inclination that the motion gives, and little else.
double gain_in_stated(const MotionFit& base, const MotionFit& fit);

/// Fits from a start in the layout of these effects.
MotionFit fit_motions(const TrackSet& set, const std::vector<std::size_t>& effects, const FitPoint& start,
                      const Lateness& late = {});

/// The same, with the common parameters of these indices held at `start`: by a statement with a ten-millionth of their
/// range. What a cause takes of a gap is measured with the shape that was found with all causes together: where a cable
/// tightens, until when a hand pushes.
MotionFit fit_held(const TrackSet& set, const std::vector<std::size_t>& effects, const FitPoint& start,
                   const Lateness& late, const std::vector<std::size_t>& held);

/// Residuals and derivatives at a point in parameter space, without a fit.
MotionFit linearise_at(const TrackSet& set, const std::vector<std::size_t>& effects, const FitPoint& at);

/// An unchanged fit, with residuals and derivatives under the noise of another set of the same motions.
MotionFit linearise_again(const TrackSet& set, const MotionFit& fit);

/// Fits one more effect than `base` has, from the start that a search found. If the result is worse than `base`, which
/// is the same model with the effect absent, the fit starts again from `base`, by small steps, and the better of the
/// two is returned. So its cost is never above that of `base`. A bumper or a cable that is added to a nominal model
/// which follows no bounce is also fitted from the integrated positions (integrated_start.h).
MotionFit fit_with_effect(const TrackSet& set, const MotionFit& base, std::size_t effect, const FitPoint& start);

/// `fit`; or, if `base` fits better, a fit that starts there, with the additional effect of `fit` absent.
MotionFit no_worse_than(const TrackSet& set, const MotionFit& base, std::size_t effect, MotionFit fit);

/// The parameters of a fit in the layout with one more effect, which is absent except for `values` (in the order of its
/// global parameters). A quadratic drag that takes the place of K has the size that brakes as K does in the fit
/// (drag_of_air.h).
FitPoint with_effect(const TrackSet& set, const MotionFit& fit, std::size_t effect, const std::vector<double>& values,
                     const std::vector<std::vector<double>>& own);

/// The parameters of a fit that a layout has too, those of its effects among them; 0 for others.
FitPoint with_some_effects(const ParameterLayout& layout, const MotionFit& from);

}  // namespace glidelab::diagnose
