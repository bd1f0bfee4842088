/// A dry friction mu (1 + r n) that changes steadily from clip to clip. n is the number of the clip in the order of the
/// file, from 0.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

void drifting_friction(const double* p, const GliderConstants& glider, const GliderState&, DryFriction& of) {
  of.mu *= 1.0 + p[0] * glider.clip;
}

/// With two clips, any difference would be a drift.
double drifts(const Circumstances& of) {
  return of.clips < 3 ? 0.0 : 1.0;
}

}  // namespace

EffectInfo friction_drift() {
  return {
      .id = ids::friction_drift,
      .stage = Stage::dynamics,
      .of_camera = false,
      .words = "a dry friction that changes steadily from clip to clip",
      .name = "drifting friction",
      .meaning = "µ becomes µ (1 + r n) in clip number n, counted from 0",
      .search = Search::amplitude,
      .both_signs = true,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {.of = AmongClips::Of::friction, .steadily = true},
      .point_scatter = {},
      .odds = drifts,
      .log_odds_beside_remainder = 0.0,
      .parameters =
          {{.key = "r_1_clip", .absent = 0.0, .low = -1.0, .high = 1.0, .step = 1e-6, .reach = Reach::per_clip}},
      .law = {.friction = drifting_friction, .steady = true, .passing = true},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::none("in a scenario all clips of a configuration have the same forces"),
      .in_images = std::nullopt,
      .next = {},
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
