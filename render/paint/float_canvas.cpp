#define GL_GLEXT_PROTOTYPES
#include "render/paint/float_canvas.h"

#include <GL/gl.h>
#include <GL/glext.h>
#include <GL/osmesa.h>
#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/errors.h"

namespace glidelab::render {
namespace {

// One triangle that covers the viewport, from the vertex number alone.
constexpr const char* kVertexShader = R"(#version 330 core
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  gl_Position = vec4(corner, 0.0, 1.0);
}
)";

struct FloatFormat {
  GLint internal;
  GLenum external;
};

FloatFormat format_of(int channels) {
  switch (channels) {
    case 1:
      return {GL_R32F, GL_RED};
    case 2:
      return {GL_RG32F, GL_RG};
    case 4:
      return {GL_RGBA32F, GL_RGBA};
    default:
      throw std::logic_error(fmt::format("a float texture has 1, 2 or 4 channels, not {}", channels));
  }
}

GLuint compile(GLenum kind, const std::string& source) {
  const GLuint shader = glCreateShader(kind);
  const char* text = source.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled != GL_TRUE) {
    std::array<char, 4096> log{};
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::logic_error(fmt::format("shader does not compile:\n{}", log.data()));
  }
  return shader;
}

}  // namespace

// Everything that GL holds is freed with the context.
struct FloatCanvas::Context {
  OSMesaContext mesa = nullptr;
  std::array<unsigned char, 4> unused_color_buffer{};  // required by OSMesa; drawing goes to the float target
  int width = 0;
  int height = 0;
  int channels = 0;
  int textures = 0;
  GLuint program = 0;
  std::vector<GLuint> programs;

  ~Context() {
    if (mesa != nullptr) OSMesaDestroyContext(mesa);
  }
  void make_current() {
    if (OSMesaGetCurrentContext() == mesa) return;
    if (OSMesaMakeCurrent(mesa, unused_color_buffer.data(), GL_UNSIGNED_BYTE, 1, 1) != GL_TRUE) {
      throw base::EnvironmentError("off-screen OpenGL (OSMesa) cannot be made current");
    }
  }
  GLint location(const char* name) {
    make_current();
    const GLint found = glGetUniformLocation(program, name);
    if (found < 0) throw std::logic_error(fmt::format("shader has no uniform '{}'", name));
    return found;
  }
};

FloatCanvas::FloatCanvas(int width, int height, int channels) : context_(std::make_unique<Context>()) {
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            3,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            3,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_STENCIL_BITS,
                            0,
                            0};
  context_->mesa = OSMesaCreateContextAttribs(attributes, nullptr);
  if (context_->mesa == nullptr) throw base::EnvironmentError("off-screen OpenGL 3.3 (OSMesa) is not available");
  context_->width = width;
  context_->height = height;
  context_->channels = channels;
  context_->make_current();

  GLuint target = 0;
  glGenTextures(1, &target);
  glBindTexture(GL_TEXTURE_2D, target);
  const FloatFormat format = format_of(channels);
  glTexImage2D(GL_TEXTURE_2D, 0, format.internal, width, height, 0, format.external, GL_FLOAT, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  GLuint framebuffer = 0;
  glGenFramebuffers(1, &framebuffer);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    throw base::EnvironmentError(fmt::format("off-screen OpenGL gives no float target of {} x {}", width, height));
  }
  GLuint vertices = 0;
  glGenVertexArrays(1, &vertices);
  glBindVertexArray(vertices);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

FloatCanvas::~FloatCanvas() = default;

int FloatCanvas::add_texture(int width, int height, int channels, std::span<const float> values) {
  context_->make_current();
  const int unit = context_->textures++;
  GLuint texture = 0;
  glGenTextures(1, &texture);
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  update_texture(unit, width, height, channels, values);
  return unit;
}

void FloatCanvas::update_texture(int unit, int width, int height, int channels, std::span<const float> values) {
  if (values.size() != static_cast<std::size_t>(width) * height * channels) {
    throw std::logic_error(
        fmt::format("texture of {} x {} x {} from {} values", width, height, channels, values.size()));
  }
  context_->make_current();
  glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  const FloatFormat format = format_of(channels);
  glTexImage2D(GL_TEXTURE_2D, 0, format.internal, width, height, 0, format.external, GL_FLOAT, values.data());
  if (glGetError() != GL_NO_ERROR) {
    throw base::EnvironmentError(fmt::format("off-screen OpenGL takes no texture of {} x {}", width, height));
  }
}

int FloatCanvas::add_program(std::string_view fragment_shader) {
  context_->make_current();
  const GLuint program = glCreateProgram();
  glAttachShader(program, compile(GL_VERTEX_SHADER, kVertexShader));
  glAttachShader(program, compile(GL_FRAGMENT_SHADER, std::string(fragment_shader)));
  glLinkProgram(program);
  GLint linked = GL_FALSE;
  glGetProgramiv(program, GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) {
    std::array<char, 4096> log{};
    glGetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::logic_error(fmt::format("shader does not link:\n{}", log.data()));
  }
  context_->programs.push_back(program);
  use(static_cast<int>(context_->programs.size()) - 1);
  return static_cast<int>(context_->programs.size()) - 1;
}

void FloatCanvas::use(int program) {
  context_->make_current();
  context_->program = context_->programs.at(static_cast<std::size_t>(program));
  glUseProgram(context_->program);
}

void FloatCanvas::set(const char* name, int value) {
  glUniform1i(context_->location(name), value);
}
void FloatCanvas::set(const char* name, float value) {
  glUniform1f(context_->location(name), value);
}
void FloatCanvas::set(const char* name, const Eigen::Vector2f& value) {
  glUniform2fv(context_->location(name), 1, value.data());
}
void FloatCanvas::set(const char* name, const Eigen::Vector3f& value) {
  glUniform3fv(context_->location(name), 1, value.data());
}
void FloatCanvas::set(const char* name, const Eigen::Vector4f& value) {
  glUniform4fv(context_->location(name), 1, value.data());
}
void FloatCanvas::set(const char* name, const Eigen::Matrix3f& value) {
  glUniformMatrix3fv(context_->location(name), 1, GL_FALSE, value.data());
}
void FloatCanvas::set_array(const char* name, std::span<const Eigen::Vector2f> values) {
  if (values.empty()) return;
  glUniform2fv(context_->location(name), static_cast<GLsizei>(values.size()), values.front().data());
}
void FloatCanvas::set_array(const char* name, std::span<const Eigen::Vector4f> values) {
  if (values.empty()) return;
  glUniform4fv(context_->location(name), static_cast<GLsizei>(values.size()), values.front().data());
}

void FloatCanvas::draw(const PixelRect& rect) {
  if (rect.empty()) return;
  context_->make_current();
  glViewport(rect.x, rect.y, rect.width, rect.height);
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void FloatCanvas::read(const PixelRect& rect, std::span<float> values) {
  if (values.size() != static_cast<std::size_t>(rect.width) * rect.height * context_->channels) {
    throw std::logic_error(fmt::format("{} values for {} x {} pixels", values.size(), rect.width, rect.height));
  }
  if (rect.empty()) return;
  context_->make_current();
  glReadPixels(rect.x, rect.y, rect.width, rect.height, format_of(context_->channels).external, GL_FLOAT,
               values.data());
  if (const GLenum error = glGetError(); error != GL_NO_ERROR) {
    throw std::logic_error(fmt::format("OpenGL error {:#x} while drawing", error));
  }
}

}  // namespace glidelab::render
