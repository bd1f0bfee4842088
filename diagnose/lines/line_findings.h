/// What a fit of lines says: how probable each explanation is, how far the lines lie off it, and where.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "diagnose/lines/line_model.h"
#include "diagnose/result/diagnosis.h"

namespace glidelab::diagnose {

struct LineExplanation {
  std::vector<std::size_t> causes;  ///< indices, of two effects at most
  LineSolution solution;
  double log_evidence = 0.0;
  double probability = 0.0;  ///< 0 if a size is impossible
};

/// How probable each explanation of a table of lines is, the nominal model first.
///
/// The odds are those for tracks: nothing 0.3, one effect 0.4 (shared), two 0.1. A second cause of which the first
/// absorbs nearly all is not weighed beside it.
std::vector<LineExplanation> weigh_lines(const LineData& data, const std::vector<LineCause>& causes);

/// The terms of these causes, one after another.
std::vector<LineTerm> terms_of(const std::vector<LineCause>& causes, const std::vector<std::size_t>& which);

/// How similar every two effects of one size are in a table of lines. They are as alike as the angle between their
/// columns is small (ln K/m and a0 of all lines, each over its scatter), the nominal model projected out. Measured
/// sizes do not enter. `least_seen` is the size that makes one standard deviation. The scatters are above 0.
Isolability line_isolability(const LineData& data, const std::vector<LineCause>& causes, double sd_log_k, double sd_a0);

/// Whether other terms absorb nearly all (a cosine of kAlike) of this one: beside it they add nothing to what they say
/// alone.
bool taken_up(const LineData& data, const LineTerm& term, const std::vector<LineTerm>& by, double sd_log_k,
              double sd_a0);

struct LineGap {
  GapSizes sizes;
  std::vector<Note> notes;  ///< of the inclinations
};

/// How far a table's lines lie off an explanation, each held out of it in turn, and how far their inclinations lie off
/// what is stated. `before` is the fit of the nominal model, `after` that of the explanation. The lines' own scatter,
/// which is known, is the unit of the gap. The stated inclination is compared with the mean intercept, asin(a0 / g).
LineGap line_gap(const std::vector<TableLine>& lines, double g, const LineSolution& before, const LineSolution& after,
                 const OwnScatter& scatter);

/// The part of the gap due to each of the causes, beside those before it; the cause that takes more by itself comes
/// first.
///
///     share_i = (g²_{i-1} - g²_i) / (g²_0 - 1),        g the gap of held-out lines, g_0 of the nominal model
///
/// Intervals are over lines, each left out in turn (gap/gap_sizes.h). Empty if the gap before is not above its floor by
/// three standard errors. The lines' own scatter must be known.
std::vector<ExplainedCause> explained_by(const LineData& data, const std::vector<LineCause>& causes,
                                         const LineSolution& nominal, const OwnScatter& scatter, double standard_error);

/// The gap of held-out lines with mu and K common to all, and with mu and K of each mass on each set-up (none if there
/// is only one of these).
GapLevels line_levels(const std::vector<TableLine>& lines, const LineData& data, const LineSolution& nominal,
                      const OwnScatter& scatter, double standard_error);

/// The mu or K of every cell of a cause with a form, and their spread (the sample standard deviation), to first order:
/// `sd` and `mu.NAME`, or `sd_n_s_m` and `k_n_s_m.NAME`. `first` is the index of its first term among all those of the
/// explanation.
std::vector<DiagnosedParameter> own_of_cells(const LineData& data, const LineCause& cause, const LineSolution& with,
                                             std::size_t first);

/// Where lines depart from the nominal model: by the intercepts (m/s²) of each mass, and of each set-up, in one
/// direction, and by the drag K (N s/m) of each mass and of each set-up. None where the lines' own scatter is not
/// known.
///
/// Regions are groups of lines whose mean is off by three of its standard deviations or more, the largest first. For a
/// group with weights w (each 1/n) the mean of the residuals r = (1 - H) y is w'r, and its standard deviation is
/// sqrt(w' (1 - H) w) times the lines' own scatter, H being the nominal model's projection.
std::vector<GapRegion> line_regions(const std::vector<TableLine>& lines, const LineData& data,
                                    const LineSolution& nominal, const OwnScatter& scatter);

/// The residuals of the nominal model, for the plots.
std::vector<LineOff> lines_off(const std::vector<TableLine>& lines, const LineSolution& nominal);

/// The friction that a single effect on intercepts (a friction force, a smoothing bias) adds to that of the nominal
/// model, as fitted to the lines. Empty for any other term.
LineCurve line_curve(const std::vector<TableLine>& lines, const LineData& data, const LineCause& cause,
                     const LineSolution& with);

}  // namespace glidelab::diagnose
