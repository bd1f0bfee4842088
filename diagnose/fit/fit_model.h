/// The model that is fitted: the nominal model with any set of effects, its parameters and their ranges, the motion
/// that they make, and that motion's derivatives.
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

/// Standard deviations that the largest size of an effect must make to be visible at all.
inline constexpr double kVisible_sd = 4.0;

/// Standard deviation of the prior of an inclination that is not stated: practically free.
inline constexpr double kOpenInclination_rad = 0.35;

/// Near the vertical the inclination is taken as stated, to within a plumb line's error where none is stated. Where
/// only falls were recorded, mu is held at 0 and not determined: almost no force presses on a track, and together with
/// a free inclination mu would imitate any constant force.
inline constexpr double kFallInclination_rad = 0.0175, kFallFriction = 1e-4;

/// Log evidence above which something is acted upon without being weighed against anything else.
inline constexpr double kBeyondDoubt = 5.0;

/// The fewest points at which the shape of a scatter says anything.
inline constexpr std::size_t kFewestScatter = 50;

/// Uneven times of filmed clips below this are none: a hundredth of a short exposure.
inline constexpr double kLeastFilmedJitter_s = 1e-5;

struct ParameterRange {
  double low = 0.0, high = 0.0;
};

/// The range of an effect's parameter in given data: one range for the scan, which averages evidence over it, and for
/// the fit. A fit that went further would gain from sizes that its evidence does not average over. A wave slower than
/// the clips can imitate any drift; a cable that tightens before the first position, or a lens whose axis is outside
/// the image, can imitate any bend.
///
/// Sizes are as the effects state them, those proportional to the mass for the heaviest glider. A place lies within the
/// range of positions. A frequency makes at least two turns in the longest motion. A release comes after four frames,
/// and within half a second and the first two fifths of the longest motion. A Stribeck speed lies above that at which a
/// codec may hold the marker (TrackSet::held_m_s).
ParameterRange range_of(const TrackSet& set, const EffectParameter& parameter);

/// From the least to the largest position.
ParameterRange range_of_places(const TrackSet& set);

/// Whether a motion begins with its clip, so that a hand could be in it.
bool begins_with_its_clip(const TrackSet& set, const TrackedMotion& motion);

/// A mass on a set-up.
struct Configuration {
  std::size_t group = 0, mass = 0;
  auto operator<=>(const Configuration&) const = default;
};

/// Those of a set's motions, in order.
std::vector<Configuration> configurations_of(const TrackSet& set);

/// The parameters of the nominal model with any set of effects: which exist for a set of tracks, and their indices.
class ParameterLayout {
 public:
  ParameterLayout(const TrackSet& set, std::vector<std::size_t> effects);
  /// For motions that are not in `like`: an effect's parameters are those of the configurations and clips of `like`,
  /// and the range of places is the same.
  ParameterLayout(const TrackSet& set, std::vector<std::size_t> effects, const ParameterLayout& like);

  struct Global {
    enum class Kind { k, mu, alpha, mass, mode, scale, effect } kind;
    std::size_t index = 0;  ///< of the group, mass, mode, or clip
    const EffectParameter* parameter = nullptr;
    std::size_t effect = 0;
    double step = 0.0;
    ParameterRange range = {};         ///< of an effect: what it may be
    Configuration configuration = {};  ///< of Each::configuration
  };
  /// Whether two layouts mean the same parameter by these, of the same group, mass, mode, configuration or clip.
  static bool same(const Global& a, const Global& b) {
    return a.kind == b.kind && a.index == b.index && a.parameter == b.parameter && a.configuration == b.configuration;
  }
  const std::vector<Global>& globals() const { return globals_; }
  const std::vector<const EffectParameter*>& own() const { return own_; }  ///< after x0, v0
  const std::vector<std::size_t>& effects() const { return effects_; }
  const ParameterRange& places() const { return places_; }  ///< of all positions
  /// Index among globals of an effect's first parameter that is not own.
  std::size_t first_of(std::size_t effect) const;
  /// The indices among globals of one parameter of an effect: more than one where each configuration or clip has its
  /// own.
  std::vector<std::size_t> all_of(const EffectSlot& slot) const;
  /// Ranges that include where a fit starts: what was found in whole clips may lie beyond what a part of them shows.
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

/// The motion of one track under the point's parameters; `unnamed` is an additional force.
TrackModel model_of(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at, std::size_t motion,
                    const UnnamedForce* unnamed = nullptr);

/// What the shared errors (of camera, plane, scale, pixels) at this point add to a motion's modelled positions `x_m`.
std::vector<double> shared_errors(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at,
                                  std::size_t motion, const std::vector<double>& x_m);

/// How much later than stated each point of each motion is (dropped frames); empty: not at all.
using Lateness = std::vector<std::vector<double>>;

/// One motion at a point of the parameters: what the model leaves of its positions, and the model's derivatives by the
/// parameters, both over the noise.
struct FitMotion {
  Eigen::VectorXd residual;  ///< of unit white noise
  Eigen::VectorXd plain;     ///< over each position's own noise, with what neighbours share of it
  Eigen::MatrixXd global;
  Eigen::MatrixXd own;
  std::vector<double> v_m_s;
};

/// `forward` differences take half the time and are for the steps of a fit; `central` ones, with the square of their
/// error, are for what rests on the result: the rest of an effect that the nuisance parameters nearly absorb must not
/// be the error of the derivatives.
enum class Derivatives { none, forward, central };

/// Of the motion with this index, by finite differences.
FitMotion linearise(const TrackSet& set, const ParameterLayout& layout, const FitPoint& at, std::size_t motion,
                    const Lateness& late, Derivatives derivatives);

}  // namespace glidelab::diagnose
