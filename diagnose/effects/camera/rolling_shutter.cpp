/// A rolling shutter: the rows of the image are exposed one after the other, each later than the one above by the line
/// time. Fitted: the excess over the stated line time.
#include "diagnose/effects/effect.h"

#include <cmath>

namespace glidelab::diagnose::effects {
namespace {

double rows_late(const double* p) {
  return p[0];
}

void rows_twin(const TwinSizes& sizes, TwinCamera& camera) {
  const auto found = sizes.of("line_s");
  if (!found) return;
  if (!camera.filmed || std::abs(*found) * camera.height_px > camera.stated_frame_s) {
    return camera.lack(ids::rolling_shutter, "a scenario reads all rows within the frame time");
  }
  camera.line_s = *found;
  camera.notes.emplace_back("render states the true shutter in experiment.toml; the data's own folder states another");
}

}  // namespace

EffectInfo rolling_shutter() {
  return {
      .id = ids::rolling_shutter,
      .stage = Stage::timing,
      .of_camera = true,
      .words = "a rolling shutter that differs from the stated one",
      .name = "rolling shutter",
      .meaning = "line: the time from the exposure of one row to that of the next",
      .search = Search::rows,
      .both_signs = true,
      .drag = Drag::none,
      .touch = Touch::nothing,
      .mirror = {},
      .among_clips = {},
      .point_scatter = {},
      .odds = nullptr,
      .log_odds_beside_remainder = 0.0,
      .parameters = {{.key = "line_s",
                      .absent = 0.0,
                      .low = -3e-4,
                      .high = 3e-4,
                      .step = 1e-7,
                      .shown_as = ShownAs::beside_stated}},
      .law = {.row_s = rows_late},
      .shapes = nullptr,
      .lines = {},
      .twin = EffectTwin::as_camera(TwinPart::shutter, rows_twin),
      .in_images = InImages{.over = GapVariable::row, .what = GapKind::marker_shear},
      .next =
          "Turn the camera upside down and record the same launch again (or film it with a global shutter): rows are "
          "then read across the track in the opposite order, so their delay and the marker's shear change sign, "
          "and a force does not.",
      .alike = {},
  };
}

}  // namespace glidelab::diagnose::effects
