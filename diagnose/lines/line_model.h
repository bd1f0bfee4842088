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
/// p0 - p) / 2) however little is left. Two causes at once would never be found where one of them explains nearly all.)
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

/// Columns mass_kg,incline_deg,direction,a0_m_s2,k_over_m_1_s,r2; others are ignored. InputError for what is out of
/// range and for fewer than kFewestLines.
std::vector<TableLine> read_lines(const std::filesystem::path& file);

/// An experiment folder; or a table of lines that lies in no folder, a CSV file whose header has k_over_m_1_s: an
/// experiment named after the file, of its lines alone, with the default gravity; or any other file, a track.
/// InputError as from read_tracks() (core/track/bare_track.h); the contents of a table are not examined.
core::Experiment read_recording(const std::filesystem::path& path, const core::TrackFileOptions& bare);

/// The issue of a table with too few lines.
base::Issue too_few_lines(const std::string& file, std::size_t lines);

/// The values of a member among the lines, ascending, each once.
std::vector<double> different(const std::vector<TableLine>& lines, double TableLine::*member);

/// One size that is fitted beside the nominal model: what one unit of it adds to ln(K/m) and to a0 (m/s²) of every
/// line.
struct LineTerm {
  std::string key;
  Eigen::VectorXd of_log_k, of_a0;
  bool both_signs = false;
  double largest = 0.0;  ///< in the unit of the key
};

/// Lines that have a mu or a K of their own together, and which: "335 g, 4°", "4°".
struct LineCell {
  std::string name;
  std::vector<Eigen::Index> lines;
};

/// An effect that lines can show, in one of its forms.
struct LineCause {
  std::string id;
  Stage stage = Stage::dynamics;
  std::string words;
  std::vector<LineTerm> terms;         ///< one; of a form with n cells n - 1, since the first has the nominal mu or K
  double share = 1.0;                  ///< of the effect's odds
  std::optional<LinesOver> over = {};  ///< the form; none where one size goes for all lines
  std::vector<LineCell> cells = {};    ///< of the form
  bool drag = false;                   ///< of a form: a K of each cell, not a mu
};

/// Both kinds of data, and the nominal model's columns.
struct LineData {
  Eigen::VectorXd log_k, a0;
  Eigen::MatrixXd base_log_k, base_a0;
  double rounding_log_k = 0.0, rounding_a0 = 0.0;  ///< standard deviations of the numbers' own rounding
};

LineData line_data(const std::vector<TableLine>& lines, double gravity_m_s2);

/// The effects that these lines can show, less what is left `without`: those of one size (what each does to a line
/// stands in its file, diagnose/effects/effect.h, OnLines), then a mu, and a K, of each mass, of each set-up, or of
/// each mass on each set-up. Of an effect with several forms each is as likely as another. None of which the nominal
/// model can make nearly all itself (a cosine of kAlike), as with a single mass.
std::vector<LineCause> line_causes(const std::vector<TableLine>& lines, const LineData& data,
                                   const std::vector<std::string>& without);

/// A mu, and a K, of each mass on each set-up, each a cause; empty where there is one of these alone.
std::vector<LineCause> own_of_each_configuration(const std::vector<TableLine>& lines, const LineData& data);

/// Effects of the speed whose lines are those of load_independent_friction, less what is left `without`.
std::vector<std::string> alike_friction_force(const std::vector<std::string>& without);

/// Lines fitted by the nominal model and terms beside it, and how well.
struct LineSolution {
  Eigen::VectorXd size, sd;                    ///< of the terms; sd from what is left
  Eigen::VectorXd all;                         ///< ln K, the intercept of each set-up, mu, and the terms' sizes
  Eigen::MatrixXd covariance;                  ///< of all
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

/// Weighted least squares of both kinds together; their errors from the residuals, in turn.
LineSolution solve_lines(const LineData& data, const std::vector<LineTerm>& terms);

OwnScatter own_scatter(const std::vector<TableLine>& lines);

/// The logarithm of the Bayes factor that the head of this file states, for one kind of data. `left` and `nominal_left`
/// are root mean squares. 0 where there are as many parameters as lines.
double log_bayes_factor(double left, double nominal_left, double lines, double nominal_parameters, double terms);

/// Of both kinds together, against the nominal model. A term that acts on both is half a one of each.
double log_line_evidence(const LineData& data, const std::vector<LineTerm>& terms, const LineSolution& with,
                         const LineSolution& nominal);

/// Of both kinds together, each with an unknown scatter: n ln(nominal rms / rms).
double log_likelihood_gain_of(const LineSolution& with, const LineSolution& nominal);

/// Sum of squares of what is left over the lines' own scatter.
double chi_square_of(const LineSolution& solution, const OwnScatter& scatter);

/// Root mean square of line i's two held-out residuals over the lines' own scatter.
double gap_of_line(const LineSolution& solution, const OwnScatter& scatter, std::size_t i);
double gap_of_lines(const LineSolution& solution, const OwnScatter& scatter);

}  // namespace glidelab::diagnose
