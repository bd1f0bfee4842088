/// The model of published lines: their table, the terms that may act on it, and the fit of both.
///
/// For a line a = a0 - k v of mass m, set-up g and direction s, with k = K/m, the nominal model gives
///
///     ln(k m) = ln K,     a0 = gravity sin(alpha_g) - s mu gravity cos(alpha_g).
///
/// A table states no errors: those of ln(k) and of a0 are unknown and are taken from the scatter of the lines, so that
/// few lines carry little information. Of n lines with p0 nominal parameters, p terms that leave RSS of the nominal
/// model's RSS_0 have the Bayes factor, for unknown scatter and terms of a size g that one line tells, give or take
/// (Zellner and Siow 1980; Liang et al. 2008),
///
///     ∫ (1 + g)^((n - p0 - p) / 2) (1 + g RSS / RSS_0)^(-(n - p0) / 2) sqrt(n / (2 pi)) g^(-3/2) exp(-n / (2 g)) dg
///
/// for each kind of data. Neither RSS is less than what rounding to the table's decimals leaves, since lines that were
/// calculated and rounded carry no more information than their digits. (With g = n fixed it stays below (1 + n)^((n -
/// p0 - p) / 2) however little is left. Two causes at once would never be found if one of them explains nearly all.)
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/errors.h"
#include "core/track/bare_track.h"
#include "diagnose/result/gap_place.h"
#include "diagnose/result/line_comparison.h"

namespace glidelab::diagnose {

/// A fitted line a = a0 - (K/m) v of a table, as printed in a paper, in place of clips.
struct TableLine {
  double mass_kg = 0.0;
  double incline_deg = 0.0;
  int direction = 0;  ///< sign of v in the fitted range
  double a0_m_s2 = 0.0;
  double k_over_m_1_s = 0.0;
  double a0_digit_m_s2 = 0.0, k_digit_1_s = 0.0;  ///< the unit of the last digit in the table; 0: not rounded
};

inline constexpr std::size_t kFewestLines = 6;

/// Columns mass_kg,incline_deg,direction,a0_m_s2,k_over_m_1_s,r2; others are ignored. InputError for values out of
/// range and for fewer than kFewestLines.
std::vector<TableLine> read_lines(const std::filesystem::path& file);

/// An experiment folder; or a table of lines that lies in no folder, a CSV file whose header has k_over_m_1_s: an
/// experiment named after the file, of its lines alone, with the default gravity; or any other file, a track.
/// InputError as from read_tracks() (core/track/bare_track.h); the contents of a table are not examined.
core::Experiment read_recording(const std::filesystem::path& path, const core::TrackFileOptions& bare);

/// The issue of a table with too few lines.
base::Issue too_few_lines(const std::string& file, std::size_t lines);

/// The distinct values of a member among the lines, in ascending order.
std::vector<double> different(const std::vector<TableLine>& lines, double TableLine::*member);

/// One size that is fitted in addition to the nominal model: what one unit of it adds to ln(K/m) and to a0 (m/s²) of
/// every line.
struct LineTerm {
  std::string key;
  Eigen::VectorXd of_log_k, of_a0;
  bool both_signs = false;
  double largest = 0.0;  ///< in the unit of the key
};

/// Lines that share their own mu or K, and their name: "335 g, 4°", "4°".
struct LineCell {
  std::string name;
  std::vector<Eigen::Index> lines;
};

/// An effect that lines can show, in one of its forms.
struct LineCause {
  std::string id;
  Stage stage = Stage::dynamics;
  std::string words;
  std::vector<LineTerm> terms;         ///< one; n - 1 for a form with n cells, since the first has the nominal mu or K
  double share = 1.0;                  ///< share of the effect's odds
  std::optional<LinesOver> over = {};  ///< the form; none if one size applies to all lines
  std::vector<LineCell> cells = {};    ///< of the form
  bool drag = false;                   ///< of a form: each cell has its own K, not mu
};

/// Both kinds of data, and the nominal model's columns.
struct LineData {
  Eigen::VectorXd log_k, a0;
  Eigen::MatrixXd base_log_k, base_a0;
  double rounding_log_k = 0.0, rounding_a0 = 0.0;  ///< standard deviations due to the rounding of the numbers
};

LineData line_data(const std::vector<TableLine>& lines, double gravity_m_s2);

/// The effects that these lines can show, except those in `without`: effects of one size (what each does to a line is
/// in its file, diagnose/effects/effect.h, OnLines), then a mu, and a K, of each mass, of each set-up, or of each mass
/// on each set-up. If an effect has several forms, these are equally likely. Left out are effects that the nominal
/// model can imitate nearly completely (a cosine of kAlike), as with a single mass.
std::vector<LineCause> line_causes(const std::vector<TableLine>& lines, const LineData& data,
                                   const std::vector<std::string>& without);

/// A mu, and a K, of each mass on each set-up, each a cause; empty if there is only one of these.
std::vector<LineCause> own_of_each_configuration(const std::vector<TableLine>& lines, const LineData& data);

/// Effects whose lines are those of one of the `named` ones to first order (OnLines::same_as), except those in
/// `without`.
std::vector<std::string> same_on_lines_as(const std::vector<std::string>& named,
                                          const std::vector<std::string>& without);

/// A fit of lines by the nominal model and additional terms, and its quality.
struct LineSolution {
  Eigen::VectorXd size, sd;                    ///< of the terms; sd from the residuals
  Eigen::VectorXd all;                         ///< ln K, the intercept of each set-up, mu, and the terms' sizes
  Eigen::MatrixXd covariance;                  ///< of all
  Eigen::VectorXd off_k, off_a;                ///< measured less fitted
  double sd_k = 0.0, sd_a = 0.0;               ///< root mean square of the residuals
  std::vector<double> held_out_k, held_out_a;  ///< residuals of the prediction by the other lines
  std::optional<ImpossibleSize> left_out;      ///< the first size that is impossible, if any
};

/// Scatter without any model of friction: that of the mean intercept over both directions between masses of one set-up
/// (as that of one line), and that of K/m, relative, within each mass. 0 if nothing is repeated.
struct OwnScatter {
  double intercept_m_s2 = 0.0, slope = 0.0;
  std::size_t freedom = 0;  ///< degrees of freedom of both together
  bool known() const { return intercept_m_s2 > 0.0 && slope > 0.0; }
};

/// Weighted least squares of both kinds together; the errors follow from the residuals, in alternation.
LineSolution solve_lines(const LineData& data, const std::vector<LineTerm>& terms);

OwnScatter own_scatter(const std::vector<TableLine>& lines);

/// The logarithm of the Bayes factor at the head of this file, for one kind of data. `left` and `nominal_left` are root
/// mean squares of residuals. 0 if there are as many parameters as lines.
double log_bayes_factor(double left, double nominal_left, double lines, double nominal_parameters, double terms);

/// The log evidence of both kinds together, relative to the nominal model. A term that acts on both counts half in
/// each.
double log_line_evidence(const LineData& data, const std::vector<LineTerm>& terms, const LineSolution& with,
                         const LineSolution& nominal);

/// The gain of both kinds together, each with an unknown scatter: n ln(nominal rms / rms).
double log_likelihood_gain_of(const LineSolution& with, const LineSolution& nominal);

/// Sum of squares of the residuals over the lines' own scatter.
double chi_square_of(const LineSolution& solution, const OwnScatter& scatter);

/// Root mean square of line i's two held-out residuals over the lines' own scatter.
double gap_of_line(const LineSolution& solution, const OwnScatter& scatter, std::size_t i);
double gap_of_lines(const LineSolution& solution, const OwnScatter& scatter);

}  // namespace glidelab::diagnose
