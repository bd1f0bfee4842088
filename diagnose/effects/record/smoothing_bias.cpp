/// The bias of the smoothing itself, which bends a(v) near v = 0. Only a table of lines shows it.
#include "diagnose/effects/effect.h"

namespace glidelab::diagnose::effects {
namespace {

/// a0 - s c (K/m)², s the direction, c in m.
LineChange smoothing_lines(const LineQuantities& line) {
  return {0.0, -line.direction * line.k_over_m_1_s * line.k_over_m_1_s};
}

}  // namespace

EffectInfo smoothing_bias() {
  return {
      .id = ids::smoothing_bias,
      .stage = Stage::analysis,
      .of_camera = false,
      .words = "the bias of the smoothing itself, which bends a(v) near v = 0 in proportion to (K/m)²",
      .name = "smoothing bias",
      .meaning = "intercepts are off by this for each 1/s² of (K/m)²",
      .search = Search::lines,
      .both_signs = false,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {},
      .law = {},
      .shapes = nullptr,
      .lines = {.change = smoothing_lines, .key = "intercept_s2_m_s2", .largest = 1.0, .unknown_key = "bandwidth_s"},
      .twin = EffectTwin::none("a table of lines has no motion to simulate"),
      .in_images = std::nullopt,
      .next =
          "Analyse the same clips with half and with twice the bandwidth: a smoothing bias changes with its "
          "square.",
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
