/// Where a gap lies: at which stage between the world and the result, over which variable, and in which quantity of a
/// motion or an image.
#pragma once

#include <string_view>

namespace glidelab::diagnose {

/// Where between the world and the result an effect acts.
enum class Stage { dynamics, optics, timing, sensor, tracking, analysis };

/// The variable over which a gap is seen.
enum class GapVariable { acceleration, clip, direction, set_up, mass, time, column, speed, row, position };

/// The quantity that differs there from the model.
enum class GapKind {
  force,
  friction,
  viscous_drag,
  acceleration,
  displacement,
  lateness,
  scale,
  intercept,     ///< of a published line
  drag,          ///< of a published line
  marker_width,  ///< from here on: quantities of images
  marker_shear,
  brightness,
  scene_place,
  block_steps
};

/// Where a value comes from with which a fit, or a part of the data, is compared.
enum class Against { plumb, stated, all_clips };

/// What is compared with the model. Images are compared only if there are any.
enum class GapDomainKind { positions, phase_plane, parameters, images };

/// The word used in files: "dynamics".
std::string_view to_text(Stage stage);
/// The word used in diagnosis.json: "x_m", "group".
std::string_view to_text(GapVariable variable);
/// The words used in files and pages: "viscous drag".
std::string_view to_text(GapKind kind);
/// The words used in diagnosis.json and in tables: "plumb", "all clips".
std::string_view to_text(Against against);
/// The word used in diagnosis.json: "phase_plane"; "image" for images.
std::string_view to_text(GapDomainKind domain);

}  // namespace glidelab::diagnose
