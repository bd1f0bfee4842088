/// The body of one clip of a twin: that of its configuration, with what differs from clip to clip
/// (diagnose/causes/remainder.h).
#pragma once

#include "sim/force/force_law.h"

namespace glidelab::validate {

/// What a clip has of its own. In the direction of motion s it adds to the acceleration a constant, s times another
/// one, and a part of the drag.
struct ClipScatter {
  double incline_m_s2 = 0.0;   ///< positive downhill
  double friction_m_s2 = 0.0;  ///< positive along the motion
  double drag = 0.0;           ///< relative to K: positive is less drag
};

/// Whether the body has no normal force to speak of: core::is_fall() of its inclination.
bool falls(const sim::Body& body);

/// The inclination's part is a constant force. The friction's part changes mu, which does not fall below 0; a body
/// without friction keeps none. A body that falls has no load for a coefficient of friction: there it is a constant
/// force as well, which is the same while the motion keeps its direction. Drag is K; of a body that falls also c of
/// -c v |v|, which takes the place of K there (diagnose/fit/drag_of_air.h).
sim::Body scattered(sim::Body body, ClipScatter by);

/// The rate k + 2 c |v| at which drag takes a small change of the speed v away, per mass.
double drag_rate_1_s(const sim::Body& body, double v_m_s);

}  // namespace glidelab::validate
