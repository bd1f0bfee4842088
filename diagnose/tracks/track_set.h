/// From the results of an analysis to the motions that a diagnosis fits (tracked_motions.h), and their noise.
#pragma once

#include <vector>

#include "core/experiment/experiment.h"
#include "core/result/results.h"
#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {

/// `setups` are the clips of all folders, in the results' order. With `all`, what the analysis took for a hand at the
/// start or for a stop stays in the motion; else it is left out. Motions with fewer than 12 points are left out. Of
/// more than 30,000 positions in all every second, third, ... is taken (thin_tracks.h).
TrackSet track_set(const core::AnalysisResults& results, const std::vector<core::ClipSetup>& setups, bool all);

/// Point i off the cubic through its four nearest neighbours, over the standard deviation that unit noise gives it: its
/// own noise, independent of the motion. 2 <= i < n - 2.
double neighbour_residual(const std::vector<double>& t_s, const std::vector<double>& x_m, std::size_t i);

/// The noise of each motion from its neighbouring positions (`late_s`, where not empty, is what each is later than its
/// time says), and one level for all where theirs differ by no more than their own errors; else half way between.
void measure_noise(std::vector<TrackedMotion>& motions, const std::vector<std::vector<double>>& late_s = {});

/// Noise of one position, from how far each lies off the cubic through its four nearest neighbours, outliers spared;
/// never below what rounding to a step makes.
double neighbour_noise(const std::vector<double>& t_s, const std::vector<double>& x_m,
                       const std::vector<char>& outlier);

}  // namespace glidelab::diagnose
