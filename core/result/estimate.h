/// Numbers with their uncertainty, and what experiment.toml states about a configuration compared with its motion.
#pragma once

#include <optional>
#include <vector>

#include "core/result/analysis_note.h"
#include "core/result/results.h"
#include "core/result/why_unknown.h"

namespace glidelab::core {

/// The value with its 95 % interval: Student's t with `degrees` degrees of freedom, or the normal distribution if they
/// are infinite.
Estimate estimate(double value, double sd, double degrees);

/// The 97.5 % quantile of Student's t for any degrees above 0; of the normal distribution if they are infinite.
double student_t975(double degrees);

/// A variance, and how many degrees of freedom its own value has; infinite if it is known.
struct KnownVariance {
  double value = 0.0;
  double degrees = 0.0;
};

/// The value with a variance in two parts: one that is estimated, and one that is known, as that of a stated
/// inclination or of the camera. The half-width of the interval is the root of the sum of squares of those of
/// either part alone; Student's t belongs to the first.
Estimate estimate(double value, const KnownVariance& random, double known);

/// The sum of two parts that count as independent (Welch 1947 and Satterthwaite 1946: the degrees that give it the
/// right variance).
KnownVariance sum_of(const KnownVariance& one, const KnownVariance& other);

/// chi^2 per degree of freedom that is exceeded by chance with a probability of 0.00135, as a normal number exceeds
/// three standard deviations (Wilson and Hilferty 1931; the probability is accurate to a tenth from 2 degrees on).
double chi2_ratio_limit(double degrees);

/// `noise_sd`: the random part of the estimate's standard deviation (Quantity).
Quantity determined(const Estimate& estimate, std::optional<double> noise_sd = {});
Quantity undetermined(AnyReason why);

/// Why a line a = a0 - (K/m) v of v > 0 has no terminal velocity a0/(K/m); empty if it has one: both coefficients are
/// above zero by 1.96 standard deviations. `rate` is the reason if K/m is not.
std::optional<AnyReason> why_no_limit_velocity(const Estimate& k_over_m_1_s, unknown::RateNotPositive rate,
                                               const Estimate& a0_m_s2);

/// Laboratory gliders are lighter; masses given in grams instead of kilograms are not. What covers more than a glider's
/// track, as a sledge or a car does, may be as heavy; or its lengths are in another unit.
inline constexpr double kLargestMass_kg = 20.0, kLongestRun_m = 20.0;
inline constexpr double kMassRatio = 100.0;  ///< gliders of one track differ by less; grams instead of kilograms make
                                             ///< 1000

/// The stated inclination compared with that of the lines a = a0 - (K/m) v:
///
///     both directions: g sin(alpha) = (a0- + a0+)/2        (the paper's equation (13))
///     one direction:   friction brakes, so g sin(alpha) <= a0-, and g sin(alpha) >= a0+
///
/// A wrong length, frame rate or gravity shows up here as well as a wrong angle: a0 scales with the length scale, with
/// the square of the rate, and with g.
///
/// Empty if the two agree, or if there is nothing to compare. They disagree by more than half a degree and three
/// standard deviations of both together; grossly by more than one degree, a quarter of the stated angle and five
/// standard deviations (a choice: half a degree is typical of a track that was not carefully levelled).
std::optional<InclineContradiction> incline_contradiction(const ConfigurationResult& found, double gravity_m_s2,
                                                          const StatedIncline& stated);

/// As stated by incline_deg and incline_sd_deg of its clips.
StatedIncline stated_incline(const ConfigurationResult& configuration);

/// Adds notes about masses that look like grams, and about stated inclinations that the motion contradicts (grossly,
/// where no uncertainty is stated), in place of those that it added before. A configuration whose inclination is not
/// stated cannot be contradicted. What runs more than 20 m, as a sledge or a car does, may have any mass.
void note_statements(std::vector<ConfigurationResult>& results, const std::vector<ClipResult>& clips,
                     double gravity_m_s2);

}  // namespace glidelab::core
