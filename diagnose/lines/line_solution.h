/// Lines fitted by the nominal model and terms beside it, and how well.
///
/// The nominal model gives, for a line of mass m, set-up g and direction s,
///
///     ln(k m) = ln K,     a0 = gravity sin(alpha_g) - s mu gravity cos(alpha_g)
///
/// A table states no errors: those of ln(k) and of a0 are unknown and are what the lines scatter, so that few lines
/// carry little. Of n lines with p0 nominal parameters, p terms that leave RSS of the nominal model's RSS_0 have the
/// Bayes factor, for unknown scatter and terms of a size g that one line tells, give or take (Zellner and Siow 1980;
/// Liang et al. 2008),
///
///     ∫ (1 + g)^((n - p0 - p) / 2) (1 + g RSS / RSS_0)^(-(n - p0) / 2) sqrt(n / (2 pi)) g^(-3/2) exp(-n / (2 g)) dg
///
/// for each kind of data. Neither RSS is less than what rounding to the table's decimals leaves: lines that were
/// calculated, and rounded, tell no more than their digits. (With g = n fixed it stays below (1 + n)^((n - p0 - p) / 2)
/// however little is left: two causes at once would never be found where one of them explains nearly all.)
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

#include "diagnose/lines/line_table.h"
#include "diagnose/lines/line_terms.h"
#include "diagnose/result/line_comparison.h"

namespace glidelab::diagnose {

/// Both kinds of data, and the nominal model's columns.
struct LineData {
  Eigen::VectorXd log_k, a0;
  Eigen::MatrixXd base_log_k, base_a0;
  double rounding_log_k = 0.0, rounding_a0 = 0.0;  ///< standard deviations of the numbers' own rounding
};

struct LineSolution {
  Eigen::VectorXd size, sd;                    ///< of the terms; sd from what is left
  Eigen::VectorXd off_k, off_a;                ///< measured less fitted
  double sd_k = 0.0, sd_a = 0.0;               ///< root mean square of what is left
  std::vector<double> held_out_k, held_out_a;  ///< off the prediction by the other lines
  std::optional<ImpossibleSize> left_out;      ///< the first size that is impossible, if any
};

/// Scatter that no model of friction goes into: of the mean intercept over both directions between masses of one set-up
/// (as that of one line), and of K/m, relative, within each mass. 0 where nothing is repeated.
struct OwnScatter {
  double intercept_m_s2 = 0.0, slope = 0.0;
  std::size_t freedom = 0;  ///< degrees of freedom of both together
  bool known() const { return intercept_m_s2 > 0.0 && slope > 0.0; }
};

LineData line_data(const std::vector<TableLine>& lines, double gravity_m_s2);

/// Weighted least squares of both kinds together; their errors from the residuals, in turn.
LineSolution solve_lines(const LineData& data, const std::vector<LineTerm>& terms);

OwnScatter own_scatter(const std::vector<TableLine>& lines);

/// The logarithm of the Bayes factor above for one kind of data: `left` and `nominal_left` are root mean squares. 0
/// where there are as many parameters as lines.
double log_bayes_factor(double left, double nominal_left, double lines, double nominal_parameters, double terms);

/// Of both kinds together, against the nominal model. A term that acts on both is half a one of each.
double log_evidence_of(const LineData& data, const std::vector<LineTerm>& terms, const LineSolution& with,
                       const LineSolution& nominal);

/// Of both kinds together, each with an unknown scatter: n ln(nominal rms / rms).
double log_likelihood_gain_of(const LineSolution& with, const LineSolution& nominal);

/// Sum of squares of what is left over the lines' own scatter.
double chi_square_of(const LineSolution& solution, const OwnScatter& scatter);

/// Root mean square of line i's two held-out residuals over the lines' own scatter.
double gap_of_line(const LineSolution& solution, const OwnScatter& scatter, std::size_t i);
double gap_of_lines(const LineSolution& solution, const OwnScatter& scatter);

}  // namespace glidelab::diagnose
