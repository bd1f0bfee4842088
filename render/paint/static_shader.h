/// The fragment shader that casts a pixel's rays at the static scene (GLSL 3.30): wall, boxes, plumb line, board, and
/// the light on them. StaticPainter sets its uniforms.
#pragma once

#include <string>

namespace glidelab::render {

inline constexpr int kMostBoxes = 24;  ///< in a tile, and among those that cast shadows
inline constexpr int kPixelRays = 64;  ///< maximum per pixel; with_focus: kFocusRays
inline constexpr int kFocusRays = 256;

/// `with_focus`: rays start from the whole aperture of the lens.
std::string static_shader(bool with_focus);

}  // namespace glidelab::render
