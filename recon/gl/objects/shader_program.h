// A linked pair of shaders. For the .cc files of this folder: it includes OpenGL.
#pragma once

#include <Eigen/Core>
#include <string>

#include "recon/gl/objects/gl_name.h"

namespace elbowroom::recon::gl {

class ShaderProgram {
 public:
  // Sources without their #version line. Throws: Error{kGraphics} naming `what` and the compiler's first
  // line.
  ShaderProgram(const std::string& what, const std::string& vertex_source,
                const std::string& fragment_source);

  void Use() const { glUseProgram(program_.get()); }

  // The program must be in use. A name that the linker dropped is ignored, as OpenGL does.
  void Set(const char* name, int value) const { glUniform1i(At(name), value); }
  void Set(const char* name, float value) const { glUniform1f(At(name), value); }
  void Set(const char* name, const Eigen::Vector2i& value) const { glUniform2iv(At(name), 1, value.data()); }
  void Set(const char* name, const Eigen::Vector3i& value) const { glUniform3iv(At(name), 1, value.data()); }
  void Set(const char* name, const Eigen::Vector2f& value) const { glUniform2fv(At(name), 1, value.data()); }
  void Set(const char* name, const Eigen::Vector3f& value) const { glUniform3fv(At(name), 1, value.data()); }
  void Set(const char* name, const Eigen::Vector4f& value) const { glUniform4fv(At(name), 1, value.data()); }
  void Set(const char* name, const Eigen::Matrix3f& value) const {
    glUniformMatrix3fv(At(name), 1, GL_FALSE, value.data());
  }
  void Set(const char* name, const Eigen::Matrix4f& value) const {
    glUniformMatrix4fv(At(name), 1, GL_FALSE, value.data());
  }

 private:
  struct Kind {
    static GLuint Create() { return glCreateProgram(); }
    static void Destroy(GLuint name) { glDeleteProgram(name); }
  };
  [[nodiscard]] GLint At(const char* name) const { return glGetUniformLocation(program_.get(), name); }

  GlName<Kind> program_;
};

}  // namespace elbowroom::recon::gl
