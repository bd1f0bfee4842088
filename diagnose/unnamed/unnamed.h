/// Explanations without a name: smooth forces and displacements in each variable, and sizes that differ between clips,
/// masses or set-ups for no stated reason. They stand for whatever is not in the list of effects.
///
/// Each family is a set of bumps (or of members) whose sizes are drawn from N(0, tau²), with tau unknown over four
/// decades; or one of these bumps at an unknown position; or one step there. Its evidence is exact in the linear
/// neighbourhood of a fit. Forces are functions of v, x or t; displacements are functions of x or t (also waves in x);
/// a delay is a function of t. Displacements of each clip, and a delay, may also decay from the clip's start.
#pragma once

#include <vector>

#include "diagnose/unnamed/unnamed_family.h"

namespace glidelab::diagnose {

/// All families around a fit. The result is the same for any number of threads `jobs`.
std::vector<UnnamedFamily> unnamed_families(const ScoreSpace& space, int jobs = 1);

/// The likeliest family by which one clip predicts another; null: none. The families' columns must be set.
const UnnamedFamily* likeliest_shared(const std::vector<UnnamedFamily>& families);

/// The likeliest family with one size for each clip; null: none. The families' columns must be set.
const UnnamedFamily* likeliest_of_clips(const std::vector<UnnamedFamily>& families);

/// The fit with the family's bumps as further parameters, each N(0, tau²), at the minimum of its linear neighbourhood:
/// for held_out_gap(), statement_pulls() and its residuals. The family must have its columns.
MotionFit with_unnamed(const TrackSet& set, const MotionFit& fit, const UnnamedFamily& family);

/// The joint evidence of all families. The prior gives all variables the same weight, and so all families of one
/// variable.
double log_unnamed_evidence(const std::vector<UnnamedFamily>& families);

}  // namespace glidelab::diagnose
