/// Images by fragment shaders, off screen and in single precision: an OSMesa context managed by RAII.
///
/// A canvas has one render target of floats, textures of floats that shaders read with texelFetch, and programs, each
/// made of one fragment shader (GLSL 3.30) that runs once for every pixel of a rectangle. Row 0 of the target is the
/// image's top row: the shader's ivec2(gl_FragCoord.xy) is the target's (column, row), and this is the one place
/// where OpenGL's half pixel is dropped.
///
/// A canvas belongs to one thread at a time. Errors: EnvironmentError if OSMesa provides no 3.3 core context or no
/// float target; std::logic_error with the compiler's message for a shader that does not compile (a programmer's
/// mistake).
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <string_view>

#include "render/image/float_image.h"

namespace glidelab::render {

class FloatCanvas {
 public:
  /// A target of width x height pixels with `channels` (1, 2 or 4) floats each.
  FloatCanvas(int width, int height, int channels);
  ~FloatCanvas();
  FloatCanvas(const FloatCanvas&) = delete;
  FloatCanvas& operator=(const FloatCanvas&) = delete;

  /// Returns the texture unit at which shaders find it; values row by row, 1, 2 or 4 channels.
  int add_texture(int width, int height, int channels, std::span<const float> values);

  /// Replaces the values of a texture by as many others.
  void update_texture(int unit, int width, int height, int channels, std::span<const float> values);

  /// Compiles a fragment shader and returns its number.
  int add_program(std::string_view fragment_shader);

  /// Selects the program to which set() and draw() refer from now on.
  void use(int program);
  void set(const char* name, int value);
  void set(const char* name, float value);
  void set(const char* name, const Eigen::Vector2f& value);
  void set(const char* name, const Eigen::Vector3f& value);
  void set(const char* name, const Eigen::Vector4f& value);
  void set(const char* name, const Eigen::Matrix3f& value);
  void set_array(const char* name, std::span<const Eigen::Vector2f> values);
  void set_array(const char* name, std::span<const Eigen::Vector4f> values);

  /// Runs the program on every pixel of the rectangle of the target.
  void draw(const PixelRect& rect);

  /// Copies a rectangle of the target, row by row from its top; `values` holds exactly width x height x channels.
  void read(const PixelRect& rect, std::span<float> values);

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

}  // namespace glidelab::render
