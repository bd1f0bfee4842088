/// The parameters of the nominal model with any set of effects: which there are for a set of tracks, where they stand,
/// and the motion that they make of one track.
#pragma once

#include <Eigen/Core>

#include <vector>

#include "diagnose/effects/effect_library.h"
#include "diagnose/fit/effect_ranges.h"
#include "diagnose/model/track_model.h"
#include "diagnose/tracks/track_set.h"

namespace glidelab::diagnose {

/// Which parameters there are, and where they stand.
class ParameterLayout {
 public:
  ParameterLayout(const TrackSet& set, std::vector<std::size_t> effects);

  struct Global {
    enum class Kind { k, mu, alpha, mass, mode, scale, effect } kind;
    std::size_t index = 0;  ///< of the group, mass or mode
    const EffectParameter* parameter = nullptr;
    std::size_t effect = 0;
    double step = 0.0;
    ParameterRange range = {};  ///< of an effect: what it may be
  };
  const std::vector<Global>& globals() const { return globals_; }
  const std::vector<const EffectParameter*>& own() const { return own_; }  ///< after x0, v0
  const std::vector<std::size_t>& effects() const { return effects_; }
  /// Index among globals of an effect's first parameter that is not own.
  std::size_t first_of(std::size_t effect) const;
  /// Ranges that hold where a fit starts: what was found in whole clips may lie beyond what a part of them shows.
  void widen_to(const Eigen::VectorXd& start);

 private:
  std::vector<Global> globals_;
  std::vector<const EffectParameter*> own_;
  std::vector<std::size_t> effects_;
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

}  // namespace glidelab::diagnose
