/// The model that is fitted: the nominal model with any set of effects, its parameters and their ranges, the resulting
/// motion, and the derivatives of that motion.
///
/// The constants are limits that several searches share and that must be the same in each.
#pragma once

#include <Eigen/Core>

#include <compare>
#include <cstddef>
#include <vector>

#include "diagnose/effects/effect.h"
#include "diagnose/effects/effect_library.h"
#include "diagnose/model/track_model.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// An effect is visible at all only if its largest size shows by this many standard deviations.
inline constexpr double kVisible_sd = 4.0;

/// Standard deviation of the prior of an unstated inclination: practically free.
inline constexpr double kOpenInclination_rad = 0.35;

/// Near the vertical the inclination is taken as stated, or, if it is not stated, as known to within a plumb line's
/// error. If only falls were recorded, mu is held at 0 and not determined: there is almost no normal force on the
/// track, and together with a free inclination mu would imitate any constant force.
inline constexpr double kFallInclination_rad = 0.0175, kFallFriction = 1e-4;

/// Log evidence above which a finding is acted upon without being weighed against anything else.
inline constexpr double kBeyondDoubt = 5.0;

/// Positions in excess of the free parameters, the fewest that show whether a model fits.
inline constexpr std::size_t kFewestSpare = 6;

/// The parameters that only the positions determine, of the nominal model with these effects: K, or the quadratic drag
/// in its place; the starts of all motions; mu and the inclinations, except in a fall; those of the effects, of which
/// many sizes of one kind count as one.
std::size_t free_parameters(const TrackSet& set, const std::vector<std::size_t>& effects);

/// The fewest points at which the shape of a scatter is informative.
inline constexpr std::size_t kFewestScatter = 50;

/// Timing jitter of filmed clips below this is taken as zero, for a marker that moves at up to this speed in the image:
/// a hundredth of a short exposure, or the time in which it moves 0.015 px. A centre errs by up to 0.012 px with its
/// place in the pixel (docs/evidence/other-renderers.md), slowly at low speed and like noise at high speed, as with
/// jitter.
double least_filmed_jitter_s(double top_px_s);

struct ParameterRange {
  double low = 0.0, high = 0.0;
};

/// Whether a size stands at an end of its range other than the one at which it has no effect.
bool is_at_end(const ParameterRange& range, double value, double absent);

/// The range of an effect's parameter for the given data. It is the same for the scan, which averages the evidence over
/// it, and for the fit: a fit that went further would gain from sizes that its evidence does not average over. Limits
/// are needed, as a wave slower than the clips can imitate any drift, and a cable that tightens before the first
/// position, or a lens whose axis is outside the image, can imitate any bend.
///
/// Sizes are as the effects state them; those proportional to the mass are for the heaviest glider. A location lies
/// within the range of positions. A frequency makes at least two periods in the longest motion. A release comes after
/// four frames, and within half a second and the first two fifths of the longest motion; where only falls were
/// recorded, before the body has fallen 0.15 m. A Stribeck speed lies above the speed up to which a codec may hold the
/// marker in place (TrackSet::held_m_s). Friction that drifts is not negative in the last clip. Where only falls were
/// recorded, an inertia without weight is up to 500 times the mass of the heaviest object, a Maxwell wheel's; that of
/// the air beside a quadratic drag (`beside`: the other effects of the model) up to ten times that of the lightest.
ParameterRange range_of(const TrackSet& set, const EffectParameter& parameter,
                        const std::vector<std::size_t>& beside = {});

/// From the smallest to the largest position.
ParameterRange range_of_places(const TrackSet& set);

/// Whether a motion begins with its clip, so that a hand could still be touching the glider.
bool begins_with_its_clip(const TrackSet& set, const TrackedMotion& motion);

/// A mass on one set-up of the track.
struct Configuration {
  std::size_t group = 0, mass = 0;
  auto operator<=>(const Configuration&) const = default;
};

/// The configurations of a set's motions, in order.
std::vector<Configuration> configurations_of(const TrackSet& set);

/// The parameters of the nominal model with any set of effects: which of them exist for a set of tracks, and their
/// indices.
class ParameterLayout {
 public:
  ParameterLayout(const TrackSet& set, std::vector<std::size_t> effects);
  /// For motions that are not in `like`: an effect has the parameters of the configurations and clips of `like`, and
  /// the range of locations is the same.
  ParameterLayout(const TrackSet& set, std::vector<std::size_t> effects, const ParameterLayout& like);

  struct Global {
    enum class Kind { k, mu, alpha, gravity, mass, mode, scale, effect } kind;
    std::size_t index = 0;  ///< of the group, mass, mode, or clip
    const EffectParameter* parameter = nullptr;
    std::size_t effect = 0;
    double step = 0.0;
    ParameterRange range = {};         ///< allowed range of an effect's parameter
    Configuration configuration = {};  ///< used if the parameter is one of Each::configuration
  };
  /// Whether two layouts mean the same parameter by a and b: of the same group, mass, mode, configuration or clip.
  static bool same(const Global& a, const Global& b) {
    return a.kind == b.kind && a.index == b.index && a.parameter == b.parameter && a.configuration == b.configuration;
  }
  const std::vector<Global>& globals() const { return globals_; }
  const std::vector<const EffectParameter*>& own() const { return own_; }  ///< they follow x0 and v0
  const std::vector<std::size_t>& effects() const { return effects_; }
  const ParameterRange& places() const { return places_; }  ///< range of all positions
  /// Index among globals of an effect's first parameter that is not a motion's own.
  std::size_t first_of(std::size_t effect) const;
  /// The indices among globals of one parameter of an effect: more than one if each configuration or clip has its own.
  std::vector<std::size_t> all_of(const EffectSlot& slot) const;
  /// Widens the ranges to include the start of a fit: what was found in whole clips may lie beyond what a part of them
  /// shows.
  void widen_to(const Eigen::VectorXd& start);

 private:
  void add_common(const TrackSet& set);
  void add_effect(const TrackSet& set, std::size_t effect);

  std::vector<Global> globals_;
  std::vector<const EffectParameter*> own_;
  std::vector<std::size_t> effects_;
  std::vector<Configuration> configurations_;
  std::vector<std::size_t> clips_;
  ParameterRange places_;
};

struct FitPoint {
  Eigen::VectorXd global;
  std::vector<Eigen::VectorXd> own;  ///< x0, v0 (at the motion's first point), then the effects' own
};

/// Whether a motion depends on a parameter.
bool touches(const TrackSet& set, const ParameterLayout::Global& global, std::size_t motion);

/// The model of one track's motion at these parameters; `unnamed` is an additional force.
TrackModel model_of(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at, std::size_t motion,
                    const UnnamedForce* unnamed = nullptr);

/// What the shared errors (of camera, plane, scale, pixels) at these parameters add to a motion's modelled positions
/// `x_m`.
std::vector<double> shared_errors(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at,
                                  std::size_t motion, const std::vector<double>& x_m);

/// The delay of each point of each motion relative to its stated time (dropped frames); empty: none.
using Lateness = std::vector<std::vector<double>>;

/// One over the noise of each position of a motion; 0 at outliers.
std::vector<double> weights_of(const TrackedMotion& motion);

/// One motion at one point in parameter space: its residuals, and the model's derivatives with respect to the
/// parameters, both divided by the noise.
struct FitMotion {
  Eigen::VectorXd residual;  ///< with unit white noise
  Eigen::VectorXd plain;     ///< divided by each position's own noise, still correlated between neighbours
  Eigen::MatrixXd global;
  Eigen::MatrixXd own;
  std::vector<double> x_m, v_m_s;  ///< of the model, without the shared errors
};

/// `forward` differences take half the time and serve for the steps of a fit. `central` differences, whose error is of
/// second order, serve for everything that rests on the result: if the nuisance parameters absorb nearly all of an
/// effect, what is left must not be the error of the derivatives.
enum class Derivatives { none, forward, central };

/// The same motion at the same point, with its derivatives by finite differences.
void add_derivatives(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at, std::size_t motion,
                     const Lateness& late, Derivatives derivatives, FitMotion& of);

/// The linearised motion with this index.
FitMotion linearise(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at, std::size_t motion,
                    const Lateness& late, Derivatives derivatives);

}  // namespace glidelab::diagnose
