/// The content of a certificate: whether the stated intervals hold in recordings like this one, the error of each
/// quantity, and what limits it. report/certificate puts it into words, as certify.json and a page.
///
/// Its numbers are statistics of grouped values: twins are runs, each with several configurations and quantities. The
/// values of one run (several intervals that contain the truth, or not) are correlated, because its configurations
/// share camera and clock. So the interval of a share is that of Clopper and Pearson, with the effective number of
/// independent values instead of the number of values: n / D, D = (variance of the share from run to run) / (p (1 - p)
/// / n), at least 1, and n / D is at least 1 as well (Korn and Graubard 1998). If all or none hold, nothing varies, and
/// each run counts once.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/result/why_unknown.h"

namespace glidelab::validate {

/// That of the stated intervals, and that with which they are judged.
inline constexpr double kCertifiedConfidence = 0.95;

/// The number of values that hold in one run.
struct RunCount {
  std::size_t holds = 0;
  std::size_t of = 0;
};

/// The share over all runs, with its interval.
struct RunShare {
  std::size_t holds = 0, of = 0;
  double share = 0.0;
  double low = 0.0, high = 1.0;
};

/// Runs with `of` = 0 do not count; without any runs the share is 0 and the interval 0 to 1.
RunShare share_of(const std::vector<RunCount>& runs, double confidence);

/// A mean over runs with its standard deviation, which is infinite for a single run.
struct RunMean {
  double value = 0.0, sd = 0.0;
};
/// The mean from each run's sum and number of values: sum of sums over sum of counts, with the jackknife's standard
/// deviation.
RunMean mean_of(const std::vector<double>& sums, const std::vector<double>& counts);

/// The reduction of an rms value: 1 - sqrt(sum after / sum before), from the squares of each run, before and after in
/// the same runs; the interval by the jackknife of ln(after / before) and Student's t.
struct RunFall {
  double value = 0.0;
  double low = 0.0, high = 0.0;  ///< for the requested confidence
};
/// Several quantities have equal weight: the mean of their logarithms. Each has the same runs, two or more (asserted).
RunFall fall_of(const std::vector<std::vector<double>>& before, const std::vector<std::vector<double>>& after,
                double confidence);

/// A configuration of the twins.
struct CertifiedSetup {
  std::string name;  ///< in the twin's scenario
  double mass_kg = 0.0;
  double incline_rad = 0.0;  ///< as stated
};

/// One of core::kQuantities over the twins, in its unit.
struct CertifiedQuantity {
  std::optional<std::size_t> setup;  ///< among Certificate::setups; empty: all together
  std::string quantity;
  std::size_t asked = 0;                     ///< number of values with known truth: twins times configurations
  std::size_t failed = 0;                    ///< of these, without an estimate
  RunShare coverage;                         ///< of the stated intervals of 95 %
  RunShare wide_coverage;                    ///< the same with an interval of 99 % over all quantities (Bonferroni)
  RunMean bias_sds;                          ///< error over stated sd
  double rms = 0.0;                          ///< of the errors
  double stated_sd = 0.0;                    ///< root mean square
  std::optional<core::WhyUnknown> why = {};  ///< why none has an estimate; empty: no clip could be used

  std::size_t answered() const { return asked - failed; }
  /// Fewer hold than 95 %, by more than chance makes.
  bool too_narrow() const { return answered() > 0 && wide_coverage.high < kCertifiedConfidence; }
};

/// The reduction of one quantity's error by a change.
struct QuantityFall {
  std::string quantity;
  RunFall fall;              ///< with an interval of 95 %
  bool significant = false;  ///< above 0 at 95 % over all changes and quantities (Bonferroni)
};

/// What may limit a recording, and what its twins have instead.
enum class TwinLimit {
  pixel_noise,     ///< of filmed twins: half the noise of each pixel
  position_noise,  ///< of tracks: half the noise of each position
  marker,          ///< twice its diameter
  frame_rate,      ///< twice as many frames
  scale,           ///< no error
  calibration,     ///< the camera without error
  codec,           ///< no loss
  rounding,        ///< positions with all their digits
  cause,           ///< no force but the viscous and the Coulomb friction
  clip_scatter,    ///< every clip by one law
  few_clips,       ///< every clip twice
};

/// One limitation removed or reduced, and the same twins recorded with this change.
struct ChangedTwin {
  TwinLimit limit = TwinLimit::few_clips;
  std::vector<std::string> causes = {};  ///< of TwinLimit::cause: ids of the effects, as far as they have names
  std::size_t runs = 0;
  std::vector<QuantityFall> quantities;
  std::optional<RunFall> together;  ///< K/m, mu and alpha (those that have values), interval of 95 %
  bool stands_out = false;          ///< together, above 0 at 95 % over all changes (Bonferroni)
};

/// The twins that follow one of the explanations weighed by the diagnosis.
struct CertifiedExplanation {
  std::vector<std::string> ids;  ///< effects that it contains; none: the nominal model
  double probability = 1.0;      ///< among all explanations that are recorded
  std::size_t twins = 0;
  RunShare coverage;  ///< of K/m, mu and alpha

  /// Fewer hold than 95 %, by more than chance makes.
  bool fails() const { return coverage.of > 0 && coverage.high < kCertifiedConfidence; }
};

/// Features of the recording that its twins lack, and why.
namespace lacking {

/// No scenario can express it.
struct Inexpressible {
  std::string what, why;  ///< as in diagnose::TwinLack
};

/// A scenario's camera would not see enough, so that tracks were simulated.
struct Images {
  std::string error;  ///< of the scenario
};

/// The pattern's calibration error: another folder has a scale, and all twins are measured by that.
struct Pattern {};

/// The scatter from clip to clip: errors of filming may explain it.
struct ClipScatter {};

/// The scatter of positions: something other than pixel noise makes that of the recording.
struct Noise {
  double recorded_m = 0.0, twin_m = 0.0;
};

}  // namespace lacking

using NotInTwins =
    std::variant<lacking::Inexpressible, lacking::Images, lacking::Pattern, lacking::ClipScatter, lacking::Noise>;

struct Certificate {
  std::size_t runs = 0;
  std::string estimator;
  bool filmed = false;                 ///< clips were filmed and tracked; otherwise positions were simulated
  std::size_t clips = 0;               ///< recorded
  std::size_t motions = 0;             ///< in these; each is a clip of a twin. 0: as many
  std::vector<CertifiedSetup> setups;  ///< the twins' configurations
  RunShare together;                   ///< coverage of K/m, mu and alpha, in all configurations
  RunShare wide_together;              ///< the same with the interval of CertifiedQuantity
  std::vector<CertifiedExplanation> explanations;     ///< those that the twins follow, the reported one first
  std::vector<CertifiedQuantity> quantities;          ///< all configurations together: those with a truth
  std::vector<CertifiedQuantity> configurations;      ///< each on its own, if there are several
  std::vector<ChangedTwin> changes;                   ///< in order of the largest combined fall
  std::vector<std::string> causes;                    ///< ids: named by the diagnosis, and in the twin
  std::vector<NotInTwins> without;                    ///< of the recording, and not in its twins
  double recorded_noise_m = 0.0, twin_noise_m = 0.0;  ///< of positions: medians over clips

  /// Whether the intervals hold, for K/m, mu, alpha together and for each quantity on its own.
  bool holds() const;
  /// Whether there is nothing to count: no quantity has a value beside a known truth.
  bool empty() const;
};

}  // namespace glidelab::validate
