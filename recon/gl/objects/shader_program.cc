#include "recon/gl/objects/shader_program.h"

#include <fmt/format.h>

#include "core/error.h"

namespace elbowroom::recon::gl {
namespace {

constexpr const char* kVersionLine = "#version 330 core\n";

struct VertexShaderKind {
  static GLuint Create() { return glCreateShader(GL_VERTEX_SHADER); }
  static void Destroy(GLuint name) { glDeleteShader(name); }
};
struct FragmentShaderKind {
  static GLuint Create() { return glCreateShader(GL_FRAGMENT_SHADER); }
  static void Destroy(GLuint name) { glDeleteShader(name); }
};

[[noreturn]] void ThrowFirstLine(const std::string& what, const std::string& log) {
  throw core::Error(core::ErrorKind::kGraphics,
                    fmt::format("the graphics driver refuses the {} shader: {}; update the driver or set "
                                "LIBGL_ALWAYS_SOFTWARE=1",
                                what, log.substr(0, log.find('\n'))));
}

void Compile(GLuint shader, const std::string& what, const std::string& source) {
  const std::string whole = kVersionLine + source;
  const char* text = whole.c_str();
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return;
  std::string log(1024, '\0');
  glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  ThrowFirstLine(what, log.c_str());
}

}  // namespace

ShaderProgram::ShaderProgram(const std::string& what, const std::string& vertex_source,
                             const std::string& fragment_source) {
  const GlName<VertexShaderKind> vertex_shader;
  const GlName<FragmentShaderKind> fragment_shader;
  Compile(vertex_shader.get(), what + " vertex", vertex_source);
  Compile(fragment_shader.get(), what + " fragment", fragment_source);
  glAttachShader(program_.get(), vertex_shader.get());
  glAttachShader(program_.get(), fragment_shader.get());
  glLinkProgram(program_.get());
  glDetachShader(program_.get(), vertex_shader.get());
  glDetachShader(program_.get(), fragment_shader.get());
  GLint linked = GL_FALSE;
  glGetProgramiv(program_.get(), GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return;
  std::string log(1024, '\0');
  glGetProgramInfoLog(program_.get(), static_cast<GLsizei>(log.size()), nullptr, log.data());
  ThrowFirstLine(what, log.c_str());
}

}  // namespace elbowroom::recon::gl
