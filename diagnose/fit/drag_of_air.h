/// The drag on a body that falls through air.
///
/// At the speeds of such falls (falls_through_air()) the drag of air grows with the square of the speed, and the
/// viscous K is bounded by Stokes' law:
///
///     K <= 6 pi eta r = 3.4e-5 N s/m     for r = 0.1 m in air, eta = 1.8e-5 Pa s.
///
/// A K that is fitted freely imitates the quadratic drag over a small range of speeds. So in a fall, K has that bound
/// as its standard deviation about 0 in every model with a quadratic drag: the quadratic drag takes the place of K, and
/// does not compete with it for the same braking. The models without it keep a free K, because a viscous drag may be
/// what acts after all (a magnet in a copper pipe, or made data), and have prior odds against them where braking shows
/// (weigh/air_odds.h).
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/tracks/tracked_motions.h"

namespace glidelab::diagnose {

inline constexpr double kStokesDrag_n_s_m = 3.4e-5;

/// The air that moves with a disc of radius r that falls at v is 17 r/v² (m, s) times its mass: 10 for 0.15 m and 0.5
/// m/s.
inline constexpr double kMostAirAlong_masses = 10.0;

/// Whether K is held at 0, to within Stokes' law, in a model with these effects.
bool holds_drag(const TrackSet& set, const std::vector<std::size_t>& effects);

/// Whether one more effect beside these takes the place of K.
bool takes_place_of_drag(const TrackSet& set, const std::vector<std::size_t>& effects, std::size_t effect);

/// The same motions with K held at 0 in every model: a fall without any drag, unless an effect is one.
TrackSet without_drag(TrackSet set);

}  // namespace glidelab::diagnose
